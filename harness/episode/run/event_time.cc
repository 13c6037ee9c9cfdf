// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/event_time.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "grammar/contents.h"

namespace prehend::episode {

std::optional<EventTime> ParseEventTime(const std::string& text) {
  double time_s = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), time_s);
  if (parsed.ec == std::errc() && parsed.ptr == text.data() + text.size()) {
    if (!std::isfinite(time_s) || time_s < 0) return std::nullopt;
    return EventTime{.time_s = time_s, .event = {}};
  }
  for (const char* boundary : {".begin", ".end"}) {
    const std::size_t length = std::char_traits<char>::length(boundary);
    if (text.size() <= length || !text.ends_with(boundary)) continue;
    return EventTime{.time_s = std::nullopt,
                     .event = text.substr(0, text.size() - length),
                     .end = boundary == std::string(".end")};
  }
  return std::nullopt;
}

std::optional<EventTimeProblem> WhyNoEventTime(const std::string& text,
                                               const grammar::Program& program) {
  const auto moment = ParseEventTime(text);
  if (!moment) {
    return EventTimeProblem{
        fmt::format("'{}' is not a time", text),
        "write seconds, like 1.25, or the boundary of an event, like reaching.begin"};
  }
  if (moment->time_s) return std::nullopt;
  if (HasEvent(program, moment->event)) return std::nullopt;
  const std::vector<std::string> events = EventNames(program);
  const std::string near = grammar::NearestName(moment->event, events);
  return EventTimeProblem{
      fmt::format("grammar '{}' has no event '{}'", GrammarName(program), moment->event),
      near.empty() ? fmt::format("known: {}", fmt::join(events, ", "))
                   : fmt::format("did you mean '{}'?", near)};
}

FoundTime FindEventTime(const std::string& text, const RunResult& run) {
  const auto moment = ParseEventTime(text);
  if (!moment) return {run.ticks, fmt::format("'{}' is not a time", text)};
  if (moment->time_s) {
    const double ticks_per_s = static_cast<double>(run.timeline.ticks_per_second);
    const double tick = std::round(*moment->time_s * ticks_per_s);
    if (tick <= static_cast<double>(run.ticks)) return {static_cast<grammar::Tick>(tick), ""};
    return {run.ticks, fmt::format("{} s is after the end", text)};
  }
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (event.event == moment->event)
      return {moment->end ? event.interval.end : event.interval.begin, ""};
  }
  return {run.ticks, fmt::format("{} did not happen", text)};
}

const physics::Snapshot& SnapshotAt(const RunResult& run, grammar::Tick tick) {
  const auto at = std::ranges::lower_bound(run.recording, tick, {}, &physics::Snapshot::tick);
  return at == run.recording.end() ? run.recording.back() : *at;
}

}  // namespace prehend::episode
