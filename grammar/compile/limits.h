// SPDX-License-Identifier: Apache-2.0
// One rule of a compiled grammar, compiled again by itself with another number: what would have
// been with it. Tested by tests/harness/show/explain/decisive_test.cc
#pragma once

#include "grammar/base/quantity.h"
#include "grammar/compile/compile.h"

namespace prehend::grammar {

/// A number that decides whether a rule's events happen, in the text of the rule or of what it
/// uses.
struct Limit {
  std::string owner;   ///< the rule or definition in which it stands
  std::string clause;  ///< "distance(hand, cup) <= 0.2 m", "lasting 0.3 s"
  std::string file;
  Place place;
  Quantity value;
  bool is_count = false;
};

/// Those on which the rule depends, in the order of the files.
std::vector<Limit> LimitsOf(const Program& program, const std::string& rule);

/// The rule and what it uses, with this value in place of the limit. Null where it does not
/// compile.
std::shared_ptr<const Program> WithLimit(const Program& program, const std::string& rule,
                                         const Limit& limit, double value);

}  // namespace prehend::grammar
