// SPDX-License-Identifier: Apache-2.0
// How far from the origin a scenario may put or send anything. Tested by
// tests/harness/scenario_errors_test.cc
#pragma once

namespace prehend::harness {

inline constexpr double kFarthestM = 100;

}  // namespace prehend::harness
