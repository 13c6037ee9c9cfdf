// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/timeline/event_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace prehend::truth {
namespace {

// Told apart by people who are colour-blind: M. Okabe and K. Ito, "Color universal design", 2008;
// after these six, what is far from them of P. Tol, "Colour schemes", 2021.
constexpr std::array<std::uint32_t, 13> kPalette = {
    0x0072B2, 0xE69F00, 0x009E73, 0xCC79A7, 0x56B4E9, 0xD55E00, 0x332288,
    0x117733, 0x999933, 0xCC6677, 0x882255, 0xAA4499, 0xDDCC77};

/// Gives each event a colour of its own, as far as there are so many.
class Colors {
 public:
  explicit Colors(const std::vector<grammar::EventSignature>& events) {
    for (const grammar::EventSignature& event : events)
      if (event.drawing.color) wanted_.insert(*event.drawing.color);
  }

  std::uint32_t Of(const grammar::EventSignature& event) {
    const auto& own = event.drawing.color;
    if (own && given_.insert(*own).second) return *own;
    for (std::size_t i = 0; i < kPalette.size(); ++i) {
      const std::uint32_t color = kPalette[next_++ % kPalette.size()];
      if (!wanted_.contains(color) && given_.insert(color).second) return color;
    }
    return own ? *own : kPalette[next_++ % kPalette.size()];
  }

 private:
  std::set<std::uint32_t> wanted_, given_;
  std::size_t next_ = 0;
};

/// Line ends and tabs of a cell, as JSON writes them.
void KeepInItsRow(std::string& cell) {
  for (const auto& [end, written] : {std::pair('\n', "\\n"), {'\r', "\\r"}, {'\t', "\\t"}})
    for (std::size_t at = 0; (at = cell.find(end, at)) != cell.npos; ++at)
      cell.replace(at, 1, written);
}

EventDrawing DrawingOf(const grammar::EventSignature& event, std::uint32_t color) {
  EventDrawing drawing{.as = event.drawing.as, .color = color, .ghost = event.drawing.ghost};
  const auto hand = std::ranges::find(event.classes, "Hand");
  drawing.hand = static_cast<std::size_t>(hand - event.classes.begin());
  const bool holds = drawing.as == grammar::DrawnAs::kGrasp;
  drawing.first = holds && drawing.hand == 0 ? 1 : 0;
  drawing.last = 1;
  return drawing;
}

}  // namespace

using grammar::NamedEvent;
using grammar::Role;
using grammar::Tick;

std::string SecondsText(Tick tick, Tick ticks_per_second) {
  // Half a unit of the last decimal must stay below half a tick: 10^decimals > ticks_per_second.
  const int decimals = std::max<int>(4, static_cast<int>(std::to_string(ticks_per_second).size()));
  return fmt::format("{:.{}f}", SecondsOf(tick, ticks_per_second), decimals);
}

Tick TickAt(double seconds, Tick ticks_per_second) {
  return std::llround(seconds * static_cast<double>(ticks_per_second));
}

std::string IntervalText(grammar::Interval interval, Tick ticks_per_second) {
  return fmt::format("{}..{} s", SecondsText(interval.begin, ticks_per_second),
                     SecondsText(interval.end, ticks_per_second));
}

double MillisecondsOf(double ticks, Tick ticks_per_second) {
  return 1000.0 * (ticks / static_cast<double>(ticks_per_second));
}

std::string ValueText(const grammar::NamedValue& value) {
  return fmt::format("{:.4g}{}{}", value.value, value.unit.empty() ? "" : " ", value.unit);
}

bool IsAttribute(const Role& role) { return role.name == "style"; }

std::string RoleText(const NamedEvent& event, std::size_t column) {
  if (column >= event.roles.size()) return "";
  return event.roles[column].name + "=" + event.roles[column].value;
}

const std::string& RoleValue(const NamedEvent& event, std::string_view role) {
  static const std::string kNone;
  const auto found = std::find_if(event.roles.begin(), event.roles.end(),
                                  [&](const Role& candidate) { return candidate.name == role; });
  return found == event.roles.end() ? kNone : found->value;
}

HandRoles HandRolesOf(const std::vector<grammar::EventSignature>& events) {
  HandRoles roles;
  for (const grammar::EventSignature& event : events) {
    const auto hand = std::ranges::find(event.classes, "Hand");
    const bool is_one = std::ranges::count(event.classes, "Hand") == 1;
    roles[event.name] = is_one ? event.roles[hand - event.classes.begin()] : "";
  }
  return roles;
}

const std::string& HandOf(const NamedEvent& event, const HandRoles& roles) {
  const auto role = roles.find(event.event.substr(0, event.event.find(" of ")));
  return RoleValue(event, role == roles.end() ? "hand" : role->second);
}

std::string NameByHand(const NamedEvent& event, const HandRoles& roles) {
  const std::string& hand = HandOf(event, roles);
  return hand.empty() ? event.event : event.event + " of " + hand;
}

std::string AlignColumns(const std::vector<std::vector<std::string>>& cells, Numbers numbers) {
  std::vector<std::vector<std::string>> rows = cells;
  for (auto& row : rows) std::ranges::for_each(row, KeepInItsRow);
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t column = 0; column < row.size(); ++column)
      widths[column] = std::max(widths[column], row[column].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      const bool right = numbers == Numbers::kRight && column > 0;
      text +=
          fmt::format(fmt::runtime(right ? "{:>{}}  " : "{:<{}}  "), row[column], widths[column]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

std::vector<std::string> EventCells(const NamedEvent& event, Tick ticks_per_second,
                                    std::size_t role_columns) {
  std::vector<std::string> cells = {event.event,
                                    SecondsText(event.interval.begin, ticks_per_second),
                                    SecondsText(event.interval.end, ticks_per_second)};
  for (std::size_t column = 0; column < role_columns; ++column) {
    cells.push_back(RoleText(event, column));
  }
  cells.push_back(event.open_end ? "open_end" : "");
  return cells;
}

using Json = nlohmann::ordered_json;

Json EventJson(const grammar::NamedEvent& event, grammar::Tick ticks_per_second) {
  const auto seconds = [&](grammar::Tick tick) { return SecondsOf(tick, ticks_per_second); };
  Json roles = Json::object(), attributes = Json::object();
  for (const grammar::Role& role : event.roles)
    (IsAttribute(role) ? attributes : roles)[role.name] = role.value;
  for (const grammar::NamedValue& value : event.values) attributes[value.name] = value.value;
  return {{"event", event.event},
          {"roles", std::move(roles)},
          {"attributes", std::move(attributes)},
          {"begin_tick", event.interval.begin},
          {"end_tick", event.interval.end},
          {"begin_s", seconds(event.interval.begin)},
          {"end_s", seconds(event.interval.end)},
          {"decided_tick", event.decided},
          {"open_end", event.open_end}};
}

Json TimelineJson(const grammar::Timeline& timeline) {
  Json events = Json::array();
  for (const grammar::NamedEvent& event : timeline.events)
    events.push_back(EventJson(event, timeline.ticks_per_second));
  return {{"ticks_per_second", timeline.ticks_per_second}, {"events", std::move(events)}};
}

EventDrawings::EventDrawings(const grammar::Program& program) {
  const std::vector<grammar::EventSignature> events = EventSignatures(program);
  Colors colors(events);
  for (const grammar::EventSignature& event : events)
    drawings_[event.name] = DrawingOf(event, colors.Of(event));
  for (auto& [name, drawing] : drawings_) drawing.regions = grammar::RegionsOf(program, name);
}

const EventDrawing& EventDrawings::Of(std::string_view event) const {
  static const EventDrawing kUnknown;
  const auto found = drawings_.find(event);
  return found == drawings_.end() ? kUnknown : found->second;
}

}  // namespace prehend::truth
