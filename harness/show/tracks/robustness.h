// SPDX-License-Identifier: Apache-2.0
// By how much a `while` holds or does not, frame by frame: the robustness of signal temporal logic.
// Tested by tests/harness/show/tracks/robustness_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/replay_monitor.h"

namespace prehend::show {

struct Robustness {
  std::vector<double> values;  ///< per frame: above 0 where it holds, below where it does not
  std::string unit;            ///< "": of numbers of several kinds, or plain
};

/// Nothing of another form, nor of one that `until`, `requires`, `confirmed by` or a greatest
/// length decides.
std::optional<Robustness> RobustnessOf(grammar::ReplayMonitor& past, grammar::InstanceId instance);

}  // namespace prehend::show
