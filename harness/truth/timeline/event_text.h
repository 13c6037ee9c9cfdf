// SPDX-License-Identifier: Apache-2.0
// How events are written for people: seconds, intervals, roles. Goldens, tables, differences and
// reports share it. Events as JSON, as `prehend run --json` prints them. Tested by
// tests/harness/truth/golden/golden_test.cc and tests/harness/episode/run/run_text_test.cc
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/contents.h"

namespace prehend::truth {

/// An event has at most so many roles, and at most so many values, wherever it is read.
inline constexpr std::size_t kMostRoles = 8;

/// Seconds with at least 4 decimals, and as many as it takes for TickAt() to find the same tick
/// again.
std::string SecondsText(grammar::Tick tick, grammar::Tick ticks_per_second);

/// The tick nearest to a time.
grammar::Tick TickAt(double seconds, grammar::Tick ticks_per_second);

/// "1.2000..1.8125 s"
std::string IntervalText(grammar::Interval interval, grammar::Tick ticks_per_second);

/// In milliseconds.
double MillisecondsOf(double ticks, grammar::Tick ticks_per_second);

/// "12.5 N", "0.3"
std::string ValueText(const grammar::NamedValue& value);

/// True for what qualifies an event (the grasp's style) instead of saying who takes part.
bool IsAttribute(const grammar::Role& role);

/// "hand=right_hand", or "" when the event has no such column.
std::string RoleText(const grammar::NamedEvent& event, std::size_t column);

/// The value of a role or attribute, or "".
const std::string& RoleValue(const grammar::NamedEvent& event, std::string_view role);

/// By event the role of the one hand that it is of, as its class says; "" if there is none.
using HandRoles = std::map<std::string, std::string>;
HandRoles HandRolesOf(const std::vector<grammar::EventSignature>& events);

/// The hand that an event is of, or "". Of events that are not in `roles`: their role "hand".
const std::string& HandOf(const grammar::NamedEvent& event, const HandRoles& roles);
/// "EVENT of HAND", or without a hand "EVENT".
std::string NameByHand(const grammar::NamedEvent& event, const HandRoles& roles);

inline double SecondsOf(grammar::Tick tick, grammar::Tick ticks_per_second) {
  return static_cast<double>(tick) / static_cast<double>(ticks_per_second);
}

/// Rows of cells as lines with aligned columns, two blanks apart, no trailing blanks. Where numbers
/// are to the right, the first column is not.
enum class Numbers { kLeft, kRight };
std::string AlignColumns(const std::vector<std::vector<std::string>>& rows,
                         Numbers numbers = Numbers::kLeft);

/// Event, begin, end, roles, and "open_end" as cells of a table row.
std::vector<std::string> EventCells(const grammar::NamedEvent& event,
                                    grammar::Tick ticks_per_second, std::size_t role_columns);

/// {"event", "roles": {..}, "attributes": {..}, "begin_tick", "end_tick", "begin_s", "end_s",
/// "decided_tick", "open_end"}; attributes are words (style) or numbers in SI units.
nlohmann::ordered_json EventJson(const grammar::NamedEvent& event, grammar::Tick ticks_per_second);

/// {"ticks_per_second", "events": [..]}
nlohmann::ordered_json TimelineJson(const grammar::Timeline& timeline);

// How the events of a grammar are drawn in pictures and reports: what its `drawn` clauses say, and
// a colour of a palette for each event that names none. Tested by
// tests/harness/truth/timeline/event_drawings_test.cc

struct EventDrawing {
  grammar::DrawnAs as = grammar::DrawnAs::kRow;
  std::uint32_t color = 0x7A828C;  ///< 0xRRGGBB
  grammar::Ghost ghost = grammar::Ghost::kAtBegin;
  std::size_t hand = 0;   ///< of a phase or grasp: which role is the hand
  std::size_t first = 0;  ///< of a grasp: which role is held; of a support: which one stands
  std::size_t last = 0;   ///< of a support: on which one it stands
  std::vector<grammar::RegionOfInterest> regions = {};  ///< that its rule asks about
};

class EventDrawings {
 public:
  using ByEvent = std::map<std::string, EventDrawing, std::less<>>;

  EventDrawings() = default;  ///< no event is known
  explicit EventDrawings(ByEvent drawings) : drawings_(std::move(drawings)) {}
  explicit EventDrawings(const grammar::Program& program);

  /// Of an event that the grammar does not have: a grey row.
  const EventDrawing& Of(std::string_view event) const;

  const ByEvent& all() const { return drawings_; }

 private:
  ByEvent drawings_;
};

}  // namespace prehend::truth
