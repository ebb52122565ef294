#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Rejects what would make results differ between systems, or break 32-bit WebAssembly. Usage: check_banned.py [ROOT]

Looks at include/ and src/ with comments and strings taken out. Which modules a rule is for stands with the rule; SAME are
those whose results are the same bits everywhere (docs: the log and everything that feeds it), CORE those that compile for
WebAssembly. A line that must break a rule says why in a comment: `// allowed: REASON`. Exit 0: fine; 1: violations.
"""
import pathlib
import re
import sys

SAME = {"base", "math", "net", "lang", "run", "figure", "motion", "stage", "scene"}
CORE = SAME
ALL = SAME | {"io", "render"}

# sqrt fabs floor ceil trunc nearbyint copysign, and round fmod remainder ldexp frexp scalbn, are exactly specified.
INEXACT = ("sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh sincos exp exp2 exp10 expm1 log log2 log10 "
           "log1p logb pow cbrt hypot erf erfc tgamma lgamma fma").split()
OURS = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log", "log1p", "pow"}
NAMES = "|".join(INEXACT)
DISTRIBUTIONS = ("uniform_int|uniform_real|bernoulli|binomial|geometric|negative_binomial|poisson|exponential|gamma|weibull|"
                 "extreme_value|normal|lognormal|chi_squared|cauchy|fisher_f|student_t|discrete|piecewise_constant|"
                 "piecewise_linear")

RULES = [  # (modules, only in headers, pattern, message)
    (SAME, False, rf"(?<![\w.>])(?:std)?::(?:{NAMES})[fl]?\s*\(", "libm: use puppetri/base/elementary.h"),
    (SAME, False, rf"(?<![\w.>:])(?:{NAMES})[fl]\s*\(", "libm in float or long double: use puppetri/base/elementary.h"),
    (SAME, False, rf"\bstd::(?:{DISTRIBUTIONS})_distribution\b", "differs between libraries: use puppetri/base/distribution.h"),
    (SAME, False, r"\bstd::(?:mt19937|random_device|default_random_engine|minstd_rand\w*|ranlux\w*|seed_seq)\b|(?<![\w.>:])s?rand\s*\(|#\s*include\s*<random>",
     "use the streams of puppetri/base/random.h"),
    (SAME, False, r"\bstd::(?:shuffle|sample|random_shuffle)\b", "differs between libraries: draw from a RandomStream"),
    (SAME, False, r"\bstd::hash\b", "differs between libraries: use puppetri/base/hash.h"),
    (SAME, False, r"#\s*include\s*<(?:chrono|ctime|time\.h|sys/time\.h)>|\bstd::chrono\b|(?<![\w.>:])(?:clock|gettimeofday|clock_gettime)\s*\(",
     "clocks: model time is SimTime"),
    (ALL, False, r"(?<![\w.>])(?:std::)?(?:strto(?:d|f|ld)|ato[fil]|sto(?:d|f|ld)|s?scanf|setlocale)\s*\(|#\s*include\s*<locale>",
     "depends on the locale: use parse_number of puppetri/base/text.h"),
    (SAME, False, r"(?<![\w.>])(?:std::)?is(?:alpha|alnum|digit|space|upper|lower|punct|print)\s*\(|#\s*include\s*<(?:cctype|ctype\.h)>",
     "depends on the locale: compare characters"),
    (SAME, False, r"\bstd::(?:multi)?(?:map|set)<\s*(?:const\s+)?[\w:]+\s*\*", "ordered by address"),
    (SAME, False, r"\bstd::chars_format\b", "from_chars and to_chars of doubles are missing in libc++: use puppetri/base/text.h"),
    (CORE, False, r"#\s*include\s*<(?:format|source_location|ranges|coroutine|thread|stop_token|expected|execution)>|\bstd::(?:jthread|format|ranges|views)\b",
     "missing or different in the browser's toolchain"),
    (CORE, False, r"(?<!\w)(?:unsigned\s+)?long(?!\s+long)(?!\s+double)\b(?!\s*long)(?<!long long)", "long has another size in 32 bits: use std::int64_t"),
    (SAME, False, r"\blong\s+double\b", "has another precision on each system"),
    (ALL, True, r"#\s*include\s*<(?:iostream|Eigen/|nlohmann/|tao/|boost/|fmt/|regex)", "too heavy for a public header"),
    (ALL, True, r"^\s*using\s+namespace\b", "no using namespace in a header"),
]
RULES = [(m, h, re.compile(p), text) for m, h, p, text in RULES]
UNQUALIFIED = re.compile(rf"(?<![\w.>:])({NAMES})\s*\(")
UNORDERED = re.compile(r"\bstd::unordered_(?:multi)?(?:map|set)<.*>\s+(\w+)\s*[;={(]")


def strip(text):
    """The same lines without comments and without the inside of strings and characters; #includes stay."""
    out = []
    i = 0
    while i < len(text):
        c = text[i]
        if text.startswith("//", i):
            end = text.find("\n", i)
            i = len(text) if end < 0 else end
        elif text.startswith("/*", i):
            end = text.find("*/", i + 2)
            end = len(text) if end < 0 else end + 2
            out.append("\n" * text.count("\n", i, end))
            i = end
        elif c == '"' and out and "".join(out[-2:]).endswith("R"):
            match = re.match(r'"([^(\s]*)\(', text[i:])
            end = text.find(")" + match.group(1) + '"', i) if match else -1
            end = len(text) if end < 0 else end + len(match.group(1)) + 2
            out.append('""' + "\n" * text.count("\n", i, end))
            i = end
        elif c == '"' or (c == "'" and not (out and out[-1][-1:].isalnum())):  # not the ' of 1'000
            line_start = text.rfind("\n", 0, i) + 1
            keep = text[line_start:i].lstrip().startswith("#")
            end = i + 1
            while end < len(text) and text[end] != c and text[end] != "\n":
                end += 2 if text[end] == "\\" else 1
            out.append(text[i:end + 1] if keep else c + c)
            i = end + 1
        else:
            out.append(c)
            i += 1
    return "".join(out)


def check_file(path, module, header, report):
    raw = path.read_text(errors="replace")
    raw_lines = raw.splitlines()
    code = strip(raw)
    has_ours = '"puppetri/base/elementary.h"' in raw
    in_elementary = module == "base" and path.name.startswith("elementary")
    unordered = set(UNORDERED.findall(code))
    walks = re.compile(r"for\s*\([^;)]*:\s*(?:\w+(?:\.|->))*(" + "|".join(map(re.escape, unordered)) + r")\s*\)") if unordered else None

    for number, line in enumerate(code.splitlines(), 1):
        if number <= len(raw_lines) and "// allowed: " in raw_lines[number - 1]:
            continue
        for modules, only_headers, pattern, message in RULES:
            if module in modules and (header or not only_headers) and pattern.search(line):
                report(path, number, message)
        if module in SAME and not in_elementary:
            for name in UNQUALIFIED.findall(line):
                if name not in OURS or not has_ours:
                    if re.search(rf"\b(?:double|float|auto|Expr|[A-Z]\w*)\s+{name}\s*\(", line):
                        continue  # a declaration of that name
                    report(path, number, f"{name}: include puppetri/base/elementary.h" if name in OURS else f"libm: {name}")
        if module in SAME and walks and walks.search(line):
            report(path, number, "the order of unordered containers differs between libraries")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    found = []
    count = 0

    def report(path, number, message):
        found.append(f"{path.relative_to(root)}:{number}: {message}")

    for folder, header in (("include/puppetri", True), ("src", False)):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".h", ".hpp", ".cpp", ".ipp"}:
                count += 1
                check_file(path, path.relative_to(root / folder).parts[0], header, report)
    print("\n".join(found) if found else f"check_banned: {count} files, nothing banned")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
