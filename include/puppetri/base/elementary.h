// SPDX-License-Identifier: MIT
// Elementary functions with the same bits on every compiler, processor and in the browser. The C
// library's differ in the last place from one system to the next, and a last place decides who is
// first in a queue. These use only
// + - * / sqrt on doubles, in a fixed order, and are compiled with -ffp-contract=off.
//
// Errors  below 1 unit in the last place for exp, log, pow, sin, cos, atan; below 2 for tan, asin,
// acos, atan2, log1p
//         (tests/base/elementary_test.cpp measures all of them). Special values are those of C's
//         Annex F, without floating-point exceptions. Angles are in radians.
// Cost    exp and log about 5 ns, the others 10 to 40 ns.
// Source  the published methods named in the sources; every table and coefficient is made by
// tools/elementary_tables.py.
#pragma once

namespace puppetri {

double exp(double x);
double log(double x);
double log1p(double x);  // log(1 + x), exact also where 1 + x would round
double pow(double x,
           double y);  // pow(x, 0) == 1 for every x, pow(-8, 3) == -512, pow(-8, 0.5) is NaN

double sin(double x);  // any finite angle, also a large one, is reduced exactly
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);  // the angle of the point (x, y), in [-pi, pi]

}  // namespace puppetri
