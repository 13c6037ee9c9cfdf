// SPDX-License-Identifier: Apache-2.0
// See harness/judge/judge_transforms.h. Tested by tests/harness/transform/transform_test.cc
#include "harness/judge/judge_transforms.h"

#include <fmt/format.h>

#include <algorithm>
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

Findings JudgeTransform(const CheckedRun& checked, const Golden& here, Transform transform) {
  const auto there = Transformed(checked.loaded.scenario, transform);
  if (!there) return {};
  const std::string name(NameOf(transform));
  RunResult run = RunScenario(*there, checked.loaded.program);
  if (run.status.kind != physics::RunStatus::Kind::kCompleted)
    return {{.reason = name + ": the simulation failed",
             .details = name + ": " + StatusText(run) + "\n"}};
  DropEventsOfAdded(checked.loaded.scenario, *there, run.timeline);
  const Comparison comparison = Compare(here, run.timeline, DefaultTolerance(*there));
  if (comparison.Agrees()) return {};
  return {{.reason = fmt::format("{}: {} of {} events differ", name, comparison.Differing().size(),
                                 comparison.pairings.size()),
           .details = "recognised after '" + name + "', expected as without it:\n" +
                      DifferenceText(comparison, "")}};
}

}  // namespace

Findings JudgeTransforms(const CheckedRun& checked, const Golden& here,
                         const std::vector<Transform>& transforms) {
  Findings findings;
  for (const Transform transform : transforms)
    Append(findings, JudgeTransform(checked, here, transform));
  return findings;
}

}  // namespace prehend::harness
