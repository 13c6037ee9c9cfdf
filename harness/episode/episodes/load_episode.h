// SPDX-License-Identifier: Apache-2.0
// A recorded episode as if it had just been played: its scenario, its grammar, its result. Tested
// by tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/scenario/read/read_scenario.h"

namespace prehend::episode {

/// Which grammar looks at an episode.
struct GrammarChoice {
  std::string grammar;                ///< name or path in the project; empty: the episode's own
  std::vector<std::string> settings;  ///< parameters of the grammar: "reach_radius=25cm"
};

/// Loads episodes of any files, one after another; what several of them need is read once.
class EpisodeLoader {
 public:
  explicit EpisodeLoader(std::string root) : root_(std::move(root)) {}

  /// Its scenario and the grammar. Of a recording the scenario has the scene that stands in for it,
  /// and nothing that is judged.
  Result<LoadedRun> Load(const EpisodeFile& file, const EpisodeRow& episode,
                         const GrammarChoice& choice = {});

  /// A grammar of the episode that was loaded last.
  grammar::CompileResult CompileOwn(const std::string& name_or_path,
                                    const grammar::Overrides& overrides) {
    return Compile(true, name_or_path, overrides);
  }

 private:
  Result<LoadedRun> LoadRecording(const EpisodeFile& file, const EpisodeRow& episode,
                                  const TaskFiles& task, const GrammarChoice& choice);
  /// What is wrong with files of a task, as they were called.
  grammar::Diagnostics OfTask(grammar::Diagnostics diagnostics, const EpisodeFile& file,
                              const EpisodeRow& episode) const;
  /// Forgets what was read of the tasks' files if other ones are there now.
  void Refresh();
  /// `is_own`: one of the task's grammars, else one of the project.
  grammar::CompileResult Compile(bool is_own, const std::string& name_or_path,
                                 const grammar::Overrides& overrides);

  std::string root_;
  UnpackedTasks tasks_;
  scenario::ScenarioLibrary library_;  ///< what was read of the tasks' hands
  struct GrammarKey {
    bool is_own = false;
    std::string name_or_path;
    grammar::Overrides overrides;
    auto operator<=>(const GrammarKey&) const = default;
  };
  std::map<GrammarKey, std::shared_ptr<const grammar::Program>> programs_;
  std::size_t writes_read_ = 0;  ///< of the tasks' files, when these were read
};

/// What the grammar recognises in a run. One that is not finished has the status "failed".
/// `frames`: with every frame, as RunScenario() with RunOptions::record returned it.
Result<RunResult> Resegment(const EpisodeFile& file, const EpisodeRow& episode,
                            const LoadedRun& loaded, bool frames);

}  // namespace prehend::episode
