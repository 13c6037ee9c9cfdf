// SPDX-License-Identifier: Apache-2.0
// See harness/judge/judge_transforms.h. Tested by tests/harness/transform/transform_test.cc
#include "harness/judge/judge_transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "harness/golden/compare.h"
#include "harness/run/run_scenario.h"
#include "harness/run/run_text.h"

namespace prehend::harness {
namespace {

/// Without the events of what the transform added: the last bodies of `there`.
void DropEventsOfAdded(const Scenario& here, const Scenario& there, grammar::Timeline& timeline) {
  std::set<std::string> added;
  for (std::size_t i = here.scene.bodies.size(); i < there.scene.bodies.size(); ++i)
    added.insert(there.scene.bodies[i].name);
  std::erase_if(timeline.events, [&](const grammar::NamedEvent& event) {
    return std::ranges::any_of(
        event.roles, [&](const grammar::Role& role) { return added.contains(role.value); });
  });
}

struct Play {
  Findings findings;
  std::optional<Comparison> comparison;  ///< of a play that came to its end
};

/// Empty if the transform makes another story of the scenario.
std::optional<Play> PlayAfter(Transform transform, const LoadedRun& loaded, const Golden& here) {
  const auto there = Transformed(loaded.scenario, transform);
  if (!there) return std::nullopt;
  const std::string name(NameOf(transform));
  RunResult run = RunScenario(*there, loaded.program);
  if (run.status.kind != physics::RunStatus::Kind::kCompleted)
    return Play{.findings = {{.reason = name + ": the simulation failed",
                              .details = name + ": " + StatusText(run) + "\n"}},
                .comparison = {}};
  DropEventsOfAdded(loaded.scenario, *there, run.timeline);
  Play play{.findings = {}, .comparison = Compare(here, run.timeline, DefaultTolerance(*there))};
  const Comparison& comparison = *play.comparison;
  if (!comparison.Agrees())
    play.findings = {
        {.reason = fmt::format("{}: {} of {} events differ", name, comparison.Differing().size(),
                               comparison.pairings.size()),
         .details = "recognised after '" + name + "', expected as without it:\n" +
                    DifferenceText(comparison, "")}};
  return play;
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
std::vector<std::optional<Offset>> OffsetsOf(const Comparison& comparison, const Golden& golden) {
  std::vector<std::optional<Offset>> offsets(golden.events.size());
  for (const Pairing& pairing : comparison.pairings)
    if (pairing.expected && pairing.actual)
      offsets[pairing.golden_line] = {pairing.begin_offset, pairing.end_offset};
  return offsets;
}

}  // namespace

Ensemble PlayEnsemble(const LoadedRun& loaded, const grammar::Timeline& here,
                      const Golden& golden) {
  Ensemble ensemble;
  ensemble.spreads.resize(golden.events.size());
  const auto offsets_here =
      OffsetsOf(Compare(golden, here, DefaultTolerance(loaded.scenario)), golden);
  for (const Transform transform : EnsembleTransforms()) {
    auto play = PlayAfter(transform, loaded, golden);
    if (!play) continue;
    ++ensemble.plays;
    Append(ensemble.differences, std::move(play->findings));
    if (!play->comparison) continue;
    const auto offsets = OffsetsOf(*play->comparison, golden);
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

void KeepSpreads(const Ensemble& ensemble, Golden& golden) {
  golden.ensemble_plays = ensemble.plays;
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    if (golden.events[i].spread == ensemble.spreads[i]) continue;
    golden.events[i].spread = ensemble.spreads[i];
    golden.events[i].as_written.clear();
  }
}

Findings JudgeTransforms(const CheckedRun& checked, const Golden& here,
                         const std::vector<Transform>& transforms) {
  Findings findings;
  for (const Transform transform : transforms) {
    const bool may_differ =
        !here.unsteady.empty() && std::ranges::count(EnsembleTransforms(), transform) > 0;
    auto play = PlayAfter(transform, checked.loaded, here);
    if (play && !may_differ) Append(findings, std::move(play->findings));
  }
  return findings;
}

}  // namespace prehend::harness
