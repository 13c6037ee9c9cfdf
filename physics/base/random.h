// SPDX-License-Identifier: Apache-2.0
// Seeded random numbers, the same on every machine and with every standard library. Tested by
// tests/physics/motion/tracker_test.cc and tests/harness/scenario/read/sample_variations_test.cc
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace prehend::physics {

/// SplitMix64 (Steele, Lea & Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In [0, 1).
  double Share() { return static_cast<double>(Next() >> 11) * 0x1p-53; }
  double Between(double low, double high) { return low + (high - low) * Share(); }
  /// Box & Muller 1958.
  double Normal(double mean, double deviation) {
    const double radius = std::sqrt(-2 * std::log(1 - Share()));
    return mean + deviation * radius * std::cos(2 * std::numbers::pi * Share());
  }

 private:
  std::uint64_t state_;
};

}  // namespace prehend::physics
