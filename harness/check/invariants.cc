// SPDX-License-Identifier: Apache-2.0
// One function per invariant, and the table that names them. Tested by
// tests/harness/check/invariants_test.cc
#include "harness/check/invariants.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/timeline/event_text.h"
#include "harness/timeline/interval_set.h"

namespace prehend::harness {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;
using grammar::Timeline;

/// Phases of a carried object; sliding is the one on a support.
constexpr std::array<std::string_view, 3> kUnsupportedPhases = {"picking_up", "transporting",
                                                                "putting_down"};

bool IsUnsupportedPhase(const NamedEvent& event) {
  return std::find(kUnsupportedPhases.begin(), kUnsupportedPhases.end(), event.event) !=
         kUnsupportedPhases.end();
}

bool IsGraspPhase(const NamedEvent& event) {
  return event.event == "sliding" || IsUnsupportedPhase(event);
}

bool SamePair(const NamedEvent& a, const NamedEvent& b) {
  return RoleValue(a, "hand") == RoleValue(b, "hand") &&
         RoleValue(a, "object") == RoleValue(b, "object");
}

bool Inside(Interval inner, Interval outer) {
  return inner.begin >= outer.begin && inner.end <= outer.end;
}

bool Overlaps(Interval a, Interval b) { return a.begin < b.end && b.begin < a.end; }

/// When the object rests on something, whatever it is.
IntervalSet Supports(const Timeline& timeline, const std::string& object) {
  std::vector<Interval> intervals;
  for (const NamedEvent& event : timeline.events) {
    if (event.event == "supported_by" && RoleValue(event, "object") == object)
      intervals.push_back(event.interval);
  }
  return Union(std::move(intervals));
}

/// The phases of a grasp: those of its hand and object that overlap it.
std::vector<const NamedEvent*> PhasesOf(const Timeline& timeline, const NamedEvent& grasp) {
  std::vector<const NamedEvent*> phases;
  for (const NamedEvent& event : timeline.events) {
    if (IsGraspPhase(event) && SamePair(event, grasp) && Overlaps(event.interval, grasp.interval)) {
      phases.push_back(&event);
    }
  }
  return phases;
}

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

void CheckPhasesInsideGrasp(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                            Violations& out) {
  for (const NamedEvent& phase : timeline.events) {
    if (!IsGraspPhase(phase)) continue;
    const bool inside =
        std::any_of(timeline.events.begin(), timeline.events.end(), [&](const NamedEvent& grasp) {
          return grasp.event == "grasping" && SamePair(phase, grasp) &&
                 Inside(phase.interval, grasp.interval);
        });
    if (!inside)
      out.push_back({name, phase.interval.begin, phase.Label() + " does not lie inside a grasp"});
  }
}

void CheckPhasesApart(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                      Violations& out) {
  for (const NamedEvent& grasp : timeline.events) {
    if (grasp.event != "grasping") continue;
    const auto phases = PhasesOf(timeline, grasp);
    for (std::size_t i = 0; i < phases.size(); ++i) {
      for (std::size_t j = i + 1; j < phases.size(); ++j) {
        if (!Overlaps(phases[i]->interval, phases[j]->interval)) continue;
        out.push_back({name, phases[j]->interval.begin,
                       phases[j]->Label() + " overlaps " + phases[i]->event});
      }
    }
  }
}

void CheckPhasesCoverGrasp(const Timeline& timeline, const EpisodeFacts& facts,
                           std::string_view name, Violations& out) {
  for (const NamedEvent& grasp : timeline.events) {
    const std::string& object = RoleValue(grasp, "object");
    if (grasp.event != "grasping" || !facts.movable.contains(object)) continue;
    std::vector<Interval> explained = Supports(timeline, object);
    for (const NamedEvent* phase : PhasesOf(timeline, grasp)) {
      if (IsUnsupportedPhase(*phase)) explained.push_back(phase->interval);
    }
    for (const Interval gap : Without(grasp.interval, Union(std::move(explained)))) {
      out.push_back(
          {name, gap.begin,
           fmt::format("{} is held unsupported by {} for {} and belongs to no phase", object,
                       RoleValue(grasp, "hand"), IntervalText(gap, timeline.ticks_per_second))});
    }
  }
}

void CheckPhasesFitSupport(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                           Violations& out) {
  for (const NamedEvent& phase : timeline.events) {
    if (!IsGraspPhase(phase)) continue;
    const IntervalSet supports = Supports(timeline, RoleValue(phase, "object"));
    if (phase.event == "sliding") {
      if (!Covers(supports, phase.interval)) {
        out.push_back({name, Without(phase.interval, supports).front().begin,
                       phase.Label() + " goes on without support"});
      }
      continue;
    }
    const auto support = std::find_if(supports.begin(), supports.end(), [&](Interval interval) {
      return Overlaps(interval, phase.interval);
    });
    if (support != supports.end()) {
      out.push_back({name, std::max(support->begin, phase.interval.begin),
                     phase.Label() + " goes on while supported"});
    }
  }
}

/// Whether an event of one of these names, of the same pair, begins where `event` ends.
bool Meets(const Timeline& timeline, const NamedEvent& event,
           std::initializer_list<std::string_view> next) {
  return std::any_of(
      timeline.events.begin(), timeline.events.end(), [&](const NamedEvent& candidate) {
        return candidate.interval.begin == event.interval.end && SamePair(candidate, event) &&
               std::find(next.begin(), next.end(), candidate.event) != next.end();
      });
}

void CheckMeetings(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                   Violations& out) {
  for (const NamedEvent& event : timeline.events) {
    if (event.event == "reaching" && !Meets(timeline, event, {"fixation", "grasping"})) {
      out.push_back(
          {name, event.interval.end, event.Label() + " meets neither a fixation nor a grasp"});
    } else if (event.event == "fixation" && !Meets(timeline, event, {"grasping"})) {
      out.push_back({name, event.interval.end, event.Label() + " does not meet a grasp"});
    }
  }
}

void CheckSupportInsideContact(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                               Violations& out) {
  for (const NamedEvent& support : timeline.events) {
    if (support.event != "supported_by") continue;
    std::pair pair(RoleValue(support, "object"), RoleValue(support, "support"));
    if (pair.first > pair.second) std::swap(pair.first, pair.second);
    const bool inside =
        std::any_of(timeline.events.begin(), timeline.events.end(), [&](const NamedEvent& contact) {
          return contact.event == "contact" && RoleValue(contact, "a") == pair.first &&
                 RoleValue(contact, "b") == pair.second &&
                 Inside(support.interval, contact.interval);
        });
    if (!inside)
      out.push_back({name, support.interval.begin,
                     support.Label() + " does not lie inside a contact of the two"});
  }
}

/// Whether the two are about a common entity at a common time (ends included).
bool Concern(const NamedEvent& a, const NamedEvent& b) {
  if (a.interval.begin > b.interval.end || b.interval.begin > a.interval.end) return false;
  return std::any_of(a.roles.begin(), a.roles.end(), [&](const grammar::Role& role) {
    return !IsAttribute(role) &&
           std::any_of(b.roles.begin(), b.roles.end(), [&](const grammar::Role& other) {
             return !IsAttribute(other) && other.value == role.value;
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
  return from + TickAt(wait.seconds, timeline.ticks_per_second) + 2 * facts.ticks_per_frame;
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
                       SecondsText(event.decided, timeline.ticks_per_second),
                       SecondsText(latest, timeline.ticks_per_second))});
    }
  }
}

constexpr std::array kInvariants = {
    Invariant{"events_lie_inside_the_episode",
              "begin < end, and nothing reaches out of the episode", CheckInsideEpisode},
    Invariant{"phases_lie_inside_a_grasp",
              "sliding, picking up, transporting, putting down need a grasp",
              CheckPhasesInsideGrasp},
    Invariant{"phases_do_not_overlap", "a hand does one thing at a time with an object",
              CheckPhasesApart},
    Invariant{"phases_cover_the_grasp", "every unsupported moment of a grasp belongs to a phase",
              CheckPhasesCoverGrasp},
    Invariant{"phases_fit_the_support", "sliding only while supported, the others only while not",
              CheckPhasesFitSupport},
    Invariant{"reaches_meet_what_follows",
              "reaching meets fixation or grasping, fixation meets grasping", CheckMeetings},
    Invariant{"supports_lie_inside_contacts", "what supports touches", CheckSupportInsideContact},
    Invariant{"decisions_come_in_time",
              "every event is decided at or after its end, within its rule's bound", CheckLatency},
};

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
                     SecondsText(violation.tick, ticks_per_second), violation.what);
}

}  // namespace prehend::harness
