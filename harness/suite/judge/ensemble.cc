// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/suite/judge/compare_engines_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/run_text.h"
#include "harness/scenario/transform/transform.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/judge/other_view.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

/// Without the events of those who are not in the scenario.
void LeaveOutOthers(const physics::Scene& scene, grammar::Timeline& timeline) {
  std::set<std::string> names;
  for (const physics::Body& body : scene.bodies) names.insert(body.name);
  for (const physics::Hand& hand : scene.hands) names.insert(hand.name);
  for (const physics::Person& person : scene.persons) names.insert(person.name);
  std::erase_if(timeline.events, [&](const grammar::NamedEvent& event) {
    return std::ranges::any_of(event.roles, [&](const grammar::Role& role) {
      return !truth::IsAttribute(role) && !names.contains(role.value);
    });
  });
}

/// Rounded as a golden is written.
double Milliseconds(grammar::Tick ticks, grammar::Tick ticks_per_second) {
  const double ms =
      1000.0 * static_cast<double>(std::abs(ticks)) / static_cast<double>(ticks_per_second);
  return std::round(10 * ms) / 10;
}

/// How far boundaries are from their golden lines, by line; nothing for events without partner.
struct Offset {
  grammar::Tick begin, end;
};
std::vector<std::optional<Offset>> OffsetsOf(const truth::Comparison& comparison,
                                             const truth::Golden& golden) {
  std::vector<std::optional<Offset>> offsets(golden.events.size());
  for (const truth::Pairing& pairing : comparison.pairings)
    if (pairing.expected && pairing.actual)
      offsets[pairing.golden_line] = {pairing.begin_offset, pairing.end_offset};
  return offsets;
}

using physics::Engine;

Engine Other(Engine engine) { return engine == Engine::kBox2d ? Engine::kBullet : Engine::kBox2d; }

}  // namespace

Ensemble PlayEnsemble(const episode::LoadedRun& loaded, const grammar::Timeline& here,
                      const truth::Golden& golden) {
  Ensemble ensemble;
  ensemble.spreads.resize(golden.events.size());
  const auto offsets_here =
      OffsetsOf(truth::Compare(golden, here, scenario::DefaultTolerance(loaded.scenario)), golden);
  for (const scenario::Transform transform : scenario::kTransforms) {
    auto scenario = scenario::Transformed(loaded.scenario, transform);
    if (!scenario) continue;
    const std::string name(NameOf(transform));
    TransformedPlay play = Play({.name = name,
                                 .scenario = std::move(*scenario),
                                 .tolerance = scenario::DefaultTolerance(loaded.scenario)},
                                loaded, golden);
    ++ensemble.plays;
    Findings broken = BrokenIn(play, name);
    if (!broken.empty()) ++ensemble.plays_broken;
    Append(ensemble.broken, std::move(broken));
    Append(ensemble.differences, std::move(play.differs));
    if (!play.comparison) continue;
    const auto offsets = OffsetsOf(*play.comparison, golden);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (!offsets[i] || !offsets_here[i]) continue;
      const auto widen = [&](grammar::Tick moved, double& spread_ms) {
        spread_ms = std::max(spread_ms, Milliseconds(moved, here.ticks_per_second));
      };
      widen(offsets[i]->begin - offsets_here[i]->begin, ensemble.spreads[i].begin_ms);
      widen(offsets[i]->end - offsets_here[i]->end, ensemble.spreads[i].end_ms);
    }
  }
  return ensemble;
}

void KeepSpreads(const Ensemble& ensemble, truth::Golden& golden) {
  golden.ensemble_plays = ensemble.plays;
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    if (golden.events[i].spread == ensemble.spreads[i]) continue;
    golden.events[i].spread = ensemble.spreads[i];
    golden.events[i].as_written.clear();
  }
}

TransformedPlay Play(const TransformedScenario& there, const episode::LoadedRun& original,
                     const truth::Golden& here) {
  TransformedPlay play;
  episode::RunResult run = episode::RunScenario(there.scenario, original.program);
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    play.failed = {{.reason = there.name + ": the simulation failed",
                    .details = there.name + ": " + episode::StatusText(run) + "\n"}};
    return play;
  }
  if (there.rename_back) there.rename_back(run.timeline);
  LeaveOutOthers(original.scenario.scene, run.timeline);
  play.claims = JudgeClaims(original, run.timeline);
  play.comparison = truth::Compare(here, run.timeline, there.tolerance);
  if (!play.comparison->Agrees())
    play.differs = {{.reason = fmt::format("{}: {} of {} events differ", there.name,
                                           play.comparison->Differing().size(),
                                           play.comparison->pairings.size()),
                     .details = "recognised after '" + there.name + "', expected as without it:\n" +
                                truth::DifferenceText(*play.comparison, "")}};
  return play;
}

Findings BrokenIn(const TransformedPlay& play, const std::string& name) {
  Findings findings = play.failed;
  for (Finding& finding : ClaimFindings(play.claims))
    findings.push_back({.exit_code = finding.exit_code,
                        .reason = name + ": " + finding.reason,
                        .details = name + ": " + finding.details});
  return findings;
}

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
