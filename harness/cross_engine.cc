// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/cross_engine_test.cc
#include "harness/cross_engine.h"

#include <cmath>

namespace prehend::harness {

const char* NameOf(physics::Engine engine) {
  return engine == physics::Engine::kBox2d ? "box2d" : "bullet";
}

std::optional<EngineComparison> CompareEngines(const Scenario& scenario,
                                               std::shared_ptr<const grammar::Program> program,
                                               const grammar::Timeline& timeline) {
  using physics::Engine;
  if (!scenario.scene.world.planar) return std::nullopt;
  EngineComparison result;
  Scenario in_other = scenario;
  Engine& engine = in_other.scene.world.engine;
  result.other = engine = engine == Engine::kBox2d ? Engine::kBullet : Engine::kBox2d;
  result.run = RunScenario(in_other, std::move(program));
  if (result.run.status.kind != physics::RunStatus::Kind::kCompleted) return result;
  Golden expected{.ticks_per_second = timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : timeline.events)
    expected.events.push_back({.event = event});
  const auto tolerance = std::llround(kEngineTolerance_s * timeline.ticks_per_second);
  result.comparison = Compare(expected, result.run.timeline, tolerance);
  return result;
}

}  // namespace prehend::harness
