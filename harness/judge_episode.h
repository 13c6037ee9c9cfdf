// SPDX-License-Identifier: Apache-2.0
// One scenario, played once and segmented by several grammars, beside what truly happened.
// Tested by tests/house/score_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/read_result.h"
#include "harness/score/score.h"

namespace prehend::harness {

struct JudgeRequest {
  std::string scenario_file;
  std::string id;
  std::string root;
  std::vector<std::string> grammars;  ///< names or paths
};

/// One judged episode per grammar, of the kinds of event that the oracle defines and the grammar prints: a grammar is
/// not blamed for events it does not speak of. Without value: what cannot be read, or why the run did not complete.
ReadResult<std::vector<score::JudgedEpisode>> JudgeEpisode(const JudgeRequest& request);

}  // namespace prehend::harness
