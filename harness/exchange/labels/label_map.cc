// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/labels/label_map.h. Tested by tests/harness/exchange/labels/labels_test.cc
#include "harness/exchange/labels/label_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "grammar/base/wording.h"
#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/error_at.h"
#include "harness/base/yaml/yaml_scalar.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;
using grammar::EventSignature;
using Events = std::vector<EventSignature>;

/// A label may end so long after its recording; people stop marking later than cameras stop.
constexpr double kMostBeyondEnd_s = 1;

const EventSignature* FindEvent(const Events& events, const std::string& name) {
  const auto found = std::ranges::find(events, name, &EventSignature::name);
  return found == events.end() ? nullptr : &*found;
}

std::vector<std::string> NamesOf(const Events& events) {
  std::vector<std::string> names;
  for (const EventSignature& event : events) names.push_back(event.name);
  return names;
}

/// In the order of the event's head; the two of a symmetric event by the alphabet, as recognised
/// events have them.
void PutInOrder(const EventSignature& event, std::vector<grammar::Role>& roles) {
  std::ranges::sort(roles, {}, [&](const grammar::Role& role) {
    return std::ranges::find(event.roles, role.name) - event.roles.begin();
  });
  if (event.symmetric && roles.size() >= 2 && roles[1].value < roles[0].value)
    std::swap(roles[0].value, roles[1].value);
}

class MapReader {
 public:
  MapReader(LabelMap& map, const Events& events)
      : map_(map), events_(events), errors_(map.document) {}

  Diagnostics Read() {
    const YamlNode& root = map_.document.root;
    if (root.kind != YamlNode::Kind::kMapping) {
      errors_.Add(root.where, "expected a map of labels, found " + Describe(root), kExample);
      return errors_.Sorted();
    }
    for (const YamlNode& node : root.children) {
      if (node.key == "version")
        ReadVersion(node);
      else if (node.key == "offset_s")
        ReadNumber(node, map_.offset_s, "seconds", false);
      else if (node.key == "join_s")
        ReadNumber(node, map_.join_s, "seconds", true);
      else if (node.key == "rate_hz")
        ReadNumber(node, map_.csv.rate_hz, "frames per second", true);
      else if (node.key == "time_unit")
        ReadTimeUnit(node);
      else if (node.key == "columns")
        ReadColumns(node);
      else if (node.key == "entities")
        ReadEntities(node);
      else if (node.key == "tiers")
        ReadTiers(node);
      else if (node.key != "labels")
        errors_.AddUnknownName(node.key_where, "unknown key '" + node.key + "'", node.key,
                               {"version", "labels", "tiers", "offset_s", "join_s", "time_unit",
                                "rate_hz", "columns", "entities"});
    }
    if (const YamlNode* labels = root.Find("labels"))
      ReadLabelNodes(*labels);
    else
      errors_.Add(root.where, "'labels' is missing", kExample);
    return errors_.Sorted();
  }

 private:
  static constexpr const char* kExample =
      "labels:\n    hold: {event: EVENT, object: cup}\n    idle: ignore";

  void ReadNumber(const YamlNode& node, double& into, const char* what, bool positive) {
    const std::optional<double> number = NumberOf(node);
    if (number && (!positive || *number > 0))
      into = *number;
    else
      errors_.Add(node.where, fmt::format("{}: expected {}{}, found {}", node.key, what,
                                          positive ? ", more than 0" : "", Describe(node)));
  }

  /// 1 where no line says it.
  void ReadVersion(const YamlNode& node) {
    if (NumberOf(node) != 1)
      errors_.Add(node.where,
                  "version: expected 1, the version of this format, found " + Describe(node));
  }

  void ReadTimeUnit(const YamlNode& node) {
    static const std::map<std::string, double> units = {
        {"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"frame", 0}};
    const auto unit = node.kind == YamlNode::Kind::kScalar ? units.find(node.text) : units.end();
    if (unit == units.end())
      return errors_.Add(node.where,
                         "time_unit: expected s, ms, us, ns or frame, found " + Describe(node));
    map_.csv.unit_s = unit->second;
    map_.csv.in_frames = node.text == "frame";
  }

  /// Every role of an event.
  std::set<std::string> Roles() const {
    std::set<std::string> known;
    for (const EventSignature& event : events_)
      known.insert(event.roles.begin(), event.roles.end());
    return known;
  }

  void ReadColumns(const YamlNode& columns) {
    if (!IsMapping(columns)) return;
    std::set<std::string> known = Roles();
    for (const YamlNode& node : columns.children) {
      if (node.kind != YamlNode::Kind::kScalar || node.text.empty()) {
        errors_.Add(node.where,
                    node.key + ": expected the name of a column, found " + Describe(node));
      } else if (node.key == "begin") {
        map_.csv.begin = node.text;
      } else if (node.key == "end") {
        map_.csv.end = node.text;
      } else if (node.key == "label") {
        map_.csv.label = node.text;
      } else if (node.key == "tier") {
        map_.csv.tier = node.text;
      } else if (known.contains(node.key)) {
        map_.csv.roles.push_back({node.key, node.text});
      } else {
        known.insert({"begin", "end", "label", "tier"});
        errors_.AddUnknownName(
            node.key_where,
            "'" + node.key + "' is no column of labels: begin, end, label, tier or a role",
            node.key, {known.begin(), known.end()});
      }
    }
  }

  void ReadEntities(const YamlNode& entities) {
    if (!IsMapping(entities)) return;
    for (const YamlNode& node : entities.children) {
      if (node.kind != YamlNode::Kind::kScalar || node.text.empty())
        errors_.Add(node.where, node.key + ": expected the name of an entity, or 'ignore', found " +
                                    Describe(node));
      else
        map_.entities[node.key] = {SaysIgnore(node) ? "" : node.text, node.where};
    }
  }

  bool IsMapping(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::kMapping && !node.children.empty()) return true;
    errors_.Add(node.where, node.key + ": expected a mapping, found " + Describe(node), kExample);
    return false;
  }

  static bool SaysIgnore(const YamlNode& node) {
    return node.kind == YamlNode::Kind::kScalar && node.text == "ignore";
  }

  void ReadTiers(const YamlNode& tiers) {
    if (!IsMapping(tiers)) return;
    const std::set<std::string> known = Roles();
    for (const YamlNode& node : tiers.children) {
      Meaning& tier = map_.tiers[node.key];
      tier.where = node.key_where;
      tier.ignored = SaysIgnore(node);
      if (tier.ignored || !IsMapping(node)) continue;
      for (const YamlNode& role : node.children) {
        if (!known.contains(role.key))
          errors_.AddUnknownName(role.key_where, "no event has a role '" + role.key + "'", role.key,
                                 {known.begin(), known.end()});
        ReadRole(role, tier);
      }
    }
  }

  void ReadRole(const YamlNode& node, Meaning& meaning) {
    if (node.kind != YamlNode::Kind::kScalar || node.text.empty())
      errors_.Add(node.where,
                  node.key + ": expected the name of an entity, found " + Describe(node));
    else
      meaning.roles.push_back({node.key, node.text}), meaning.entities[node.text] = node.where;
  }

  void ReadLabelNodes(const YamlNode& labels) {
    if (!IsMapping(labels)) return;
    for (const YamlNode& node : labels.children) {
      Meaning& label = map_.labels[node.key];
      label.where = node.key_where;
      label.ignored = SaysIgnore(node);
      if (label.ignored) continue;
      const YamlNode* name = node.kind == YamlNode::Kind::kMapping ? node.Find("event") : nullptr;
      if (!name) {
        errors_.Add(
            node.where,
            fmt::format("'{}': expected an event or 'ignore', found {}", node.key, Describe(node)),
            kExample);
        continue;
      }
      label.event = name->text;
      const EventSignature* event = FindEvent(events_, label.event);
      if (!event) {
        errors_.AddUnknownName(name->where, "the grammar has no event '" + label.event + "'",
                               label.event, NamesOf(events_));
        continue;
      }
      for (const YamlNode& role : node.children) {
        if (role.key == "event") continue;
        if (std::ranges::find(event->roles, role.key) == event->roles.end())
          errors_.AddUnknownName(role.key_where,
                                 fmt::format("'{}' has no role '{}'", event->name, role.key),
                                 role.key, event->roles);
        ReadRole(role, label);
      }
    }
  }

  LabelMap& map_;
  const Events& events_;
  DiagnosticList errors_;
};

/// Between double quotes.
std::string AsYaml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n"), end = text.find_last_not_of(" \t\n");
  return begin == std::string_view::npos ? "" : std::string(text.substr(begin, end - begin + 1));
}

/// "grasping(right_hand, cup)", or the name alone. Nothing, and `problem`, if it is no
/// event.
std::optional<grammar::NamedEvent> EventIn(const std::string& text, const Events& events,
                                           std::string& problem) {
  const std::size_t open = text.find('(');
  const std::string name = Trimmed(std::string_view(text).substr(0, open));
  const EventSignature* event = FindEvent(events, name);
  if (!event) {
    const std::string near = grammar::NearestName(name, NamesOf(events));
    problem = fmt::format("found the label '{}', wanted an event of the grammar{}", text,
                          near.empty() ? "" : ", like " + near);
    return std::nullopt;
  }
  grammar::NamedEvent named{.event = name, .roles = {}, .interval = {}};
  if (open == std::string::npos) return named;
  const std::size_t close = text.find(')', open);
  std::vector<std::string> values;
  std::string_view inner = std::string_view(text).substr(open + 1, close - open - 1);
  for (std::size_t begin = 0; begin <= inner.size();) {
    const std::size_t end = std::min(inner.find(',', begin), inner.size());
    values.push_back(Trimmed(inner.substr(begin, end - begin)));
    begin = end + 1;
  }
  if (close == std::string::npos || close + 1 != text.size() ||
      values.size() != event->roles.size()) {
    problem = fmt::format("found the label '{}', wanted {}({})", text, name,
                          fmt::join(event->roles, ", "));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    named.roles.push_back({event->roles[i], values[i]});
  PutInOrder(*event, named.roles);
  return named;
}

/// What a label means: an event, nothing (it is ignored), or a problem.
struct Meant {
  std::optional<grammar::NamedEvent> event = {};
  std::map<std::string, Where> in_map = {};  ///< of the entities that the map names, not the label
  std::string problem = {}, hint = {};
};

Meant WithoutMap(const std::string& text, const Events& events) {
  Meant meant;
  meant.event = EventIn(text, events, meant.problem);
  if (!meant.event) meant.hint = "say what your labels mean in a file: --map labels.yaml";
  return meant;
}

/// What the map says of a label or a tier, which `kind` names; null if it has it not.
const Meaning* Find(const std::map<std::string, Meaning>& known, const std::string& name,
                    const std::string& kind, Meant& meant) {
  const auto found = known.find(name);
  if (found != known.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [each, _] : known) names.push_back(each);
  const std::string near = grammar::NearestName(name, names);
  meant.problem = fmt::format("the map has no {} '{}'", kind, name);
  meant.hint = near.empty() ? fmt::format("{}s: {{{}: ignore}}", kind, AsYaml(name))
                            : "did you mean '" + near + "'?";
  return nullptr;
}

/// The roles of the label's meaning, then those of its columns, then those of its tier. False if a
/// column has an entity that is left out.
bool AddRoles(const Label& label, const LabelMap& map, const Meaning* tier,
              const EventSignature& event, Meant& meant) {
  std::vector<grammar::Role>& roles = meant.event->roles;
  const auto add = [&](const grammar::Role& role) {
    const bool has_it = std::ranges::find(event.roles, role.name) != event.roles.end();
    const bool given = std::ranges::find(roles, role.name, &grammar::Role::name) != roles.end();
    if (has_it && !given) roles.push_back(role);
  };
  for (grammar::Role role : label.roles) {
    const auto entity = map.entities.find(role.value);
    meant.in_map.erase(role.value);
    if (entity != map.entities.end()) {
      role.value = entity->second.value;
      meant.in_map[role.value] = entity->second.where;
    }
    if (role.value.empty()) return false;
    add(role);
  }
  if (tier) std::ranges::for_each(tier->roles, add);
  PutInOrder(event, roles);
  return true;
}

Meant ByMap(const Label& label, const std::string& text, const LabelMap& map,
            const Events& events) {
  Meant meant;
  const Meaning* tier = nullptr;
  if (!map.tiers.empty()) {
    tier = Find(map.tiers, label.tier, "tier", meant);
    if (!tier || tier->ignored) return meant;
  }
  const Meaning* meaning = Find(map.labels, text, "label", meant);
  if (!meaning || meaning->ignored) return meant;
  meant.event = {.event = meaning->event, .roles = meaning->roles, .interval = {}};
  meant.in_map = meaning->entities;
  if (tier) meant.in_map.insert(tier->entities.begin(), tier->entities.end());
  if (!AddRoles(label, map, tier, *FindEvent(events, meaning->event), meant)) meant.event.reset();
  return meant;
}

/// Only roles that all labels of the event have are compared.
void Compare(const std::string& event, const std::vector<grammar::Role>& roles,
             ComparedRoles& compared) {
  std::vector<std::string> names;
  for (const grammar::Role& role : roles) names.push_back(role.name);
  const auto [found, is_new] = compared.try_emplace(event, names);
  if (!is_new)
    std::erase_if(found->second, [&](const std::string& role) {
      return std::ranges::find(names, role) == names.end();
    });
}

}  // namespace

Result<LabelMap> ReadLabelMap(const std::string& path, const Events& events) {
  Result<YamlDocument> document = ReadYamlFile(path);
  if (!document) return tl::unexpected(std::move(document.error()));
  LabelMap map{.document = std::move(*document)};
  Diagnostics problems = MapReader(map, events).Read();
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return map;
}

Result<LabelReading> LabelReading::Of(std::vector<LabelFile> files, const LabelMap* map,
                                      const Events& events) {
  LabelReading reading;
  if (map) {
    reading.join_s_ = map->join_s;
    reading.offset_s_ = map->offset_s;
    reading.map_ = map->document;
  }
  Diagnostics problems;
  std::set<std::string> complained;
  for (const LabelFile& file : files) {
    std::vector<LabelledEvent>& of_file = reading.events_.emplace_back();
    for (const Label& label : file.labels) {
      const std::string text = Trimmed(label.text);
      Meant meant = map ? ByMap(label, text, *map, events) : WithoutMap(text, events);
      if (!meant.problem.empty() && problems.size() < kMostComplaints &&
          complained.insert(meant.problem).second)
        problems.push_back(file.At(label.place, std::move(meant.problem), std::move(meant.hint)));
      if (!meant.event) continue;
      Compare(meant.event->event, meant.event->roles, reading.compared_);
      of_file.push_back({label.begin_s + reading.offset_s_, label.end_s + reading.offset_s_,
                         std::move(*meant.event), label.place, std::move(meant.in_map)});
    }
  }
  // What labels could name: without one of them, what is recognised of it is too much.
  if (map) {
    for (const auto& [text, meaning] : map->labels)
      if (!meaning.ignored && !reading.compared_.contains(meaning.event))
        Compare(meaning.event, meaning.roles, reading.compared_);
  }
  // Of a symmetric event one role alone says nothing.
  for (auto& [name, roles] : reading.compared_) {
    const EventSignature& event = *FindEvent(events, name);
    if (event.symmetric && roles.size() == 1) roles.clear();
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  for (const auto& [name, _] : reading.compared_)
    reading.signatures_.emplace(name, *FindEvent(events, name));
  reading.files_ = std::move(files);
  return reading;
}

grammar::Diagnostic LabelReading::At(const LabelFile& labels, const LabelledEvent& label,
                                     const std::string& entity, std::string message,
                                     std::string hint) const {
  const auto where = label.in_map.find(entity);
  if (where == label.in_map.end())
    return labels.At(label.place, std::move(message), std::move(hint));
  grammar::Diagnostic in_map = ErrorAt(*map_, where->second);
  in_map.message = std::move(message);
  in_map.hint = std::move(hint);
  return in_map;
}

Result<grammar::Timeline> LabelReading::Truth(std::size_t file,
                                              const std::vector<grammar::EntityInfo>& entities,
                                              grammar::Tick ticks_per_second,
                                              grammar::Tick end) const {
  const LabelFile& labels = files_[file];
  grammar::Timeline truth{.ticks_per_second = ticks_per_second, .events = {}};
  Diagnostics problems;
  const double end_s = static_cast<double>(end) / static_cast<double>(ticks_per_second);
  for (const LabelledEvent& label : events_[file]) {
    if (problems.size() >= kMostComplaints) break;
    for (const grammar::Role& role : label.event.roles) {
      const EventSignature& event = signatures_.at(label.event.event);
      const auto index =
          static_cast<std::size_t>(std::ranges::find(event.roles, role.name) - event.roles.begin());
      const auto takes = [&](const grammar::EntityInfo& entity) {
        return std::ranges::find(entity.classes, event.classes[index]) != entity.classes.end();
      };
      const auto entity = std::ranges::find(entities, role.value, &grammar::EntityInfo::name);
      if (entity != entities.end() && takes(*entity)) continue;
      std::vector<std::string> names;
      for (const grammar::EntityInfo& other : entities)
        if (entity == entities.end() || takes(other)) names.push_back(other.name);
      const std::string near = grammar::NearestName(role.value, names);
      const grammar::Diagnostic problem =
          At(labels, label, role.value,
             entity == entities.end()
                 ? fmt::format("the recording has no entity '{}'", role.value)
                 : fmt::format("'{}' is never '{}' of '{}', which takes {}", role.value, role.name,
                               event.name, grammar::WithArticle(event.classes[index])),
             !near.empty()   ? "did you mean '" + near + "'?"
             : names.empty() ? fmt::format("the recording has no {}", event.classes[index])
                             : fmt::format("it has {}", fmt::join(names, ", ")));
      // A mistake in the map is one for all labels.
      const auto is_same = [&](const grammar::Diagnostic& other) {
        return other.file == problem.file && other.place.line == problem.place.line &&
               other.place.column == problem.place.column;
      };
      if (std::ranges::none_of(problems, is_same)) problems.push_back(problem);
    }
    if (label.begin_s < -kMostBeyondEnd_s || label.end_s > end_s + kMostBeyondEnd_s) {
      problems.push_back(labels.At(
          label.place,
          fmt::format("the label lies at {:g} to {:g} s, the recording ends after {:g} s",
                      label.begin_s, label.end_s, end_s),
          "is it of another recording, in another unit, or by another clock? offset_s in the map "
          "moves all labels"));
      continue;
    }
    grammar::NamedEvent event = label.event;
    event.interval.begin =
        std::clamp<grammar::Tick>(truth::TickAt(label.begin_s, ticks_per_second), 0, end - 1);
    event.interval.end = std::clamp<grammar::Tick>(truth::TickAt(label.end_s, ticks_per_second),
                                                   event.interval.begin + 1, end);
    event.decided = event.interval.end;
    truth.events.push_back(std::move(event));
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return Compared(truth, compared_, truth::TickAt(join_s_, ticks_per_second));
}

grammar::Timeline Compared(const grammar::Timeline& timeline, const ComparedRoles& roles,
                           grammar::Tick join) {
  std::map<std::string, std::vector<grammar::NamedEvent>> by_label;
  for (grammar::NamedEvent event : timeline.events) {
    const auto compared = roles.find(event.event);
    if (compared == roles.end()) continue;
    std::erase_if(event.roles, [&](const grammar::Role& role) {
      return std::ranges::find(compared->second, role.name) == compared->second.end();
    });
    event.values.clear();
    by_label[event.Label()].push_back(std::move(event));
  }
  grammar::Timeline all{.ticks_per_second = timeline.ticks_per_second, .events = {}};
  for (auto& [label, events] : by_label) {
    std::ranges::sort(events, {}, [](const grammar::NamedEvent& event) {
      return std::pair(event.interval.begin, event.interval.end);
    });
    const std::size_t first = all.events.size();
    for (grammar::NamedEvent& event : events) {
      const bool follows = all.events.size() > first;
      if (follows &&
          (event.interval.begin < all.events.back().interval.end ||
           (join > 0 && event.interval.begin <= all.events.back().interval.end + join))) {
        grammar::NamedEvent& before = all.events.back();
        before.interval.end = std::max(before.interval.end, event.interval.end);
        before.decided = std::max(before.decided, event.decided);
      } else {
        all.events.push_back(std::move(event));
      }
    }
  }
  Sort(all);
  return all;
}

grammar::Timeline ByHand(grammar::Timeline timeline) {
  for (grammar::NamedEvent& event : timeline.events) {
    const std::string& hand = truth::RoleValue(event, "hand");
    if (!hand.empty()) event.event += " of " + hand;
  }
  return timeline;
}

}  // namespace prehend::exchange
