// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/diagnostic.h"

#include <gtest/gtest.h>

namespace prehend::grammar {
namespace {

TEST(Diagnostic, ShowsPlaceLineCaretAndHint) {
  const Diagnostic d = DiagnosticAt("a.grammar", "one\ntwo thre\nfour", {2, 5}, "no 'thre'",
                                    "did you mean 'three'?");
  EXPECT_EQ(
      Format(d),
      "a.grammar:2:5: error: no 'thre'\n  two thre\n      ^\n  hint: did you mean 'three'?\n");
}

TEST(Diagnostic, KeepsTabsUnderTabsAndCountsUtf8AsOneColumn) {
  EXPECT_EQ(Format(DiagnosticAt("f", "\t\xc3\xa9 x", {1, 5}, "m")),
            "f:1:5: error: m\n  \t\xc3\xa9 x\n  \t  ^\n");
}

TEST(Diagnostic, OfAWholeFileHasNoPlace) {
  EXPECT_EQ(Format(DiagnosticAt("f", "x", {}, "empty")), "f: error: empty\n");
}

TEST(Diagnostic, CutsLongLinesAroundTheCaret) {
  std::string text(10001, 'a');
  text[5000] = 'X';
  const std::string shown = Format(DiagnosticAt("f", text, {1, 5001}, "m"));
  EXPECT_LT(shown.size(), 300u);
  EXPECT_NE(shown.find("aX"), std::string::npos);
}

TEST(Diagnostic, SurvivesPlacesOutsideTheText) {
  EXPECT_EQ(Format(DiagnosticAt("f", "ab", {7, 9}, "m")), "f:7:9: error: m\n");
  EXPECT_EQ(Format(DiagnosticAt("f", "ab", {1, 99}, "m")), "f:1:99: error: m\n  ab\n    ^\n");
}

TEST(NearestName, FindsTypingMistakesOnly) {
  const std::vector<std::string> names = {"grasping", "reaching", "cm"};
  EXPECT_EQ(NearestName("graspin", names), "grasping");
  EXPECT_EQ(NearestName("raeching", names), "reaching");
  EXPECT_EQ(NearestName("Cup_QW", {"Cup_x", "Cup_qx", "Cup_qw"}), "Cup_qw");
  EXPECT_EQ(NearestName("mc", names), "") << "one swap, but of a name too short to tell";
  EXPECT_EQ(NearestName("tabel", {"table"}), "table");
  EXPECT_EQ(NearestName("pouring", names), "");
  EXPECT_EQ(NearestName("", names), "");
  const std::vector<std::string> events = {"contact", "sliding", "picking_up", "putting_down"};
  EXPECT_EQ(NearestName("slide", events), "sliding");
  EXPECT_EQ(NearestName("Slides", events), "sliding");
  EXPECT_EQ(NearestName("put_down", events), "putting_down");
  EXPECT_EQ(NearestName("pick", events), "") << "a word is missing";
  EXPECT_EQ(NearestName(std::string(1 << 20, 'x'), names), "");
}

}  // namespace
}  // namespace prehend::grammar
