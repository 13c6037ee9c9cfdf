// SPDX-License-Identifier: Apache-2.0
// What the judges of a check are given, and what they return: a run with what it was played from,
// and findings. Tested by tests/harness/suite/judge/judge_golden_test.cc
#pragma once

#include <iterator>
#include <string>
#include <vector>

#include "harness/base/base/exit_code.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::suite {

/// Something that a check found wrong.
struct Finding {
  ExitCode exit_code = ExitCode::kDiffers;  ///< of a check that finds only this
  std::string reason;                       ///< one line
  std::string details;                      ///< several lines or empty
  grammar::Diagnostics errors = {};         ///< of its input
};
using Findings = std::vector<Finding>;

inline void Append(Findings& findings, Findings more) {
  findings.insert(findings.end(), std::make_move_iterator(more.begin()),
                  std::make_move_iterator(more.end()));
}

/// A scenario that was played to its end, and recorded.
struct CheckedRun {
  std::string id;          ///< skill/name
  bool in_project = true;  ///< below scenarios/, so that it may have a golden
  episode::LoadedRun loaded;
  episode::RunResult result;
  std::string explain;  ///< the command that asks about its events
};

}  // namespace prehend::suite
