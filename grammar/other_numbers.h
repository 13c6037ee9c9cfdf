// SPDX-License-Identifier: Apache-2.0
// One rule of a compiled grammar, compiled again by itself with another number: what would have
// been with it. Tested by tests/harness/show/explain/decisive_test.cc
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/quantity.h"

namespace prehend::grammar {

struct Program;  // grammar/program/program.h

/// A number that decides whether a rule's events happen, in the text of the rule or of what it
/// uses.
struct Limit {
  std::string owner;   ///< the rule or definition in which it stands
  std::string clause;  ///< "distance(hand, cup) <= 0.2 m", "lasting 0.3 s"
  std::string file;
  Place place;
  Quantity value;
  bool is_count = false;
  std::string param = {};  ///< whose value it is; empty: it stands there as a number
};

/// The texts are read once.
class OtherNumbers {
 public:
  OtherNumbers(const Program& program, const std::string& rule);
  ~OtherNumbers();

  /// Those on which the rule depends, in the order of the files.
  const std::vector<Limit>& limits() const;

  /// The rule and what it uses, with this value in place of the limit. Null where it does not
  /// compile.
  std::shared_ptr<const Program> With(std::size_t limit, double value);

  struct Trial {
    std::size_t limit = 0;
    double value = 0;
  };
  /// For each trial, the rules in which its limit stands, be it by a definition, as events of their
  /// own; and what they use, once for all: of that, nothing depends on the limit. An event of rule
  /// R is called "R~3" in trial 3. Null where one of them does not compile.
  std::shared_ptr<const Program> Side(std::span<const Trial> trials);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prehend::grammar
