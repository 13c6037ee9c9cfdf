// SPDX-License-Identifier: Apache-2.0
// See harness/check/verdict.h. Tested by tests/harness/check/verdict_test.cc
#include "harness/check/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace prehend::harness {

using Json = nlohmann::ordered_json;

std::string_view Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return "passed";
    case Verdict::kFailed:
      return "failed";
    case Verdict::kPending:
      return "pending";
    case Verdict::kFlaky:
      return "flaky";
    case Verdict::kUnchanged:
      return "unchanged";
  }
  return "";
}

std::string_view CommandLabel(const ScenarioVerdict& verdict) {
  return verdict.verdict == Verdict::kPending && verdict.command.starts_with("prehend review")
             ? "next"
             : "again";
}

Json ToJson(const ScenarioVerdict& verdict) {
  Json pictures = Json::array();
  for (const ReportedPicture& picture : verdict.pictures) {
    pictures.push_back({{"file", picture.file}, {"caption", picture.caption}});
  }
  Json boundaries = Json::array();
  for (const BoundaryRoom& room : verdict.boundaries) {
    boundaries.push_back({{"boundary", room.boundary},
                          {"offset_ms", room.offset_ms},
                          {"tolerance_ms", room.tolerance_ms}});
  }
  return {{"scenario", verdict.scenario},
          {"verdict", Name(verdict.verdict)},
          {"exit_code", static_cast<int>(verdict.exit_code)},
          {"reason", verdict.reason},
          {"details", verdict.details},
          {"differences", verdict.differences},
          {"relations", verdict.relations},
          {"blame", verdict.blame},
          {"headroom", verdict.headroom},
          {"boundaries", std::move(boundaries)},
          {"command", verdict.command},
          {"shows", verdict.shows},
          {"state_hash", verdict.state_hash},
          {"ticks", verdict.ticks},
          {"seconds", verdict.seconds},
          {"peak_memory_kib", verdict.peak_memory_kib},
          {"inputs", verdict.inputs},
          {"pictures", std::move(pictures)},
          {"picture_differences", verdict.picture_differences},
          {"timeline_svg", verdict.timeline_svg}};
}

ScenarioVerdict VerdictFromJson(const Json& json) {
  ScenarioVerdict verdict{.scenario = json.at("scenario"), .shows = json.at("shows")};
  for (const Verdict candidate : {Verdict::kPassed, Verdict::kFailed, Verdict::kPending,
                                  Verdict::kFlaky, Verdict::kUnchanged}) {
    if (json.at("verdict") == Name(candidate)) verdict.verdict = candidate;
  }
  verdict.exit_code = static_cast<ExitCode>(json.at("exit_code").get<int>());
  verdict.reason = json.at("reason");
  verdict.details = json.at("details");
  verdict.differences = json.at("differences");
  verdict.relations = json.at("relations");
  verdict.blame = json.at("blame");
  verdict.headroom = json.at("headroom");
  for (const Json& room : json.at("boundaries")) {
    verdict.boundaries.push_back(
        {room.at("boundary"), room.at("offset_ms"), room.at("tolerance_ms")});
  }
  verdict.command = json.at("command");
  verdict.state_hash = json.at("state_hash");
  verdict.ticks = json.at("ticks");
  verdict.seconds = json.at("seconds");
  verdict.peak_memory_kib = json.at("peak_memory_kib");
  verdict.inputs = json.at("inputs").get<FileHashes>();
  for (const Json& picture : json.at("pictures")) {
    verdict.pictures.push_back({.file = picture.at("file"), .caption = picture.at("caption")});
  }
  verdict.picture_differences = json.at("picture_differences");
  verdict.timeline_svg = json.at("timeline_svg");
  return verdict;
}

namespace {

bool SaySame(const ScenarioVerdict& a, const ScenarioVerdict& b) {
  const auto said = [](const ScenarioVerdict& v) {
    return std::tie(v.verdict, v.exit_code, v.reason, v.details, v.state_hash, v.ticks);
  };
  return said(a) == said(b);
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
  for (const auto& [name, count] : counts) {
    reason += fmt::format("{}{} {}", std::exchange(separator, ", "), count, name);
  }
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
  // What a failed run said is of more use than what a passed one did.
  const auto telling = std::ranges::find_if(
      runs, [](const ScenarioVerdict& run) { return run.verdict != Verdict::kPassed; });
  ScenarioVerdict merged = telling == runs.end() ? runs.front() : *telling;
  for (const ScenarioVerdict& run : runs) {
    merged.seconds = std::max(merged.seconds, run.seconds);
    merged.peak_memory_kib = std::max(merged.peak_memory_kib, run.peak_memory_kib);
    if (!run.picture_differences.empty()) merged.picture_differences = run.picture_differences;
    if (!run.pictures.empty()) merged.pictures = run.pictures;
  }
  const bool agree = std::ranges::all_of(
      runs, [&](const ScenarioVerdict& run) { return SaySame(run, runs.front()); });
  if (agree) return JudgedByPictures(std::move(merged));
  merged.verdict = Verdict::kFlaky;
  if (merged.exit_code != ExitCode::kFailure) merged.exit_code = ExitCode::kDiffers;
  merged.reason = FlakyReason(runs);
  return JudgedByPictures(std::move(merged));
}

Tally Count(const std::vector<ScenarioVerdict>& verdicts) {
  const auto count = [&](Verdict wanted) {
    return static_cast<int>(
        std::count_if(verdicts.begin(), verdicts.end(),
                      [&](const ScenarioVerdict& verdict) { return verdict.verdict == wanted; }));
  };
  return {.passed = count(Verdict::kPassed),
          .failed = count(Verdict::kFailed) + count(Verdict::kFlaky),
          .pending = count(Verdict::kPending),
          .unchanged = count(Verdict::kUnchanged)};
}

std::string LeastHeadroomText(const std::vector<ScenarioVerdict>& verdicts) {
  const auto left = [](const BoundaryRoom& room) {
    return room.tolerance_ms - std::abs(room.offset_ms);
  };
  const ScenarioVerdict* whose = nullptr;
  const BoundaryRoom* least = nullptr;
  for (const ScenarioVerdict& verdict : verdicts) {
    for (const BoundaryRoom& room : verdict.boundaries) {
      if (room.offset_ms == 0 || (least && left(*least) <= left(room))) continue;
      whose = &verdict;
      least = &room;
    }
  }
  if (!least) return "";
  return fmt::format("least headroom: {:.1f} of {:.1f} ms are left at {} of {}", left(*least),
                     least->tolerance_ms, least->boundary, whose->scenario);
}

ExitCode WorstOf(const std::vector<ScenarioVerdict>& verdicts) {
  if (verdicts.empty()) return ExitCode::kNothing;
  for (const ExitCode code :
       {ExitCode::kFailure, ExitCode::kBadInput, ExitCode::kDiffers, ExitCode::kPending}) {
    const bool found =
        std::any_of(verdicts.begin(), verdicts.end(),
                    [&](const ScenarioVerdict& verdict) { return verdict.exit_code == code; });
    if (found) return code;
  }
  return ExitCode::kAgrees;
}

}  // namespace prehend::harness
