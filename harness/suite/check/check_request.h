// SPDX-License-Identifier: Apache-2.0
// What a check is asked, and the commands that ask it or a question about it again. Tested by
// tests/harness/suite/check/check_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::suite {

/// Of which verdicts the report gets a 3D replay.
enum class Replays { kNone, kFailures, kAll };

struct CheckRequest {
  episode::EpisodeName episode;
  std::string file_hash;             ///< FileHash() of an episode file; "": not known yet
  episode::GrammarChoice changes;    ///< settings of a scenario may be fields of it
  std::string recogniser = {};       ///< who is heard instead of the grammar: a command, or ""
  Listen listen = {};                ///< hears it
  std::string id;                    ///< skill/name, or the path of what is outside the project
  std::string root;                  ///< the project's
  std::string report_folder;         ///< pictures go to its folder `pictures`
  Replays replays = Replays::kNone;  ///< kFailures: of what has not passed
  bool explain = false;              ///< what has a golden and does not pass
  bool pictures = true;
  bool all_pictures = true;  ///< also of what passed and is compared with no golden picture
  bool leave_nothing_behind = false;  ///< no pending golden, no trace; only the verdict
  bool in_project = true;             ///< below scenarios/, so that it may have a golden
  std::string record_file;            ///< an episode file that gets the run; or empty
  std::string record_uuid;            ///< of the episode in it; "": a new one
  bool is_own_record = false;  ///< recorded by a check that was stopped: judged as if it was played
  std::string today;           ///< YYYY-MM-DD, for that file
  std::string program;         ///< ProgramHash(), to find the cause of differences
  episode::EpisodeOpener* opener = nullptr;  ///< of the episodes before it; may be null
  ProgressCounters::Tick* last_tick =
      nullptr;  ///< gets the tick that the run has reached; may be null

  episode::RunRequest Run() const { return {episode.file, changes.grammar, changes.settings}; }
  /// Whether it is simulated here and now.
  bool IsPlayed() const { return episode.origin == episode::Origin::kScenario; }
  /// Whether nothing is changed by the command line, so that what differs can be accepted.
  bool IsAsItsFileSays() const {
    return changes.grammar.empty() && changes.settings.empty() && !listen;
  }
};

/// The options of the command line that ask for these changes.
std::vector<std::string> OptionsOf(const episode::GrammarChoice& changes);

/// A command about one scenario or episode, with these changes.
std::string CommandAbout(const char* name, const std::string& id,
                         const episode::GrammarChoice& changes = {});

/// Asks about its events; "" of those that no grammar recognises.
std::string ExplainCommand(const CheckRequest& request);

/// Repeats a verdict: of the same scenario or episode, with the same changes.
std::string RepeatCommand(const CheckRequest& request);

}  // namespace prehend::suite
