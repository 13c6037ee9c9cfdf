// SPDX-License-Identifier: Apache-2.0
// See harness/explain/explain.h. Tested by tests/harness/explain_test.cc
#include "harness/explain/explain.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "harness/event_text.h"
#include "harness/explain/bindings.h"
#include "harness/explain/why_event.h"
#include "harness/explain/why_missing.h"

namespace prehend::harness::explain {
namespace {

using grammar::Fate;
using grammar::Hindsight;
using grammar::Tick;

std::vector<const Fate*> IntervalsOf(Hindsight& past, const Ask& ask) {
  std::vector<const Fate*> intervals;
  for (const int lane : BindingsThatFit(past, ask.rule, ask.entities)) {
    for (const Fate& fate : past.FatesOf(lane)) {
      if (fate.kind == Fate::Kind::kInterval) intervals.push_back(&fate);
    }
  }
  std::stable_sort(intervals.begin(), intervals.end(), [](const Fate* a, const Fate* b) {
    return std::tie(a->span.begin.tick, a->span.end.tick) <
           std::tie(b->span.begin.tick, b->span.end.tick);
  });
  return intervals;
}

Tick TickOf(const Ask& ask, const Hindsight& past) {
  return TickAt(*ask.time_s, past.cast().ticks_per_second);
}

// A time that was read off a table is rounded, so the end counts, too.
bool Contains(const Fate& fate, Tick tick) {
  return fate.span.begin.tick <= tick + 1 && tick <= fate.span.end.tick;
}

}  // namespace

std::vector<WhyEvent> ExplainAll(Hindsight& past) {
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (std::size_t rule = 0; rule < past.program().events.size(); ++rule) {
    if (!past.program().events[rule].printed) continue;
    for (const int lane : past.LanesOf(static_cast<int>(rule))) {
      for (const Fate& fate : past.FatesOf(lane)) {
        if (fate.kind == Fate::Kind::kInterval) events.push_back(reasons.Explain(lane, fate, true));
      }
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const WhyEvent& a, const WhyEvent& b) {
    return std::tie(a.interval.begin, a.interval.end, a.event) <
           std::tie(b.interval.begin, b.interval.end, b.event);
  });
  return events;
}

std::vector<WhyEvent> ExplainEvents(Hindsight& past, const Ask& ask) {
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const Fate* fate : IntervalsOf(past, ask)) {
    if (!ask.time_s || Contains(*fate, TickOf(ask, past)))
      events.push_back(reasons.Explain(fate->lane, *fate));
  }
  return events;
}

std::vector<WhyEvent> NearestEvents(Hindsight& past, const Ask& ask) {
  constexpr std::size_t kMost = 3;
  std::vector<const Fate*> intervals = IntervalsOf(past, ask);
  const auto away = [&](const Fate* fate) {
    if (!ask.time_s) return Tick{0};
    const Tick tick = TickOf(ask, past);
    return std::max({Tick{0}, fate->span.begin.tick - tick, tick - fate->span.end.tick});
  };
  std::stable_sort(intervals.begin(), intervals.end(),
                   [&](const Fate* a, const Fate* b) { return away(a) < away(b); });
  if (intervals.size() > kMost) intervals.resize(kMost);
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const Fate* fate : intervals) events.push_back(reasons.Explain(fate->lane, *fate, true));
  return events;
}

WhyMissing ExplainMissing(Hindsight& past, const Ask& ask) {
  std::optional<grammar::FrameNumber> at;
  if (ask.time_s) at = past.FrameAt(TickOf(ask, past));
  const std::vector<int> lanes = BindingsThatFit(past, ask.rule, ask.entities);
  if (!lanes.empty()) return MissingReasons(past).Explain(lanes, at);
  WhyMissing why;
  why.event = past.program().events[ask.rule].name;
  why.because = "no entities of the episode fit its roles";
  return why;
}

}  // namespace prehend::harness::explain
