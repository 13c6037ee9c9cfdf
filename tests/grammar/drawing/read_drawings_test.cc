// SPDX-License-Identifier: Apache-2.0
// What is said about wrong drawings; tests/grammar/corpus/ and the pages have right ones.
#include <gtest/gtest.h>

#include "grammar/drawing/drawn_episode.h"
#include "grammar/watch_drawing.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

std::string Said(const std::string& text) {
  Diagnostics diagnostics;
  const auto drawings = ReadDrawings({"d.txt", text}, diagnostics);
  EXPECT_EQ(drawings.empty(), !diagnostics.empty());
  return Format(diagnostics);
}

TEST(ReadDrawings, SaysWhatIsWrongWhere) {
  EXPECT_EQ(Said("# only a comment\n"),
            "d.txt:2:1: error: nothing is drawn in this file\n"
            "  hint: entities hand:Hand cup:Movable, then rows\n");
  EXPECT_EQ(Said("entities hand:Hand cup\ncup x |01|\n"),
            "d.txt:1:20: error: expected NAME:CLASS, found 'cup'\n"
            "  entities hand:Hand cup\n"
            "                     ^\n"
            "  hint: for example: cup:Movable\n"
            "d.txt:2:1: error: nobody is called 'cup'\n"
            "  cup x |01|\n"
            "  ^\n"
            "  hint: the line 'entities' names all\n");
  EXPECT_EQ(Said("entities hand:Hand\n== next\nhand x |01|\n"),
            "d.txt:1:1: error: this drawing has no row of facts\n"
            "  entities hand:Hand\n"
            "  ^\n"
            "  hint: for example: cup on table |####....|\n");
  EXPECT_EQ(Said("cup x |0123|\ncup z |012|\n"),
            "d.txt:2:8: error: this row has 3 columns, the first one has 4\n"
            "  cup z |012|\n"
            "         ^\n"
            "  hint: all rows of a drawing are equally long\n");
  EXPECT_EQ(Said("hand hold cup |..22|\n"),
            "d.txt:1:6: error: unknown fact 'hold'\n"
            "  hand hold cup |..22|\n"
            "       ^\n"
            "  hint: did you mean 'holds'?\n");
  EXPECT_EQ(Said("cup x |01|\ncup x |0!|\n"),
            "d.txt:2:9: error: expected 0..9, a..z, '#' or '.' in a row of facts\n"
            "  cup x |0!|\n"
            "          ^\n");
  EXPECT_EQ(Said("cup x |0123|\n--\ngrasping(hand, cup) |.==.|\n"),
            "d.txt:3:23: error: an event goes on here that has not begun\n"
            "  grasping(hand, cup) |.==.|\n"
            "                        ^\n"
            "  hint: '[' begins an event, '=' goes on\n");
  EXPECT_EQ(Said("cup x |01|\ncup grip |01|\ncup on cup |##|\ncup on |##|\ncup x hand |01|\n"
                 "cup x 0123\ncup x |01\n"),
            "d.txt:2:5: error: only a hand has a grip and holds, and 'cup' is a Movable\n"
            "  cup grip |01|\n"
            "      ^\n"
            "d.txt:3:5: error: 'on' is said of two, and both are 'cup'\n"
            "  cup on cup |##|\n"
            "      ^\n"
            "d.txt:4:5: error: 'on' is said of two\n"
            "  cup on |##|\n"
            "      ^\n"
            "  hint: for example: cup on table |...|\n"
            "d.txt:5:5: error: 'x' is said of one\n"
            "  cup x hand |01|\n"
            "      ^\n"
            "  hint: for example: cup x |...|\n"
            "d.txt:6:1: error: expected a row, found 'cup x 0123'\n"
            "  cup x 0123\n"
            "  ^\n"
            "  hint: a row has its columns between bars: cup on table |####....|\n"
            "d.txt:7:10: error: expected '|' at the end of the row\n"
            "  cup x |01\n"
            "           ^\n");
}

TEST(ReadDrawings, AFileMayHaveManyWithOrWithoutTitles) {
  Diagnostics diagnostics;
  const auto drawings =
      ReadDrawings({"d.txt",
                    "entities cup:Movable\ncup x |01|\n--\nentities a:Thing b:Thing\n"
                    "a beside b |##|\n== third\ncup x |0|\n"},
                   diagnostics);
  EXPECT_EQ(Format(diagnostics), "");
  ASSERT_EQ(drawings.size(), 3U);
  EXPECT_EQ(drawings[0].entity_table.size(), 1U);
  EXPECT_TRUE(drawings[0].has_expected);
  EXPECT_EQ(drawings[1].line, 4);
  EXPECT_FALSE(drawings[1].has_expected);
  EXPECT_EQ(drawings[2].title, "third");
  EXPECT_EQ(drawings[2].entity_table.size(), 3U);
}

TEST(ReadDrawings, ExpectedRowsNameEventsAndEntities) {
  const GrammarText file{"d.txt",
                         "cup x |01|\n--\nlow(cup) |..|\nhigh(cap) |..|\nhigh(cup, hand) |..|\n"
                         "high |..|\nviolated it |..|\n"};
  Diagnostics diagnostics;
  const auto drawings = ReadDrawings(file, diagnostics);
  ASSERT_EQ(drawings.size(), 1U);
  const auto program =
      testing::CompileText("grammar g\nevent high(x: Thing) while height(x) > 1 cm");
  std::string said;
  for (const Diagnostic& one : CheckExpected(*program, drawings[0], file))
    said += std::to_string(one.place.line) + ": " + one.message + "\n";
  EXPECT_EQ(said,
            "3: grammar 'g' has no event 'low'\n4: nobody is called 'cap'\n"
            "5: 'high' has 1 roles, found 2\n"
            "6: expected an event with its roles, found 'high'\n"
            "7: grammar 'g' has no law 'it'\n");
}

}  // namespace
}  // namespace prehend::grammar
