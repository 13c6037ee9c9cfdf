// SPDX-License-Identifier: Apache-2.0
// The numbers of a grammar's text that decide whether and when something happens: what a value is
// compared with, the size of a region, how long, how soon, how many. Neither windows of time nor
// numbers that an event carries. docs/explain.md has the list. Tested by
// tests/harness/show/explain/decisive_test.cc
#pragma once

#include <functional>
#include <set>
#include <string>

#include "grammar/language/ast.h"

namespace prehend::grammar::ast {

struct FoundLimit {
  std::string owner;   ///< the rule or definition in which it stands
  std::string clause;  ///< "(speed(cup) > 0.1 m/s)", "lasting 0.3 s"
  Place place;
  bool is_count = false;   ///< of `at least`, or of sensor sets
  Expr* number = nullptr;  ///< a quantity, or a name: of a parameter, or of something else
};

/// In the order of the text. `defines`: names of definitions, to which numbers are given; those of
/// signals are windows.
std::vector<FoundLimit> FindLimits(File& file, const std::set<std::string>& defines);

/// Every expression of the definition, outermost only.
void EachExpr(Definition& definition, const std::function<void(Expr&)>& look);
/// What the expression calls or names, however deep.
void AddNames(const Expr& expr, std::set<std::string>& names);

}  // namespace prehend::grammar::ast
