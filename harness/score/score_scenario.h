// SPDX-License-Identifier: Apache-2.0
// One scenario, simulated once and segmented by several grammars, each beside the true events.
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
  std::vector<std::string> events;    ///< only these are scored; empty: all that the oracle defines
};

/// One episode per grammar, all with the same truth: a grammar that does not define a kind of
/// event, or misspells it, has missed all such events. Without a value: an input that cannot be
/// read
/// (`bad_input`), or a run that did not complete.
ReadResult<std::vector<score::EpisodeToScore>> EpisodesToScore(const ScoreRequest& request,
                                                               bool& bad_input);

}  // namespace prehend::harness
