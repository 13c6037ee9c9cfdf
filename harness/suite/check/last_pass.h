// SPDX-License-Identifier: Apache-2.0
// What `prehend check` keeps in build/check/: of each scenario its last pass, with all inputs of
// it, and its duration. Losing it costs time only. Tested by
// tests/harness/suite/check/last_pass_test.cc
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/suite/check/verdict.h"
#include "harness/suite/judge/other_view.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::suite {

/// The last time that a scenario agreed with its golden: it passed, or its timeline was accepted.
struct LastPass {
  std::string program;      ///< ProgramHash() of then
  std::string build;        ///< BuildText() of then; empty: not known
  bool passed = true;       ///< false: accepted, but not checked since
  bool pictures = false;    ///< its pictures were drawn, too
  ScenarioVerdict verdict;  ///< its `inputs` are the files that decided it
};

/// Paths of inputs that have changed since, sorted.
std::vector<std::string> ChangedInputs(const LastPass& record);

class LastPasses {
 public:
  explicit LastPasses(const std::filesystem::path& project_root)
      : root_(project_root.string()),
        folder_(std::filesystem::path(BuildFolder(project_root)) / "check") {}

  /// `scenario` is its id, here and below. Nothing without a readable record.
  std::optional<LastPass> Read(const std::string& scenario) const;

  /// Returns "" or what went wrong.
  std::string Write(const LastPass& record) const;

  /// Where the physics trace of that run is kept.
  std::filesystem::path TracePath(const std::string& scenario) const {
    return folder_ / (scenario + ".trace");
  }

  using Costs = std::map<std::string, double>;  ///< id -> seconds
  Costs ReadCosts() const { return ReadCostsOf(folder_ / "costs.json"); }
  static Costs ReadCostsOf(const std::filesystem::path& file);  ///< of any such file
  std::string WriteCosts(const Costs& costs) const;

 private:
  std::string root_;
  std::filesystem::path folder_;
};

struct StateTrace {
  std::vector<std::string> entities;  ///< bodies, then hands
  std::vector<std::int64_t> ticks;
  std::vector<std::uint32_t> hashes;  ///< for each tick one per entity
  friend bool operator==(const StateTrace&, const StateTrace&) = default;
};

/// Of at most 20,000 snapshots; of a longer recording every n-th.
StateTrace TraceOf(const physics::Scene& scene, std::span<const physics::Snapshot> recording);

struct Divergence {
  std::int64_t tick = 0;
  std::string entity;  ///< the first that differs; "" when one run has more ticks or other entities
};

/// Whether both have states of the same ticks, as long as both last.
bool SameTicks(const StateTrace& a, const StateTrace& b);

/// Nothing when the two move the same at all ticks that both have, and are equally long.
std::optional<Divergence> FirstDivergence(const StateTrace& a, const StateTrace& b);

/// "" or what went wrong.
std::string WriteTrace(const std::filesystem::path& path, const StateTrace& trace);
/// Nothing when there is none or it is damaged.
std::optional<StateTrace> ReadTrace(const std::filesystem::path& path);

// What a check is asked, and the commands that ask it or a question about it again. Tested by
// tests/harness/suite/check/check_scenario_test.cc

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
  /// With the grammar of a file of takes, if the command line names none.
  episode::GrammarChoice Asked() const {
    return {changes.grammar.empty() ? episode.asked : changes.grammar, changes.settings};
  }
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
