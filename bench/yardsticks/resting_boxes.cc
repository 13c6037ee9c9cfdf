// SPDX-License-Identifier: Apache-2.0
#include "bench/yardsticks/resting_boxes.h"

#include <cmath>

namespace prehend::bench {

scenario::Scenario BoxesOnAFloor(int count, int rate_hz) {
  constexpr double kSpacing_m = 0.12, kSize_m = 0.1;
  constexpr double kMaxDuration_s = 1800;
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const double middle_m = kSpacing_m * (side - 1) / 2;
  scenario::Scenario scenario;
  scenario.scene.world.rate_hz = rate_hz;
  scenario.sensing.sensing_hz = rate_hz / 2;
  scenario.script.settle_s = kMaxDuration_s;
  const auto add = [&](physics::Body body, const char* class_name) {
    scenario.scene.bodies.push_back(std::move(body));
    scenario.body_classes.emplace_back(class_name);
    scenario.body_part_of.push_back(grammar::kNoEntity);
  };
  physics::Body floor{.name = "floor", .fixed = true};
  floor.shapes.push_back({physics::Box{{kSpacing_m * side, kSpacing_m * side, kSize_m}}, {}});
  floor.X_WB.p_m = {0, 0, -kSize_m / 2};
  add(std::move(floor), "Floor");
  for (int i = 0; i < count; ++i) {
    physics::Body box{.name = "box" + std::to_string(i), .mass_kg = 0.3};
    box.shapes.push_back({physics::Box{{kSize_m, kSize_m, kSize_m}}, {}});
    box.X_WB.p_m = {kSpacing_m * (i % side) - middle_m, kSpacing_m * (i / side) - middle_m,
                    kSize_m / 2};
    add(std::move(box), "Box");
  }
  return scenario;
}

}  // namespace prehend::bench
