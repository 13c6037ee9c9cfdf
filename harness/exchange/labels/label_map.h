// SPDX-License-Identifier: Apache-2.0
// Which events people's labels mean. With a map: a YAML file, see docs/labels.md. Without one a
// label is an event as it is printed: "grasping(right_hand, cup)". Tested by
// tests/harness/exchange/labels/labels_test.cc
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "grammar/contents.h"
#include "harness/base/base/located.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {

/// A label, or what a tier adds to its labels.
struct Meaning {
  bool ignored = false;
  std::string event;
  std::vector<grammar::Role> roles;
  std::map<std::string, Where> entities;  ///< where its roles' values stand
  Where where;
};

struct LabelMap {
  YamlDocument document;
  double offset_s = 0;  ///< added to all times of labels
  double join_s = 0;    ///< labels of one event with no longer pause between them are one
  CsvReading csv;
  /// What the columns of roles hold, as entities; "": labels of it are left out.
  std::map<std::string, Located<std::string>> entities;
  std::map<std::string, Meaning> labels;
  std::map<std::string, Meaning> tiers;  ///< empty: tiers mean nothing
};

/// Errors have their places. Events and roles must be those of `events`.
Result<LabelMap> ReadLabelMap(const std::string& path,
                              const std::vector<grammar::EventSignature>& events);

/// Of each event that labels name the roles that they name with it: what is compared.
using ComparedRoles = std::map<std::string, std::vector<std::string>>;

/// Labels as events. One without roles in common with other labels of its event is compared without
/// them.
class LabelReading {
 public:
  /// `map` may be null. Errors are labels that the map does not have, or that are no events.
  static Result<LabelReading> Of(std::vector<LabelFile> files, const LabelMap* map,
                                 const std::vector<grammar::EventSignature>& events);

  const std::vector<LabelFile>& files() const { return files_; }
  const ComparedRoles& compared() const { return compared_; }
  /// What the map adds to all times.
  double offset_s() const { return offset_s_; }

  /// The events of the file with this index in a recording of these entities and this length.
  /// Errors are entities that are missing or cannot have such a role, and labels beyond its end.
  Result<grammar::Timeline> Truth(std::size_t file,
                                  const std::vector<grammar::EntityInfo>& entities,
                                  grammar::Tick ticks_per_second, grammar::Tick end) const;

 private:
  struct LabelledEvent {
    double begin_s = 0, end_s = 0;
    grammar::NamedEvent event;
    grammar::Place place;
    std::map<std::string, Where> in_map;  ///< of the entities that the map names, not the label
  };
  /// What is wrong with a role of a label, in the file that says it.
  grammar::Diagnostic At(const LabelFile& labels, const LabelledEvent& label,
                         const std::string& entity, std::string message, std::string hint) const;
  std::vector<LabelFile> files_;
  std::vector<std::vector<LabelledEvent>> events_;  ///< per file
  ComparedRoles compared_;
  std::map<std::string, grammar::EventSignature> signatures_;  ///< of the compared events
  std::optional<YamlDocument> map_;
  double join_s_ = 0, offset_s_ = 0;
};

/// Only the compared events, each with its compared roles; those of the same label that overlap
/// become one, and so do those with at most `join` ticks between them.
grammar::Timeline Compared(const grammar::Timeline& timeline, const ComparedRoles& roles,
                           grammar::Tick join = 0);

/// The same with the hand in the name of each event that has one: "grasping of left_hand".
grammar::Timeline ByHand(grammar::Timeline timeline);

}  // namespace prehend::exchange
