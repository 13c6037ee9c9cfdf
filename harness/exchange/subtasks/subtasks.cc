// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/subtasks/subtasks.h. Tested by tests/program/labels_back.py
#include "harness/exchange/subtasks/subtasks.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/contents.h"
#include "harness/base/yaml/diagnostic_list.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

constexpr double kSettles_s = 0.5;  ///< what a label requires may begin so much later

std::string EventIn(const std::string& label) { return label.substr(0, label.find('(')); }

bool Fits(const grammar::NamedEvent& event, const SubtaskLabel& label) {
  const auto is = [&](const char* role, const std::optional<Located<std::string>>& wanted) {
    return !wanted || truth::RoleValue(event, role) == wanted->value;
  };
  return event.event == label.of.value && is("hand", label.hand) && is("object", label.object) &&
         !(label.at_end && event.open_end);
}

/// Whether the event that a label requires holds at a tick, or soon.
bool Holds(const SubtaskLabel& label, const Motion& motion, grammar::Tick tick) {
  if (!label.required) return true;
  const auto soon = static_cast<grammar::Tick>(
      kSettles_s * static_cast<double>(motion.timeline.ticks_per_second));
  std::string wanted = label.required->value;
  std::erase(wanted, ' ');
  return std::ranges::any_of(motion.timeline.events, [&](const grammar::NamedEvent& event) {
    std::string found = event.Label();
    std::erase(found, ' ');
    return found == wanted && event.interval.begin <= tick + soon && event.interval.end > tick;
  });
}

/// The first such boundary after `after`; -1: there is none.
grammar::Tick BoundaryOf(const SubtaskLabel& label, const Motion& motion, grammar::Tick after) {
  grammar::Tick first = -1;
  for (const grammar::NamedEvent& event : motion.timeline.events) {
    const grammar::Tick tick = label.at_end ? event.interval.end : event.interval.begin;
    if (tick > after && (first < 0 || tick < first) && Fits(event, label) &&
        Holds(label, motion, tick))
      first = tick;
  }
  return first;
}

std::string TextOf(const ImportMap& map, const std::string& name) {
  const auto text = std::ranges::find(map.text, name, &Named<std::string>::name);
  return text == map.text.end() ? "" : text->value;
}

std::string WhatIsMissing(const SubtaskLabel& label) {
  std::string text = fmt::format("no {} of {}", label.at_end ? "end" : "begin", label.of.value);
  for (const auto& role : {label.hand, label.object}) {
    if (role) text += " " + role->value;
  }
  return text + (label.required ? " with " + label.required->value : "");
}

}  // namespace

grammar::Diagnostics WrongInLabels(const MapFile& map, const grammar::Program& program) {
  DiagnosticList errors(map.document);
  const std::vector<std::string> events = EventNames(program);
  std::vector<std::string> entities;
  for (const Named<MappedEntity>& entity : map.map.entities) entities.push_back(entity.name);
  const auto look = [&](const Located<std::string>& name, const std::string& text,
                        const std::vector<std::string>& known, const std::string& what) {
    if (std::ranges::find(known, text) == known.end())
      errors.AddUnknownName(name.where, fmt::format("{} '{}'", what, text), text, known);
  };
  const std::string no_event = "grammar '" + GrammarName(program) + "' has no event";
  for (const Named<SubtaskLabel>& label : map.map.labels) {
    look(label.value.of, label.value.of.value, events, no_event);
    if (label.value.required)
      look(*label.value.required, EventIn(label.value.required->value), events, no_event);
    for (const auto& role : {label.value.hand, label.value.object}) {
      if (role) look(*role, role->value, entities, "the map has no entity");
    }
  }
  if (map.map.labels.empty())
    errors.Add({}, "the map has no 'labels'", "labels: {grasp: {at: begin, of: grasping}}");
  return errors.Sorted();
}

Subtasks FindSubtasks(const ImportMap& map, const Motion& motion) {
  Subtasks found{.episode = motion.header.episode,
                 .ticks_per_second = motion.table().ticks_per_second};
  motion.EachFrame([&](const grammar::Frame& frame) { found.ticks.push_back(frame.tick); });
  Subtask next;
  const auto end_at = [&](std::size_t frame, grammar::Tick tick) {
    next.end = frame;
    next.end_tick = tick;
    next.text = TextOf(map, next.name);
    found.all.push_back(next);
    next.begin = frame;
    next.begin_tick = tick;
  };
  for (const Named<SubtaskLabel>& label : map.labels) {
    const grammar::Tick tick =
        BoundaryOf(label.value, motion, found.all.empty() ? -1 : next.begin_tick);
    const auto frame = std::ranges::lower_bound(found.ticks, tick);
    next.name = label.name;
    if (tick < 0 || frame == found.ticks.end())
      found.missing = label.name + ": " + WhatIsMissing(label.value);
    else if (frame - found.ticks.begin() == static_cast<std::ptrdiff_t>(next.begin))
      found.missing = label.name + (found.all.empty() ? " would be true in the first frame"
                                                      : " is in the frame of the one before it");
    if (!found.missing.empty()) {
      found.all.clear();
      return found;
    }
    end_at(static_cast<std::size_t>(frame - found.ticks.begin()), *frame);
  }
  next.name = "rest";
  end_at(found.ticks.size(), motion.end_tick);
  return found;
}

}  // namespace prehend::exchange
