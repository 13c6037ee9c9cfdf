// SPDX-License-Identifier: Apache-2.0
// Labels by people: each format as its program writes it, what is wrong in it, and what the labels
// mean.
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <regex>
#include <set>

#include "harness/exchange/labels/read_truths.h"
#include "tests/harness/exchange/labels/labels_stage.h"

namespace prehend::exchange::of_labels {
namespace {

TEST_F(Labels, CsvHasItsColumnsByName) {
  EXPECT_EQ(Read("a.csv", "begin_s,end_s,label\n0.5,1.5,hold\n\n2,3,\"a, b\"\n"),
            "0.5..1.5 hold; 2..3 a, b; ");
  EXPECT_EQ(Read("a.csv", "Tier;Label;Start_ms;End_ms;note\nright;hold;500;1500;x\n"),
            "0.5..1.5 hold [right]; ");
  EXPECT_EQ(Read("a.csv", "onset\toffset\taction\n0\t1\thold\n0\t1\t\n"), "0..1 hold; ");
}

// As EPIC-KITCHENS, spreadsheets and others write it.
TEST_F(Labels, CsvHasClocksAndFramesToo) {
  EXPECT_EQ(Read("a.csv",
                 "start_timestamp,stop_timestamp,start_frame,stop_frame,verb,hand\n"
                 "00:01:02.50,01:00:03,3750,216180,take,left\n"),
            "62.5..3603 take [left]; ");
  EXPECT_EQ(Read("a.csv", "Start Time;End Time;Activity\n00:30.5;0:31;hold\n"), "30.5..31 hold; ");
  EXPECT_EQ(Problem("a.csv", "start_frame,end_frame,action\n30,60,hold\n"),
            "a.csv:1:1: error: 'start_frame' is counted in frames");
  EXPECT_EQ(Problem("a.csv", "begin,end,label\n0:61,0:62,hold\n"),
            "a.csv:2:1: error: begin: found '0:61', wanted a number or a time like 0:01:02.5");
}

TEST_F(Labels, AMapNamesTheColumnsOfCsv) {
  const auto read = [&](const std::string& map, const std::string& text) -> std::string {
    const auto meaning = Map(map + "labels:\n  hold: {event: grasping}\n");
    if (!meaning) return grammar::Format(meaning.error());
    const auto file = ReadLabels(File("a.csv", text), meaning->csv);
    if (!file) {
      const std::string said = grammar::Format(file.error().front());
      return said.substr(said.find("a.csv"), said.find('\n') - said.find("a.csv"));
    }
    const auto reading = LabelReading::Of({*file}, &*meaning, kEvents);
    return reading ? Text(TruthOf(reading)) : grammar::Format(reading.error());
  };
  const std::string frames =
      "start_frame,end_frame,verb,noun\n30,60,hold,red cup\n90,96,hold,tap\n";
  EXPECT_EQ(
      read("rate_hz: 30\ncolumns: {object: noun}\nentities: {red cup: cup, tap: ignore}\n", frames),
      "grasping(cup) 100..200; ");
  EXPECT_EQ(read("rate_hz: 60\n", frames), "grasping() 50..100; grasping() 150..160; ");
  const std::string own = "t0,t1,what,who\n500,1500,hold,right\n";
  const std::string columns = "columns: {begin: t0, end: t1, label: what, hand: who}\n";
  EXPECT_EQ(read("time_unit: ms\nentities: {right: right_hand}\n" + columns, own),
            "grasping(right_hand) 50..150; ");
  EXPECT_EQ(read("time_unit: frame\nrate_hz: 1000\nentities: {right: right_hand}\n" + columns, own),
            "grasping(right_hand) 50..150; ");
  EXPECT_EQ(read("columns: {begin: t00}\n", own),
            "a.csv:1:1: error: found the columns t0, t1, what, who; the map wants a column 't00'");
  EXPECT_EQ(
      MapProblem("columns: {objekt: noun}\nlabels:\n  hold: {event: grasping}\n"),
      "map.yaml:1:11: error: 'objekt' is no column of labels: begin, end, duration, time, kind, "
      "frame, label, tier, take or a role");
  EXPECT_EQ(MapProblem("time_unit: min\nlabels:\n  hold: {event: grasping}\n"),
            "map.yaml:1:12: error: time_unit: expected s, ms, us, ns or frame, found 'min'");
  EXPECT_EQ(MapProblem("rate_hz: 0\nlabels:\n  hold: {event: grasping}\n"),
            "map.yaml:1:10: error: rate_hz: expected frames per second, more than 0, found '0'");
}

// People mark move, pour, move; the grammar knows one transport.
TEST_F(Labels, WhatFollowsAtOnceMayBeJoined) {
  const auto file =
      ReadLabels(File("a.csv", "begin,end,label\n0,1,move\n1.2,2,pour\n1.9,3,move\n3.6,4,move\n"));
  const auto read = [&](const std::string& join) {
    const auto map = Map(join + "labels:\n  move: {event: grasping}\n  pour: {event: grasping}\n");
    return Text(TruthOf(LabelReading::Of({*file}, &*map, kEvents)));
  };
  EXPECT_EQ(read(""), "grasping() 0..100; grasping() 120..300; grasping() 360..400; ");
  EXPECT_EQ(read("join_s: 0.3\n"), "grasping() 0..300; grasping() 360..400; ");
}

TEST_F(Labels, AnotherClockIsNoticed) {
  grammar::Timeline found{.ticks_per_second = 100, .events = {}}, marked = found;
  for (const grammar::Tick begin : {100, 260, 430, 700, 790}) {
    const auto at = [&](grammar::Tick later) {
      return grammar::NamedEvent{.event = "grasping",
                                 .roles = {{"hand", "right_hand"}},
                                 .interval = {begin + later, begin + later + 50}};
    };
    found.events.push_back(at(0));
    marked.events.push_back(at(begin % 20 == 0 ? 55 : 65));  // people differ by 100 ms
  }
  const auto of = [](const grammar::Timeline& truth, const grammar::Timeline& recognised) {
    const std::vector<std::pair<grammar::Timeline, grammar::Timeline>> recordings = {
        {truth, recognised}};
    return FindClockOffset(recordings);
  };
  const auto clock = of(marked, found);
  ASSERT_TRUE(clock);
  EXPECT_NEAR(clock->offset_s, -0.6, 0.051);
  EXPECT_EQ(clock->found_then, 5);
  EXPECT_EQ(clock->all, 5);
  EXPECT_FALSE(of(found, found));
  EXPECT_FALSE(of(marked, {}));
  // Ends that are late are no shift: the begins agree as they are.
  grammar::Timeline late = marked;
  for (grammar::NamedEvent& event : late.events)
    event.interval.end += 5 * (event.interval.end - event.interval.begin) / 4;
  EXPECT_FALSE(of(marked, late));
}

TEST_F(Labels, FaultyCsvIsNamed) {
  const std::string head = "begin_s,end_s,label\n";
  EXPECT_EQ(Problem("a.csv", "begin,label\n1,x\n"),
            "a.csv:1:1: error: found the columns begin, label; wanted one for the begin, the end "
            "and the label of each row");
  EXPECT_EQ(Problem("a.csv", head + "x,1,hold\n"),
            "a.csv:2:1: error: begin_s: found 'x', wanted a number or a time like 0:01:02.5");
  EXPECT_EQ(Problem("a.csv", head + "0,1e999,hold\n"),
            "a.csv:2:3: error: end_s: found '1e999', wanted a number or a time like 0:01:02.5");
  EXPECT_EQ(Problem("a.csv", head + "0,nan,hold\n"),
            "a.csv:2:3: error: end_s: found 'nan', wanted a number or a time like 0:01:02.5");
  EXPECT_EQ(Problem("a.csv", head + "0,1\n"), "a.csv:2:1: error: found 2 cells, wanted 3");
  EXPECT_EQ(Problem("a.csv", head + "2,1,hold\n"),
            "a.csv:2:5: error: 'hold' ends before it begins: 2 s to 1 s");
  std::string many = head;
  for (int i = 0; i < 25; ++i) many += "2,1,hold\n";
  const Result<LabelFile> backward = ReadLabels(File("a.csv", many));
  ASSERT_FALSE(backward);
  EXPECT_EQ(backward.error().size(), kMostBackward);
  EXPECT_EQ(backward.error().back().place.line, 21);
  EXPECT_EQ(
      backward.error().back().hint,
      "there are 25 such labels in the file; --skip-bad-labels leaves out what ends before it "
      "begins");
  EXPECT_EQ(Read("a.csv", head), "") << "nothing happened, and it says so";
  EXPECT_EQ(Problem("a.csv", "\n"),
            "a.csv:1:1: error: found the columns ; wanted one for the "
            "begin, the end and the label of each row");
  EXPECT_EQ(Problem("a.csv", head + "0,1,\n"), "a.csv: error: it has no labels");
  EXPECT_EQ(Problem("a.txt", " \n"), "a.txt: error: it has a line for each frame");
  EXPECT_EQ(Problem("a.csv", head + "0,1,h\xe9\n"), "a.csv:2:6: error: byte 0xe9 is not UTF-8");
  EXPECT_NE(Problem("a.csv", "").find("a.csv"), std::string::npos);
  EXPECT_EQ(Problem("a.doc", head),
            "a.doc: error: no file of labels, which end in .csv, .tsv, .eaf, .TextGrid, .timeline, "
            ".txt");
}

const std::string kEaf = R"(<?xml version="1.0" encoding="UTF-8"?>
<ANNOTATION_DOCUMENT FORMAT="3.0">
  <HEADER TIME_UNITS="milliseconds"/>
  <TIME_ORDER>
    <TIME_SLOT TIME_SLOT_ID="ts1" TIME_VALUE="500"/>
    <TIME_SLOT TIME_SLOT_ID="ts2"/>
    <TIME_SLOT TIME_SLOT_ID="ts3" TIME_VALUE="1500"/>
  </TIME_ORDER>
  <TIER TIER_ID="right" LINGUISTIC_TYPE_REF="event">
    <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a1" TIME_SLOT_REF1="ts1" TIME_SLOT_REF2="ts2">
      <ANNOTATION_VALUE>hold &amp; lift</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
    <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a2" TIME_SLOT_REF1="ts2" TIME_SLOT_REF2="ts3">
      <ANNOTATION_VALUE></ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
  </TIER>
  <TIER TIER_ID="objects" PARENT_REF="right" LINGUISTIC_TYPE_REF="of">
    <ANNOTATION><REF_ANNOTATION ANNOTATION_ID="a3" ANNOTATION_REF="a1">
      <ANNOTATION_VALUE>cup</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION>
  </TIER>
</ANNOTATION_DOCUMENT>
)";

std::string With(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(Labels, EafHasAlignedAndReferringAnnotations) {
  EXPECT_EQ(Read("a.eaf", kEaf), "0.5..1 hold & lift [right]; 0.5..1 cup [objects]; ");
}

TEST_F(Labels, FaultyEafIsNamed) {
  EXPECT_NE(Problem("a.eaf", kEaf.substr(0, 300)).find("error: it is no XML: "), std::string::npos);
  EXPECT_EQ(Problem("a.eaf", "<html/>"),
            "a.eaf:1:2: error: found <html>, wanted <ANNOTATION_DOCUMENT>, as ELAN writes it");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "milliseconds", "PAL-frames")),
            "a.eaf:3:4: error: TIME_UNITS: found 'PAL-frames', wanted milliseconds");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "\"500\"", "\"0.5 s\"")),
            "a.eaf:5:6: error: TIME_VALUE: found '0.5 s', wanted milliseconds");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "\"500\"", "\"-5\"")),
            "a.eaf:5:6: error: TIME_VALUE: found '-5', wanted milliseconds");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "\"ts3\" TIME", "\"ts1\" TIME")),
            "a.eaf:7:6: error: TIME_SLOT_ID: 'ts1' is given twice");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "REF1=\"ts1\"", "REF1=\"ts9\"")),
            "a.eaf:10:18: error: TIME_SLOT_REF1: there is no time slot 'ts9' with a time");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, " TIME_VALUE=\"1500\"", "")),
            "a.eaf:10:18: error: TIME_SLOT_REF2: there is no time slot 'ts2' with a time");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "REF=\"a1\"", "REF=\"a7\"")),
            "a.eaf:16:18: error: ANNOTATION_REF: there is no annotation 'a7' before it");
  EXPECT_EQ(Problem("a.eaf", With(kEaf, "\"1500\"", "\"100\"")).substr(0, 12), "a.eaf:10:18:");
  EXPECT_EQ(Problem("a.eaf", "<ANNOTATION_DOCUMENT/>"), "a.eaf: error: it has no labels");
  EXPECT_EQ(Read("a.eaf", "<ANNOTATION_DOCUMENT><HEADER/></ANNOTATION_DOCUMENT>"), "");
}

// What EAFv3.0.xsd asks of the elements that are written, in their order.
TEST_F(Labels, EafHasTheStructureOfItsSchema) {
  grammar::Timeline timeline{.ticks_per_second = 100, .events = {}};
  for (const grammar::Tick begin : {10, 40, 20})
    timeline.events.push_back({.event = "grasping",
                               .roles = {{"hand", "right_hand"}, {"object", "cup"}},
                               .interval = {begin, begin + 30}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(LabelsText(".eaf", timeline, {}, 100, "2026-01-02").c_str()));
  const pugi::xml_node root = document.child("ANNOTATION_DOCUMENT");
  for (const char* attribute : {"DATE", "AUTHOR", "VERSION"})
    EXPECT_TRUE(root.attribute(attribute)) << attribute;
  EXPECT_STREQ(root.attribute("DATE").as_string(), "2026-01-02T00:00:00+00:00");
  std::string order;
  std::set<std::string> ids, slots, tiers, types;
  for (const pugi::xml_node child : root.children()) {
    order += std::string(child.name()) + " ";
    if (child.attribute("LINGUISTIC_TYPE_ID"))
      types.insert(child.attribute("LINGUISTIC_TYPE_ID").as_string());
  }
  EXPECT_EQ(order, "HEADER TIME_ORDER TIER TIER LINGUISTIC_TYPE ");
  int last = -1;
  for (const pugi::xml_node slot : root.child("TIME_ORDER").children()) {
    EXPECT_STREQ(slot.name(), "TIME_SLOT");
    EXPECT_TRUE(slots.insert(slot.attribute("TIME_SLOT_ID").as_string()).second);
    EXPECT_GE(slot.attribute("TIME_VALUE").as_int(-1), last);
    last = slot.attribute("TIME_VALUE").as_int(-1);
  }
  ids = slots;
  for (const pugi::xml_node tier : root.children("TIER")) {
    EXPECT_TRUE(tiers.insert(tier.attribute("TIER_ID").as_string()).second);
    EXPECT_TRUE(types.contains(tier.attribute("LINGUISTIC_TYPE_REF").as_string()));
    for (const pugi::xml_node annotation : tier.children()) {
      const pugi::xml_node aligned = annotation.first_child();
      EXPECT_STREQ(annotation.name(), "ANNOTATION");
      EXPECT_STREQ(aligned.name(), "ALIGNABLE_ANNOTATION");
      EXPECT_TRUE(ids.insert(aligned.attribute("ANNOTATION_ID").as_string()).second);
      EXPECT_TRUE(slots.contains(aligned.attribute("TIME_SLOT_REF1").as_string()));
      EXPECT_TRUE(slots.contains(aligned.attribute("TIME_SLOT_REF2").as_string()));
      EXPECT_STREQ(aligned.first_child().name(), "ANNOTATION_VALUE");
      EXPECT_FALSE(aligned.first_child().next_sibling());
    }
  }
  for (const std::string& id : ids)  // xsd:ID
    EXPECT_TRUE(std::regex_match(id, std::regex("[A-Za-z_][A-Za-z0-9._-]*"))) << id;
}

const std::string kShort = R"(File type = "ooTextFile"
Object class = "TextGrid"

0
3
<exists>
2
"IntervalTier"
"right"
0
3
2
0
1.5
""
1.5
3
"say ""hold"""
"TextTier"
"clicks"
0
3
1
2.5
"click"
)";
const std::string kLong = R"(File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 3
tiers? <exists>
size = 1
item []:
    item [1]:
        class = "IntervalTier" ! of one hand
        name = "right"
        xmin = 0
        xmax = 3
        intervals: size = 1
        intervals [1]:
            xmin = 0.5
            xmax = 3
            text = "hold"
)";

std::string AsUtf16(const std::string& text, bool big_endian) {
  std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (big_endian) bytes += '\0';
    bytes += c;
    if (!big_endian) bytes += '\0';
  }
  return bytes;
}

TEST_F(Labels, TextGridsAreLongOrShortAndOfAnyUtf) {
  EXPECT_EQ(Read("a.TextGrid", kShort), "1.5..3 say \"hold\" [right]; 2.5..2.5 click [clicks]; ");
  EXPECT_EQ(Read("a.TextGrid", kLong), "0.5..3 hold [right]; ");
  EXPECT_EQ(Read("a.textgrid", AsUtf16(kLong, true)), "0.5..3 hold [right]; ");
  EXPECT_EQ(Read("a.textgrid", AsUtf16(kLong, false)), "0.5..3 hold [right]; ");
}

TEST_F(Labels, FaultyTextGridsAreNamed) {
  const auto problem = [&](const std::string& from, const std::string& to) {
    return Problem("a.TextGrid", With(kLong, from, to));
  };
  EXPECT_EQ(problem("\"TextGrid\"", "\"Sound\""),
            "a.TextGrid:1:1: error: found a file of type 'ooTextFile', 'Sound'; wanted ooTextFile, "
            "TextGrid");
  EXPECT_EQ(problem("<exists>", "<absent>"), "a.TextGrid:6:8: error: it has no tiers");
  EXPECT_EQ(problem("\"IntervalTier\"", "\"PitchTier\""),
            "a.TextGrid:13:16: error: found a tier of class 'PitchTier', wanted IntervalTier or "
            "TextTier");
  EXPECT_EQ(problem("xmin = 0.5", "xmin = \"0.5\""),
            "a.TextGrid:16:20: error: found \"0.5\", wanted the begin of a label");
  EXPECT_EQ(problem("intervals: size = 1", "intervals: size = 2"),
            "a.TextGrid:19:1: error: the file ends before the begin of a label");
  EXPECT_EQ(problem("intervals: size = 1", "intervals: size = 1e9"),
            "a.TextGrid:14:27: error: the number of labels of a tier: found 1e+09, wanted a whole "
            "number up to 1e+06");
  EXPECT_EQ(problem("size = 1\nitem", "size = 1.5\nitem"),
            "a.TextGrid:7:8: error: the number of tiers: found 1.5, wanted a whole number up to "
            "10000");
  EXPECT_EQ(
      Problem("a.TextGrid", With(kShort, "\n1.5\n3\n", "\n1\n3\n")),
      "a.TextGrid:18:1: error: a label of 'right' begins at 1 s, before the one before it ends, "
      "at 1.5 s");
  EXPECT_EQ(problem("\"hold\"", "\"hold"), "a.TextGrid:18:20: error: the quote is not closed");
  EXPECT_EQ(problem("xmin = 0.5", "xmin = 5"),
            "a.TextGrid:18:20: error: 'hold' ends before it begins: 5 s to 3 s");
  EXPECT_EQ(Problem("a.TextGrid", kLong.substr(0, 120)),
            "a.TextGrid:10:3: error: the file ends before the class of a tier");
}

constexpr const char* kMap = R"(offset_s: 0.5
tiers:
  right: {hand: right_hand}
  notes: ignore
labels:
  hold: {event: grasping, object: cup}
  reach: {event: reaching}
  touch: {event: contact, a: cup, b: table}
  idle: ignore
)";

TEST_F(Labels, AMapSaysWhatTheyMean) {
  const auto map = Map(kMap);
  ASSERT_TRUE(map) << grammar::Format(map.error());
  const auto file = ReadLabels(File("a.csv",
                                    "begin_s,end_s,label,tier\n0,1,reach,right\n1,2,hold,right\n"
                                    "1,2,touch,right\n0,9,talk,notes\n3,4,idle,right\n"));
  const auto reading = LabelReading::Of({*file}, &*map, kEvents);
  ASSERT_TRUE(reading) << grammar::Format(reading.error());
  EXPECT_EQ(Text(TruthOf(reading)),
            "reaching(right_hand) 50..150; contact(cup, table) 150..250; "
            "grasping(right_hand, cup) 150..250; ");
  EXPECT_EQ(reading->compared().at("reaching"), std::vector<std::string>{"hand"});
}

TEST_F(Labels, WhatIsFoundIsComparedInTheRolesOfTheLabels) {
  grammar::Timeline found{.ticks_per_second = 100, .events = {}};
  const auto add = [&](const char* event, const char* object, grammar::Tick begin,
                       grammar::Tick end) {
    found.events.push_back({.event = event,
                            .roles = {{"hand", "right_hand"}, {"object", object}},
                            .interval = {begin, end},
                            .decided = end});
  };
  add("reaching", "cup", 0, 10);
  add("reaching", "can", 5, 20);
  add("reaching", "can", 30, 40);
  add("grasping", "can", 30, 40);
  EXPECT_EQ(Text(Compared(found, {{"reaching", {"hand"}}})),
            "reaching(right_hand) 0..20; reaching(right_hand) 30..40; ");
  EXPECT_EQ(ByHand(found, {}).events[0].event, "reaching of right_hand");
}

TEST_F(Labels, FaultyMapsAreNamed) {
  EXPECT_EQ(MapProblem("labels: 3\n"),
            "map.yaml:1:9: error: labels: expected a mapping, found '3'");
  EXPECT_EQ(MapProblem("tiers: {N: {}}\nlabels:\n  a: ignore\n"),
            "map.yaml:1:12: error: N: expected a mapping, found an empty one");
  EXPECT_EQ(MapProblem("label:\n  a: ignore\n"), "map.yaml:1:1: error: unknown key 'label'");
  EXPECT_EQ(MapProblem("version: 2\nlabels:\n  a: ignore\n"),
            "map.yaml:1:10: error: version: expected 1, the version of this format, found '2'");
  EXPECT_EQ(MapProblem("version: 1\nlabels:\n  a: ignore\n"), "");
  EXPECT_EQ(MapProblem("labels:\n  a: {event: grasp}\n"),
            "map.yaml:2:14: error: the grammar has no event 'grasp'");
  EXPECT_EQ(MapProblem("labels:\n  a: {event: grasping, thing: cup}\n"),
            "map.yaml:2:24: error: 'grasping' has no role 'thing'");
  EXPECT_EQ(MapProblem("labels:\n  a: grasping\n"),
            "map.yaml:2:6: error: 'a': expected an event or 'ignore', found 'grasping'");
  EXPECT_EQ(MapProblem("offset_s: early\nlabels:\n  a: ignore\n"),
            "map.yaml:1:11: error: offset_s: expected seconds, found 'early'");
  EXPECT_EQ(MapProblem("tiers:\n  left: {hnd: left_hand}\nlabels:\n  a: ignore\n"),
            "map.yaml:2:10: error: no event has a role 'hnd'");
  EXPECT_EQ(MapProblem("labels:\n  a: {event: grasping, object: [cup]}\n"),
            "map.yaml:2:32: error: object: expected the name of an entity, found a list");
}

TEST_F(Labels, UnknownLabelsTiersEntitiesAndTimesAreNamed) {
  const auto map = Map(kMap);
  const auto problem = [&](const std::string& row, const LabelMap* meaning) {
    const auto file = ReadLabels(File("a.csv", "begin_s,end_s,label,tier\n" + row + "\n"));
    const auto reading = LabelReading::Of({*file}, meaning, kEvents);
    if (!reading) return grammar::Format(reading.error().front());
    const auto truth = reading->Truth(0, {kHand, kTable}, 100, 1000);
    return truth ? std::string() : grammar::Format(truth.error().front());
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos ? "" : text;
  };
  EXPECT_EQ(has(problem("0,1,holt,right", &*map), "a.csv:2:5: error: the map has no label 'holt'"),
            "");
  EXPECT_EQ(has(problem("0,1,holt,right", &*map), "did you mean 'hold'?"), "");
  EXPECT_EQ(has(problem("0,1,hold,left", &*map), "the map has no tier 'left'"), "");
  EXPECT_EQ(has(problem("0,1,hold,right", &*map), "the recording has no entity 'cup'"), "");
  EXPECT_EQ(has(problem("0,99,reach,right", &*map),
                "the label lies at 0.5 to 99.5 s, the recording ends after 10 s"),
            "");
  EXPECT_EQ(has(problem("0,1,hold,right", nullptr), "found the label 'hold', wanted an event"), "");
  EXPECT_EQ(
      has(problem("0,1,\"grasping(right_hand)\",x", nullptr), "wanted grasping(hand, object)"), "");
  EXPECT_EQ(has(problem("0,1,\"grasping(hand=right_hand, hand=right_hand)\",x", nullptr),
                "found the label 'grasping(hand=right_hand, hand=right_hand)', which names a role "
                "twice"),
            "");
}

TEST_F(Labels, WhatIsWrittenIsReadAgain) {
  grammar::Timeline timeline{.ticks_per_second = 100, .events = {}};
  const auto add = [&](const char* event, std::vector<grammar::Role> roles, grammar::Tick begin,
                       grammar::Tick end) {
    timeline.events.push_back(
        {.event = event, .roles = std::move(roles), .interval = {begin, end}, .decided = end});
  };
  add("reaching", {{"hand", "right_hand"}, {"object", "cup"}}, 0, 50);
  add("reaching", {{"hand", "right_hand"}, {"object", "table"}}, 10, 60);
  add("contact", {{"a", "cup"}, {"b", "table"}}, 20, 1000);
  add("grasping", {{"hand", "right_hand"}, {"object", "cup"}}, 60, 70);
  add("grasping", {{"hand", "right_hand"}, {"object", "cup"}}, 70, 90);
  Sort(timeline);
  for (const char* ending : {".csv", ".eaf", ".TextGrid"}) {
    const auto file = ReadLabels(
        File(std::string("a") + ending, LabelsText(ending, timeline, {}, 1000, "2026-01-31")));
    ASSERT_TRUE(file) << grammar::Format(file.error());
    const auto reading = LabelReading::Of({*file}, nullptr, kEvents);
    ASSERT_TRUE(reading) << grammar::Format(reading.error());
    EXPECT_EQ(Text(TruthOf(reading)), Text(timeline)) << ending;
  }
}

TEST_F(Labels, AnEntityThatTheMapNamesIsWrongThere) {
  const auto problems = [&](const std::string& map_text) {
    const auto map = Map(map_text);
    const auto file =
        ReadLabels(File("a.csv", "begin_s,end_s,label,tier\n0,1,hold,right\n2,3,hold,right\n"));
    const auto truth =
        LabelReading::Of({*file}, &*map, kEvents)->Truth(0, {kHand, kCup, kTable}, 100, 1000);
    std::string text;
    for (const grammar::Diagnostic& problem : truth ? grammar::Diagnostics{} : truth.error())
      text += fmt::format("{}:{}:{} {} | {}\n", fs::path(problem.file).filename().string(),
                          problem.place.line, problem.place.column, problem.message, problem.hint);
    return text;
  };
  EXPECT_EQ(problems("labels:\n  hold: {event: grasping, object: cupp}\n"),
            "map.yaml:2:35 the recording has no entity 'cupp' | did you mean 'cup'?\n");
  EXPECT_EQ(problems("tiers:\n  right: {hand: cup}\nlabels:\n  hold: {event: grasping}\n"),
            "map.yaml:2:17 'cup' is never 'hand' of 'grasping', which takes a Hand | it has "
            "right_hand\n");
}

}  // namespace
}  // namespace prehend::exchange::of_labels
