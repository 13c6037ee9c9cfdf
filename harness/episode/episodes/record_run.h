// SPDX-License-Identifier: Apache-2.0
// A scenario is played, judged by its outcomes, and written where that is asked for. Tested by
// tests/program/recording_test.cc and tests/program/episodes_test.cc
#pragma once

#include <optional>
#include <string>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/run/run_trials.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

/// Writes a run while it is played: into NAME.episodes, or what the grammar sees as JSON Lines into
/// any other file; "-" is standard output.
class RunRecorder {
 public:
  /// `request.file` is not empty. Errors, here and later, are told by problem().
  RunRecorder(const RecordRequest& request, const scenario::Scenario& scenario);

  void Add(ScenarioRun& playing);
  void Finish(const RunResult& run);

  /// "", or why it is not written.
  const std::string& problem() const { return episode_ ? episode_->problem() : problem_; }

 private:
  std::optional<EpisodeRecorder> episode_;
  std::optional<AtomicFile> file_;
  std::optional<EpisodeWriter> lines_;
  std::string problem_;
};

/// `recorder` may be null.
RunResult PlayScenario(const LoadedRun& loaded, const RunOptions& how, RunRecorder* recorder);

/// Plays one trial; `request` says where to, and gets what is played.
TrialResult RecordTrial(int trial, const RunRequest& varied, RecordRequest request);

}  // namespace prehend::episode
