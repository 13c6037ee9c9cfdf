// SPDX-License-Identifier: Apache-2.0
// See grammar/watch_drawing.h
#include "grammar/watch_drawing.h"

#include <algorithm>

#include "grammar/check_laws.h"
#include "grammar/contents.h"
#include "grammar/monitor.h"
#include "grammar/name_events.h"

namespace prehend::grammar {
namespace {

constexpr std::string_view kViolated = "violated ";

EntityTable CastOf(const DrawnEpisode& drawn) {
  return {
      .ticks_per_second = kDrawnTicksPerSecond, .entities = drawn.entity_table, .styles = {"wrap"}};
}

std::string DidYouMean(const std::string& name, const std::vector<std::string>& known) {
  const std::string near = NearestName(name, known);
  return near.empty() ? "" : "did you mean '" + near + "'?";
}

// "hand, cup" -> hand; cup
std::vector<std::string> SplitRoles(const std::string& text) {
  std::vector<std::string> roles(1);
  for (const char c : text) {
    if (c == ',') {
      roles.emplace_back();
    } else if (c != ' ') {
      roles.back() += c;
    }
  }
  return roles;
}

}  // namespace

WatchedDrawing WatchDrawing(const std::shared_ptr<const Program>& program,
                            const DrawnEpisode& drawn, int frames_per_second) {
  const EntityTable entity_table = CastOf(drawn);
  Monitor monitor(program, entity_table);
  DrawnFrames frames(drawn);
  std::vector<Event> events;
  int index = 0;
  for (Tick tick = 0; tick < drawn.end(); tick += frames.StepAfter(index++, frames_per_second))
    monitor.Advance(frames.At(tick), events);
  monitor.Finish(drawn.end(), events);
  return {monitor.error(), NameEvents(*program, entity_table, events)};
}

std::vector<DrawnRow> DrawWatched(const Program& program, const DrawnEpisode& drawn,
                                  const Timeline& timeline) {
  std::vector<std::string> background;
  for (const EventSignature& event : EventSignatures(program)) {
    if (event.drawing.as == DrawnAs::kSupport || event.drawing.as == DrawnAs::kNothing)
      background.push_back(event.name);
  }
  std::vector<DrawnRow> rows = DrawEvents(drawn, timeline, background);
  Timeline violations{.ticks_per_second = kDrawnTicksPerSecond};
  for (const LawViolation& violation : CheckLaws(program, CastOf(drawn), timeline)) {
    violations.events.push_back(
        {.event = std::string(kViolated) + violation.law->name, .interval = violation.when});
  }
  for (DrawnRow& row : DrawEvents(drawn, violations, {})) {
    row.name.resize(row.name.size() - 2);  // it has no roles: "()"
    rows.push_back(std::move(row));
  }
  return rows;
}

Diagnostics CheckExpected(const Program& program, const DrawnEpisode& drawn,
                          const GrammarText& file) {
  Diagnostics diagnostics;
  std::vector<std::string> laws, names;
  for (const Law& law : program.laws) laws.push_back(law.name);
  for (const EntityInfo& entity : drawn.entity_table) names.push_back(entity.name);
  const std::vector<EventSignature> events = EventSignatures(program);
  for (const DrawnRow& row : drawn.expected) {
    const auto complain = [&](std::string message, std::string hint) {
      diagnostics.push_back(
          DiagnosticAt(file.file, file.text, {row.line, 1}, std::move(message), std::move(hint)));
    };
    if (row.name.starts_with(kViolated)) {
      const std::string law = row.name.substr(kViolated.size());
      if (std::ranges::find(laws, law) == laws.end())
        complain("grammar '" + program.name + "' has no law '" + law + "'", DidYouMean(law, laws));
      continue;
    }
    const std::size_t bracket = row.name.find('(');
    const std::string name = row.name.substr(0, bracket);
    const auto event = std::ranges::find(events, name, &EventSignature::name);
    if (event == events.end()) {
      complain("grammar '" + program.name + "' has no event '" + name + "'",
               DidYouMean(name, EventNames(program)));
      continue;
    }
    if (bracket == std::string::npos || row.name.back() != ')') {
      complain("expected an event with its roles, found '" + row.name + "'",
               "for example: grasping(hand, cup)");
      continue;
    }
    const std::vector<std::string> roles =
        SplitRoles(row.name.substr(bracket + 1, row.name.size() - bracket - 2));
    if (roles.size() != event->roles.size()) {
      complain("'" + name + "' has " + std::to_string(event->roles.size()) + " roles, found " +
                   std::to_string(roles.size()),
               "");
    }
    for (const std::string& role : roles) {
      if (std::ranges::find(names, role) == names.end())
        complain("nobody is called '" + role + "'", DidYouMean(role, names));
    }
  }
  return diagnostics;
}

}  // namespace prehend::grammar
