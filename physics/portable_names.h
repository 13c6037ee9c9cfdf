// SPDX-License-Identifier: Apache-2.0
// Gives the transcendental functions names of our own in the compiled code: what a room calls sin
// is prehend_sin (physics/portable_math.cc), also where Eigen calls it for us, and the program that
// a room is linked into keeps the sin that it had. Every source of the rooms is compiled with this
// file in front of it (CMakeLists.txt, prehend_portable()). Tested by
// tests/physics/portable_math_test.cc
#pragma once

#define PREHEND_UNARY(name)                               \
  double name(double) noexcept __asm__("prehend_" #name); \
  float name##f(float) noexcept __asm__("prehend_" #name "f");
#define PREHEND_BINARY(name)                                      \
  double name(double, double) noexcept __asm__("prehend_" #name); \
  float name##f(float, float) noexcept __asm__("prehend_" #name "f");

extern "C" {
PREHEND_UNARY(sin)
PREHEND_UNARY(cos)
PREHEND_UNARY(tan)
PREHEND_UNARY(asin)
PREHEND_UNARY(acos)
PREHEND_UNARY(atan)
PREHEND_UNARY(exp)
PREHEND_UNARY(exp2)
PREHEND_UNARY(log)
PREHEND_UNARY(log2)
PREHEND_UNARY(log10)
PREHEND_UNARY(cbrt)
PREHEND_BINARY(atan2)
PREHEND_BINARY(pow)
PREHEND_BINARY(hypot)
void sincos(double, double*, double*) noexcept __asm__("prehend_sincos");
void sincosf(float, float*, float*) noexcept __asm__("prehend_sincosf");
}

#undef PREHEND_UNARY
#undef PREHEND_BINARY
