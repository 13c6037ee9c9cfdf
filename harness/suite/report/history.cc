// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/report/history.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

using PastJson = nlohmann::json;

/// Of a scenario: [VERDICT, SECONDS, MARGIN or null].
PastJson AsJson(const PastVerdict& past) {
  return {past.verdict, std::round(1000 * past.seconds) / 1000,
          past.margin_ms ? PastJson(std::round(100 * *past.margin_ms) / 100) : PastJson()};
}

}  // namespace

PastRun RunOf(const std::vector<ScenarioVerdict>& verdicts, const std::string& date,
              const std::string& commit) {
  PastRun run{.date = date, .commit = commit, .scenarios = {}};
  for (const ScenarioVerdict& verdict : verdicts) {
    if (verdict.verdict == Verdict::kUnchanged) continue;  // it was not run
    PastVerdict& past = run.scenarios[verdict.scenario];
    past = {.verdict = std::string(Name(verdict.verdict)), .seconds = verdict.seconds};
    const truth::Margin* smallest =
        verdict.has_golden && verdict.comparison ? verdict.comparison->Smallest() : nullptr;
    if (smallest)
      past.margin_ms =
          truth::MillisecondsOf(smallest->Left(), verdict.comparison->ticks_per_second);
  }
  return run;
}

std::vector<PastRun> ReadHistory(const std::string& file) {
  std::vector<PastRun> runs;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return runs;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    try {
      const auto json = PastJson::parse(line);
      PastRun run{.date = json.at("date"), .commit = json.at("commit"), .scenarios = {}};
      for (const auto& [scenario, past] : json.at("scenarios").items()) {
        PastVerdict& one = run.scenarios[scenario];
        one = {.verdict = past.at(0), .seconds = past.at(1)};
        if (!past.at(2).is_null()) one.margin_ms = past.at(2).get<double>();
      }
      runs.push_back(std::move(run));
    } catch (const PastJson::exception&) {
    }
  }
  if (runs.size() > kMostPastRuns)
    runs.erase(runs.begin(), runs.end() - static_cast<std::ptrdiff_t>(kMostPastRuns));
  return runs;
}

std::string WriteHistory(const std::string& file, const std::vector<PastRun>& runs) {
  std::string text;
  for (std::size_t i = runs.size() - std::min(runs.size(), kMostPastRuns); i < runs.size(); ++i) {
    PastJson scenarios = PastJson::object();
    for (const auto& [scenario, past] : runs[i].scenarios) scenarios[scenario] = AsJson(past);
    const PastJson line = {
        {"date", runs[i].date}, {"commit", runs[i].commit}, {"scenarios", std::move(scenarios)}};
    text += line.dump(-1, ' ', false, PastJson::error_handler_t::replace) + "\n";
  }
  return WriteTextFile(file, text);
}

nlohmann::json HistoryJson(const std::vector<PastRun>& runs) {
  PastJson names = PastJson::array(), of = PastJson::object();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    names.push_back(runs[i].date + (runs[i].commit.empty() ? "" : ", " + runs[i].commit));
    for (const auto& [scenario, past] : runs[i].scenarios) {
      PastJson one = AsJson(past);
      one.insert(one.begin(), i);
      of[scenario].push_back(std::move(one));
    }
  }
  return {{"runs", std::move(names)}, {"of", std::move(of)}};
}

}  // namespace prehend::suite
