// SPDX-License-Identifier: Apache-2.0
// Who says what happened in an episode, a grammar or somebody else, and what they say. Tested by
// tests/program/found_test.cc and tests/program/recogniser_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"
#include "harness/exchange/labels/read_truths.h"
#include "harness/measure/recognise/recogniser.h"
#include "harness/measure/score/score.h"

namespace prehend::measure {

struct Source {
  enum class Kind { kGrammar, kFiles, kProgram };
  Kind kind = Kind::kGrammar;
  std::string text;  ///< a name or path, or a command; "": the grammar of the episodes
};

/// What --recogniser names: files:FOLDER, a grammar by its name or file, or a command.
Source SourceOf(const std::string& typed, const std::string& root);

/// What all sources are asked with.
struct Asking {
  std::vector<Source> sources;
  std::string label_map;  ///< a file, or ""
  Pace pace = Pace::kOffline;
  double time_limit_s = 60;  ///< of a program, for an episode

  /// The first grammar, whose events the others' are; "": that of the episodes.
  std::string WhoseEvents() const;
};

/// The frames that a grammar sees. `episode` must live as long.
WatchedEpisode Watched(episode::Episode& episode);

/// A source that is no grammar.
class Foreign {
 public:
  Foreign(const Asking& asking, const Source& source);

  /// In one of the takes, with all roles. What a program breaks, and what it says beside, is in
  /// `episode`.
  Result<grammar::Timeline> Find(const std::vector<episode::Take>& takes, std::size_t take,
                                 const WatchedEpisode& watched, const grammar::Program& program,
                                 const exchange::ComparedRoles& compared, EpisodeToScore& episode);

 private:
  const Asking& asking_;
  const Source& source_;
  Recogniser recogniser_;
};

/// What the first of the sources finds in one episode alone: all events of its grammar.
Result<EpisodeToScore> HeardIn(episode::Episode& episode, const Asking& asking);

}  // namespace prehend::measure
