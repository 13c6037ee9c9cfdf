// SPDX-License-Identifier: Apache-2.0
// What the fuzzers of episode files damage: the beginning of a story of the library, played once.
#pragma once

#include <string>

#include "harness/episode/frames/chunk.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::fuzz {

/// A hand takes a carton, to the first grasp. Calls `look` with its snapshots, of which there are
/// 480; returns how it ended.
template <typename Look>
episode::RunResult PlayStory(const episode::LoadedRun& loaded, const Look& look) {
  episode::ScenarioRun run(loaded.scenario, loaded.program);
  for (std::size_t i = 0; i < episode::kMostFramesOfChunk && run.Step(); ++i) look(run.snapshot());
  return run.Finish();
}

inline episode::LoadedRun LoadStory() {
  const std::string root = PREHEND_SOURCE_DIR;
  return episode::LoadRun(
             {.scenario_file = root + "/scenarios/pick_and_place/milk_carton_wrap.yaml"}, root)
      .value();
}

}  // namespace prehend::fuzz
