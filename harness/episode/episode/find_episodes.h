// SPDX-License-Identifier: Apache-2.0
// What was typed -> names of episodes. The one place that looks at a file to find out which kind it
// is. What an episode does not have that a command needs. Tested by
// tests/program/episode_kinds_test.cc
#pragma once

#include <map>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/exit_code.h"
#include "harness/base/base/result.h"
#include "harness/episode/episode/take.h"
#include "harness/episode/run/find_scenario.h"

namespace prehend::episode {

enum class EpisodeKind { kScenario, kJsonLines, kEpisodeFile, kTakes };

/// By its first bytes, or its ending if it does not exist; what is neither is a scenario's name.
EpisodeKind EpisodeKindOf(const std::string& typed);

/// Why there are no such episodes.
struct NotFound {
  ExitCode exit_code = ExitCode::kBadInput;
  std::string message;               ///< or
  grammar::Diagnostics diagnostics;  ///< of files that cannot be read
  std::string typed, nearest;        ///< a scenario that does not exist, and what was meant; or ""
};

/// The episodes of all that was typed, in its order: scenarios (name, skill/name or file),
/// recordings, folders of recordings, files of takes; and of episode files those that `which`
/// selects: a number, a scenario (name, skill/name) or a glob; "": all. Never empty. `root`: the
/// project's.
tl::expected<std::vector<Take>, NotFound> FindTakes(std::span<const std::string> typed,
                                                    const std::string& which,
                                                    const std::string& root);
tl::expected<std::vector<EpisodeName>, NotFound> FindEpisodes(std::span<const std::string> typed,
                                                              const std::string& which,
                                                              const std::string& root);
/// Where a single one is wanted.
tl::expected<EpisodeName, NotFound> FindEpisode(const std::string& typed, const std::string& which,
                                                const std::string& root);

/// All of one episode file, or those that IsSelected().
Result<std::vector<EpisodeName>> EpisodesOf(const std::string& file, const std::string& which = "");

/// What is missing in these files together of suites and trials of which they are parts, a line for
/// each part; or "". Of a folder, in its episode files. What is no episode file is no part.
Result<std::string> WhatIsMissing(const std::vector<std::string>& files);

// For commands that ask an episode file: what is in none is played, or imported, into one first.

class EpisodeKeeper {
 public:
  /// `root`: the project's; `today`: YYYY-MM-DD; `folder` gets the files; "": one that is removed
  /// at the end.
  EpisodeKeeper(std::string root, std::string today, std::string folder = "");

  /// The same episode in a file. `grammar` segments a recording; "": its own.
  Result<EpisodeName> Keep(const EpisodeName& episode, const std::string& grammar = "");
  Result<std::vector<EpisodeName>> KeepAll(std::vector<EpisodeName> episodes,
                                           const std::string& grammar = "");
  /// What the recordings do not have of what their grammars ask for, and what was moved: lines.
  const std::string& warnings() const { return warnings_; }
  /// Of a file that was made here, the scenario or recording in it; any other is as it is.
  std::string SourceOf(const std::string& file) const;

 private:
  TemporaryFolder temporary_;
  std::string root_, today_, folder_, warnings_;
  std::map<std::string, std::string> sources_;
};

/// Facts that not every kind of episode has.
enum class Need {
  kScenario,        ///< something that can be simulated
  kGroundTruth,     ///< what physically happened
  kRecordedEvents,  ///< what was recognised when it was recorded
  kEpisodeFile,     ///< to be kept in an episode file
  kGolden           ///< a place for a golden of its own
};

/// "", or a sentence: which fact is missing, and what to do.
std::string Lacks(const EpisodeName& episode, Need need);
/// Of the first of these that lacks it.
std::string Lack(std::span<const EpisodeName> episodes, Need need);

}  // namespace prehend::episode
