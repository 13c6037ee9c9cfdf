// SPDX-License-Identifier: Apache-2.0
// See latency_bound.h. Tested by tests/harness/latency_bound_test.cc
#include "harness/latency_bound.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prehend::harness {
namespace {

using grammar::Rule;

/// A fact is certain in the frame that shows it; two frames at the slowest sensing (30 Hz) are for its neighbours.
constexpr double kFrames_s = 0.07;

/// Seconds that a rule may hold back, with what it refers to; nothing: as long as it likes. Rules refer to each other
/// without cycles, which the compiler checks.
std::optional<double> HeldBack_s(const grammar::Program& program, const Rule& rule) {
  if (rule.confirmed_by != grammar::kNone || rule.form == grammar::Form::kCompose) return std::nullopt;
  if (rule.form == grammar::Form::kUntilSince && rule.back_s < 0) return std::nullopt;
  double longest_s = 0;
  for (const grammar::Reference& reference : rule.references) {
    const auto held_s = HeldBack_s(program, program.events[reference.rule]);
    if (!held_s) return std::nullopt;
    longest_s = std::max(longest_s, *held_s);
  }
  return kFrames_s + rule.bridging_s + rule.lasting_s + std::max(0.0, rule.back_s) + longest_s;
}

}  // namespace

grammar::Tick LatencyBound(const grammar::Program& program, const std::string& event, grammar::Tick ticks_per_second,
                           grammar::Tick episode) {
  const auto rule = std::find_if(program.events.begin(), program.events.end(),
                                 [&](const Rule& candidate) { return candidate.name == event; });
  if (rule == program.events.end()) return episode;
  const auto held_s = HeldBack_s(program, *rule);
  if (!held_s) return episode;
  return static_cast<grammar::Tick>(std::ceil(*held_s * static_cast<double>(ticks_per_second)));
}

}  // namespace prehend::harness
