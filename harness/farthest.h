// SPDX-License-Identifier: Apache-2.0
// How far from the origin a scenario may put or send anything. Tested by
// tests/harness/scenario_errors_test.cc
#pragma once

#include "physics/run_checks.h"

namespace prehend::harness {

inline constexpr double kFarthestM = physics::kMaxDistance_m;

}  // namespace prehend::harness
