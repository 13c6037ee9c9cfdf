// SPDX-License-Identifier: Apache-2.0
// What a row of a drawing can say, of whom, and with which characters. docs/drawings.md lists it.
// Tested by tests/grammar/drawing/read_drawings_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::grammar {

struct DrawnFact {
  std::string name;
  bool of_two = false;          ///< "cup on table"
  int most = -1;                ///< its characters stand for 0 to this number; -1: for none
  bool marks = false;           ///< '#' may stand in it
  bool says_all_along = false;  ///< in each column: '.' is 0 there, else it says nothing

  bool Takes(char cell) const;
  bool Says(char cell) const { return says_all_along || cell != '.'; }
  /// "0..9, a..k or '.'"
  std::string Characters() const;
};

/// 0..9, then a = 10 .. z = 35; of any other character nothing.
std::optional<int> DrawnNumber(char cell);

/// What can be said of an entity; a hand has a fact for each of its sensor sets.
std::vector<DrawnFact> FactsOf(const EntityInfo& entity);

/// Why this can never be said of the entity; empty: it can.
std::string WhyNever(const DrawnFact& fact, const EntityInfo& entity);

/// "Movable", "Hand", "Person", ..: a class that entities have by themselves; others are one's own.
bool IsUsualClass(const std::string& name);

/// The values that the fact sets, named so that two facts that set the same one have the same name:
/// "cup x", "cup table lie". At most one row can do so in a column.
std::vector<std::string> ValuesSetBy(const DrawnFact& fact, const std::string& who,
                                     const std::string& whom);

}  // namespace prehend::grammar
