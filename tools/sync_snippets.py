#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keeps what Markdown files show equal to the files it comes from. Usage: sync_snippets.py [--check] [ROOT]

In a Markdown file, the code block after a line

    <!-- from examples/01_toss/toss.pup -->

holds that file (a path from the root), with its comments, without its last empty lines. Without --check the blocks are
brought up to date. Exit 0: all equal (or made so); 1: a block differs, or names a file that does not exist.
"""
import pathlib
import re
import sys

BLOCK = re.compile(r"^<!-- from (?P<path>\S+) -->\n(?P<fence>```+)(?P<kind>\w*)\n(?P<body>.*?)^(?P=fence)[ \t]*$", re.M | re.S)

NOT_OURS = re.compile(r"(^|/)(build[^/]*|out|node_modules|\.[^/]*)/")


def main():
    arguments = [a for a in sys.argv[1:] if a != "--check"]
    check = "--check" in sys.argv
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).resolve().parent.parent)
    blocks, defects = 0, []
    for page in sorted(root.rglob("*.md")):
        name = str(page.relative_to(root))
        if NOT_OURS.search(name):
            continue
        text = page.read_text()

        def current(match):
            nonlocal blocks
            blocks += 1
            line = text.count("\n", 0, match.start()) + 1
            source = root / match["path"]
            if not source.exists():
                defects.append(f"{name}:{line}: there is no {match['path']}")
                return match[0]
            body = source.read_text().rstrip("\n") + "\n"
            if body != match["body"] and check:
                defects.append(f"{name}:{line}: differs from {match['path']}; run tools/sync_snippets.py")
            return f"<!-- from {match['path']} -->\n{match['fence']}{match['kind']}\n{body}{match['fence']}"

        synced = BLOCK.sub(current, text)
        if synced != text and not check:
            page.write_text(synced)
    for defect in defects:
        print(defect)
    print(f"sync_snippets: {blocks} blocks, {len(defects)} defects")
    sys.exit(1 if defects else 0)


main()
