// SPDX-License-Identifier: Apache-2.0
// One scenario, simulated once and segmented by several grammars, each beside the true events.
// Tested by tests/program/score_test.cc
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grammar/monitor.h"
#include "harness/base/base/result.h"
#include "harness/episode/run/episode_name.h"
#include "harness/measure/score/score.h"

namespace prehend::measure {

struct ScoreRequest {
  episode::EpisodeName episode;
  std::string id;
  std::string root;
  std::vector<std::string> grammars;  ///< names or paths
  std::vector<std::string> events;    ///< only these are scored; empty: all that the oracle defines
  grammar::Overrides settings = {};   ///< of parameters of all grammars
};

/// Why an episode cannot be scored.
struct ScoreFailure {
  grammar::Diagnostics diagnostics;
  bool is_bad_input = true;  ///< else the run did not complete
};

/// One episode per grammar, all with the same truth: a grammar that does not define a kind of
/// event, or misspells it, has missed all such events.
tl::expected<std::vector<EpisodeToScore>, ScoreFailure> EpisodesToScore(
    const ScoreRequest& request);

}  // namespace prehend::measure
