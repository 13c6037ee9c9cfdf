// SPDX-License-Identifier: Apache-2.0
// By how much a rule holds or does not, frame by frame: the robustness of signal temporal logic.
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

/// Of the forms and modifiers that are a formula over frames (docs/explain.md); nothing of others.
std::optional<Robustness> RobustnessOf(grammar::ReplayMonitor& past, grammar::InstanceId instance);

}  // namespace prehend::show
