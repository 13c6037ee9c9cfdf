// SPDX-License-Identifier: Apache-2.0
// Watching changes nothing: every shipped scenario moves the same, to the bit, and has the same
// timeline, whether it is recorded, watched frame by frame and drawn, or none of these. Whatever
// ran or was drawn before in the same process does not matter either. `prehend check` plays each
// scenario once and relies on it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/run_trials.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/show/pictures/pictures.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

/// Each part has every kParts-th scenario; ctest plays the parts side by side.
constexpr int kParts = 12;

class Watching : public testing::TestWithParam<int> {
 protected:
  Watching() { fs::create_directories(folder_); }
  ~Watching() override { fs::remove_all(folder_); }

  /// Everything at once that a command can ask of a run: `run --record`, `check`, `render`.
  RunResult PlayWatched(const LoadedRun& loaded) {
    const scenario::Scenario& scenario = loaded.scenario;
    std::ostringstream episode;
    EpisodeWriter writer(episode, {.episode = scenario.name,
                                   .grammar = scenario.grammar,
                                   .entity_table = MakeEntityTable(scenario)});
    OutcomeWatch outcomes(scenario.scene, scenario.outcomes);
    ScenarioRun playing(scenario, loaded.program, {.record = true, .measure = true});
    while (playing.Step()) {
      outcomes.Look(playing.snapshot());
      if (playing.sensed()) writer.Write(playing.frame());
    }
    RunResult run = playing.Finish();
    EXPECT_FALSE(run.recording.empty());
    EXPECT_FALSE(episode.str().empty());
    if (show::CanDrawPictures()) {
      const show::PictureResult drawn = show::DrawPictures(scenario, run, folder_.string());
      EXPECT_EQ(drawn.error, "");
      EXPECT_EQ(drawn.pictures.size(), scenario.pictures.size());
    }
    return run;
  }

 private:
  const fs::path folder_ =
      fs::path(PREHEND_BINARY_DIR) / "watching_test" / std::to_string(GetParam());
};

TEST_P(Watching, ChangesNothing) {
  const std::vector<ScenarioFile> all = ListScenarios(PREHEND_SOURCE_DIR);
  ASSERT_GE(all.size(), static_cast<std::size_t>(kParts));
  for (std::size_t i = static_cast<std::size_t>(GetParam()); i < all.size(); i += kParts) {
    SCOPED_TRACE(IdOf(all[i]));
    const Result<LoadedRun> loaded = LoadRun({.scenario_file = all[i].path}, PREHEND_SOURCE_DIR);
    ASSERT_TRUE(loaded) << Format(loaded.error());
    const RunResult watched = PlayWatched(*loaded);
    const RunResult plain = RunScenario(loaded->scenario, loaded->program);
    EXPECT_EQ(watched.status.kind, plain.status.kind);
    EXPECT_EQ(watched.ticks, plain.ticks);
    EXPECT_EQ(watched.state_hash, plain.state_hash) << "it moves differently when it is watched";
    EXPECT_EQ(truth::TimelineJson(watched.timeline).dump(1),
              truth::TimelineJson(plain.timeline).dump(1));
  }
}

INSTANTIATE_TEST_SUITE_P(Library, Watching, testing::Range(0, kParts));

}  // namespace
}  // namespace prehend::episode
