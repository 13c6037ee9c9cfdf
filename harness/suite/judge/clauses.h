// SPDX-License-Identifier: Apache-2.0
// The clauses of a grammar's rules as they are written, so that a changed one can be named and put
// back. Tested by tests/harness/suite/judge/clauses_test.cc
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::suite {

/// Of a rule, a condition, a law, a definition: "transporting(..)" has "transporting roles",
/// "transporting outside", "transporting drawn"; of a law "NAME law" is all that it demands. A
/// parameter is one by itself: "far" is "2 cm".
struct Clause {
  std::string name;  ///< of the rule, and the clause's first word; a second such clause: ".. 2"
  std::string text;  ///< without comments, one space where there were some
  std::size_t begin = 0, end = 0;  ///< in the file
};

/// In their order. A rule begins at the left margin; its clauses are indented as its first one is,
/// and go on where a line is indented further.
std::vector<Clause> ClausesOf(std::string_view grammar);

/// The file with this clause as it was: another text, none, or one again. "" without its rule.
std::string WithClause(std::string_view grammar, const std::string& name, const std::string& text);

/// "lost `putting_down(hand, object)`", "gained ..", "`>= 2 cm` -> `>= 5 cm`": what lies between
/// the words that both begin and end with.
std::string ClauseChangeText(std::string_view before, std::string_view after);

}  // namespace prehend::suite
