// SPDX-License-Identifier: Apache-2.0
// How well a grammar recognises events: its timelines against true ones, per kind and in total.
// Sequences of events without overlaps: what an edit score is about. Tested by
// tests/harness/measure/score/score_test.cc and tests/harness/measure/score/tracks_test.cc
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/base/base/median.h"
#include "harness/episode/episode/episode.h"
#include "harness/exchange/labels/label_map.h"
#include "harness/exchange/labels/read_truths.h"
#include "harness/measure/recognise/recogniser.h"
#include "harness/measure/score/further_scores.h"
#include "harness/measure/score/overlap_metrics.h"

namespace prehend::measure {

/// The events of one hand, or of those without a hand the events with the same roles, as far as
/// they overlap on neither side: labels, by the alphabet, each in the first track in which it
/// overlaps no other one.
std::vector<Episode> TracksOf(const grammar::Timeline& truth, const grammar::Timeline& found,
                              grammar::Tick ticks, const truth::HandRoles& hands = {});

/// Mean edit score of tracks; 100 if there are none.
class EditOfTracks {
 public:
  void Add(const std::vector<Episode>& tracks);
  double Mean() const { return tracks_ > 0 ? sum_ / tracks_ : 100; }

 private:
  double sum_ = 0;
  int tracks_ = 0;
};

/// The true events of one episode, and those that a grammar or somebody else found.
struct EpisodeToScore {
  std::string scenario;
  grammar::Tick ticks = 0;
  grammar::Timeline truth;
  grammar::Timeline found;
  std::map<std::string, int>
      ignored;  ///< count of recognised events for which there is no ground truth
  Evaluation by_definitions, by_claims;
  std::string person = {}, set = {};                      ///< of a file of takes
  std::map<std::string, exchange::Moments> moments = {};  ///< by event
  /// Of a program of somebody else: why it has no events, which is no "nothing found"; what else it
  /// said; the events that it may find; and its processor time.
  std::string failure = {}, notes = {};
  std::vector<std::string> covers = {};
  double cpu_s = 0;
  /// Where the definitions are asked: of each true event the bands of its two boundaries.
  struct Bands {
    grammar::Interval begin, end;  ///< earliest and latest
  };
  std::vector<Bands> bands = {};
  std::size_t take = 0;  ///< which one of those that were asked for
  std::string video = {};
  double offset_s = 0;  ///< of the clock of its labels and video
  truth::HandRoles hands = {};
};

/// Signed offsets of the boundaries of matched events (found - true), or from ends to decisions.
struct TimeErrors {
  std::vector<double> seconds;

  double Median() const { return prehend::Median(seconds); }
  /// Nearest rank, with its sign; 0 if there are none.
  double QuantileByMagnitude(double share) const;
};

struct EventScore {
  std::string event;  ///< "all" for the total
  int truths = 0, found = 0;
  Ward ward;
  TimeErrors begin, end, late;  ///< late: from an event's end to its decision
  Hits overlap_10, overlap_25, overlap_50;
  EventErrors within_collar;
  double collar_s = 0;  ///< -1: of a total whose kinds have several
  FrameCounts frames;
  double edit = 100;  ///< mean over the tracks of the episodes (harness/measure/score/score.h)
  FurtherScores further;
};

/// Means over the kinds of events, each of which counts as much as any other.
struct MeanOfKinds {
  double f1_10 = 1, f1_25 = 1, f1_50 = 1, edit = 100, frame_accuracy = 1, collar_f = 1;
};

/// One episode of those that are pooled.
struct EpisodeRow {
  std::string episode, person, set;
  EventScore total;                  ///< as far as it has single numbers
  std::map<std::string, Hits> hits;  ///< by event, at half of the union
  grammar::Tick ticks = 0;
  grammar::Timeline truth, found;
  std::vector<EpisodeToScore::Bands> bands;  ///< of `truth`, or none
};

struct Score {
  std::string grammar;
  std::vector<EventScore> events;  ///< sorted by name
  EventScore total;
  MeanOfKinds mean;
  std::vector<EpisodeRow> rows;
  int episodes = 0;
  std::vector<std::string>
      not_covered;  ///< events that are scored, but that no rule of the grammar prints
  std::map<std::string, int> ignored;  ///< of all episodes
  std::map<std::string, exchange::Moments> moments = {};
  std::string set = {};                  ///< the one that all takes are of, or ""
  std::vector<std::string> failed = {};  ///< episodes without a result, which no figure has
  double cpu_share = 0;  ///< of a program: processor time for a second of the episodes
  std::string ignored_because = "docs/events.md does not define them";
};

/// Tolerances of boundaries, in seconds, of single kinds of events.
using Collars = std::map<std::string, double>;

/// Labels are events with their roles. `collar_s` is for the collar-based scores of the kinds that
/// `collars` does not have.
Score ScoreOf(const std::string& grammar, const std::vector<EpisodeToScore>& episodes,
              double collar_s, const Collars& collars = {});

/// A table for people: Ward's event errors, boundary errors, F1@{10,25,50}, edit, frames, F at the
/// collar, latency. Below it, the events that the grammar does not cover, and those that are
/// ignored.
std::string ScoreTable(const Score& score);

/// The tables of several grammars, and what their columns mean.
std::string ScoresText(const std::vector<Score>& scores);

/// The totals of several grammars beside each other, as a Markdown table.
std::string SideBySide(const std::vector<Score>& scores);

/// {"collar_s", "grammars": [{"grammar", "episodes", "not_covered", "ignored", "total": {..},
/// "events": [{..}]}]}; shares from 0 to 1, times in seconds; docs/regression-suite.md says what
/// each is.
/// `with_events`: rows have what was compared, too.
nlohmann::ordered_json ScoresJson(const std::vector<Score>& scores, bool with_events = false);

/// {"by_event": {EVENT: {"of", "confirmed"}}, "differences": ["..", ..]}
nlohmann::ordered_json EvaluationJson(const Evaluation& evaluation);

/// [{"witness", "proves", "grammars": [{"grammar", "of", "confirmed", "by_event", "differences"}]}]
nlohmann::ordered_json EvaluatorsJson(const std::vector<Score>& scores,
                                      const std::vector<Evaluator>& evaluators);

// Who says what happened in an episode, a grammar or somebody else, and what they say. Tested by
// tests/program/found_test.cc and tests/program/recogniser_test.cc

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
