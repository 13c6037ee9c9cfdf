// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/suite/judge/compare_engines_test.cc
#include "harness/suite/judge/compare_engines.h"

#include <cmath>

#include "harness/episode/run/run_text.h"

namespace prehend::suite {

const char* NameOf(physics::Engine engine) {
  using physics::Engine;
  switch (engine) {
    case Engine::kBox2d:
      return "box2d";
    case Engine::kBulletStock:
      return "bullet_stock";
    case Engine::kBullet:
      break;
  }
  return "bullet";
}

std::optional<EngineComparison> CompareEngines(const scenario::Scenario& scenario,
                                               std::shared_ptr<const grammar::Program> program,
                                               const grammar::Timeline& timeline) {
  using physics::Engine;
  if (!scenario.scene.world.planar) return std::nullopt;
  EngineComparison result;
  scenario::Scenario in_other = scenario;
  Engine& engine = in_other.scene.world.engine;
  result.other = engine = engine == Engine::kBox2d ? Engine::kBullet : Engine::kBox2d;
  result.run = episode::RunScenario(in_other, std::move(program));
  if (result.run.status.kind != physics::RunStatus::Kind::kCompleted) return result;
  truth::Golden expected{.ticks_per_second = timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : timeline.events)
    expected.events.push_back({.event = event});
  const auto tolerance = std::llround(kEngineTolerance_s * timeline.ticks_per_second);
  result.comparison = truth::Compare(expected, result.run.timeline, tolerance);
  return result;
}

bool Agrees(const EngineComparison& compared) {
  return compared.run.status.kind == physics::RunStatus::Kind::kCompleted &&
         compared.comparison.Agrees();
}

std::string EngineDifferenceText(const scenario::Scenario& scenario,
                                 const EngineComparison& compared, const std::string& explain) {
  if (Agrees(compared)) return "";
  const std::string other = NameOf(compared.other),
                    again = explain + " --set world.engine=" + other;
  if (compared.run.status.kind != physics::RunStatus::Kind::kCompleted)
    return "in " + other + ": " + episode::StatusText(compared.run) + "\nsee: " + again + "\n";
  return "recognised in " + other + ", expected as recognised in " +
         NameOf(scenario.scene.world.engine) + ":\n" +
         truth::DifferenceText(compared.comparison, again);
}

}  // namespace prehend::suite
