// SPDX-License-Identifier: Apache-2.0
// See harness/show/figures/find_grasps.h. Tested by tests/program/figure_test.cc
#include "harness/show/figures/find_grasps.h"

#include <algorithm>
#include <filesystem>

namespace prehend::show {
namespace {

/// The styles in which the scenario's hands reach.
std::vector<std::string> StylesOf(const scenario::Scenario& scenario) {
  std::vector<std::string> styles;
  for (const physics::ScriptStage& stage : scenario.script.stages) {
    for (const physics::Step& step : stage.steps)
      if (const auto* reach = std::get_if<physics::ReachStep>(&step.action))
        styles.push_back(reach->style);
  }
  return styles;
}

}  // namespace

Result<std::vector<PlayedGrasp>> FindGrasps(std::vector<episode::RunRequest> scenarios,
                                            const std::string& root) {
  // Short ones show little else.
  std::ranges::stable_sort(scenarios, {}, [](const episode::RunRequest& scenario) {
    std::error_code error;
    return std::filesystem::file_size(scenario.scenario_file, error);
  });
  std::vector<PlayedGrasp> grasps;
  const auto is_known = [&](const std::string& style) {
    return std::ranges::any_of(grasps,
                               [&](const PlayedGrasp& grasp) { return grasp.held.style == style; });
  };
  for (const episode::RunRequest& scenario : scenarios) {
    Result<episode::LoadedRun> loaded = episode::LoadRun(scenario, root);
    if (!loaded) return tl::unexpected(std::move(loaded.error()));
    if (std::ranges::all_of(StylesOf(loaded->scenario), is_known)) continue;
    episode::RunResult run =
        episode::RunScenario(loaded->scenario, loaded->program, {.record = true});
    auto held = LongestGrasp(loaded->scenario, run);
    if (held && !is_known(held->style))
      grasps.push_back({std::move(*loaded), std::move(run), std::move(*held)});
  }
  return grasps;
}

std::vector<HeldScene> ScenesOf(const std::vector<PlayedGrasp>& grasps) {
  std::vector<HeldScene> scenes;
  for (const PlayedGrasp& grasp : grasps)
    scenes.push_back({&grasp.loaded.scenario, &grasp.run, grasp.held});
  return scenes;
}

}  // namespace prehend::show
