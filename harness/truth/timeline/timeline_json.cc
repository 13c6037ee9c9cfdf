// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/episode/run/run_text_test.cc
#include "harness/truth/timeline/timeline_json.h"

#include <nlohmann/json.hpp>

#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {

using Json = nlohmann::ordered_json;

Json EventJson(const grammar::NamedEvent& event, grammar::Tick ticks_per_second) {
  const auto seconds = [&](grammar::Tick tick) {
    return static_cast<double>(tick) / static_cast<double>(ticks_per_second);
  };
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

}  // namespace prehend::truth
