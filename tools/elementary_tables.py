#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes src/base/elementary_tables.h: every table and coefficient of puppetri/base/elementary.h, from 60-digit arithmetic.

Tables hold a value as high + low. Polynomials interpolate at Chebyshev nodes, which is within a small factor of the best
possible; the program prints the largest relative error of each as a comment. Usage: elementary_tables.py > FILE (needs
mpmath). The file is checked in; this program is the source of its numbers.
"""
from mpmath import mp, mpf, cos, sin, atan, log, pi, exp, floor, matrix, lu_solve

mp.dps = 60


def hexa(x):
    return float(x).hex()


def cut(x, bits):
    """x rounded to so many significant bits."""
    x = mpf(x)
    if x == 0:
        return x
    scale = mpf(2) ** (bits - 1 - int(floor(log(abs(x), 2))))
    return mp.nint(x * scale) / scale


def table(name, comment, rows, width):
    print(f"\n// {comment}")
    print(f"inline constexpr double {name}[{len(rows)}][{width}] = {{")
    for row in rows:
        print("    {" + ", ".join(hexa(x) for x in row) + "},")
    print("};")


def polynomial(name, comment, f, low, high, terms):
    """Coefficients of degree 0 .. terms-1 of a polynomial close to f on [low, high]."""
    low, high = mpf(low), mpf(high)
    nodes = [(low + high) / 2 + (high - low) / 2 * cos(pi * (2 * i + 1) / (2 * terms)) for i in range(terms)]
    a = matrix(terms, terms)
    b = matrix(terms, 1)
    for i, x in enumerate(nodes):
        b[i] = f(x)
        for j in range(terms):
            a[i, j] = x**j
    c = [mpf(float(v)) for v in lu_solve(a, b)]
    worst = max(abs(sum(c[j] * x**j for j in range(terms)) / f(x) - 1)
                for x in [low + (high - low) * (mpf(i) + 0.5) / 500 for i in range(500)])
    print(f"\n// {comment} Largest relative error 2^{float(log(worst, 2)):.1f}.")
    print(f"inline constexpr double {name}[{terms}] = {{")
    for v in c:
        print(f"    {hexa(v)},")
    print("};")


def split(x, first_bits):
    high = cut(x, first_bits) if first_bits else mpf(float(x))
    return high, mpf(float(mpf(x) - high))


def absolute_split(x, unit):
    """high is a multiple of unit, so that sums of such highs are exact; low is the rest."""
    high = mp.nint(mpf(x) / unit) * unit
    return high, mpf(float(mpf(x) - high))


print("""// SPDX-License-Identifier: MIT
// Made by tools/elementary_tables.py; do not edit. Tables and coefficients of the elementary functions.
#pragma once
#include <cstdint>

namespace puppetri::elementary {""")

unit = mpf(2) ** -42  # 1075 * ln 2 needs 10 bits before the point: 52 in all
ln2 = log(mpf(2))
h, l = absolute_split(ln2, unit)
print(f"\n// ln 2: the high part is a multiple of 2^-42, so that k * high is exact for |k| < 2^11.")
print(f"inline constexpr double kLn2High = {hexa(h)};")
print(f"inline constexpr double kLn2Low = {hexa(l)};")
print(f"inline constexpr double kLog2OfE = {hexa(1 / ln2)};")

table("kLog", "ln(j / 128) for j = 90 .. 182, high (a multiple of 2^-42) + low.",
      [absolute_split(log(mpf(j) / 128), unit) for j in range(90, 183)], 2)
table("kExp2", "2^(j / 64) for j = 0 .. 63, high + low.", [split(mpf(2) ** (mpf(j) / 64), 0) for j in range(64)], 2)
h, l = split(ln2 / 64, 32)
print("\n// ln 2 / 64: the high part has 32 bits, so that k * high is exact for |k| < 2^21.")
print(f"inline constexpr double kLn2By64High = {hexa(h)};")
print(f"inline constexpr double kLn2By64Low = {hexa(l)};")
h, l = split(64 / ln2, 0)
print(f"inline constexpr double k64ByLn2 = {hexa(h)};")

table("kAtan", "atan(j / 16) for j = 0 .. 16, high + low.", [split(atan(mpf(j) / 16), 0) for j in range(17)], 2)

half = (pi / 4) ** 2
polynomial("kSin", "(sin(x) / x - 1) / x^2 in x^2, |x| <= pi/4.",
           lambda z: (sin(mp.sqrt(z)) / mp.sqrt(z) - 1) / z, 0, half, 7)
polynomial("kCos", "(cos(x) - 1 + x^2/2) / x^4 in x^2, |x| <= pi/4.",
           lambda z: (cos(mp.sqrt(z)) - 1 + z / 2) / z**2, 0, half, 6)

rest = pi / 2
parts = []
for bits in (33, 33, 33, 0):
    h, l = split(rest, bits)
    parts.append(h)
    rest -= h
print("\n// pi/2 in four pieces: 33, 33, 33 and 53 bits.")
print("inline constexpr double kHalfPi[4] = {" + ", ".join(hexa(p) for p in parts) + "};")
print(f"inline constexpr double kTwoByPi = {hexa(2 / pi)};")
h, l = split(pi / 2, 0)
print(f"inline constexpr double kHalfPiHigh = {hexa(h)};")
print(f"inline constexpr double kHalfPiLow = {hexa(l)};")

words = 38
mp.prec = 32 * words + 64
digits = int(floor(2 / pi * mpf(2) ** (32 * words)))
print(f"\n// The first {32 * words} bits of 2/pi after the point.")
print(f"inline constexpr std::uint32_t kTwoByPiBits[{words}] = {{")
cells = [f"0x{(digits >> (32 * (words - 1 - i))) & 0xFFFFFFFF:08X}" for i in range(words)]
for i in range(0, words, 8):
    print("    " + ", ".join(cells[i:i + 8]) + ",")
print("};")
print("\n}  // namespace puppetri::elementary")
