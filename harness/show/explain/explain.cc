// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/explain.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "harness/show/explain/query.h"
#include "harness/show/explain/why_event.h"
#include "harness/show/explain/why_missing.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {
namespace {

using grammar::CandidateOutcome;
using grammar::InstanceId;
using grammar::ReplayMonitor;
using grammar::RuleId;
using grammar::Tick;

std::vector<const CandidateOutcome*> IntervalsOf(ReplayMonitor& past, const Ask& ask) {
  std::vector<const CandidateOutcome*> intervals;
  for (const InstanceId instance : BindingsThatFit(past, ask.rule, ask.entities)) {
    for (const CandidateOutcome& outcome : past.OutcomesOf(instance)) {
      if (outcome.IsInterval()) intervals.push_back(&outcome);
    }
  }
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const CandidateOutcome* a, const CandidateOutcome* b) {
                     return std::tie(a->span.begin.tick, a->span.end.tick) <
                            std::tie(b->span.begin.tick, b->span.end.tick);
                   });
  return intervals;
}

Tick TickOf(const Ask& ask, const ReplayMonitor& past) {
  return truth::TickAt(*ask.time_s, past.entity_table().ticks_per_second);
}

// A time that was read off a table is rounded, so the end counts, too.
bool Contains(const CandidateOutcome& outcome, Tick tick) {
  return outcome.span.begin.tick <= tick + 1 && tick <= outcome.span.end.tick;
}

}  // namespace

std::vector<WhyEvent> ExplainAll(ReplayMonitor& past) {
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const RuleId rule : grammar::IdsOf(past.program().rules)) {
    if (!past.program().rules[rule].printed) continue;
    for (const InstanceId instance : past.InstancesOf(rule)) {
      for (const CandidateOutcome& outcome : past.OutcomesOf(instance)) {
        if (outcome.IsInterval()) events.push_back(reasons.Explain(instance, outcome, true));
      }
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const WhyEvent& a, const WhyEvent& b) {
    return std::tie(a.interval.begin, a.interval.end, a.event) <
           std::tie(b.interval.begin, b.interval.end, b.event);
  });
  return events;
}

std::vector<WhyEvent> ExplainEvents(ReplayMonitor& past, const Ask& ask) {
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const CandidateOutcome* outcome : IntervalsOf(past, ask)) {
    if (!ask.time_s || Contains(*outcome, TickOf(ask, past)))
      events.push_back(reasons.Explain(outcome->instance, *outcome));
  }
  return events;
}

std::vector<WhyEvent> NearestEvents(ReplayMonitor& past, const Ask& ask) {
  constexpr std::size_t kMaxListed = 3;
  std::vector<const CandidateOutcome*> intervals = IntervalsOf(past, ask);
  const auto away = [&](const CandidateOutcome* outcome) {
    if (!ask.time_s) return Tick{0};
    const Tick tick = TickOf(ask, past);
    return std::max({Tick{0}, outcome->span.begin.tick - tick, tick - outcome->span.end.tick});
  };
  std::stable_sort(
      intervals.begin(), intervals.end(),
      [&](const CandidateOutcome* a, const CandidateOutcome* b) { return away(a) < away(b); });
  if (intervals.size() > kMaxListed) intervals.resize(kMaxListed);
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const CandidateOutcome* outcome : intervals)
    events.push_back(reasons.Explain(outcome->instance, *outcome, true));
  return events;
}

WhyMissing ExplainMissing(ReplayMonitor& past, const Ask& ask) {
  std::optional<grammar::FrameNumber> at;
  if (ask.time_s) at = past.FrameAt(TickOf(ask, past));
  const std::vector<InstanceId> instances = BindingsThatFit(past, ask.rule, ask.entities);
  if (!instances.empty()) return MissingReasons(past).Explain(instances, at);
  WhyMissing why;
  why.event = past.program().rules[ask.rule].name;
  why.because = "no entities of the episode fit its roles";
  return why;
}

}  // namespace prehend::show
