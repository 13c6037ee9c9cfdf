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
            "d.txt:2:9: error: 'x' takes 0..9, a..z or '.', found '!'\n"
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

// A row that is wrong is a row: the drawing is not said to have none.
TEST(ReadDrawings, ARowWithoutItsEndIsNamedAlone) {
  EXPECT_EQ(Said("cup x |01\n"),
            "d.txt:1:10: error: expected '|' at the end of the row\n"
            "  cup x |01\n"
            "           ^\n");
  EXPECT_EQ(Said("cup x 01\n"),
            "d.txt:1:1: error: expected a row, found 'cup x 01'\n"
            "  cup x 01\n"
            "  ^\n"
            "  hint: a row has its columns between bars: cup on table |####....|\n");
}

struct Impossible {
  const char* rows;
  const char* said;
};

TEST(ReadDrawings, WhatCannotBeIsRefused) {
  const std::string cast = "entities hand:Hand drum:Fixed door:Jointed anna:Person\n";
  const Impossible cases[] = {
      {"hand holds drum |.3x.|",
       "2:20: 'holds' takes 0..3 or '.', found 'x'; 'hand' has 3 sensor sets"},
      {"hand grip |.zz.|", "2:13: 'grip' takes 0..9, a, '#' or '.', found 'z'"},
      {"door joint |0kl.|", "2:15: 'joint' takes 0..9, a..k or '.', found 'l'"},
      {"drum shakes |.22.|", "2:15: 'shakes' takes '#' or '.', found '2'"},
      {"hand presses drum |.#..|", "2:21: 'presses' takes 0..9, a..z or '.', found '#'"},
      {"drum joint |0123|", "2:6: only a Jointed thing is open or closed, and 'drum' is a Fixed"},
      {"hand looks drum |.##.|",
       "2:6: only a person, a head or a camera looks, and 'hand' is a "
       "Hand"},
      {"drum z |0000|\nhand z |0000|\ndrum z |9999|",
       "4:9: 'drum z' and 'drum z' of line 2 cannot both be so at once"},
      {"door joint |0123|\ndoor percent |0123|",
       "3:15: 'door percent' and 'door joint' of line 2 cannot both be so at once"},
      {"drum circles door |..1.|\ndrum y |0123|",
       "3:9: 'drum y' and 'drum circles door' of line 2 cannot both be so at once"},
      {"door on drum |.##.|\ndrum beside door |..##|",
       "3:21: 'drum beside door' and 'door on drum' of line 2 cannot both be so at once"},
      {"anna looks drum |.##.|\nanna looks door |..##|",
       "3:20: 'anna looks door' and 'anna looks drum' of line 2 cannot both be so at once"},
  };
  for (const Impossible& one : cases) {
    Diagnostics diagnostics;
    EXPECT_TRUE(ReadDrawings({"d.txt", cast + one.rows + "\n"}, diagnostics).empty()) << one.rows;
    ASSERT_EQ(diagnostics.size(), 1U) << one.rows;
    const Diagnostic& found = diagnostics[0];
    EXPECT_EQ(std::to_string(found.place.line) + ":" + std::to_string(found.place.column) + ": " +
                  found.message + (found.hint.empty() ? "" : "; " + found.hint),
              one.said);
  }
}

TEST(ReadDrawings, AnEntityMayHaveFurtherClasses) {
  Diagnostics diagnostics;
  const auto drawings = ReadDrawings(
      {"d.txt", "entities knife:Movable:is=Knife+Tool:1kg saw:Fixed:is=Thing\nknife x |01|\n"},
      diagnostics);
  ASSERT_EQ(drawings.size(), 1U) << Format(diagnostics);
  const std::vector<EntityInfo>& all = drawings[0].entity_table;
  EXPECT_EQ(all[0].classes,
            (std::vector<std::string>{"Movable", "Thing", "Entity", "Knife", "Tool"}));
  EXPECT_EQ(all[0].mass_kg, 1);
  EXPECT_EQ(all[1].classes, (std::vector<std::string>{"Fixed", "Thing", "Entity"}));
  EXPECT_EQ(Said("entities drum:Fixed:is=Bell+Hand\ndrum x |01|\n"),
            "d.txt:1:29: error: 'Hand' is built in, and 'drum' is a Fixed\n"
            "  entities drum:Fixed:is=Bell+Hand\n"
            "                              ^\n"
            "  hint: write it before 'is=' instead: drum:Hand\n");
  EXPECT_EQ(Said("entities spot:Region:is=Abstract+Spot\nspot x |01|\n"), "");
  EXPECT_EQ(Said("entities knife:Movable/Knife\nknife x |01|\n"),
            "d.txt:1:16: error: 'Movable/Knife' is no name of a class\n"
            "  entities knife:Movable/Knife\n"
            "                 ^\n"
            "  hint: for example: knife:Movable, or with classes of its own "
            "knife:Movable:is=Knife+Tool\n"
            "d.txt:2:1: error: nobody is called 'knife'\n"
            "  knife x |01|\n"
            "  ^\n"
            "  hint: the line 'entities' names all\n");
  for (const auto& [details, column] :
       {std::pair("is=", "27"), std::pair("is=Knife+", "33"), std::pair("is=Knife+2nd", "33")}) {
    const std::string said =
        Said(std::string("entities knife:Movable:") + details + "\nknife x |01|\n");
    EXPECT_TRUE(said.starts_with(std::string("d.txt:1:") + column + ": error: '")) << said;
    EXPECT_NE(said.find("is no name of a class"), std::string::npos) << said;
  }
  EXPECT_NE(Said("entities knife:Movable:Knife\nknife x |01|\n").find("further classes (is="),
            std::string::npos);
}

TEST(ReadDrawings, WhatIsSaidOfDifferentMomentsOrThingsIsNoContradiction) {
  EXPECT_EQ(Said("entities hand:Hand cup:Movable table:Fixed anna:Person door:Door\n"
                 "cup on table |##..|\ncup beside table |..##|\nhand holds cup |..22|\n"
                 "hand palm cup |...#|\nhand presses cup |..9a|\nanna looks cup |##..|\n"
                 "anna looks hand |..##|\ndoor joint |0k..|\nhand grip |.a#.|\n"),
            "");
}

// However a pair is drawn, it is one touch.
TEST(ReadDrawings, TheRowsOfAPairAreOneTouch) {
  Diagnostics diagnostics;
  const auto drawings = ReadDrawings(
      {"d.txt", "hand presses cup |9|\nhand palm cup |#|\ncup on hand |#|\nhand holds cup |1|\n"},
      diagnostics);
  ASSERT_EQ(Format(diagnostics), "");
  DrawnFrames frames(drawings[0]);
  const Frame frame = frames.At(0);
  ASSERT_EQ(frame.touches.size(), 1U);
  EXPECT_EQ(frame.touches[0].normal_force_n, 9);
  EXPECT_EQ(frame.touches[0].sensor_sets, 0b101U);
  EXPECT_EQ(frame.touches[0].up_on_a, -1);
  EXPECT_EQ(frame.touches[0].up_on_b, 1);
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
            "5: 'high' has 1 role, found 2\n"
            "6: expected an event with its roles, found 'high'\n"
            "7: grammar 'g' has no law 'it'\n");
}

// Below `--`, what can never be recognised is a mistake, not a difference.
TEST(ReadDrawings, ExpectedEventsCanBe) {
  const GrammarText file{
      "d.txt",
      "entities hand:Hand drum:Fixed cup:Movable\ncup x |01|\n--\ntap(drum,  hand) |..|\n"
      "tap(hand, hand) |..|\nnear(drum,cup) |..|\nnear(cup, drum) |..|\ntap(cup, drum) |..|\n"
      "tap(hand, drum) |..|\ntap( hand,drum ) |..|\n"};
  Diagnostics diagnostics;
  const auto drawings = ReadDrawings(file, diagnostics);
  ASSERT_EQ(drawings.size(), 1U) << Format(diagnostics);
  const auto program = testing::CompileText(
      "grammar g\nevent tap(hand: Hand, object: Thing) while touching(hand, object)\n"
      "symmetric event near(a: Thing, b: Thing) while distance(a, b) < 1 cm");
  std::string said;
  for (const Diagnostic& one : CheckExpected(*program, drawings[0], file)) {
    said += std::to_string(one.place.line) + ": " + one.message +
            (one.hint.empty() ? "\n" : "; " + one.hint + "\n");
  }
  EXPECT_EQ(said,
            "4: 'drum' is never 'hand' of 'tap', which takes a Hand; did you mean 'tap(hand, "
            "drum)'?\n"
            "5: 'hand' cannot have two roles of 'tap'\n"
            "6: the first two roles of 'near' stand in alphabetical order; did you mean 'near(cup, "
            "drum)'?\n"
            "8: 'cup' is never 'hand' of 'tap', which takes a Hand; that can be hand\n"
            "10: 'tap(hand, drum)' is drawn in line 9 already; all its intervals stand in one "
            "row\n");
}

TEST(ReadDrawings, TheHintSaysHowAnEntityHasSeveralClasses) {
  const auto program = testing::CompileText(
      "grammar g\nevent cut(hand: Hand, knife: Knife, object: Thing) while touching(hand, knife)\n"
      "  and touching(knife, object)");
  const auto said = [&](const std::string& entities) {
    const GrammarText file{"d.txt", "entities hand:Hand " + entities +
                                        "\nhand x |01|\n--\ncut(hand, knife, bread) |..|\n"};
    Diagnostics diagnostics;
    const auto drawings = ReadDrawings(file, diagnostics);
    EXPECT_EQ(drawings.size(), 1U) << Format(diagnostics);
    std::string hints;
    for (const Diagnostic& one : CheckExpected(*program, drawings.at(0), file)) hints += one.hint;
    return hints;
  };
  const std::string several = "the drawing has none; an entity may be of several classes: ";
  EXPECT_EQ(said("knife:Movable bread:Movable"), several + "knife:Movable:is=Knife");
  EXPECT_EQ(said("knife:Knife bread:Bread"), several + "bread:Movable:is=Bread");
  EXPECT_EQ(said("knife:Movable:is=Knife bread:Movable:is=Bread"), "");
  EXPECT_EQ(said("knife:Movable:is=Knife bread:Person"), "that can be knife");
}

}  // namespace
}  // namespace prehend::grammar
