// SPDX-License-Identifier: Apache-2.0
// Which roles labels have, in which they are compared; children that are told.
#include <fmt/ranges.h>

#include <algorithm>

#include "tests/harness/exchange/labels/labels_stage.h"

namespace prehend::exchange::of_labels {
namespace {

TEST_F(Labels, OfSeveralChildrenTheFirstCountsAndTheOthersAreTold) {
  const auto map =
      Map("tiers:\n  right: {hand: right_hand}\n  things: {role: object, of: right}\n"
          "labels:\n  hold: {event: grasping}\n");
  const auto read = [&](const std::string& rows) {
    const auto file = ReadLabels(
        File("a.csv", "begin_s,end_s,label,tier\n1,3,hold,right\n1,2,cup,things\n" + rows));
    const auto reading = LabelReading::Of({*file}, &*map, kEvents);
    EXPECT_EQ(Text(TruthOf(reading)), "grasping(right_hand, cup) 100..300; ");
    const std::string& said = reading->warnings();
    return said.substr(std::min(said.find("a.csv"), said.size()), said.find('\n'));
  };
  EXPECT_EQ(read(""), "");
  EXPECT_EQ(read("2,3,cup,things\n"), "") << "the same";
  EXPECT_TRUE(read("2,3,jar,things\n")
                  .starts_with("a.csv:4:5: warning: 'jar' is left out: a label of 'right' has one "
                               "object, and the first counts"))
      << read("2,3,jar,things\n");
  EXPECT_TRUE(read("2,2.5,jar,things\n2.5,3,can,things\n")
                  .starts_with("a.csv:4:7: warning: 2 labels of child tiers are left out: a"))
      << read("2,2.5,jar,things\n2.5,3,can,things\n");
}

TEST_F(Labels, ColumnsThatAreCalledAsRolesAreRoles) {
  const auto read = [&](const std::string& table, const std::string& map_text) {
    std::optional<LabelMap> map;
    if (!map_text.empty()) map = Map(map_text).value();
    const auto file = ReadLabels(File("a.csv", "begin_s,end_s," + table),
                                 map ? map->csv : CsvReading{.role_names = RolesOf(kEvents)});
    if (!file) return grammar::Format(file.error());
    const auto reading = LabelReading::Of({*file}, map ? &*map : nullptr, kEvents);
    if (!reading) return grammar::Format(reading.error());
    const auto truth = reading->Truth(0, {kHand, kCup, kTable}, 100, 1000);
    if (!truth) return truth.error().front().message + "; " + truth.error().front().hint;
    return Text(*truth) + reading->warnings();
  };
  const std::string both = "grasping(right_hand, cup) 100..200; ",
                    hold = "labels: {hold: {event: grasping}}\n";
  EXPECT_EQ(read("event,hand,object,a\n1,2,grasping,right_hand,cup,\n", ""), both);
  EXPECT_EQ(read("label,hand,object\n1,2,grasping(hand=right_hand),,cup\n", ""), both);
  EXPECT_EQ(read("label,Hand,object\n1,2,hold,right_hand,cup\n", hold), both);
  EXPECT_EQ(read("event,hand,object\n1,2,grasping,right_hand,cop\n", ""),
            "the recording has no entity 'cop'; did you mean 'cup'?");
  EXPECT_EQ(
      read("label,hand,object\n1,2,hold,right_hand,red\n", hold + "columns: {object: ignore}\n"),
      "grasping(right_hand) 100..200; ");
  EXPECT_EQ(read("label,hand,object\n1,2,hold,right,cup\n",
                 hold + "tiers: {right: {hand: right_hand}}\n"),
            both)
      << "one column is role and tier, and the map says what it holds";
  const std::string said = read("event,hand,objct\n1,2,grasping,right_hand,cup\n", "");
  EXPECT_TRUE(said.starts_with("grasping(right_hand) 100..200; ")) << said;
  EXPECT_NE(said.find("a.csv:1:1: warning: the column 'objct' is not read"), std::string::npos);
  EXPECT_NE(said.find("did you mean 'object'?"), std::string::npos) << said;
}

TEST_F(Labels, TicksAreOnlyOfWhatIsFound) {
  EXPECT_EQ(Problem("a.jsonl", "{\"event\": \"x\", \"begin_tick\": 1, \"end_tick\": 2}\n"),
            "a.jsonl:1:1: error: end_tick: ticks are read only of what is --found; wanted end_s, "
            "in seconds");
  EXPECT_EQ(Read("a.jsonl", "{\"event\": \"x\", \"begin_s\": 1, \"end_s\": 2}\n"), "1..2 x; ");
}

// No label of such an event fails to name what its labels would name.
TEST_F(Labels, AnEventWithoutLabelsHasTheRolesThatItsLabelsWouldHave) {
  const auto roles = [&](const std::string& map_text, const std::string& rows) {
    const auto map = Map(map_text);
    if (!map) return grammar::Format(map.error());
    const auto file = ReadLabels(File("a.csv", "begin_s,end_s,label,tier,noun\n" + rows), map->csv);
    const auto reading = LabelReading::Of({*file}, &*map, kEvents);
    if (!reading) return grammar::Format(reading.error());
    const auto compared = reading->compared().find("reaching");
    return compared == reading->compared().end()
               ? "none"
               : fmt::format("{}", fmt::join(compared->second, " "));
  };
  const std::string labels =
      "labels:\n  reach: {event: reaching}\n  hold: {event: grasping, object: cup}\n";
  const std::string hands = "tiers:\n  right: {hand: right_hand}\n  left: {hand: left_hand}\n";
  for (const char* rows : {"", "1,2,hold,right,\n", "1,2,hold,left,cup\n"}) {
    EXPECT_EQ(roles(hands + "  notes: ignore\n" + labels, rows), "hand") << rows;
    EXPECT_EQ(roles("columns: {object: noun}\n" + hands + labels, rows), "hand object") << rows;
    EXPECT_EQ(roles(hands + labels + "  look: {event: reaching, object: cup}\n", rows), "hand");
    EXPECT_EQ(roles(hands + "  table: {object: table}\n" + labels, rows), "");
    EXPECT_EQ(roles(hands + "  things: {role: object, of: right}\n" + labels, rows), "hand");
    EXPECT_EQ(roles("tiers:\n  right: {hand: right_hand}\n  left: ignore\n"
                    "  things: {role: object, of: right}\n" +
                        labels,
                    rows),
              "hand object");
  }
  EXPECT_EQ(roles("columns: {hand: noun}\n" + labels, "1,2,hold,,\n"), "") << "none fills it";
  EXPECT_EQ(roles("columns: {hand: noun}\n" + labels, "1,2,hold,,right_hand\n"), "hand");
  EXPECT_EQ(roles(labels, ""), "");
  EXPECT_EQ(roles(hands + labels, "1,2,reach,right,\n"), "hand") << "as its label";
}

}  // namespace
}  // namespace prehend::exchange::of_labels
