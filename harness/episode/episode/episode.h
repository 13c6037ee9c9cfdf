// SPDX-License-Identifier: Apache-2.0
// An episode: something with entities, a rate, frames and an end, whatever it came from.
// OpenEpisode() in harness/episode/episode/episode.h opens one; a scenario is simulated when
// its frames are asked for. The one place that opens an episode, of any kind. Tested by
// tests/program/episode_kinds_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment_recording.h"

namespace prehend::episode {

using GrammarChoice = GrammarChoice;

class Episode {
 public:
  const EpisodeName& name() const { return name_; }
  /// Otherwise nothing is known but what a grammar sees: no forces, no ground truth.
  bool was_simulated() const { return name_.origin != Origin::kRecording; }
  /// The scenario and the grammar, with its warnings. Of a recording the scenario has the scene
  /// that stands in for it: for pictures, not to be sensed.
  const LoadedRun& loaded() const { return loaded_; }
  LoadedRun& loaded() { return loaded_; }
  const std::shared_ptr<const grammar::Program>& program() const { return loaded_.program; }
  grammar::EntityTable entities() const;
  /// The first line of a recording of it.
  EpisodeHeader Header() const;
  /// Null unless it is one of an episode file.
  const EpisodeRow* row() const { return file_ ? &row_ : nullptr; }
  const EpisodeFile* file() const { return file_.get(); }
  /// Null if it was simulated.
  Recording* recording() { return recording_ ? &*recording_ : nullptr; }
  /// Of a recording that begins before 0: lines that say it, or "".
  std::string moved() const {
    return recording_ ? MovedText(recording_->header, recording_->moved) : "";
  }

  /// What `prehend run` prints; a scenario is simulated, once. `frames`: with every snapshot.
  Result<RunResult> Run(bool frames);
  /// The same of a scenario, with every snapshot; it is kept, and what asks for frames reads it.
  const RunResult& Played();
  /// After Run(): of a recording, what it does not have of what the grammar asks for.
  const MissingFacts& missing() const { return missing_; }
  /// The same of a recording, with what it does not have of what the grammar asks for.
  Result<SegmentedRecording> SegmentRecorded();
  /// Run() of a recording that is segmented.
  RunResult RunOf(SegmentedRecording segmented, bool frames);
  /// What was recognised when it was recorded; of a scenario, what its run recognises.
  Result<grammar::Timeline> Recorded();

  struct End {
    grammar::Tick tick = 1;  ///< the first one after the episode
    std::string failure;     ///< "", or why its simulation ended early
  };
  /// Calls `look` with every frame that a grammar sees.
  End EachFrame(const std::function<void(const grammar::Frame&)>& look);

  /// What any grammar recognises. The frames are simulated or read once, and kept.
  Result<grammar::Timeline> Segment(const std::shared_ptr<const grammar::Program>& program);
  /// One per tick of physics.
  Result<std::vector<physics::Snapshot>> Snapshots();
  /// Of a recorded run, what it was made from.
  Result<TaskFiles> Task() const {
    return name_.origin == Origin::kRecordedRun ? file_->TaskOf(row_) : TaskFiles();
  }
  /// Whether it was recorded with other values of all that its scenario varies: it has no golden.
  bool IsTrial() const;
  /// The first tick after the episode; an error if it did not come to a good end.
  Result<grammar::Tick> EndTick();

 private:
  friend class EpisodeOpener;
  Episode(EpisodeName name, LoadedRun loaded)
      : name_(std::move(name)), loaded_(std::move(loaded)) {}

  Result<std::vector<physics::Snapshot>> ReadSnapshots(
      const std::function<bool(std::int64_t)>& wanted) const;
  tl::unexpected<grammar::Diagnostics> Failure(const std::string& message) const;

  EpisodeName name_;
  LoadedRun loaded_;
  std::shared_ptr<const EpisodeFile> file_;
  EpisodeRow row_;
  std::optional<Recording> recording_;
  MissingFacts missing_;
  std::optional<RunResult> played_;                       ///< of a scenario, with its snapshots
  std::optional<std::vector<physics::Snapshot>> sensed_;  ///< of a recorded run, what is due
};

/// Opens episodes one after another; what several of them need is read once.
class EpisodeOpener {
 public:
  /// `root`: the project's.
  explicit EpisodeOpener(std::string root) : root_(std::move(root)), loader_(root_) {}

  /// Reads the scenario and the grammar, of a recording its frames, too. `asked`: settings of a
  /// scenario may be fields of it. `files` receives what a scenario was read from.
  Result<Episode> Open(const EpisodeName& name, const GrammarChoice& asked = {},
                       std::vector<std::string>* files = nullptr);
  /// A recording that is no file.
  Result<Episode> Open(Recording recording, const EpisodeName& name, const GrammarChoice& choice);

  /// The grammar alone, with other values of its parameters; no frames are read.
  grammar::CompileResult Compile(const EpisodeName& name, const std::string& asked,
                                 const grammar::Overrides& parameters);

 private:
  Result<Episode> OpenLines(const EpisodeName& name, const GrammarChoice& choice);
  Result<Episode> OpenKept(const EpisodeName& name, const GrammarChoice& choice);
  Result<EpisodeRow> FindKept(const EpisodeName& name);

  std::string root_;
  EpisodeLoader loader_;
  std::shared_ptr<const EpisodeFile> file_;
  std::optional<EpisodeName> compiled_;  ///< whose own grammar is `own_`
  LoadedRun own_;
};

/// Empty if all were played or recorded with the same grammar.
grammar::Diagnostics WhyNotOneGrammar(std::span<const EpisodeName> episodes,
                                      const std::string& root);

/// A single one.
Result<Episode> OpenEpisode(const EpisodeName& name, const GrammarChoice& choice,
                            const std::string& root, std::vector<std::string>* files = nullptr);

// Many episodes, segmented again on all cores. Tested by tests/program/episodes_test.cc

struct ResegmentRequest {
  std::string root;
  GrammarChoice choice;
  bool compare = false;  ///< with what was recognised when it was recorded
  bool replay = false;   ///< read every tick, and check the state hash
  int jobs = 1;
};

struct Resegmented {
  EpisodeName episode;
  RunHeading heading;
  RunResult run;            ///< without its frames
  std::string differences;  ///< lines "- event" (only recorded) and "+ event" (only now)
  std::string warnings;
  std::string problem;        ///< empty, or why it could not be read or segmented
  bool nothing_left = false;  ///< no event of the grammar can be recognised in it
  bool finished = false;      ///< its recording was not cut off
};

/// One result per episode, in their order.
std::vector<Resegmented> ResegmentAll(const std::vector<EpisodeName>& episodes,
                                      const ResegmentRequest& request);

}  // namespace prehend::episode
