#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles each public header alone, as a native and as a 32-bit one. Usage: check_headers.py [--compiler CXX] [ROOT]

The 32-bit pass needs no 32-bit system library: only syntax and sizes are checked, with the system's own headers. Headers
of modules that may not throw are compiled without exceptions and RTTI. Also checks the house rules for headers: SPDX line,
a paragraph of purpose, #pragma once, at most 400 lines, and that struct members do not have the size of a pointer
(std::size_t, ptrdiff_t), which would change hashes and files with the word size; members named with a trailing underscore
are private and may.
Exit 0: fine; 1: violations.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

MAY_THROW = {"lang", "io", "render"}
MOST_LINES = 400
MEMBER = re.compile(r"^\s+(?:std::)?(?:size_t|ptrdiff_t|uintptr_t|intptr_t)\s+(\w+)\s*(?:=[^;(]*)?;")


def in_class(lines, at):
    """Whether line `at` stands directly in the body of a struct or class, by its indentation."""
    depth = len(lines[at]) - len(lines[at].lstrip())
    for line in reversed(lines[:at]):
        if line.strip() and len(line) - len(line.lstrip()) < depth and not re.match(r"\s*(public|private|protected):", line):
            return re.match(r"\s*(template.*>\s*)?(struct|class)\b", line) is not None
    return False


def lint(path, name):
    lines = path.read_text(errors="replace").splitlines()
    if not lines or lines[0] != "// SPDX-License-Identifier: MIT":
        yield f"{name}:1: the first line is not // SPDX-License-Identifier: MIT"
    if len(lines) < 2 or not lines[1].startswith("// "):
        yield f"{name}:2: no paragraph of purpose"
    if "#pragma once" not in lines:
        yield f"{name}:1: no #pragma once"
    if len(lines) > MOST_LINES:
        yield f"{name}:{MOST_LINES}: longer than {MOST_LINES} lines"
    for number, line in enumerate(lines, 1):
        match = MEMBER.match(line)
        if match and in_class(lines, number - 1) and not match.group(1).endswith("_") and "// allowed: " not in line:
            yield f"{name}:{number}: {match.group(1)} changes its size with the word size: use std::uint32_t or std::uint64_t"


def compile_alone(compiler, root, header, flags):
    command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror",
               "-I", str(root / "include"), *flags, "-x", "c++", "-"]
    text = f'#include "{header}"\n#include "{header}"\n'
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    return None if done.returncode == 0 else done.stderr.strip()


def flags_of_32_bit(compiler, scratch):
    """Flags under which an empty C++ program with library headers compiles for 32 bits, or None."""
    stubs = scratch / "gnu"
    stubs.mkdir()
    (stubs / "stubs-32.h").write_text("")
    machine = subprocess.run([compiler, "-dumpmachine"], capture_output=True, text=True).stdout.strip()
    version = subprocess.run([compiler, "-dumpversion"], capture_output=True, text=True).stdout.strip().split(".")[0]
    flags = ["-m32", "-I", str(scratch), "-isystem", f"/usr/include/{machine}/c++/{version}",
             "-isystem", f"/usr/include/{machine}"]
    text = "#include <string>\n#include <vector>\nstatic_assert(sizeof(void*) == 4);\n"
    done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", *flags, "-x", "c++", "-"], input=text,
                          capture_output=True, text=True)
    return flags if done.returncode == 0 else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--compiler", default=os.environ.get("CXX", "g++"))
    parser.add_argument("root", nargs="?", default=str(pathlib.Path(__file__).parent.parent))
    options = parser.parse_args()
    root = pathlib.Path(options.root)
    headers = sorted((root / "include/puppetri").rglob("*.h"))
    found = []
    with tempfile.TemporaryDirectory() as scratch:
        narrow = flags_of_32_bit(options.compiler, pathlib.Path(scratch))
        jobs = []
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            for path in headers:
                name = path.relative_to(root / "include").as_posix()
                found += list(lint(path, f"include/{name}"))
                strict = [] if name.split("/")[1] in MAY_THROW else ["-fno-exceptions", "-fno-rtti"]
                jobs.append((name, "alone", pool.submit(compile_alone, options.compiler, root, name, strict)))
                if narrow is not None:
                    jobs.append((name, "in 32 bits", pool.submit(compile_alone, options.compiler, root, name, strict + narrow)))
        for name, how, job in jobs:
            if job.result() is not None:
                found.append(f"include/{name}: does not compile {how}\n{job.result()}")
    if found:
        print("\n".join(found))
        return 1
    print(f"check_headers: {len(headers)} headers compile alone" +
          (", also in 32 bits" if narrow is not None else " (no 32-bit pass with this compiler)"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
