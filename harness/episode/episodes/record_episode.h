// SPDX-License-Identifier: Apache-2.0
// Writes an episode into an episode file while it is played. A chunk is one transaction: whenever
// the program is killed, the file has all chunks that were written, and an episode that did not
// come to its end says so. Several processes may write into one file. Tested by
// tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/episode/frames/frame_layout.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::episode {

struct RecordRequest {
  std::string file;
  std::string root;                ///< the project's; files below it are named relative to it
  RunRequest run;                  ///< what was asked for
  std::vector<std::string> files;  ///< all that LoadRun() tried to read
  std::string recorded_on;         ///< YYYY-MM-DD
  std::string program_hash;        ///< ProgramHash()
};

class EpisodeRecorder {
 public:
  /// Errors, here and later, are told by problem(); a recorder with a problem does nothing more.
  EpisodeRecorder(const RecordRequest& request, const scenario::Scenario& scenario);
  ~EpisodeRecorder();
  EpisodeRecorder(EpisodeRecorder&&) noexcept;

  void Add(const physics::Snapshot& snapshot);
  /// The episode's end, its events and notes.
  void Finish(const RunResult& run);

  /// "", or why nothing can be recorded: "FILE: the disk is full".
  const std::string& problem() const { return problem_; }

 private:
  struct State;
  void WriteChunk();

  std::string file_;
  std::string problem_;
  std::unique_ptr<State> state_;
};

/// Empty, or why episodes cannot be recorded there. Creates the file with its tables.
std::string WhyNotRecordable(const std::string& file);

}  // namespace prehend::episode
