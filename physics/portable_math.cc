// SPDX-License-Identifier: Apache-2.0
// The transcendental functions of the C library, the same to the last bit on every processor. The C
// library's own choose an implementation by the processor (with or without fused multiplication)
// and differ in last bits; so would every state hash. This file is compiled twice: with
// physics/portable_names.h for the rooms, and without it for programs that simulate, in which these
// functions take the place of the C library's, for Bullet and Box2D.
//
// SLEEF's functions without fused multiplication ("cinz", "purec") give the same results on all
// platforms: N. Shibata and F. Petrogalli, "SLEEF: A Portable Vectorized Library of C Standard
// Mathematical Functions", IEEE TPDS 31(6), 2020. Errors are at most 1 ulp (hypot: 0.5 ulp). In
// single precision they are the rounded results in double precision. Tested by
// tests/physics/portable_math_test.cc
#include <sleef.h>

#include <bit>
#include <cstdint>

#define PREHEND_UNARY(name, sleef)                    \
  double name(double x) noexcept { return sleef(x); } \
  float name##f(float x) noexcept { return static_cast<float>(sleef(x)); }
#define PREHEND_BINARY(name, sleef)                                \
  double name(double a, double b) noexcept { return sleef(a, b); } \
  float name##f(float a, float b) noexcept { return static_cast<float>(sleef(a, b)); }

namespace {

/// Bullet asks for the same power for every body in every tick (damping).
double PowerOf(double a, double b) {
  struct Known {
    double a = 1, b = 1, power = 1;
  };
  thread_local Known last;
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  if (!same(a, last.a) || !same(b, last.b)) last = {a, b, Sleef_cinz_powd1_u10purec(a, b)};
  return last.power;
}

}  // namespace

extern "C" {
PREHEND_UNARY(sin, Sleef_cinz_sind1_u10purec)
PREHEND_UNARY(cos, Sleef_cinz_cosd1_u10purec)
PREHEND_UNARY(tan, Sleef_cinz_tand1_u10purec)
PREHEND_UNARY(asin, Sleef_cinz_asind1_u10purec)
PREHEND_UNARY(acos, Sleef_cinz_acosd1_u10purec)
PREHEND_UNARY(atan, Sleef_cinz_atand1_u10purec)
PREHEND_UNARY(exp, Sleef_cinz_expd1_u10purec)
PREHEND_UNARY(exp2, Sleef_cinz_exp2d1_u10purec)
PREHEND_UNARY(log, Sleef_cinz_logd1_u10purec)
PREHEND_UNARY(log2, Sleef_cinz_log2d1_u10purec)
PREHEND_UNARY(log10, Sleef_cinz_log10d1_u10purec)
PREHEND_UNARY(cbrt, Sleef_cinz_cbrtd1_u10purec)
PREHEND_BINARY(atan2, Sleef_cinz_atan2d1_u10purec)
PREHEND_BINARY(pow, PowerOf)
PREHEND_BINARY(hypot, Sleef_cinz_hypotd1_u05purec)

void sincos(double x, double* sine, double* cosine) noexcept {
  *sine = Sleef_cinz_sind1_u10purec(x);
  *cosine = Sleef_cinz_cosd1_u10purec(x);
}
void sincosf(float x, float* sine, float* cosine) noexcept {
  *sine = sinf(x);
  *cosine = cosf(x);
}
}
