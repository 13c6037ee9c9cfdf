// SPDX-License-Identifier: Apache-2.0
// What a grammar asks for and a recording does not have. Tested by
// tests/program/missing_facts_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

struct MissingFacts {
  /// Warnings of events that need facts which the recording does not have, and of entities of which
  /// it never says where they are; or "".
  std::string warnings;
  /// Of these, those of events that are never recognised, a line and its hint each.
  std::vector<std::string> never;
  bool nothing_left = false;  ///< no event is left that could be recognised
};

MissingFacts FindMissingFacts(Recording& episode, const grammar::Program& program);

}  // namespace prehend::episode
