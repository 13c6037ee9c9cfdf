// SPDX-License-Identifier: Apache-2.0
// A planar scenario in the other engine: what is recognised does not depend on the engine that
// computed the physics. Tested by tests/harness/suite/judge/compare_engines_test.cc
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "harness/episode/run/run_scenario.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {

/// Said of a scenario that differs between them.
inline constexpr const char* kUntilEnginesAgree =
    "it cannot be accepted until both engines agree: change the scenario, or fix what differs";

/// As the scenario format calls it.
const char* NameOf(physics::Engine engine);

struct EngineComparison {
  physics::Engine other = physics::Engine::kBullet;
  episode::RunResult run;  ///< in the other engine
  truth::Comparison
      comparison;  ///< of the other engine's timeline with the one given; empty if it failed
};

/// In the engine that it does not name.
episode::RunResult RunInOtherEngine(scenario::Scenario scenario,
                                    std::shared_ptr<const grammar::Program> program,
                                    const episode::RunOptions& options = {});
/// Boundaries may differ by this much between engines, which place contacts and distribute friction
/// differently.
grammar::Tick EngineTolerance(const grammar::Timeline& timeline);
/// With nothing that people wrote.
truth::Golden GoldenOf(const grammar::Timeline& timeline);

/// Plays the scenario in the other engine. Empty when it is not planar.
std::optional<EngineComparison> CompareEngines(const scenario::Scenario& scenario,
                                               std::shared_ptr<const grammar::Program> program,
                                               const grammar::Timeline& timeline);

/// Whether the other engine's run completed with the same events.
bool Agrees(const EngineComparison& compared);

/// In which events the other engine differs and how far, or why its run failed; "" when they agree.
/// `explain` is the command that asks about the scenario's events.
std::string EngineDifferenceText(const scenario::Scenario& scenario,
                                 const EngineComparison& compared, const std::string& explain);

}  // namespace prehend::suite
