// SPDX-License-Identifier: Apache-2.0
// Functions of several numbers at once. Every result is that of std::sin and std::cos, to the last
// bit. Tested by tests/physics/portable_math_test.cc
#pragma once

#include <array>

namespace prehend::physics {

void SinesAndCosines(const std::array<double, 4>& angles, std::array<double, 4>& sines,
                     std::array<double, 4>& cosines);

}  // namespace prehend::physics
