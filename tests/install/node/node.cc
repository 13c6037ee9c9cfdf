// SPDX-License-Identifier: Apache-2.0
// docs/cpp-library.md
#include <prehend/episode.h>

#include <cstdio>

#include "grammar/monitor.h"
#include "grammar/name_events.h"

int main() try {
  using namespace prehend::grammar;
  const prehend::Grammar grammar("near.grammar", {{"radius", "25 cm"}});
  EntityTable table{.ticks_per_second = 100, .entities = {}, .styles = {}};
  table.entities.push_back({.name = "right_hand", .classes = {"Hand", "Entity"}});
  table.entities.push_back({.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}});
  Monitor monitor(grammar.program(), table);
  const CollisionSphere palm{};  // the hand is a point, and stays at the origin
  const HandSample hand{.entity = 0, .collision_spheres = {&palm, 1}};
  std::vector<EntitySample> now(2);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 400; ++tick) {
    now[1].p_WB_m = {1.0 - 0.005 * static_cast<double>(tick), 0, 0};  // the cup comes, and goes on
    monitor.Advance({.tick = tick, .entities = now, .hands = {&hand, 1}, .touches = {}}, events);
  }
  monitor.Finish(400, events);
  for (const NamedEvent& event : NameEvents(*grammar.program(), table, events).events)
    std::printf("%s %.2f..%.2f s\n", event.Label().c_str(), event.interval.begin / 100.0,
                event.interval.end / 100.0);
} catch (const prehend::Error& error) {
  std::fputs(error.what(), stderr);  // file:line:column: error: .., the line, a caret, the remedy
  return 2;
}
