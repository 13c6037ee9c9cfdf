// SPDX-License-Identifier: Apache-2.0
// One function per invariant, and the table that names them. Tested by
// tests/harness/suite/judge/invariants_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "grammar/check_laws.h"
#include "grammar/describe.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;
using grammar::Timeline;

bool Inside(Interval inner, Interval outer) {
  return inner.begin >= outer.begin && inner.end <= outer.end;
}

bool Overlaps(Interval a, Interval b) { return a.begin < b.end && b.begin < a.end; }

void CheckInsideEpisode(const Timeline& timeline, const EpisodeFacts& facts, std::string_view name,
                        Violations& out) {
  for (const NamedEvent& event : timeline.events) {
    const Interval interval = event.interval;
    if (interval.begin >= interval.end) {
      out.push_back({name, interval.begin, event.Label() + " does not end after it begins"});
    } else if (!Inside(interval, {0, facts.end})) {
      out.push_back({name, interval.begin, event.Label() + " reaches out of the episode"});
    }
  }
}

/// Intervals of one event with the same roles, whatever it is about.
void CheckApartFromItself(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                          Violations& out) {
  std::map<std::string, const NamedEvent*> last;  // by label, in the order of time
  for (const NamedEvent& event : timeline.events) {
    const NamedEvent*& before = last[event.Label()];
    if (before && Overlaps(before->interval, event.interval))
      out.push_back({name, event.interval.begin, event.Label() + " overlaps itself"});
    if (!before || before->interval.end < event.interval.end) before = &event;
  }
}

/// Whether the two are about a common entity at a common time (ends included).
bool Concern(const NamedEvent& a, const NamedEvent& b) {
  if (a.interval.begin > b.interval.end || b.interval.begin > a.interval.end) return false;
  return std::any_of(a.roles.begin(), a.roles.end(), [&](const grammar::Role& role) {
    return !truth::IsAttribute(role) &&
           std::any_of(b.roles.begin(), b.roles.end(), [&](const grammar::Role& other) {
             return !truth::IsAttribute(other) && other.value == role.value;
           });
  });
}

/// The last tick at which the event may be decided.
Tick LatestDecision(const NamedEvent& event, const Timeline& timeline, const EpisodeFacts& facts) {
  const auto found = facts.latency.find(event.event);
  const grammar::Wait wait = found == facts.latency.end() ? grammar::Wait{} : found->second;
  Tick from = event.interval.end;
  for (const NamedEvent& other : timeline.events) {
    if (wait.until_end_of.contains(other.event) && Concern(event, other))
      from = std::max(from, other.interval.end);
  }
  return from + truth::TickAt(wait.seconds, timeline.ticks_per_second) + 2 * facts.ticks_per_frame;
}

void CheckLatency(const Timeline& timeline, const EpisodeFacts& facts, std::string_view name,
                  Violations& out) {
  for (const NamedEvent& event : timeline.events) {
    const Tick latest = LatestDecision(event, timeline, facts);
    if (event.decided < event.interval.end) {
      out.push_back({name, event.decided, event.Label() + " was decided before it ended"});
    } else if (event.decided > latest) {
      out.push_back(
          {name, event.decided,
           fmt::format("{} was decided at {} s, by its rule it is certain at {} s", event.Label(),
                       truth::SecondsText(event.decided, timeline.ticks_per_second),
                       truth::SecondsText(latest, timeline.ticks_per_second))});
    }
  }
}

constexpr std::array kInvariants = {
    Invariant{"events_lie_inside_the_episode",
              "begin < end, and nothing reaches out of the episode", CheckInsideEpisode},
    Invariant{"an_event_does_not_overlap_itself",
              "intervals of one event with the same roles lie apart", CheckApartFromItself},
    Invariant{"decisions_come_in_time",
              "every event is decided at or after its end, within its rule's bound", CheckLatency},
};

std::map<std::string, grammar::Wait> LatencyByEvent(const grammar::Program& program) {
  std::map<std::string, grammar::Wait> latency;
  for (const grammar::RuleDescription& rule : Describe(program).rules)
    latency[rule.name] = rule.latency;
  return latency;
}

Findings ViolationFinding(std::string reason, std::string details) {
  if (details.empty()) return {};
  return {{.exit_code = ExitCode::kDiffers,
           .reason = std::move(reason),
           .details = std::move(details)}};
}

}  // namespace

std::span<const Invariant> Invariants() { return kInvariants; }

Violations CheckInvariants(const Timeline& timeline, const EpisodeFacts& facts) {
  Violations violations;
  for (const Invariant& invariant : kInvariants)
    invariant.check(timeline, facts, invariant.name, violations);
  return violations;
}

std::string Text(const Violation& violation, Tick ticks_per_second) {
  return fmt::format("{} at {} s: {}", violation.invariant,
                     truth::SecondsText(violation.tick, ticks_per_second), violation.what);
}

std::string Text(const grammar::LawViolation& violation, Tick ticks_per_second) {
  const grammar::Law& law = *violation.law;
  return fmt::format("{} at {}: {}\n  {}:{}: {} {}", law.name,
                     truth::IntervalText(violation.when, ticks_per_second), violation.what,
                     law.file, law.place.line, law.Head(), law.says);
}

Findings JudgeInvariants(const CheckedRun& checked) {
  const episode::RunResult& run = checked.result;
  const scenario::Scenario& scenario = checked.loaded.scenario;
  EpisodeFacts facts{.end = run.ticks + 1};
  facts.ticks_per_frame = scenario::DefaultTolerance(scenario) / 2;
  facts.latency = LatencyByEvent(*checked.loaded.program);
  std::string details;
  for (const Violation& violation : CheckInvariants(run.timeline, facts))
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  return ViolationFinding("invariant violated", std::move(details));
}

Findings JudgeLaws(const CheckedRun& checked) {
  const grammar::Timeline& timeline = checked.result.timeline;
  std::string details;
  std::set<std::string> names;
  for (const grammar::LawViolation& violation : CheckLaws(
           *checked.loaded.program, episode::MakeEntityTable(checked.loaded.scenario), timeline)) {
    details += "violated: " + Text(violation, timeline.ticks_per_second) + "\n";
    names.insert(violation.law->name);
  }
  return ViolationFinding(
      fmt::format("a law of the grammar is violated, {}", fmt::join(names, ", ")),
      std::move(details));
}

}  // namespace prehend::suite
