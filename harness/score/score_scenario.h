// SPDX-License-Identifier: Apache-2.0
// One scenario, played once and segmented by several grammars, beside what truly happened.
// Tested by tests/program/score_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/read_result.h"
#include "harness/score/score.h"

namespace prehend::harness {

struct ScoreRequest {
  std::string scenario_file;
  std::string id;
  std::string root;
  std::vector<std::string> grammars;  ///< names or paths
  std::vector<std::string> events;    ///< only these are judged; none: all that the oracle defines
};

/// One judged episode per grammar, all with the same truth: a grammar that is silent about a kind
/// of event, or misspells it, has missed what happened. Without value: what cannot be read
/// (`bad_input`), or why the run did not complete.
ReadResult<std::vector<score::EpisodeToScore>> EpisodesToScore(const ScoreRequest& request,
                                                               bool& bad_input);

}  // namespace prehend::harness
