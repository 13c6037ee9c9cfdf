// SPDX-License-Identifier: Apache-2.0
// Which events cannot be recognised in an episode, because it has no facts of some kind: poses
// without touches, say. Tested by tests/grammar/never_recognised_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

/// What an episode has at all, in any frame.
struct FactsOfEpisode {
  bool touches = false;
  bool sensor_sets = false;
  bool grips = false;
  bool gazes = false;
  bool forces = false;
  bool orientations = false;  ///< something that can move does not stand upright and not turned

  void Add(const Frame& frame, const EntityTable& entities);
};

/// An event that asks for what the episode does not have.
struct NeverRecognised {
  std::string event;
  std::string file;
  Place place;
  std::string_view fact;  ///< "touches", "sensor sets", "closed grips", "gazes", "forces",
                          ///< "orientations"
};

/// In the order of the grammar. An event that is not among them may be recognised, or may not.
std::vector<NeverRecognised> FindNeverRecognised(const Program& program,
                                                 const FactsOfEpisode& facts);

}  // namespace prehend::grammar
