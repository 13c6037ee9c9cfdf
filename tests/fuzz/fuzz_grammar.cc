// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a grammar. Whatever compiles is described and watches a few
// frames. How to run it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "grammar/compile/compile.h"
#include "grammar/describe.h"
#include "grammar/monitor.h"
#include "grammar/program/program.h"

namespace {

using namespace prehend::grammar;

std::optional<GrammarText> Library(std::string_view name) {
  if (name == "grasp") {
    return GrammarText{
        "grasp",
        "grammar grasp\nparam grip_on = 0.3\nevent grasping(hand: Hand, object: Thing)\n"
        "  while trigger(hand) >= grip_on and sensor_sets(hand, object) >= 2 bridging 60 ms\n"};
  }
  if (name == "contact") {
    return GrammarText{
        "contact",
        "grammar contact\nsymmetric event contact(a: Entity, b: Entity) while touching(a, b)\n"
        "event supported_by(object: Movable, support: Thing) while up(object, support) >= 0.5\n"};
  }
  return std::nullopt;
}

// A hand grasps a cup, lifts it and lets go.
void Watch(const std::shared_ptr<const Program>& program) {
  const EntityTable entity_table{
      .ticks_per_second = 100,
      .entities = {{.name = "hand",
                    .classes = {"Hand", "Entity"},
                    .sensor_sets = {"fingers", "thumb"}},
                   {.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}},
                   {.name = "table", .classes = {"Fixed", "Thing", "Entity"}}},
      .styles = {"wrap"}};
  Monitor monitor(program, entity_table);
  std::vector<EntitySample> looks(3);
  const CollisionSphere collision_sphere;
  std::vector<Event> events;
  for (int i = 0; i < 30; ++i) {
    looks[1].p_WB_m.z() = i < 10 ? 0 : 0.01 * i;
    const HandSample hand{.entity = 0,
                          .trigger = i > 3 && i < 20 ? 1.0 : 0.0,
                          .collision_spheres = {&collision_sphere, 1}};
    std::vector<Touch> touches;
    if (i > 2 && i < 22) touches.push_back({.a = 0, .b = 1, .normal_force_n = 2, .sensor_sets = 3});
    if (i < 10 || i > 25) touches.push_back({.a = 1, .b = 2, .up_on_a = 1, .normal_force_n = 1});
    monitor.Advance({.tick = i, .entities = looks, .hands = {&hand, 1}, .touches = touches},
                    events);
  }
  monitor.Finish(30, events);
  for (const Event& event : events) {
    if (event.interval.begin >= event.interval.end || event.decided < event.interval.end)
      std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const CompileResult result =
      Compile({"g", std::string(reinterpret_cast<const char*>(data), size)}, Library, {},
              {"grasp", "contact"});
  if ((result.program == nullptr) == result.diagnostics.empty())
    std::abort();  // a program or errors, never both
  (void)Format(result.diagnostics);
  if (!result.program) return 0;
  (void)Text(Describe(*result.program));
  Watch(result.program);
  return 0;
}
