// SPDX-License-Identifier: Apache-2.0
// See harness/suite/check/judges.h. Tested by tests/harness/suite/check/check_scenario_test.cc
#include "harness/suite/check/judges.h"

#include <filesystem>

#include "harness/episode/run/run_text.h"
#include "harness/suite/check/attribute_run.h"
#include "harness/suite/judge/accept_golden.h"
#include "harness/suite/judge/compare_engines.h"
#include "harness/suite/judge/judge_claims.h"
#include "harness/suite/judge/judge_invariants.h"
#include "harness/suite/judge/judge_recording.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

/// Draws into the folder of the report, and compares with the goldens of pictures.
Findings Pictures(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  if (!request.pictures || !show::CanDrawPictures()) return {};
  const scenario::Scenario& scenario = checked.run.loaded.scenario;
  const fs::path folder = fs::path(request.report_folder) / "pictures" / scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const show::GoldenOf none = [](const std::string&) { return std::string(); };
  const show::PictureResult drawn =
      show::DrawAndCompare(scenario, checked.run.result, folder.string(),
                           request.in_project ? GoldensOf(request.id, request.root) : none);
  checked.pictures =
      ComparisonsOf(request.id, drawn.pictures, request.root, !request.leave_nothing_behind);
  for (const show::WrittenPicture& picture : drawn.pictures) {
    const fs::path file = fs::path(picture.file).lexically_relative(request.report_folder);
    checked.verdict.pictures.push_back({.file = file.generic_string(), .caption = picture.caption});
  }
  if (drawn.error.empty()) return {};
  return {{.exit_code = ExitCode::kFailure,
           .reason = "no picture",
           .details = "no picture: " + drawn.error + "\n"}};
}

Findings EndOfRun(CheckedEpisode& checked) {
  return {{ExitCode::kFailure, "the simulation failed",
           episode::StatusText(checked.run.result) + "\n"}};
}

Findings Invariants(CheckedEpisode& checked) { return JudgeInvariants(checked.run); }

Findings Laws(CheckedEpisode& checked) { return JudgeLaws(checked.run); }

Findings Claims(CheckedEpisode& checked) {
  checked.verdict.claims = JudgeClaims(checked.run.loaded, checked.run.result.timeline);
  return ClaimFindings(checked.verdict.claims);
}

Findings GoldenAndTruth(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  std::optional<truth::Golden> golden;
  if (request.in_project) {
    auto read = truth::GoldenFiles(request.root).ReadGoldenOf(request.id);
    if (!read) return {{ExitCode::kBadInput, "the golden cannot be read", "", read.error()}};
    golden = std::move(*read);
  }
  checked.golden = CompareWithGolden(golden, checked.run);
  ScenarioVerdict& verdict = checked.verdict;
  if (checked.golden->Differs())
    AttributeRun(request, checked.run, *golden, checked.golden->comparison, verdict);
  verdict.has_golden = checked.golden->has_golden;
  verdict.comparison = checked.golden->comparison;
  verdict.drawings = checked.run.result.drawings;
  return JudgeGolden(*checked.golden, checked.run, verdict.cause);
}

/// A planar scenario has the same events in both engines.
Findings OtherEngine(CheckedEpisode& checked) {
  if (!checked.request.IsPlayed()) return {};
  const CheckedRun& run = checked.run;
  const scenario::Scenario& scenario = run.loaded.scenario;
  const auto compared = CompareEngines(scenario, run.loaded.program, run.result.timeline);
  std::string& difference = checked.engine_difference;
  if (compared) difference = EngineDifferenceText(scenario, *compared, run.explain);
  if (difference.empty()) return {};
  const std::string engine = NameOf(compared->other);
  if (compared->run.status.kind != physics::RunStatus::Kind::kCompleted)
    return {{ExitCode::kFailure, "the simulation failed in " + engine, difference}};
  return {{ExitCode::kDiffers, engine + " does not lead to the same events",
           difference + kUntilEnginesAgree + "\n"}};
}

Findings UnrequestedPictures(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  if (!request.in_project || !request.IsAsItsFileSays()) return {};
  return JudgeUnrequestedPictures(request.id, checked.run.loaded.scenario.pictures.size(),
                                  request.root, AcceptPicturesCommand(request.id));
}

Findings GoldenBesideRecording(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  ScenarioVerdict& verdict = checked.verdict;
  Result<JudgedRecording> judged = JudgeSegmented(
      std::move(*checked.recording), GoldenOfRecording(request, &checked.run.loaded.scenario));
  if (!judged) return {{ExitCode::kBadInput, "cannot be read", "", judged.error()}};
  verdict.ticks = judged->segmented.end;
  verdict.has_golden = judged->golden.has_value();
  verdict.drawings = truth::EventDrawings(*judged->segmented.program);
  Findings findings;
  if (!judged->golden) {
    findings.push_back({ExitCode::kPending, "no golden yet", ""});
  } else if (!judged->comparison.Agrees()) {
    findings.push_back(DifferenceFinding(judged->comparison, verdict.explain));
    findings.back().details += OtherGrammarText(*judged);
  }
  if (!findings.empty()) findings.back().details += judged->segmented.missing.warnings;
  if (verdict.has_golden)
    verdict.attributions =
        AttributeDifferences(judged->comparison, {.other_changes = OptionsOf(request.changes)},
                             [](const auto&) { return std::optional<truth::Comparison>(); });
  verdict.comparison = std::move(judged->comparison);
  return findings;
}

constexpr Judge kOfRuns[] = {Pictures,    Invariants,         Laws, Claims, GoldenAndTruth,
                             OtherEngine, UnrequestedPictures};
constexpr Judge kOfFailedRuns[] = {Pictures, EndOfRun};
constexpr Judge kOfRecordings[] = {GoldenBesideRecording};

}  // namespace

std::string GoldenOfRecording(const CheckRequest& request, const scenario::Scenario* scenario) {
  if (!request.episode.number) return GoldenBeside(request.episode.file);
  return scenario ? (fs::path(request.root) / GoldenBeside(scenario->file)).string() : "";
}

std::span<const Judge> JudgesOf(const CheckedEpisode& checked) {
  if (checked.recording) return kOfRecordings;
  if (checked.IsComplete()) return kOfRuns;
  return kOfFailedRuns;
}

}  // namespace prehend::suite
