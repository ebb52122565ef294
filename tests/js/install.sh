#!/bin/sh
# Installs the packages of package-lock.json into FOLDER, once: install.sh FOLDER. Exit code 77 (skipped) where there is no
# npm or no registry.
set -eu
here=$(dirname "$0")
mkdir -p "$1"
cp "$here"/*.mjs "$here/package.json" "$1"
if cmp -s "$here/package-lock.json" "$1/installed.json"; then
    echo "already installed"
    exit 0
fi
cp "$here/package-lock.json" "$1"
cd "$1"
command -v npm > npm.log || { echo "skipped: there is no npm"; exit 77; }
if npm ci --no-audit --no-fund --loglevel=error > npm.log 2>&1; then
    cp package-lock.json installed.json
    echo "installed"
elif npm ping --fetch-retries=0 --fetch-timeout=5000 >> npm.log 2>&1; then
    cat npm.log
    exit 1
else
    cat npm.log
    echo "skipped: the registry of npm cannot be reached"
    exit 77
fi
