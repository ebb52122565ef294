#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh clone to moving figures in one command. `./go --help` says what it does.
set -euo pipefail
cd "$(dirname "$0")"

usage() {
    cat <<'END'
./go                builds build/puppetri and performs the ball game into out/
./go test           builds and runs all tests
./go test --strict  the same with warnings as errors, and the checks of style and layers

  --no-install      install nothing: say what is missing instead
  --jobs N          compile N files at a time (default: one per core)
END
}

# Program packages are needed when their command is missing, library packages when Debian does not know them installed.
build_tools=(g++:g++ cmake:cmake ninja:ninja-build ccache:ccache)
build_libraries=(tao-pegtl-dev libcli11-dev libfmt-dev libembree-dev libpng-dev libstb-dev libpugixml-dev nlohmann-json3-dev
    libboost1.81-dev libeigen3-dev)
film_tools=(ffmpeg:ffmpeg)
test_tools=(python3:python3)
test_libraries=(doctest-dev libtinygltf-dev librapidcheck-dev libbenchmark-dev)
reader_tools=(node:nodejs npm:npm)
strict_tools=(clang-format:clang-format)

command=perform
install=yes
strict=no
jobs=$(nproc)
while [ $# -gt 0 ]; do
    case "$1" in
        test) command=test ;;
        --strict) strict=yes ;;
        --no-install) install=no ;;
        --jobs) jobs=${2:?--jobs wants a number}; shift ;;
        -h | --help) usage; exit 0 ;;
        *) echo "go: unknown argument $1" >&2; usage >&2; exit 2 ;;
    esac
    shift
done

say() { printf '\n== %s\n' "$*"; }

# Prints those of "command:package" whose command is missing.
missing_tools() {
    local pair
    for pair in "$@"; do
        command -v "${pair%%:*}" > /dev/null || echo "${pair#*:}"
    done
}

# Prints those packages that are not installed; on a system without dpkg nobody knows, and cmake will say.
missing_libraries() {
    command -v dpkg-query > /dev/null || return 0
    local package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2> /dev/null)" = "ii " ] || echo "$package"
    done
}

# Installs the named packages; $1 says whether the work can go on without them.
install_packages() {
    local need=$1
    shift
    [ $# -gt 0 ] || return 0
    if [ "$install" = no ] || ! command -v apt-get > /dev/null; then
        echo "missing ($need): $*" >&2
        [ "$need" = optional ] || exit 2
        return 0
    fi
    local root=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo > /dev/null || { echo "go: become root, or install yourself: $*" >&2; exit 2; }
        root=(sudo)
    fi
    say "installing with apt-get ($need): $*"
    if [ -z "${lists_fresh:-}" ]; then
        "${root[@]}" apt-get -qq update || true
        lists_fresh=yes
    fi
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "$@" > /dev/null ||
        [ "$need" = optional ] || { echo "go: apt-get could not install: $*" >&2; exit 1; }
}

build() {
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" > build.log 2>&1 || { cat build.log; exit 1; }
    rm -f build.log
    ninja -C build -j "$jobs"
}

perform() {
    mapfile -t needed < <(missing_tools "${build_tools[@]}"; missing_libraries "${build_libraries[@]}")
    mapfile -t wished < <(missing_tools "${film_tools[@]}")
    install_packages needed "${needed[@]}"
    install_packages optional "${wished[@]}"
    say "building build/puppetri"
    build
    say "performing examples/03_ball/ball.pup"
    mkdir -p out
    build/puppetri run examples/03_ball/ball.pup
    build/puppetri export examples/03_ball/ball.pup -o out/ball.glb -o out/ball.bvh
    build/puppetri render examples/03_ball/ball.pup -o out/ball.mp4 --size 960x540 --frames 0-479
    say "done: build/puppetri is the program; the take, its film and its markers are in out/"
    ls -l out
}

run_tests() {
    mapfile -t needed < <(missing_tools "${build_tools[@]}" "${test_tools[@]}"
        missing_libraries "${build_libraries[@]}" "${test_libraries[@]}")
    mapfile -t wished < <(missing_tools "${film_tools[@]}" "${reader_tools[@]}")
    if [ "$strict" = yes ]; then
        mapfile -t -O "${#wished[@]}" wished < <(missing_tools "${strict_tools[@]}")
    fi
    install_packages needed "${needed[@]}"
    install_packages optional "${wished[@]}"
    say "building the tests"
    build -DPUPPETRI_TESTS=ON "-DPUPPETRI_WERROR=$([ "$strict" = yes ] && echo ON || echo OFF)"
    say "running the tests"
    ctest --test-dir build --output-on-failure -j "$jobs"
}

if [ "$command" = test ]; then
    run_tests
else
    perform
fi
