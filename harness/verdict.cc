// SPDX-License-Identifier: Apache-2.0
// See verdict.h. Tested by tests/harness/verdict_test.cc
#include "harness/verdict.h"

#include <algorithm>
#include <nlohmann/json.hpp>

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
  }
  return "";
}

Json ToJson(const ScenarioVerdict& verdict) {
  Json pictures = Json::array();
  for (const ReportedPicture& picture : verdict.pictures) {
    pictures.push_back({{"file", picture.file}, {"caption", picture.caption}});
  }
  return {{"scenario", verdict.scenario},
          {"verdict", Name(verdict.verdict)},
          {"exit_code", static_cast<int>(verdict.exit_code)},
          {"reason", verdict.reason},
          {"details", verdict.details},
          {"headroom", verdict.headroom},
          {"command", verdict.command},
          {"shows", verdict.shows},
          {"state_hash", verdict.state_hash},
          {"ticks", verdict.ticks},
          {"seconds", verdict.seconds},
          {"pictures", std::move(pictures)},
          {"timeline_svg", verdict.timeline_svg}};
}

ScenarioVerdict VerdictFromJson(const Json& json) {
  ScenarioVerdict verdict{.scenario = json.at("scenario"), .shows = json.at("shows")};
  for (const Verdict candidate : {Verdict::kPassed, Verdict::kFailed, Verdict::kPending}) {
    if (json.at("verdict") == Name(candidate)) verdict.verdict = candidate;
  }
  verdict.exit_code = static_cast<ExitCode>(json.at("exit_code").get<int>());
  verdict.reason = json.at("reason");
  verdict.details = json.at("details");
  verdict.headroom = json.at("headroom");
  verdict.command = json.at("command");
  verdict.state_hash = json.at("state_hash");
  verdict.ticks = json.at("ticks");
  verdict.seconds = json.at("seconds");
  for (const Json& picture : json.at("pictures")) {
    verdict.pictures.push_back({.file = picture.at("file"), .caption = picture.at("caption")});
  }
  verdict.timeline_svg = json.at("timeline_svg");
  return verdict;
}

Tally Count(const std::vector<ScenarioVerdict>& verdicts) {
  const auto count = [&](Verdict wanted) {
    return static_cast<int>(
        std::count_if(verdicts.begin(), verdicts.end(),
                      [&](const ScenarioVerdict& verdict) { return verdict.verdict == wanted; }));
  };
  return {.passed = count(Verdict::kPassed),
          .failed = count(Verdict::kFailed),
          .pending = count(Verdict::kPending)};
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
