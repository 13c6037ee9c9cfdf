// SPDX-License-Identifier: Apache-2.0
// Seconds are rounded such that comparing ticks gives the same as comparing seconds.
#include "grammar/state/rule_ticks.h"

namespace prehend::grammar {

RuleTicks TicksOf(const Rule& rule, const History& history) {
  RuleTicks ticks{.lasting = history.AtLeastTicks(rule.lasting_s)};
  if (rule.lasting_most_s >= 0) ticks.lasting_most = history.AtMostTicks(rule.lasting_most_s);
  if (const auto* composition = rule.If<ComposeRule>()) {
    if (composition->within_s > 0) ticks.within = history.AtMostTicks(composition->within_s);
    for (const ComposeRule::Clause& clause : composition->clauses)
      ticks.clauses.push_back(
          clause.In([&](double seconds) { return history.AtMostTicks(seconds); }));
  }
  if (const auto* any = rule.If<AnyRule>()) ticks.nearest = history.AtMostTicks(any->within_s);
  if (const auto* holds = rule.If<WhileRule>())
    ticks.bridging = history.AtMostTicks(holds->bridging_s);
  if (const auto* from_to = rule.If<FromToRule>(); from_to != nullptr && from_to->within_s >= 0) {
    ticks.in_time = history.AtMostTicks(from_to->within_s);
    ticks.within = from_to->absence ? history.AtLeastTicks(from_to->within_s) : ticks.in_time;
  }
  if (const auto* looks_back = rule.If<UntilSinceRule>()) {
    ticks.back = history.AtMostTicks(looks_back->back_s);
    if (const auto& approach = looks_back->approach) {
      ticks.idle = history.AtMostTicks(approach->idle_s);
      ticks.over = history.AtMostTicks(approach->over_s / 2);
      ticks.still = history.AtMostTicks(approach->still_s / 2);
    }
  }
  return ticks;
}

double LooksBack_s(const Rule& rule) {
  double back_s = 0;
  if (const auto* looks_back = rule.If<UntilSinceRule>()) {
    back_s += looks_back->back_s;
    if (looks_back->approach) back_s += looks_back->approach->looks_around_s();
  }
  // A requirement or an attribute is asked for where the run ended, when its gap is too long.
  if (const auto* holds = rule.If<WhileRule>();
      holds != nullptr && (rule.requirement != kNone || !rule.attributes.empty()))
    back_s += holds->bridging_s;
  return back_s;
}

}  // namespace prehend::grammar
