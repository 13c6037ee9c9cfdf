// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/labels/label_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "grammar/base/diagnostic.h"
#include "harness/base/yaml/diagnostic_list.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;
using grammar::EventSignature;
using Events = std::vector<EventSignature>;

/// A label may end so long after its recording; people stop marking later than cameras stop.
constexpr double kMostBeyondEnd_s = 1;
constexpr double kNoCut_s = 0.02;  ///< about a frame
/// Times after this are hardly counted from the begin of a recording.
constexpr double kDates_s = 1e8;

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

/// "grasping(right_hand, cup)", "grasping(hand=right_hand)", or the name alone. Nothing, and
/// `problem`, if it is no event.
std::optional<grammar::NamedEvent> EventIn(const std::string& text, const Events& events,
                                           std::string& problem) {
  const std::size_t open = text.find('(');
  const std::string name(Trimmed(std::string_view(text).substr(0, open)));
  const EventSignature* event = FindEvent(events, name);
  if (!event) {
    const std::string near = grammar::NearestName(name, NamesOf(events));
    problem = fmt::format("found the label '{}', wanted an event of the grammar{}", text,
                          near.empty() ? "" : ", like " + near);
    return std::nullopt;
  }
  grammar::NamedEvent named{.event = name, .roles = {}};
  if (open == std::string::npos) return named;
  const std::size_t close = text.find(')', open);
  std::vector<std::string> values;
  for (const std::string& value : SplitAt(text.substr(open + 1, close - open - 1), ','))
    values.emplace_back(Trimmed(value));
  const bool is_named = std::ranges::all_of(values, [&](const std::string& value) {
    return std::ranges::count(event->roles, value.substr(0, value.find('='))) > 0 &&
           value.find('=') != std::string::npos;
  });
  if (close == std::string::npos || close + 1 != text.size() ||
      (!is_named && values.size() != event->roles.size())) {
    problem = fmt::format("found the label '{}', wanted {}({})", text, name,
                          fmt::join(event->roles, ", "));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t equals = is_named ? values[i].find('=') : 0;
    named.roles.push_back(
        is_named
            ? grammar::Role{values[i].substr(0, equals),
                            std::string(Trimmed(std::string_view(values[i]).substr(equals + 1)))}
            : grammar::Role{event->roles[i], values[i]});
  }
  PutInOrder(*event, named.roles);
  if (std::ranges::adjacent_find(named.roles, {}, &grammar::Role::name) != named.roles.end())
    return problem = fmt::format("found the label '{}', which names a role twice", text),
           std::nullopt;
  return named;
}

/// What a label means: an event, nothing (it is ignored), or a problem.
struct Meant {
  std::optional<grammar::NamedEvent> event = {};
  std::map<std::string, Where> in_map = {};  ///< of the entities that the map names, not the label
  std::string problem = {}, hint = {};
};

/// What the map says of a label or a tier, which `kind` names; null if it has it not.
const Meaning* Find(const std::map<std::string, Meaning>& known, const std::string& name,
                    const std::string& kind, Meant& meant) {
  const auto found = known.find(name);
  if (found != known.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [each, _] : known) names.push_back(each);
  meant.problem = fmt::format("the map has no {} '{}'", kind, name);
  meant.hint =
      grammar::DidYouMean(name, names, fmt::format("{}s: {{{}: ignore}}", kind, InQuotes(name)));
  return nullptr;
}

/// The roles of the label's meaning, then those of its columns, then those of its tier. False if a
/// column has an entity that is left out.
bool AddRoles(const Label& label, const LabelMap* map, const Meaning* tier,
              const EventSignature& event, Meant& meant) {
  std::vector<grammar::Role>& roles = meant.event->roles;
  const auto add = [&](const grammar::Role& role) {
    const bool has_it = std::ranges::find(event.roles, role.name) != event.roles.end();
    const bool given = std::ranges::find(roles, role.name, &grammar::Role::name) != roles.end();
    if (has_it && !given) roles.push_back(role);
  };
  for (grammar::Role role : label.roles) {
    if (tier && role.value == label.tier) continue;  // one column is both, and the map explains it
    meant.in_map.erase(role.value);
    if (map && map->entities.contains(role.value)) {
      const Located<std::string>& entity = map->entities.at(role.value);
      role.value = entity.value;
      meant.in_map[role.value] = entity.where;
    }
    if (role.value.empty()) return false;
    add(role);
  }
  if (tier) std::ranges::for_each(tier->roles, add);
  PutInOrder(event, roles);
  return true;
}

Meant WithoutMap(const Label& label, const std::string& text, const Events& events) {
  Meant meant;
  meant.event = EventIn(text, events, meant.problem);
  if (!meant.event) {
    meant.hint = "say what your labels mean in a file: --map labels.yaml";
  } else {
    AddRoles(label, nullptr, nullptr, *FindEvent(events, meant.event->event), meant);
  }
  return meant;
}

Meant ByMap(const Label& label, const std::string& text, const LabelMap& map, const Events& events,
            Side side) {
  Meant meant;
  const Meaning* tier = nullptr;
  if (!map.tiers.empty() && (side == Side::kTruth || map.tiers.contains(label.tier))) {
    tier = Find(map.tiers, label.tier, "tier", meant);
    if (!tier || tier->ignored) return meant;
  }
  const Meaning* meaning = Find(map.labels, text, "label", meant);
  if (!meaning || meaning->ignored) return meant;
  meant.event = {.event = meaning->event, .roles = meaning->roles};
  meant.in_map = meaning->entities;
  if (tier) meant.in_map.insert(tier->entities.begin(), tier->entities.end());
  if (!AddRoles(label, &map, tier, *FindEvent(events, meaning->event), meant)) meant.event.reset();
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

/// Of all events of a map the roles that each label of it would have, in any tier, with those
/// columns and child tiers `filled` that are so of some label; with all, if there are no labels.
ComparedRoles Possible(const LabelMap& map, const Events& events,
                       const std::vector<LabelFile>& files, const std::set<std::string>& filled) {
  std::vector<Label> places(map.tiers.empty() ? 1 : 0);
  for (const auto& [name, tier] : map.tiers)
    if (!tier.ignored && tier.role.empty()) places.push_back({.tier = name});
  ComparedRoles possible;
  for (Label& label : places) {
    for (const LabelFile& file : files)
      for (const std::string& column : file.roles) label.roles.push_back({column, "?"});
    for (const auto& [_, tier] : map.tiers)
      if (!tier.role.empty() && tier.of == label.tier) label.roles.push_back({tier.role, "?"});
    std::erase_if(label.roles, [&](const grammar::Role& role) {
      return !filled.empty() && !filled.contains(role.name);
    });
    for (const auto& [text, _] : map.labels)
      if (const Meant meant = ByMap(label, text, map, events, Side::kTruth); meant.event)
        Compare(meant.event->event, meant.event->roles, possible);
  }
  return possible;
}

/// A warning of labels that are left out, or "".
std::string WithoutText(const LabelFile& file) {
  if (file.empty.empty()) return "";
  const Label& first = file.empty.front();
  grammar::Diagnostic warning =
      file.At(first.place,
              fmt::format("{} without text, and left out; the first {}at {:g} to {:g} s",
                          file.empty.size() == 1 ? "a label is"
                                                 : fmt::format("{} labels are", file.empty.size()),
                          first.tier.empty() ? "" : "of the tier '" + first.tier + "' ",
                          first.begin_s, first.end_s));
  warning.is_warning = true;
  return grammar::Format(warning);
}

/// Warnings of columns whose names are nearly those of roles, and of roles in lines of JSON that
/// the event does not have, or "".
std::string Misspelt(const LabelFile& file, const Events& events) {
  const std::set<std::string> roles = RolesOf(events);
  std::string warnings;
  for (const std::string& column : file.unread) {
    const std::string near = grammar::NearestName(column, {roles.begin(), roles.end()});
    if (near.empty() || near == column) continue;
    grammar::Diagnostic warning = file.At(
        {1, 1}, fmt::format("the column '{}' is not read", column), "did you mean '" + near + "'?");
    warning.is_warning = true;
    warnings += grammar::Format(warning);
  }
  std::map<std::pair<std::string, std::string>, std::size_t> unknown;  // event and role
  for (const Label& label : file.labels)
    for (const grammar::Role& role : label.roles) {
      const EventSignature* event = FindEvent(events, label.text);
      if (file.roles.empty() && event && std::ranges::count(event->roles, role.name) == 0)
        ++unknown[{label.text, role.name}];
    }
  for (const auto& [what, count] : unknown) {
    const auto& [event, role] = what;
    const std::vector<std::string>& known = FindEvent(events, event)->roles;
    const std::string near = grammar::NearestName(role, known);
    grammar::Diagnostic warning{
        .file = file.file,
        .message = fmt::format("'{}' has no role '{}': it is left out of {}", event, role,
                               grammar::CountOf(count, "line")),
        .hint = near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                             : "did you mean '" + near + "'?"};
    warning.is_warning = true;
    warnings += grammar::Format(warning);
  }
  return warnings;
}

const Meaning* TierOf(const Label& label, const LabelMap* map) {
  if (!map) return nullptr;
  const auto tier = map->tiers.find(label.tier);
  return tier == map->tiers.end() ? nullptr : &tier->second;
}

/// The labels of a take; those of tiers that are roles of others are in these, and a warning says
/// how many are not.
std::vector<Label> LabelsOf(const LabelFile& file, const TakeRows& take, const LabelMap* map,
                            Diagnostics& problems, std::string& warnings) {
  std::vector<Label> labels, children;
  for (const std::size_t index : take.labels) {
    const Label& label = file.labels[index];
    const Meaning* tier = TierOf(label, map);
    (tier && !tier->role.empty() ? children : labels).push_back(label);
  }
  std::vector<const Label*> left_out;
  for (const Label& child : children) {
    const Meaning& tier = *TierOf(child, map);
    const double middle_s = (child.begin_s + child.end_s) / 2;
    const auto parent = std::ranges::find_if(labels, [&](const Label& label) {
      return label.tier == tier.of && label.begin_s <= middle_s && middle_s <= label.end_s;
    });
    if (parent == labels.end()) {
      if (problems.size() < kMostComplaints)
        problems.push_back(file.At(child.place, fmt::format("the tier '{}' has no label here whose "
                                                            "{} '{}' could be",
                                                            tier.of, tier.role, child.text)));
      continue;
    }
    const std::string value(Trimmed(child.text));
    const auto role = std::ranges::find(parent->roles, tier.role, &grammar::Role::name);
    if (role == parent->roles.end())
      parent->roles.push_back({tier.role, value});
    else if (role->value != value)
      left_out.push_back(&child);
  }
  if (!left_out.empty()) {
    const Meaning& tier = *TierOf(*left_out.front(), map);
    grammar::Diagnostic warning =
        file.At(left_out.front()->place,
                fmt::format("{} left out: a label of '{}' has one {}, and the first counts",
                            left_out.size() == 1
                                ? fmt::format("'{}' is", left_out.front()->text)
                                : fmt::format("{} labels of child tiers are", left_out.size()),
                            tier.of, tier.role));
    warning.is_warning = true;
    warnings += grammar::Format(warning);
  }
  return labels;
}

}  // namespace

Result<LabelReading> LabelReading::Of(std::vector<LabelFile> files, const LabelMap* map,
                                      const Events& events) {
  std::vector<TakeRows> takes;
  for (std::size_t i = 0; i < files.size(); ++i) {
    TakeRows& take = takes.emplace_back(TakeRows{.file = i, .offset_s = map ? map->offset_s : 0});
    for (std::size_t k = 0; k < files[i].labels.size(); ++k) take.labels.push_back(k);
  }
  return Of(std::move(files), map, events, std::move(takes));
}

Result<LabelReading> LabelReading::Of(std::vector<LabelFile> files, const LabelMap* map,
                                      const Events& events, std::vector<TakeRows> takes,
                                      Side side) {
  LabelReading reading;
  if (map) {
    reading.join_s_ = map->join_s;
    reading.collars_s_ = map->collars_s;
    reading.map_ = map->document;
  }
  Diagnostics problems;
  std::set<std::string> complained;
  reading.counted_.takes = takes.size();
  for (const TakeRows& take : takes) {
    const LabelFile& file = files[take.file];
    std::vector<LabelledEvent>& of_take = reading.events_.emplace_back();
    for (const Label& label : LabelsOf(file, take, map, problems, reading.warnings_)) {
      const std::string text(Trimmed(label.text));
      const bool in_map = map && map->labels.contains(text);
      const Meaning* tier = side == Side::kFound && map && !in_map ? TierOf(label, map) : nullptr;
      if ((tier && tier->ignored) ||
          (text == "background" && !in_map && !FindEvent(events, text))) {
        ++reading.counted_.ignored[text];
        continue;
      }
      Meant meant = map && (in_map || side == Side::kTruth) ? ByMap(label, text, *map, events, side)
                                                            : WithoutMap(label, text, events);
      if (tier && meant.event &&
          !AddRoles(label, map, tier, *FindEvent(events, meant.event->event), meant))
        meant.event.reset();
      const bool is_problem = !meant.problem.empty();
      if (is_problem && problems.size() < kMostComplaints &&
          complained.insert(meant.problem).second)
        problems.push_back(file.At(label.place, std::move(meant.problem), std::move(meant.hint)));
      if (!meant.event && !is_problem) ++reading.counted_.ignored[text];
      if (!meant.event) continue;
      if (std::isnan(label.begin_s)) {
        Compare(meant.event->event, meant.event->roles, reading.compared_);
        continue;
      }
      ++(label.IsMoment() ? reading.counted_.moments : reading.counted_.labels);
      Compare(meant.event->event, meant.event->roles, reading.compared_);
      of_take.push_back({label.begin_s + take.offset_s, label.end_s + take.offset_s,
                         std::move(*meant.event), label.place, std::move(meant.in_map),
                         label.decided_s});
    }
    reading.WarnOfOverlaps(file, of_take);
  }
  for (const LabelFile& file : files) {
    if (file.backward > 0) reading.counted_.backward[file.file] = file.backward;
    reading.warnings_ +=
        grammar::Format(file.warnings) + WithoutText(file) + Misspelt(file, events);
    reading.counted_.without_text += file.empty.size();
    for (const std::string& column : file.unread) ++reading.counted_.unread[column];
  }
  // What labels could name: without one of them, what is recognised of it is too much. Where no
  // label is and no map, that is all.
  if (map) {
    std::set<std::string> filled;
    for (const auto& of_take : reading.events_)
      for (const LabelledEvent& one : of_take)
        for (const grammar::Role& role : one.event.roles) filled.insert(role.name);
    ComparedRoles possible = Possible(*map, events, files, filled);
    reading.compared_.merge(possible);
  } else if (reading.compared_.empty()) {
    for (const EventSignature& event : events) reading.compared_[event.name] = event.roles;
  }
  // Of a symmetric event one role alone says nothing.
  for (auto& [name, roles] : reading.compared_) {
    const EventSignature& event = *FindEvent(events, name);
    if (event.symmetric && roles.size() == 1) roles.clear();
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  for (const auto& [name, _] : reading.compared_)
    reading.signatures_.emplace(name, *FindEvent(events, name));
  reading.hands_ = truth::HandRolesOf(events);
  reading.files_ = std::move(files);
  reading.takes_ = std::move(takes);
  return reading;
}

std::optional<double> LabelReading::offset_s() const {
  for (const TakeRows& take : takes_)
    if (take.offset_s != takes_.front().offset_s) return std::nullopt;
  return takes_.front().offset_s;
}

void LabelReading::WarnOfOverlaps(const LabelFile& file, const std::vector<LabelledEvent>& events) {
  constexpr double kRounding_s = 1e-3;
  if (join_s_ > 0) return;  // they are to become one
  std::map<std::string, std::vector<const LabelledEvent*>> by_label;
  for (const LabelledEvent& event : events) by_label[event.event.Label()].push_back(&event);
  std::size_t count = 0;
  const LabelledEvent* first = nullptr;
  for (auto& [label, same] : by_label) {
    std::ranges::sort(same, {}, &LabelledEvent::begin_s);
    double end_s = -1e300;
    for (const LabelledEvent* one : same) {
      if (!one->IsMoment() && one->begin_s < end_s - kRounding_s && ++count == 1) first = one;
      end_s = std::max(end_s, one->end_s);
    }
  }
  if (count == 0) return;
  grammar::Diagnostic warning =
      file.At(first->place,
              fmt::format("{} another one of the same event and roles, and {} one with it",
                          count == 1 ? "a label overlaps" : fmt::format("{} labels overlap", count),
                          count == 1 ? "is" : "are"),
              "did two people mark them? rows: {COLUMN: NAME} in a file of takes tells them apart");
  warning.is_warning = true;
  warnings_ += grammar::Format(warning);
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

Diagnostics LabelReading::Problems(std::size_t take,
                                   const std::vector<grammar::EntityInfo>& entities,
                                   double end_s) const {
  const LabelFile& labels = files_[takes_[take].file];
  Diagnostics problems;
  for (const LabelledEvent& label : events_[take]) {
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
    const bool is_outside = label.IsMoment() ? label.end_s < 0 || label.begin_s > end_s
                                             : label.end_s <= 0 || label.begin_s >= end_s;
    if (is_outside || label.begin_s < -kMostBeyondEnd_s || label.end_s > end_s + kMostBeyondEnd_s) {
      problems.push_back(labels.At(
          label.place,
          fmt::format("the label lies at {:g} to {:g} s, the recording ends after {:g} s",
                      label.begin_s, label.end_s, end_s),
          std::abs(label.begin_s) < kDates_s
              ? "is it of another recording, in another unit, or by another clock? offset_s in the "
                "map moves all labels"
              : "is it a time of day? When did the recording begin? In the map or in a file of "
                "takes: starts_at: 2026-10-25T01:59:50"));
    }
  }
  return problems;
}

Result<grammar::Timeline> LabelReading::Truth(std::size_t take,
                                              const std::vector<grammar::EntityInfo>& entities,
                                              grammar::Tick ticks_per_second,
                                              grammar::Tick end) const {
  Diagnostics problems = Problems(take, entities, truth::SecondsOf(end, ticks_per_second));
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return Marked(take, ticks_per_second, end, false);
}

Result<grammar::Timeline> LabelReading::Found(std::size_t take,
                                              const std::vector<grammar::EntityInfo>& entities,
                                              grammar::Tick ticks_per_second, grammar::Tick end,
                                              const ComparedRoles& compared) const {
  Diagnostics problems = Problems(take, entities, truth::SecondsOf(end, ticks_per_second));
  grammar::Timeline found{.ticks_per_second = ticks_per_second};
  for (const LabelledEvent& label : events_[take]) {
    if (problems.size() >= kMostComplaints) break;
    const LabelFile& file = files_[takes_[take].file];
    if (label.IsMoment())
      problems.push_back(file.At(label.place, "what is found has a begin and a later end"));
    const auto roles = compared.find(label.event.event);
    if (roles == compared.end()) {
      found.events.push_back(InTicks(label, ticks_per_second, end));
      continue;
    }
    for (const std::string& role : roles->second)
      if (std::ranges::count(label.event.roles, role, &grammar::Role::name) == 0)
        problems.push_back(
            file.At(label.place,
                    fmt::format("'{}' says no {}, and what is true does", label.event.event, role),
                    fmt::format("{}({}), or the roles in columns, in the map or in \"roles\"",
                                label.event.event,
                                fmt::join(signatures_.at(label.event.event).roles, ", "))));
    found.events.push_back(InTicks(label, ticks_per_second, end));
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  Sort(found);
  return found;
}

grammar::NamedEvent LabelReading::InTicks(const LabelledEvent& label,
                                          grammar::Tick ticks_per_second, grammar::Tick end) const {
  grammar::NamedEvent event = label.event;
  event.interval.begin =
      std::clamp<grammar::Tick>(truth::TickAt(label.begin_s, ticks_per_second), 0, end - 1);
  event.interval.end = std::clamp<grammar::Tick>(truth::TickAt(label.end_s, ticks_per_second),
                                                 event.interval.begin + 1, end);
  event.decided = label.decided_s ? truth::TickAt(*label.decided_s, ticks_per_second) : -1;
  return event;
}

grammar::Timeline LabelReading::Marked(std::size_t take, grammar::Tick ticks_per_second,
                                       grammar::Tick end, bool moments) const {
  grammar::Timeline marked{.ticks_per_second = ticks_per_second};
  for (const LabelledEvent& label : events_[take])
    if (moments || !label.IsMoment())
      marked.events.push_back(InTicks(label, ticks_per_second, end));
  return Compared(marked, compared_, truth::TickAt(join_s_, ticks_per_second));
}

std::size_t LabelReading::Cut(std::size_t take, double end_s) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(events_[take], [&](const LabelledEvent& label) {
        return label.begin_s < -kNoCut_s || label.end_s > end_s + kNoCut_s;
      }));
}

std::pair<double, double> LabelReading::SpanOf(std::size_t take) const {
  std::pair<double, double> span;
  for (const LabelledEvent& label : events_[take])
    span = {std::min(span.first, label.begin_s), std::max(span.second, label.end_s)};
  return span;
}

void LabelReading::Move(std::size_t take, double by_s) {
  for (LabelledEvent& label : events_[take]) {
    label.begin_s += by_s;
    label.end_s += by_s;
    if (label.decided_s) *label.decided_s += by_s;
  }
}

}  // namespace prehend::exchange
