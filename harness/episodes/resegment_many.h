// SPDX-License-Identifier: Apache-2.0
// Many episodes of many files, segmented again on all cores. Tested by
// tests/program/episodes_test.cc
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/episodes/load_episode.h"

namespace prehend::harness::episodes {

/// One episode of a file.
struct EpisodeName {
  std::string file;
  std::int64_t id = 0;
  std::string scenario;
};

/// The episodes of these files, in their order. `only`: a number, a scenario, or a glob of
/// scenarios; empty: all. Reports files that cannot be read, and a file without episodes; not that
/// nothing matches.
Result<std::vector<EpisodeName>> SelectEpisodes(const std::vector<std::string>& files,
                                                const std::string& only);

struct ResegmentRequest {
  std::string root;
  GrammarChoice choice;
  bool compare = false;  ///< with what was recognised when it was recorded
  bool replay = false;   ///< read every tick, and check the state hash
  int jobs = 1;
};

struct Resegmented {
  EpisodeName episode;
  std::string table;        ///< as `prehend run` prints it
  std::string json;         ///< the same as a JSON object
  std::string differences;  ///< lines "- event" (only recorded) and "+ event" (only now)
  std::string warnings;
  std::string problem;  ///< empty, or why it could not be read or segmented
  bool completed = false;
  bool finished = false;  ///< its recording was not cut off
};

/// One result per episode, in their order.
std::vector<Resegmented> ResegmentAll(const std::vector<EpisodeName>& episodes,
                                      const ResegmentRequest& request);

}  // namespace prehend::harness::episodes
