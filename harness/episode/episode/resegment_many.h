// SPDX-License-Identifier: Apache-2.0
// Many episodes, segmented again on all cores. Tested by
// tests/program/episodes_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"
#include "harness/episode/run/run_text.h"

namespace prehend::episode {

struct ResegmentRequest {
  std::string root;
  GrammarChoice choice;
  bool compare = false;  ///< with what was recognised when it was recorded
  bool replay = false;   ///< read every tick, and check the state hash
  int jobs = 1;
};

struct Resegmented {
  EpisodeName episode;
  RunHeading heading;
  RunResult run;            ///< without its frames
  std::string differences;  ///< lines "- event" (only recorded) and "+ event" (only now)
  std::string warnings;
  std::string problem;        ///< empty, or why it could not be read or segmented
  bool nothing_left = false;  ///< no event of the grammar can be recognised in it
  bool finished = false;      ///< its recording was not cut off
};

/// One result per episode, in their order.
std::vector<Resegmented> ResegmentAll(const std::vector<EpisodeName>& episodes,
                                      const ResegmentRequest& request);

}  // namespace prehend::episode
