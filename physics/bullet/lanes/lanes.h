// SPDX-License-Identifier: Apache-2.0
// Several doubles side by side in memory, as physics/bullet/lanes/wide.h loads them. Only for
// physics/bullet/core. Tested by tests/physics/bullet/single_bodies_test.cc
#pragma once

#include <cstddef>

namespace prehend::physics {

/// Without a constructor: one would be an inline function, compiled for several processors.
template <std::size_t n>
struct alignas(n * sizeof(double)) Lanes {
  double values[n];

  double& operator[](std::size_t lane) { return values[lane]; }
  double operator[](std::size_t lane) const { return values[lane]; }
};

}  // namespace prehend::physics
