// SPDX-License-Identifier: Apache-2.0
// Which events people's labels mean. With a map: a YAML file, see docs/labels.md. Without one a
// label is an event as it is printed: "grasping(right_hand, cup)". Tested by
// tests/harness/exchange/labels/labels_test.cc
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "grammar/contents.h"
#include "harness/base/base/located.h"
#include "harness/base/base/number_text.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/exchange/labels/read_labels.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {

/// The error of a table whose LabelFile::several are not told apart.
grammar::Diagnostic SeveralTakes(const LabelFile& file, const std::string& take);

/// A label, or what a tier adds to its labels.
struct Meaning {
  bool ignored = false;
  std::string event;
  std::vector<grammar::Role> roles;
  std::map<std::string, Where> entities;  ///< where its roles' values stand
  /// Of a tier whose labels are no events: they are this role of those of another tier.
  std::string role, of;
  Where where;
};

struct LabelMap {
  YamlDocument document;
  /// Of takes by their names, or "" of all, with {take} in it; paths as seen from here.
  std::map<std::string, std::string> videos;
  double offset_s = 0;                      ///< added to all times of labels
  std::map<std::string, double> offsets_s;  ///< the same of single takes, by their names
  double join_s = 0;  ///< labels of one event with no longer pause between them are one
  std::map<std::string, double> collars_s;  ///< of boundaries, by event
  CsvReading csv;
  /// What the columns of roles hold, as entities; "": labels of it are left out.
  std::map<std::string, Located<std::string>> entities;
  std::map<std::string, Meaning> labels;
  std::map<std::string, Meaning> tiers;  ///< empty: tiers mean nothing
};

/// What a map says should be added to the times of a take; nothing if that is nowhere.
std::optional<double> OffsetOf(const LabelMap& map, const std::vector<std::string>& names);
/// Its video, or ""; the clock is that of its labels.
std::string VideoOf(const LabelMap& map, const std::vector<std::string>& names);

/// Every role of an event.
std::set<std::string> RolesOf(const std::vector<grammar::EventSignature>& events);

/// Errors have their places. Events and roles must be those of `events`.
Result<LabelMap> ReadLabelMap(const std::string& path,
                              const std::vector<grammar::EventSignature>& events);

/// Of each event that labels name the roles that they name with it: what is compared.
using ComparedRoles = std::map<std::string, std::vector<std::string>>;

/// Labels of a file that are those of a take.
struct TakeRows {
  std::size_t file = 0;
  std::vector<std::size_t> labels;  ///< their indices
  double offset_s = 0;
  std::string video = {};
};

/// What was counted, and what was not and why.
struct Counted {
  std::size_t takes = 0, labels = 0, moments = 0;
  std::size_t cut = 0;  ///< of the labels, those that begin before their recording or end after it
  std::size_t merged = 0;  ///< by how many they are more than what became of them
  std::map<std::string, std::size_t> ignored;  ///< by the text of the label
  std::size_t without_text = 0;
  std::map<std::string, std::size_t> unread;  ///< columns that mean nothing, and in how many files
  std::map<std::string, std::size_t> backward;  ///< by file
  /// By file and take.
  std::map<std::string, std::map<std::string, std::size_t>> of_other_takes;

  /// "counted: 5 labels of 1 take\nleft out: ..\n"
  std::string Text() const;
  /// Files that both have read are not counted twice.
  Counted& operator+=(const Counted& more);
  std::size_t Backward() const;
  std::map<std::string, std::size_t> OfOtherTakes() const;
};

/// Labels of a moment, and how many lie in what was recognised of the same name and roles.
struct Moments {
  int marked = 0, found = 0;
  std::vector<std::pair<double, grammar::NamedEvent>> labels = {};  ///< of a take, with seconds
};

/// What labels are: what is true, or what somebody else found. Of the latter the map says what it
/// has, and all else is an event as it is printed, in tiers that mean nothing.
enum class Side { kTruth, kFound };

/// Labels as events. One without roles in common with other labels of its event is compared without
/// them.
class LabelReading {
 public:
  /// `map` may be null. Errors are labels that the map does not have, or that are no events.
  static Result<LabelReading> Of(std::vector<LabelFile> files, const LabelMap* map,
                                 const std::vector<grammar::EventSignature>& events,
                                 std::vector<TakeRows> takes, Side side = Side::kTruth);
  /// A file for each take.
  static Result<LabelReading> Of(std::vector<LabelFile> files, const LabelMap* map,
                                 const std::vector<grammar::EventSignature>& events);

  const std::vector<LabelFile>& files() const { return files_; }
  const ComparedRoles& compared() const { return compared_; }
  const truth::HandRoles& hands() const { return hands_; }
  const TakeRows& rows(std::size_t take) const { return takes_[take]; }
  /// What is added to all times of labels; nothing if that differs between takes.
  std::optional<double> offset_s() const;
  /// What the map says of the tolerances of boundaries, in seconds, by event.
  const std::map<std::string, double>& collars_s() const { return collars_s_; }
  const Counted& counted() const { return counted_; }
  Counted& counted() { return counted_; }
  /// Of what is strange, lines.
  const std::string& warnings() const { return warnings_; }

  /// The events of the take with this index, in a recording of these entities and this length; not
  /// those of a moment. Errors are entities that are missing or cannot have such a role, and labels
  /// outside of it, or beyond its end.
  Result<grammar::Timeline> Truth(std::size_t take,
                                  const std::vector<grammar::EntityInfo>& entities,
                                  grammar::Tick ticks_per_second, grammar::Tick end) const;
  /// The same with all their roles, of what was found; when it was decided is -1 where nothing says
  /// it. Errors are also events of a moment, and those without a role in which they are compared.
  Result<grammar::Timeline> Found(std::size_t take,
                                  const std::vector<grammar::EntityInfo>& entities,
                                  grammar::Tick ticks_per_second, grammar::Tick end,
                                  const ComparedRoles& compared) const;
  /// The same as Truth() without a recording; with those of a moment or not, which then last a
  /// tick.
  grammar::Timeline Marked(std::size_t take, grammar::Tick ticks_per_second, grammar::Tick end,
                           bool moments) const;
  /// How many labels of the take are cut at an end of a recording of this length.
  std::size_t Cut(std::size_t take, double end_s) const;
  /// From 0, or where its first label begins before, to where the last label of the take ends, s.
  std::pair<double, double> SpanOf(std::size_t take) const;
  /// All labels of the take come so much later.
  void Move(std::size_t take, double by_s);
  /// Of those of a moment how many lie in what is found, by event, give or take `before` ticks from
  /// its begin. What contains one, and no true event is there, is taken out of `found`.
  std::map<std::string, Moments> TakeMoments(std::size_t take, const grammar::Timeline& truth,
                                             grammar::Tick before, grammar::Timeline& found) const;

 private:
  struct LabelledEvent {
    double begin_s = 0, end_s = 0;
    grammar::NamedEvent event;
    grammar::Place place;
    std::map<std::string, Where> in_map;  ///< of the entities that the map names, not the label
    std::optional<double> decided_s;
    bool IsMoment() const { return begin_s == end_s; }
  };
  /// What is wrong with a role of a label, in the file that says it.
  grammar::Diagnostic At(const LabelFile& labels, const LabelledEvent& label,
                         const std::string& entity, std::string message, std::string hint) const;
  grammar::Diagnostics Problems(std::size_t take, const std::vector<grammar::EntityInfo>& entities,
                                double end_s) const;
  grammar::NamedEvent InTicks(const LabelledEvent& label, grammar::Tick ticks_per_second,
                              grammar::Tick end) const;
  void WarnOfOverlaps(const LabelFile& file, const std::vector<LabelledEvent>& events);

  std::vector<LabelFile> files_;
  std::vector<TakeRows> takes_;
  std::vector<std::vector<LabelledEvent>> events_;  ///< per take
  ComparedRoles compared_;
  truth::HandRoles hands_;
  std::map<std::string, grammar::EventSignature> signatures_;  ///< of the compared events
  std::optional<YamlDocument> map_;
  double join_s_ = 0;
  std::map<std::string, double> collars_s_;
  Counted counted_;
  std::string warnings_;
};

/// Only the compared events, each with its compared roles; those of the same label that overlap
/// become one, and so do those with at most `join` ticks between them.
grammar::Timeline Compared(const grammar::Timeline& timeline, const ComparedRoles& roles,
                           grammar::Tick join = 0);

/// The same with the hand in the name of each event that has one: "grasping of left_hand".
grammar::Timeline ByHand(grammar::Timeline timeline, const truth::HandRoles& hands);

// Videos and trackers begin at different times: labels that are all too early, or all too late.

/// Labels that are found: something of the same name and roles shares half of the union with them.
struct ClockOffset {
  double offset_s = 0;  ///< to be added to the times of the labels
  int found_now = 0, found_then = 0, all = 0;
};

/// Of recordings, each with its labels and what was recognised, the offset of up to 5 s with which
/// the most labels are found. Nothing if that are hardly more than now.
std::optional<ClockOffset> FindClockOffset(
    std::span<const std::pair<grammar::Timeline, grammar::Timeline>> recordings);

}  // namespace prehend::exchange
