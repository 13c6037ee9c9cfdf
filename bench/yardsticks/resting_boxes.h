// SPDX-License-Identifier: Apache-2.0
// Many bodies without events: boxes that stand on a floor and fall asleep.
// Tested by tests/bench/workload_test.cc
#pragma once

#include "harness/scenario/scenario/scenario.h"

namespace prehend::bench {

/// `count` boxes side by side on a fixed floor, without a hand, sensed at every second tick. They
/// fall asleep within 2.2 s.
scenario::Scenario BoxesOnAFloor(int count, int rate_hz = 480);
inline constexpr double kUntilAsleep_s = 2.5;

}  // namespace prehend::bench
