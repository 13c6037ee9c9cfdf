// SPDX-License-Identifier: Apache-2.0
// Runs in which hands hold something, one for each style of grasp. Tested by
// tests/program/figure_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/show/figures/scene_tiles.h"

namespace prehend::show {

struct PlayedGrasp {
  episode::LoadedRun loaded;
  episode::RunResult run;
  HeldMoment held;
};

/// Of the first scenario, short ones first, in which a hand holds something in that style. Plays
/// only what may show a style that is not known yet.
Result<std::vector<PlayedGrasp>> FindGrasps(std::vector<episode::RunRequest> scenarios,
                                            const std::string& root);

/// They point to the grasps.
std::vector<HeldScene> ScenesOf(const std::vector<PlayedGrasp>& grasps);

}  // namespace prehend::show
