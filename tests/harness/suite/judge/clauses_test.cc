// SPDX-License-Identifier: Apache-2.0
// Clauses are found, named and put back as they were.
#include <gtest/gtest.h>

#include <map>

#include "harness/suite/judge/judges.h"

namespace prehend::suite {
namespace {

constexpr const char* kClauses = R"(# Of hands.
grammar g
use contact
param far = 2 cm

event carrying(hand: Hand, object: Thing)  # what is up
  rest of grasping(hand, object)
  outside supported_by(object, any), putting_down(hand, object),
    picking_up(hand, object)
  requires a(hand)
  requires b(hand)
  drawn as phase "#112233"

define near(a: Thing, b: Thing) = distance(a, b) <= far
)";

std::map<std::string, std::string> Texts(std::string_view grammar) {
  std::map<std::string, std::string> texts;
  for (const Clause& clause : ClausesOf(grammar)) texts[clause.name] = clause.text;
  return texts;
}

TEST(Clauses, EachHasItsName) {
  EXPECT_EQ(Texts(kClauses),
            (std::map<std::string, std::string>{
                {"far", "2 cm"},
                {"carrying roles", "carrying(hand: Hand, object: Thing)"},
                {"carrying rest", "rest of grasping(hand, object)"},
                {"carrying outside",
                 "outside supported_by(object, any), putting_down(hand, object), "
                 "picking_up(hand, object)"},
                {"carrying requires", "requires a(hand)"},
                {"carrying requires 2", "requires b(hand)"},
                {"carrying drawn", "drawn as phase \"#112233\""},
                {"near roles", "near(a: Thing, b: Thing) = distance(a, b) <= far"}}));
}

TEST(Clauses, PutBack) {
  const std::string less =
      WithClause(kClauses, "carrying outside", "outside supported_by(object, any)");
  EXPECT_EQ(Texts(less)["carrying outside"], "outside supported_by(object, any)");
  EXPECT_EQ(Texts(less)["carrying requires"], "requires a(hand)");
  const std::string gone = WithClause(kClauses, "carrying rest", "");
  EXPECT_FALSE(Texts(gone).contains("carrying rest"));
  EXPECT_EQ(Texts(WithClause(gone, "carrying rest", "rest of grasping(hand, object)")),
            Texts(kClauses));
  const std::string roles = WithClause(kClauses, "near roles", "near(a: Hand) = true");
  EXPECT_NE(roles.find("\ndefine near(a: Hand) = true\n"), std::string::npos) << roles;
  EXPECT_EQ(WithClause(kClauses, "lifting while", "while x"), "");
}

TEST(Clauses, TheChangeIsWhatLiesBetween) {
  EXPECT_EQ(ClauseChangeText("outside a(x), b(x, y), c", "outside a(x), c"), "lost `b(x, y)`");
  EXPECT_EQ(ClauseChangeText("while a", "while a and not b(c)"), "gained `not b(c)`");
  EXPECT_EQ(ClauseChangeText("while in(a, b) and c", "while in(b, a) and c"),
            "`in(a, b)` -> `in(b, a)`");
  EXPECT_EQ(ClauseChangeText("lasting 0.3 s", "lasting 0.5 s"), "`0.3` -> `0.5`");
  EXPECT_EQ(ClauseChangeText("", "requires a"), "gained `requires a`");
  EXPECT_EQ(ClauseChangeText("during in(a, b)", "during not in(a, b)"),
            "`in(a, b)` -> `not in(a, b)`");
  EXPECT_EQ(ClauseChangeText("outside a(x, y), b", "outside a(x, y), b, c(x)"), "gained `c(x)`");
  EXPECT_EQ(ClauseChangeText("while a and not b and c", "while a and b and c"), "`not b` -> `b`");
}

TEST(Clauses, OfALawAndOfWhatIsSymmetric) {
  EXPECT_EQ(Texts("symmetric event touch(a: Thing, b: Thing)\n  while near(a, b)\n\n"
                  "law apart(a: Thing)\n  up(a), down(a),\n    held(a)\n  do not overlap\n"),
            (std::map<std::string, std::string>{
                {"touch roles", "touch(a: Thing, b: Thing)"},
                {"touch while", "while near(a, b)"},
                {"apart roles", "apart(a: Thing)"},
                {"apart law", "up(a), down(a), held(a) do not overlap"}}));
}

}  // namespace
}  // namespace prehend::suite
