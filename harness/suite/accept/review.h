// SPDX-License-Identifier: Apache-2.0
// What there is to accept. Reads files only: the pending ones are from `check`; recordings are
// judged again. Tested by tests/program/golden_workflow_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "harness/suite/check/select_scenarios.h"

namespace prehend::suite {

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
