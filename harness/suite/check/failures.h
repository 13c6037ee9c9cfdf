// SPDX-License-Identifier: Apache-2.0
// Demonstrations of robots that failed, grouped by what went wrong first. Tested by
// tests/program/failed_demonstrations.py
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/suite/check/verdict.h"

namespace prehend::suite {

struct FailedTake {
  std::string scenario;  ///< ScenarioVerdict::scenario
  double at_s = 0;
  std::string command;  ///< asks why; or ""
};

/// The first cause of several.
struct Failure {
  std::string because;
  std::vector<FailedTake> takes;
};

struct Failures {
  std::size_t demonstrations = 0, failed = 0;
  std::vector<Failure> groups;  ///< the most frequent first
};

Failures FailuresOf(const std::vector<ScenarioVerdict>& verdicts);

/// "3 of 20 demonstrations failed:" and some lines for each cause, or "".
std::string FailuresText(const Failures& failures);

/// Keys in docs/robot-demonstrations.md.
nlohmann::ordered_json FailuresJson(const Failures& failures);

}  // namespace prehend::suite
