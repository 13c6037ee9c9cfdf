// SPDX-License-Identifier: Apache-2.0
// Arithmetic on several doubles at once: each operator works lane by lane, with the bits that
// single doubles would have. Two doubles fit into a register of every processor that this project
// runs on; more of them side by side hide how long a sum takes. Only for physics/bullet/core.
// Tested by tests/physics/bullet/lone_bodies_test.cc
#pragma once

#include <cmath>
#include <cstddef>

namespace prehend::physics {

/// 2, 4 or 8 doubles. Halves of halves instead of an array: compilers keep them in registers.
template <std::size_t lanes>
struct Wide {
  Wide<lanes / 2> low, high;

  double At(std::size_t lane) const { return reinterpret_cast<const double*>(this)[lane]; }
  void Put(std::size_t lane, double value) { reinterpret_cast<double*>(this)[lane] = value; }
};
template <>
struct Wide<2> {
  using Two = double __attribute__((vector_size(16)));
  Two two;

  double At(std::size_t lane) const { return two[lane]; }
  void Put(std::size_t lane, double value) { two[lane] = value; }
};

/// By lane, whether something holds.
template <std::size_t lanes>
struct Marks {
  Marks<lanes / 2> low, high;

  bool At(std::size_t lane) const {
    return lane < lanes / 2 ? low.At(lane) : high.At(lane - lanes / 2);
  }
  void Put(std::size_t lane, bool holds) {
    lane < lanes / 2 ? low.Put(lane, holds) : high.Put(lane - lanes / 2, holds);
  }
};
template <>
struct Marks<2> {
  using Two = long long __attribute__((vector_size(16)));
  Two two;

  bool At(std::size_t lane) const { return two[lane] != 0; }
  void Put(std::size_t lane, bool holds) { two[lane] = holds ? -1 : 0; }
};

/// The same for two halves.
#define PREHEND_LANE_BY_LANE(Result, operation)                                                    \
  template <std::size_t n>                                                                         \
  [[gnu::always_inline]] inline Result<n> operator operation(const Wide<n>& a, const Wide<n>& b) { \
    if constexpr (n == 2)                                                                          \
      return {a.two operation b.two};                                                              \
    else                                                                                           \
      return {a.low operation b.low, a.high operation b.high};                                     \
  }
PREHEND_LANE_BY_LANE(Wide, +)
PREHEND_LANE_BY_LANE(Wide, -)
PREHEND_LANE_BY_LANE(Wide, *)
PREHEND_LANE_BY_LANE(Wide, /)
PREHEND_LANE_BY_LANE(Marks, <)
PREHEND_LANE_BY_LANE(Marks, >)
#undef PREHEND_LANE_BY_LANE

template <std::size_t n>
[[gnu::always_inline]] inline Wide<n> operator-(const Wide<n>& a) {
  if constexpr (n == 2)
    return {-a.two};
  else
    return {-a.low, -a.high};
}
template <std::size_t n>
[[gnu::always_inline]] inline Wide<n> operator*(double a, const Wide<n>& b) {
  if constexpr (n == 2)
    return {a * b.two};
  else
    return {a * b.low, a * b.high};
}
template <std::size_t n>
[[gnu::always_inline]] inline Marks<n> operator&(const Marks<n>& a, const Marks<n>& b) {
  if constexpr (n == 2)
    return {a.two & b.two};
  else
    return {a.low & b.low, a.high & b.high};
}
template <std::size_t n>
[[gnu::always_inline]] inline Marks<n> operator|(const Marks<n>& a, const Marks<n>& b) {
  if constexpr (n == 2)
    return {a.two | b.two};
  else
    return {a.low | b.low, a.high | b.high};
}
template <std::size_t n>
[[gnu::always_inline]] inline bool Any(const Marks<n>& marks) {
  if constexpr (n == 2)
    return (marks.two[0] | marks.two[1]) != 0;
  else
    return Any(marks.low | marks.high);
}

/// `a` where it is marked, else `b`.
template <std::size_t n>
[[gnu::always_inline]] inline Wide<n> Select(const Marks<n>& marks, const Wide<n>& a,
                                             const Wide<n>& b) {
  if constexpr (n == 2)
    return {marks.two ? a.two : b.two};
  else
    return {Select(marks.low, a.low, b.low), Select(marks.high, a.high, b.high)};
}

/// std::max(a, b)
template <std::size_t n>
[[gnu::always_inline]] inline Wide<n> Larger(const Wide<n>& a, const Wide<n>& b) {
  return Select(a < b, b, a);
}

template <std::size_t n>
[[gnu::always_inline]] inline Wide<n> Root(const Wide<n>& a) {
  if constexpr (n == 2)
    return {typename Wide<n>::Two{std::sqrt(a.two[0]), std::sqrt(a.two[1])}};
  else
    return {Root(a.low), Root(a.high)};
}

}  // namespace prehend::physics
