// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "harness/base/base/quoting.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {

std::string_view Name(Verdict verdict) {
  constexpr std::array<std::string_view, 5> kNames = {"passed", "failed", "pending", "flaky",
                                                      "unchanged"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

bool LeadsToReview(const ScenarioVerdict& verdict) {
  return verdict.verdict == Verdict::kPending &&
         verdict.command.starts_with(CommandText({"review"}));
}

std::string_view CommandLabel(const ScenarioVerdict& verdict) {
  return LeadsToReview(verdict) ? "next" : "again";
}

std::string MarginText(const ScenarioVerdict& verdict) {
  const bool good = verdict.verdict == Verdict::kPassed || verdict.verdict == Verdict::kUnchanged;
  return good && verdict.has_golden && verdict.comparison ? MarginText(*verdict.comparison) : "";
}

std::string NotesText(const ScenarioVerdict& verdict) {
  const std::size_t count = verdict.notes.size();
  if (count == 0) return "";
  if (verdict.exit_code == ExitCode::kAgrees)
    return count == 1 ? "1 note on its steps is in the report\n"
                      : fmt::format("{} notes on its steps are in the report\n", count);
  std::string text;
  for (const std::string& note : verdict.notes) text += note + "\n";
  return text;
}

FirstPlace WhereToLook(const ScenarioVerdict& verdict) {
  FirstPlace where{.file = verdict.file};
  const auto claim =
      std::ranges::find(verdict.claims, truth::kContradicted, &truth::ClaimVerdict::says);
  if (!verdict.errors.empty()) {
    where = {verdict.errors.front().file, std::max(1, verdict.errors.front().place.line)};
  } else if (claim != verdict.claims.end()) {
    const std::size_t colon = claim->place.rfind(':');
    where = {claim->place.substr(0, colon), std::stoi(claim->place.substr(colon + 1))};
  }
  std::error_code error;
  const std::string below = std::filesystem::current_path(error).string() + "/";
  if (where.file.starts_with(below)) where.file.erase(0, below.size());
  return where;
}

std::string DetailsText(const ScenarioVerdict& verdict) {
  return Format(verdict.errors) + verdict.details;
}

namespace {

bool SameOutcome(const ScenarioVerdict& a, const ScenarioVerdict& b) {
  const auto outcome = [](const ScenarioVerdict& v) {
    return std::tie(v.verdict, v.exit_code, v.reason, v.details, v.state_hash, v.ticks);
  };
  return outcome(a) == outcome(b) && Format(a.errors) == Format(b.errors);
}

/// "flaky: of 5 runs 3 passed, 2 failed; 2 different state hashes"
std::string FlakyReason(const std::vector<ScenarioVerdict>& runs) {
  std::map<std::string_view, int> counts;
  std::set<std::string> hashes;
  for (const ScenarioVerdict& run : runs) {
    ++counts[Name(run.verdict)];
    if (!run.state_hash.empty()) hashes.insert(run.state_hash);
  }
  std::string reason = fmt::format("flaky: of {} runs", runs.size());
  const char* separator = " ";
  for (const auto& [name, count] : counts)
    reason += fmt::format("{}{} {}", std::exchange(separator, ", "), count, name);
  if (hashes.size() > 1) reason += fmt::format("; {} different state hashes", hashes.size());
  return reason;
}

/// Events may agree while a picture does not, and the other way round.
ScenarioVerdict JudgedByPictures(ScenarioVerdict verdict) {
  if (verdict.picture_differences.empty()) return verdict;
  verdict.details += verdict.picture_differences;
  if (verdict.verdict == Verdict::kFailed || verdict.verdict == Verdict::kFlaky) return verdict;
  verdict.verdict = Verdict::kFailed;
  verdict.exit_code = ExitCode::kDiffers;
  verdict.reason = "a picture differs from its golden";
  return verdict;
}

}  // namespace

ScenarioVerdict MergeRepeats(const std::vector<ScenarioVerdict>& runs) {
  // The text of a failed run is of more use than that of a passed one.
  const auto failed = std::ranges::find_if(
      runs, [](const ScenarioVerdict& run) { return run.verdict != Verdict::kPassed; });
  ScenarioVerdict merged = failed == runs.end() ? runs.front() : *failed;
  for (const ScenarioVerdict& run : runs) {
    merged.seconds = std::max(merged.seconds, run.seconds);
    merged.peak_memory_kib = std::max(merged.peak_memory_kib, run.peak_memory_kib);
    if (!run.picture_differences.empty()) merged.picture_differences = run.picture_differences;
    if (!run.pictures.empty()) merged.pictures = run.pictures;
    if (!run.replay.empty()) merged.replay = run.replay;
    if (!run.drawn_differences.empty()) merged.drawn_differences = run.drawn_differences;
    if (!run.explained.events.empty()) merged.explained = run.explained;
    if (!run.not_recorded.empty()) merged.not_recorded = run.not_recorded;
  }
  const bool agree = std::ranges::all_of(
      runs, [&](const ScenarioVerdict& run) { return SameOutcome(run, runs.front()); });
  if (agree) return JudgedByPictures(std::move(merged));
  merged.verdict = Verdict::kFlaky;
  if (merged.exit_code != ExitCode::kFailure) merged.exit_code = ExitCode::kDiffers;
  merged.reason = FlakyReason(runs);
  return JudgedByPictures(std::move(merged));
}

Tally Count(const std::vector<ScenarioVerdict>& verdicts) {
  const auto count = [&](Verdict wanted) {
    return static_cast<int>(std::ranges::count(verdicts, wanted, &ScenarioVerdict::verdict));
  };
  return {.passed = count(Verdict::kPassed),
          .failed = count(Verdict::kFailed) + count(Verdict::kFlaky),
          .pending = count(Verdict::kPending),
          .unchanged = count(Verdict::kUnchanged)};
}

std::string SmallestMarginText(const std::vector<ScenarioVerdict>& verdicts) {
  double smallest_ms = std::numeric_limits<double>::infinity();
  std::string text;
  for (const ScenarioVerdict& verdict : verdicts) {
    if (!verdict.has_golden || !verdict.comparison) continue;
    const grammar::Tick ticks_per_second = verdict.comparison->ticks_per_second;
    for (const truth::Margin& margin : verdict.comparison->margins) {
      const double left_ms = truth::MillisecondsOf(margin.Left(), ticks_per_second);
      if (margin.offset == 0 || left_ms >= smallest_ms) continue;
      smallest_ms = left_ms;
      text = fmt::format("smallest margin: {:.1f} of {:.1f} ms left at {} of {}", left_ms,
                         truth::MillisecondsOf(margin.tolerance, ticks_per_second),
                         margin.Boundary(), verdict.scenario);
    }
  }
  return text;
}

ExitCode WorstOf(const std::vector<ScenarioVerdict>& verdicts) {
  if (verdicts.empty()) return ExitCode::kNothing;
  for (const ExitCode code :
       {ExitCode::kFailure, ExitCode::kBadInput, ExitCode::kDiffers, ExitCode::kPending}) {
    if (std::ranges::count(verdicts, code, &ScenarioVerdict::exit_code) > 0) return code;
  }
  return ExitCode::kAgrees;
}

}  // namespace prehend::suite
