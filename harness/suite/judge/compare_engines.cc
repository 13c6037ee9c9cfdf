// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/suite/judge/compare_engines_test.cc
#include <cmath>

#include "harness/episode/run/run_text.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::suite {
namespace {

using physics::Engine;

Engine Other(Engine engine) { return engine == Engine::kBox2d ? Engine::kBullet : Engine::kBox2d; }

}  // namespace

const char* NameOf(Engine engine) {
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

episode::RunResult RunInOtherEngine(scenario::Scenario scenario,
                                    std::shared_ptr<const grammar::Program> program,
                                    const episode::RunOptions& options) {
  scenario.scene.world.engine = Other(scenario.scene.world.engine);
  return episode::RunScenario(scenario, std::move(program), options);
}

grammar::Tick EngineTolerance(const grammar::Timeline& timeline) {
  return std::llround(0.05 * static_cast<double>(timeline.ticks_per_second));
}

truth::Golden GoldenOf(const grammar::Timeline& timeline) {
  truth::Golden golden{.ticks_per_second = timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : timeline.events)
    golden.events.push_back({.event = event});
  return golden;
}

std::optional<EngineComparison> CompareEngines(const scenario::Scenario& scenario,
                                               std::shared_ptr<const grammar::Program> program,
                                               const grammar::Timeline& timeline) {
  if (!scenario.scene.world.planar) return std::nullopt;
  EngineComparison result{.other = Other(scenario.scene.world.engine),
                          .run = RunInOtherEngine(scenario, std::move(program))};
  if (result.run.status.kind == physics::RunStatus::Kind::kCompleted)
    result.comparison =
        truth::Compare(GoldenOf(timeline), result.run.timeline, EngineTolerance(timeline));
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
