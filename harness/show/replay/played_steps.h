// SPDX-License-Identifier: Apache-2.0
// When each step of a script was played, for a row beside the events. Tested by
// tests/harness/show/replay/played_steps_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::show {

struct PlayedStep {
  std::string who;   ///< a hand or a person
  std::string what;  ///< "reach milk"
  grammar::Tick begin = 0, end = 0;
};

/// In the order in which they began. Nothing without a recording of every tick. A step ends with
/// the next one of the same actor, or with its stage.
std::vector<PlayedStep> PlayedSteps(const scenario::Scenario& scenario,
                                    const episode::RunResult& run);

}  // namespace prehend::show
