// SPDX-License-Identifier: Apache-2.0
// Looks up names of rules, roles and attributes in the program, of entities in the entity_table.
#include "grammar/name_events.h"

#include <cmath>

#include "grammar/program/program.h"

namespace prehend::grammar {

Timeline NameEvents(const Program& program, const EntityTable& entity_table,
                    const std::vector<Event>& events) {
  Timeline timeline{.ticks_per_second = entity_table.ticks_per_second};
  timeline.events.reserve(events.size());
  for (const Event& event : events) {
    const Rule& rule = program.rules[event.rule];
    NamedEvent named{.event = rule.name,
                     .interval = event.interval,
                     .decided = event.decided,
                     .open_end = event.open_end};
    for (std::size_t i = 0; i < rule.roles.size(); ++i) {
      named.roles.push_back({rule.roles[i].name, entity_table.entities[event.roles[i]].name});
    }
    if (event.style >= 0 && event.style < static_cast<int>(entity_table.styles.size())) {
      named.roles.push_back({"style", entity_table.styles[event.style]});
    }
    for (std::size_t i = 0; i < rule.attributes.size(); ++i) {
      const RuleAttribute& attribute = rule.attributes[i];
      if (std::isnan(event.attributes[i])) continue;  // nobody knows it
      const std::string unit =
          attribute.dimension == kPlain ? "" : DimensionText(attribute.dimension);
      named.values.push_back({attribute.name, event.attributes[i], unit});
    }
    timeline.events.push_back(std::move(named));
  }
  Sort(timeline);
  return timeline;
}

}  // namespace prehend::grammar
