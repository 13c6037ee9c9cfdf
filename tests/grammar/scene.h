// SPDX-License-Identifier: Apache-2.0
// Frames written by hand, for tests of signals and of the monitor.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "grammar/program/program.h"

namespace prehend::grammar::testing {

/// A hand with one collision sphere, a cup and a tray; the ids are their places in the
/// entity_table. 1000 ticks per second.
struct Scene {
  static constexpr int kHand = 0;
  static constexpr int kCup = 1;
  static constexpr int kTray = 2;

  EntityTable entity_table{
      .ticks_per_second = 1000,
      .entities = {{.name = "hand",
                    .classes = {"Hand", "Entity"},
                    .sensor_sets = {"fingers", "thumb", "palm"}},
                   {.name = "cup",
                    .classes = {"Cup", "Movable", "Thing", "Entity"},
                    .part_of = kTray},
                   {.name = "tray", .classes = {"Movable", "Thing", "Entity"}}},
      .styles = {"wrap", "pinch"}};
  std::vector<EntitySample> looks = std::vector<EntitySample>(3);
  CollisionSphere collision_sphere;
  HandSample hand{.entity = kHand};
  std::vector<Touch> touches;

  Frame At(Tick tick) {
    hand.collision_spheres = {&collision_sphere, 1};
    return {.tick = tick, .entities = looks, .hands = {&hand, 1}, .touches = touches};
  }
};

inline std::shared_ptr<const Program> CompileText(const std::string& text) {
  CompileResult result = Compile({"test", text}, nullptr);
  EXPECT_TRUE(result.program) << Format(result.diagnostics);
  return result.program;
}

}  // namespace prehend::grammar::testing
