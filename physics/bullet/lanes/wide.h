// SPDX-License-Identifier: Apache-2.0
// Arithmetic on several doubles at once: each operator works lane by lane, with the bits that
// single doubles would have, on every processor. More lanes than a register has hide how long a sum
// takes. A file that includes this is compiled for one kind of processor: where it defines
// PREHEND_AVX2 a register has four doubles, else two. Only for this folder.
// Tested by tests/physics/bullet/kernels_test.cc
#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "physics/bullet/lanes/kernels.h"

// Names differ by processor, lest the linker takes one for the other.
#ifdef PREHEND_AVX2
#define PREHEND_WIDE wide_avx2
#else
#define PREHEND_WIDE wide
#endif

// In the loops that use these, a call costs more than its work.
#define PREHEND_INLINE [[gnu::always_inline]] inline

namespace prehend::physics::PREHEND_WIDE {

/// Whether this number of doubles is one register.
template <std::size_t n>
#ifdef PREHEND_AVX2
inline constexpr bool kRegister = n == 2 || n == 4;
#else
inline constexpr bool kRegister = n == 2;
#endif

/// Halves of halves instead of an array: compilers keep them in registers.
template <std::size_t n, bool is_register = kRegister<n>>
struct Wide {
  Wide<n / 2> low, high;
};
template <std::size_t n>
struct Wide<n, true> {
  typedef double Values __attribute__((vector_size(n * sizeof(double))));
  Values values;
};

/// By lane, whether something holds.
template <std::size_t n, bool is_register = kRegister<n>>
struct Marks {
  Marks<n / 2> low, high;
};
template <std::size_t n>
struct Marks<n, true> {
  typedef long long Values __attribute__((vector_size(n * sizeof(double))));
  Values values;
};

template <std::size_t n>
PREHEND_INLINE Wide<n> LoadFrom(const double* lanes) {
  if constexpr (kRegister<n>)
    return {*reinterpret_cast<const typename Wide<n>::Values*>(lanes)};
  else
    return {LoadFrom<n / 2>(lanes), LoadFrom<n / 2>(lanes + n / 2)};
}
template <std::size_t n>
PREHEND_INLINE void StoreTo(const Wide<n>& a, double* lanes) {
  if constexpr (kRegister<n>)
    *reinterpret_cast<typename Wide<n>::Values*>(lanes) = a.values;
  else
    StoreTo(a.low, lanes), StoreTo(a.high, lanes + n / 2);
}
template <std::size_t n>
PREHEND_INLINE Wide<n> Load(const Lanes<n>& lanes) {
  return LoadFrom<n>(lanes.values);
}
template <std::size_t n>
PREHEND_INLINE void Store(const Wide<n>& a, Lanes<n>& lanes) {
  StoreTo(a, lanes.values);
}

#define PREHEND_LANE_BY_LANE(Result, operation)                                     \
  template <std::size_t n>                                                          \
  PREHEND_INLINE Result<n> operator operation(const Wide<n>& a, const Wide<n>& b) { \
    if constexpr (kRegister<n>)                                                     \
      return {a.values operation b.values};                                         \
    else                                                                            \
      return {a.low operation b.low, a.high operation b.high};                      \
  }
PREHEND_LANE_BY_LANE(Wide, +)
PREHEND_LANE_BY_LANE(Wide, -)
PREHEND_LANE_BY_LANE(Wide, *)
PREHEND_LANE_BY_LANE(Wide, /)
PREHEND_LANE_BY_LANE(Marks, <)
PREHEND_LANE_BY_LANE(Marks, >)
#undef PREHEND_LANE_BY_LANE

template <std::size_t n>
PREHEND_INLINE Wide<n> operator-(const Wide<n>& a) {
  if constexpr (kRegister<n>)
    return {-a.values};
  else
    return {-a.low, -a.high};
}
template <std::size_t n>
PREHEND_INLINE Wide<n> operator*(double a, const Wide<n>& b) {
  if constexpr (kRegister<n>)
    return {a * b.values};
  else
    return {a * b.low, a * b.high};
}
template <std::size_t n>
PREHEND_INLINE Marks<n> operator&(const Marks<n>& a, const Marks<n>& b) {
  if constexpr (kRegister<n>)
    return {a.values & b.values};
  else
    return {a.low & b.low, a.high & b.high};
}
template <std::size_t n>
PREHEND_INLINE Marks<n> operator|(const Marks<n>& a, const Marks<n>& b) {
  if constexpr (kRegister<n>)
    return {a.values | b.values};
  else
    return {a.low | b.low, a.high | b.high};
}
template <std::size_t n>
PREHEND_INLINE bool Any(const Marks<n>& marks) {
  if constexpr (n == 2)
    return (marks.values[0] | marks.values[1]) != 0;
  else if constexpr (kRegister<n>)
    return (marks.values[0] | marks.values[1] | marks.values[2] | marks.values[3]) != 0;
  else
    return Any(marks.low | marks.high);
}

/// `a` where it is marked, else `b`.
template <std::size_t n>
PREHEND_INLINE Wide<n> Select(const Marks<n>& marks, const Wide<n>& a, const Wide<n>& b) {
  if constexpr (kRegister<n>)
    return {marks.values ? a.values : b.values};
  else
    return {Select(marks.low, a.low, b.low), Select(marks.high, a.high, b.high)};
}

/// std::max(a, b)
template <std::size_t n>
PREHEND_INLINE Wide<n> Larger(const Wide<n>& a, const Wide<n>& b) {
  return Select(a < b, b, a);
}

template <std::size_t n>
PREHEND_INLINE Wide<n> Root(const Wide<n>& a) {
  if constexpr (!kRegister<n>) {
    return {Root(a.low), Root(a.high)};
  } else {
#ifdef PREHEND_AVX2
    if constexpr (n == 4) return {_mm256_sqrt_pd(a.values)};
#endif
#ifdef __SSE2__
    if constexpr (n == 2) return {_mm_sqrt_pd(a.values)};
#endif
#ifndef __SSE2__
    return {{__builtin_sqrt(a.values[0]), __builtin_sqrt(a.values[1])}};
#endif
  }
}

}  // namespace prehend::physics::PREHEND_WIDE
