// SPDX-License-Identifier: Apache-2.0
// Whether a finished timeline keeps the laws of its grammar. Tested by
// tests/grammar/check_laws_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

/// One place where a law is broken.
struct LawViolation {
  const Law* law = nullptr;  ///< of the program
  Interval when;             ///< what is left uncovered; the subject; where the two overlap
  std::string what;          ///< "reaching(right_hand, milk) meets no grasping(right_hand, milk)"
};

/// Where the events of one episode break laws of the program: in the order of the laws, then of
/// time. The entity table says of what classes the entities are. Time grows with the square of the
/// number of events that a law names.
std::vector<LawViolation> CheckLaws(const Program& program, const EntityTable& entity_table,
                                    const Timeline& timeline);

}  // namespace prehend::grammar
