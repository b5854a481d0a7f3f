// The elementary functions, with the same bits on every processor and with every compiler.
//
// A mathematical library may round the last bit as it likes, and glibc's does it in another way with fused
// multiply-adds than without.  These are made of + - * / and square roots of doubles, all of which IEEE 754 defines to
// the bit.  Each is wrong by less than one unit in the last place (most by less than 0.53; decision 24 has the figures).
// Special values are those of annex F of the C standard; a NaN that comes out has no sign and no payload; no flags and
// no errno.
//
// Of <cmath> itself only what is exact or correctly rounded may be used: sqrt, fma, floor, ceil, trunc, round, fmod,
// frexp, ldexp, nextafter and the like (tests/unit/symbols_test.cc).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rayshade::elementary {

double exp(double x);
double expm1(double x);  // e^x - 1
double log(double x);
double pow(double x, double y);
double cbrt(double x);
double hypot(double x, double y);

// Angles are in radians.
double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);

}  // namespace rayshade::elementary
