// SPDX-License-Identifier: Apache-2.0
// What became of each scenario in the last runs: a file with a line of JSON for each run. Tested by
// tests/harness/suite/report/history_test.cc
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/suite/check/verdict.h"

namespace prehend::suite {

inline constexpr std::size_t kMostPastRuns = 20;

struct PastVerdict {
  std::string verdict;
  double seconds = 0;
  std::optional<double> margin_ms;  ///< the smallest one; none if all boundaries are exact
};

struct PastRun {
  std::string date, commit;
  std::map<std::string, PastVerdict> scenarios;
};

PastRun RunOf(const std::vector<ScenarioVerdict>& verdicts, const std::string& date,
              const std::string& commit);

/// The last of them, the oldest first. Lines that are damaged are left out.
std::vector<PastRun> ReadHistory(const std::string& file);

/// Returns "" or what went wrong.
std::string WriteHistory(const std::string& file, const std::vector<PastRun>& runs);

/// For the script of the page: {"runs": [DATE, ..], "of": {SCENARIO: [[RUN, VERDICT, SECONDS,
/// MARGIN or null], ..]}}.
nlohmann::json HistoryJson(const std::vector<PastRun>& runs);

}  // namespace prehend::suite
