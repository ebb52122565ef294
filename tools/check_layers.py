#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that every #include stays in its module's row of layers.txt. Usage: check_layers.py [ROOT]

A module (include/puppetri/M, src/M) may include public headers of itself and of its row, and private headers of its own
folder. Programs (apps/) and tests may include every public header, never a private one of a module; benchmarks too.
Exit 0: fine; 1: violations, one per line as FILE:LINE: message; 2: layers.txt itself is wrong.
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]')
SOURCES = {".h", ".hpp", ".cpp", ".cc", ".ipp"}


def read_rows(path):
    rows = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        line = line.split("#")[0].strip()
        if not line:
            continue
        module, _, allowed = line.partition(":")
        for name in allowed.split():
            if name not in rows:  # rows go upwards: this also forbids cycles
                sys.exit(f"{path}:{number}: {module} may include {name}, which has no row above it")
        rows[module.strip()] = set(allowed.split())
    return rows


def files_below(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in SOURCES) if folder.is_dir() else []


def check_module(root, module, rows, report):
    own_public = root / "include/puppetri" / module
    own_private = root / "src" / module
    for path in files_below(own_public) + files_below(own_private):
        public = own_public in path.parents
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            quote, name = match.groups()
            if name.startswith("puppetri/"):
                other = name.split("/")[1]
                if not (root / "include" / name).is_file():
                    report(path, number, f"there is no include/{name}")
                elif other != module and other not in rows[module]:
                    report(path, number, f"{module} may not include {other} (layers.txt)")
            elif quote == '"':
                if public:
                    report(path, number, f'a public header may not include the private "{name}"')
                elif not any((folder / name).is_file() for folder in (path.parent, own_private)):
                    report(path, number, f'"{name}" is no private header of {module}; public ones are written "puppetri/..."')


def check_outside(root, folder, report):
    for path in files_below(root / folder):
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            match = INCLUDE.match(line)
            if match and re.search(r"(^|/)src/", match.group(2)):
                report(path, number, f"{folder} may include public headers only, not {match.group(2)}")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    rows = read_rows(root / "layers.txt")
    found = []

    def report(path, number, message):
        found.append(f"{path.relative_to(root)}:{number}: {message}")

    for folder in ("include/puppetri", "src"):
        for path in sorted((root / folder).iterdir()) if (root / folder).is_dir() else []:
            if path.is_dir() and path.name not in rows:
                found.append(f"{path.relative_to(root)}: no row in layers.txt")
    for module in rows:
        check_module(root, module, rows, report)
    for folder in ("apps", "tests", "bench"):
        check_outside(root, folder, report)
    print("\n".join(found) if found else f"check_layers: {len(rows)} modules, every include in its row")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
