// SPDX-License-Identifier: Apache-2.0
// The only thing that writes goldens. It runs the scenario itself, so that what is accepted is what
// this build recognises now, and refuses when that is not what was shown. Tested by
// tests/program/golden_workflow_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "harness/base/base/exit_code.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/suite/check/run_suite.h"

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

// What there is to accept. Reads files only: the pending ones are from `check`; recordings are
// judged again. Tested by tests/program/golden_workflow_test.cc

/// One thing to review.
struct Review {
  std::string id;
  std::string kind;  ///< "new", "changed", "same", "engines", "picture", "unreadable", "orphan"
  std::string text = {};  ///< events of a new scenario, differences, errors; several lines or empty
  std::string fingerprint = {};  ///< of the pending golden; lets `accept` take nothing else
  std::vector<std::string> files =
      {};  ///< of a picture: golden, new, difference; of an orphan: what to remove
  std::string contradicts = {};  ///< the claims that the pending golden contradicts, or empty
  std::string grammar = {};      ///< `--grammar` of a recording, or empty
};

/// Without patterns all that is pending. `grammar` is of recordings, or empty.
tl::expected<std::vector<Review>, NoSelection> Reviews(const std::vector<std::string>& patterns,
                                                       const std::string& grammar,
                                                       const std::string& root);

/// Each with the next step.
std::string ReviewsText(const std::vector<Review>& reviews);
/// {"pending": [{"scenario", "kind", "fingerprint", "files", "text"}]}
nlohmann::ordered_json ReviewsJson(const std::vector<Review>& reviews);

}  // namespace prehend::suite
