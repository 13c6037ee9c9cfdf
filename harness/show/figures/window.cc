// SPDX-License-Identifier: Apache-2.0
// See harness/show/figures/window.h. Tested by tests/harness/show/figures/figures_test.cc
#include "harness/show/figures/window.h"

#include <algorithm>

namespace prehend::show {

bool Window::Shows(const scenario::Scenario& scenario, const grammar::NamedEvent& event) const {
  const auto has = [&](const std::string& name) {
    return std::ranges::any_of(event.roles,
                               [&](const grammar::Role& role) { return role.value == name; });
  };
  if (!entity.empty() && !has(entity)) return false;
  return hand.empty() ||
         std::ranges::none_of(scenario.scene.hands, [&](const physics::Hand& other) {
           return other.name != hand && has(other.name);
         });
}

Window WholeOf(const episode::RunResult& run) {
  return {.from_s = 0, .to_s = SecondsOf(run, run.ticks)};
}

std::string HandOf(const episode::RunResult& run, const grammar::NamedEvent& event) {
  const truth::EventDrawing& drawing = run.drawings.Of(event.event);
  return drawing.hand < event.roles.size() ? event.roles[drawing.hand].value : std::string();
}

double SecondsOf(const episode::RunResult& run, grammar::Tick tick) {
  return static_cast<double>(tick) / static_cast<double>(run.timeline.ticks_per_second);
}

}  // namespace prehend::show
