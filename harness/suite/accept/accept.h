// SPDX-License-Identifier: Apache-2.0
// The only thing that writes goldens. It runs the scenario itself, so that what is accepted is what
// this build recognises now, and refuses when that is not what was shown. Tested by
// tests/program/golden_workflow_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/base/base/exit_code.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"

namespace prehend::suite {

/// What a person says about it.
struct AcceptRequest {
  std::string root, today, reason;
  std::string grammar;               ///< of a recording: instead of the one that it names
  std::vector<std::string> derived;  ///< how the events follow from the definitions
  std::optional<std::string> reviewed, unsteady;
  bool exact = false;     ///< boundaries that moved within their tolerance are taken over
  bool pictures = false;  ///< they are accepted, not the events
};

struct AcceptOutcome {
  ExitCode code = ExitCode::kAgrees;
  std::string text;     ///< what changes, or what speaks against it; several lines
  std::string notes;    ///< on how it was played
  std::string problem;  ///< why nothing was accepted, or ""
};

/// One of the project. Errors are those of its files.
Result<AcceptOutcome> AcceptScenario(const episode::ScenarioFile& file,
                                     const AcceptRequest& request);

/// The golden of a recording lies beside it; nothing is simulated, so nothing is transformed.
Result<AcceptOutcome> AcceptRecording(const episode::EpisodeName& name,
                                      const AcceptRequest& request);

}  // namespace prehend::suite
