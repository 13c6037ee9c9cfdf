// SPDX-License-Identifier: Apache-2.0
// See harness/judge/judge_transforms.h. Tested by tests/harness/transform/transform_test.cc
#include "harness/judge/judge_transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "grammar/contents.h"
#include "harness/golden/compare.h"
#include "harness/judge/judge_claims.h"
#include "harness/run/run_scenario.h"
#include "harness/run/run_text.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
namespace {

/// The names of an original, by those of what was made of it.
using Names = std::map<std::string, std::string>;

/// Without the events of those who were added, and with the names of the original.
grammar::Timeline AsInOriginal(const Names& names, const grammar::Program& program,
                               grammar::Timeline timeline) {
  std::set<std::string> symmetric;
  for (const grammar::EventSignature& signature : grammar::EventSignatures(program))
    if (signature.symmetric) symmetric.insert(signature.name);
  std::erase_if(timeline.events, [&](grammar::NamedEvent& event) {
    for (grammar::Role& role : event.roles) {
      if (IsAttribute(role)) continue;
      const auto original = names.find(role.value);
      if (original == names.end()) return true;
      role.value = original->second;
    }
    // The alphabet decides which of the two is named first.
    if (symmetric.contains(event.event) && event.roles[1].value < event.roles[0].value)
      std::swap(event.roles[0].value, event.roles[1].value);
    return false;
  });
  Sort(timeline);
  return timeline;
}

struct Play {
  Findings failed;                       ///< to come to its end
  std::vector<ClaimVerdict> claims;      ///< of what the scenario expects, here as there
  Findings differs;                      ///< from the golden
  std::optional<Comparison> comparison;  ///< of a play that came to its end
};

/// What is wrong with it whatever a golden says.
Findings BrokenIn(const Play& play, Transform transform) {
  const std::string name(NameOf(transform));
  Findings findings = play.failed;
  for (Finding& finding : ClaimFindings(play.claims))
    findings.push_back({.exit_code = finding.exit_code,
                        .reason = name + ": " + finding.reason,
                        .details = name + ": " + finding.details});
  return findings;
}

/// In other steps, physics is another approximation of the same motion.
constexpr double kToleranceAtOtherRate_s = 0.05;

/// In the ticks of what the transform made of the scenario.
grammar::Tick ToleranceAfter(Transform transform, const Scenario& here, const Scenario& there) {
  const int rate_hz = there.scene.world.rate_hz;
  return transform == Transform::kRate
             ? TickAt(kToleranceAtOtherRate_s, rate_hz)
             : DefaultTolerance(here) * rate_hz / here.scene.world.rate_hz;
}

/// Otherwise why the transform makes another story of the scenario.
tl::expected<Play, std::string> PlayAfter(Transform transform, const LoadedRun& loaded,
                                          const Golden& here) {
  const auto there = Transformed(loaded.scenario, transform);
  if (!there) return tl::unexpected(there.error());
  const std::string name(NameOf(transform));
  const RunResult run = RunScenario(there->scenario, loaded.program);
  if (run.status.kind != physics::RunStatus::Kind::kCompleted)
    return Play{.failed = {{.reason = name + ": the simulation failed",
                            .details = name + ": " + StatusText(run) + "\n"}},
                .claims = {},
                .differs = {},
                .comparison = {}};
  const grammar::Timeline timeline = AsInOriginal(there->names, *loaded.program, run.timeline);
  Play play{.failed = {},
            .claims = JudgeClaims(loaded, timeline),
            .differs = {},
            .comparison = Compare(here, timeline,
                                  ToleranceAfter(transform, loaded.scenario, there->scenario))};
  const Comparison& comparison = *play.comparison;
  if (!comparison.Agrees())
    play.differs = {
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
    Findings broken = BrokenIn(*play, transform);
    if (!broken.empty()) ++ensemble.plays_broken;
    Append(ensemble.broken, std::move(broken));
    Append(ensemble.differences, std::move(play->differs));
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

std::string TextOfNotCompared(const std::vector<TransformVerdict>& verdicts) {
  std::string text;
  for (const TransformVerdict& verdict : verdicts) {
    if (verdict.says == kNotApplied || verdict.says == kMayDiffer)
      text += fmt::format("{}: {}: {}\n", verdict.transform, verdict.says, verdict.why);
  }
  return text;
}

TransformJudgement JudgeTransforms(const CheckedRun& checked, const Golden& here,
                                   const std::vector<Transform>& transforms) {
  TransformJudgement judgement;
  const std::vector<ClaimVerdict> claims_here =
      JudgeClaims(checked.loaded, checked.result.timeline);
  for (const Transform transform : transforms) {
    TransformVerdict& verdict = judgement.verdicts.emplace_back(
        TransformVerdict{std::string(NameOf(transform)), kSameStory, ""});
    auto play = PlayAfter(transform, checked.loaded, here);
    if (!play) {
      verdict = {verdict.transform, kNotApplied, play.error()};
      continue;
    }
    // All but other names change rounding or the order of computations.
    const bool may_differ = !here.unsteady.empty() && transform != Transform::kRename;
    // A claim that does not hold here either says nothing of the transform.
    for (std::size_t i = play->claims.size(); i-- > 0;)
      if (IsContradicted(claims_here[i])) play->claims.erase(play->claims.begin() + i);
    Findings findings = BrokenIn(*play, transform);
    if (!may_differ) Append(findings, std::move(play->differs));
    if (!findings.empty()) {
      verdict = {verdict.transform, kOtherStory, findings.front().reason};
    } else if (!play->differs.empty()) {
      verdict = {verdict.transform, kMayDiffer, here.unsteady};
    }
    Append(judgement.findings, std::move(findings));
  }
  return judgement;
}

}  // namespace prehend::harness
