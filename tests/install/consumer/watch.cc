// SPDX-License-Identifier: Apache-2.0
// A program of somebody else, with the installed library: a hand comes near a cup and leaves it.
#include <prehend/version.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "grammar/monitor.h"
#include "grammar/name_events.h"

using namespace prehend::grammar;

int main(int argc, char**) {
  const CompileResult compiled = Compile(
      {"near.grammar",
       "grammar near\nevent near(hand: Hand, cup: Cup)\n  while distance(hand, cup) < 10 cm\n"},
      [](std::string_view) { return std::nullopt; });
  for (const Diagnostic& found : compiled.diagnostics) std::puts(found.message.c_str());
  if (!compiled.program) return 2;

  EntityTable table{.ticks_per_second = 100};
  table.entities = {{.name = "hand", .classes = {"Hand", "Entity"}},
                    {.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}}};
  Monitor monitor(compiled.program, table);
  std::vector<Event> events;
  for (Tick tick = 1; tick <= 200; ++tick) {
    std::array<EntitySample, 2> looks;
    looks[0].p_WB_m = {0.5 * std::abs(static_cast<double>(tick - 100)) / 100, 0, 0};
    const CollisionSphere palm{looks[0].p_WB_m, 0.01};
    const HandSample hand{.entity = 0, .collision_spheres = {&palm, 1}};
    monitor.Advance({.tick = tick, .entities = looks, .hands = {&hand, 1}}, events);
  }
  monitor.Finish(201, events);
  for (const NamedEvent& event : NameEvents(*compiled.program, table, events).events)
    std::printf("%s %ld..%ld\n", event.Label().c_str(), event.interval.begin, event.interval.end);
  std::printf("prehend %s, sin of the C library: %a\n", PREHEND_VERSION, std::sin(0.5 * argc));
  return 0;
}
