// SPDX-License-Identifier: Apache-2.0
#include "grammar/watch_drawing.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "grammar/base/diagnostic.h"
#include "grammar/check_laws.h"
#include "grammar/contents.h"
#include "grammar/drawing/drawn_episode.h"
#include "grammar/monitor.h"
#include "grammar/name_events.h"

namespace prehend::grammar {
namespace {

constexpr std::string_view kViolated = "violated ";

EntityTable CastOf(const DrawnEpisode& drawn) {
  return {
      .ticks_per_second = kDrawnTicksPerSecond, .entities = drawn.entity_table, .styles = {"wrap"}};
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

/// What keeps an expected event from ever being recognised.
class ExpectedEvent {
 public:
  /// `label` is "grasping(hand, cup)".
  ExpectedEvent(const EventSignature& event, const DrawnEpisode& drawn, const std::string& label)
      : event_(event), entities_(drawn.entity_table) {
    const std::size_t open = label.find('(');
    roles_ = SplitRoles(label.substr(open + 1, label.size() - open - 2));
  }

  using Complain = std::function<void(std::string message, std::string hint)>;
  void Check(const Complain& complain) const {
    if (roles_.size() != event_.roles.size()) {
      return complain("'" + event_.name + "' has " + CountOf(event_.roles.size(), "role") +
                          ", found " + std::to_string(roles_.size()),
                      "");
    }
    std::vector<std::string> names;
    for (const EntityInfo& entity : entities_) names.push_back(entity.name);
    bool are_there = true;
    for (const std::string& role : roles_) {
      if (std::ranges::find(names, role) != names.end()) continue;
      complain("nobody is called '" + role + "'", DidYouMean(role, names));
      are_there = false;
    }
    if (!are_there) return;
    for (std::size_t i = 0; i < roles_.size(); ++i) {
      if (std::ranges::count(roles_, roles_[i]) > 1)
        return complain("'" + roles_[i] + "' cannot have two roles of '" + event_.name + "'", "");
      if (Takes(i, roles_[i])) continue;
      return complain("'" + roles_[i] + "' is never '" + event_.roles[i] + "' of '" + event_.name +
                          "', which takes " + WithArticle(event_.classes[i]),
                      Remedy(i));
    }
    if (event_.symmetric && roles_[0] > roles_[1])
      complain("the first two roles of '" + event_.name + "' stand in alphabetical order",
               "did you mean '" + Exchanged(0, 1) + "'?");
  }

 private:
  bool Takes(std::size_t role, const std::string& name) const {
    return std::ranges::count(ClassesOf(name), event_.classes[role]) > 0;
  }
  const std::vector<std::string>& ClassesOf(const std::string& name) const {
    return std::ranges::find(entities_, name, &EntityInfo::name)->classes;
  }
  std::string Exchanged(std::size_t one, std::size_t other) const {
    std::vector<std::string> roles = roles_;
    std::swap(roles[one], roles[other]);
    std::string label = event_.name + "(";
    for (const std::string& role : roles) label += (&role == &roles.front() ? "" : ", ") + role;
    return label + ")";
  }
  std::string Remedy(std::size_t role) const {
    for (std::size_t other = 0; other < roles_.size(); ++other) {
      if (other != role && Takes(role, roles_[other]) && Takes(other, roles_[role]))
        return "did you mean '" + Exchanged(role, other) + "'?";
    }
    std::string who;
    for (const EntityInfo& entity : entities_) {
      if (Takes(role, entity.name)) who += (who.empty() ? "" : ", ") + entity.name;
    }
    if (!who.empty()) return "that can be " + who;
    // The one has a class of one's own without the usual one, or the usual one only.
    const std::string &is = ClassesOf(roles_[role]).front(), &wanted = event_.classes[role];
    if (IsRootClass(is) && IsRootClass(wanted)) return "the drawing has none";
    std::string both = is + ":is=" + wanted;
    if (IsRootClass(wanted)) both = (wanted == "Thing" ? "Movable" : wanted) + ":is=" + is;
    return "the drawing has none; an entity may be of several classes: " + roles_[role] + ":" +
           both;
  }

  const EventSignature& event_;
  const std::vector<EntityInfo>& entities_;
  std::vector<std::string> roles_;
};

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
  std::vector<std::string> laws;
  std::map<std::string, int> lines;  // of the rows so far
  for (const Law& law : program.laws) laws.push_back(law.name);
  const std::vector<EventSignature> events = EventSignatures(program);
  for (const DrawnRow& row : drawn.expected) {
    const auto complain = [&](std::string message, std::string hint) {
      diagnostics.push_back(
          DiagnosticAt(file.file, file.text, {row.line, 1}, std::move(message), std::move(hint)));
    };
    const auto [first, is_new] = lines.try_emplace(row.name, row.line);
    if (!is_new) {
      complain("'" + row.name + "' is drawn in line " + std::to_string(first->second) + " already",
               "all its intervals stand in one row");
    }
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
    ExpectedEvent(*event, drawn, row.name).Check(complain);
  }
  return diagnostics;
}

}  // namespace prehend::grammar
