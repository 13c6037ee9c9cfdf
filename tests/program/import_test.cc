// SPDX-License-Identifier: Apache-2.0
// Files of poses become recordings; what is wrong with them, or looks wrong, is named, and nothing
// is written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <sstream>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Writer = std::function<std::string(const char* name, Row row)>;

/// Five seconds at 60 Hz, both bodies.
std::string Csv(const Writer& write = AsWritten) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 300; ++i) {
    csv += write("Mug", CupAt(i / 60.0));
    csv += write("Glove", HandAt(i / 60.0));
  }
  return csv;
}

std::string Events(const std::filesystem::path& folder) {
  return Prehend({"episode", "resegment", (folder / "take.jsonl").string()}).out;
}

TEST(Import, PosesBecomeARecordingInWhichACupIsCarried) {
  const auto folder = FreshFolder("import");
  const Said said = ImportCsv(folder, Csv(), kCupMap);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err, "");
  EXPECT_TRUE(said.out.starts_with("a_cup_is_carried: 301 frames, 5.000 s\n")) << said.out;
  const std::string events = Events(folder);
  for (const char* event : {"picking_up", "transporting", "putting_down", "pick_and_place"})
    EXPECT_NE(events.find(event), std::string::npos) << event << "\n" << events;
}

TEST(Import, UnitsAxesOrdersAndLayoutsMakeNoDifference) {
  const auto folder = FreshFolder("import");
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  const std::string events = Events(folder);

  // Millimetres, y up, xyzw, milliseconds, semicolons.
  std::string csv = "t;name;x;y;z;qx;qy;qz;qw\n";
  csv += Csv([](const char* name, Row row) {
           char text[200];
           std::snprintf(text, sizeof text, "%.1f;%s;%.2f;%.2f;%.2f;0;0;0;1\n", row.t_s * 1e3, name,
                         row.x * 1e3, row.z * 1e3, -row.y * 1e3);
           return std::string(text);
         }).substr(std::string("t,name,x,y,z,qw,qx,qy,qz\n").size());
  std::string map = Replaced(kCupMap, "unit: m\n", "unit: mm\nseparator: semicolon\n");
  map = Replaced(map, "z_up", "y_up");
  map = Replaced(map, "wxyz", "xyzw");
  map = Replaced(map, "time_unit: s", "time_unit: ms");
  map = Replaced(map, "[qw, qx, qy, qz]", "[qx, qy, qz, qw]");
  const Said said = ImportCsv(folder, csv, map);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Events(folder), events);

  // All bodies in one row, without orientations, frames counted.
  csv = "frame,Mug x,Mug y,Mug z,Glove x,Glove y,Glove z\n";
  for (int i = 0; i <= 300; ++i) {
    const Row cup = CupAt(i / 60.0), hand = HandAt(i / 60.0);
    char text[200];
    std::snprintf(text, sizeof text, "%d,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f\n", i, cup.x, cup.y, cup.z,
                  hand.x, hand.y, hand.z);
    csv += text;
  }
  map = Replaced(kCupMap, "time_unit: s", "time_unit: frame\nrate_hz: 60");
  map = Replaced(map, "  body: name\n", "");
  map = Replaced(map, "  time: t\n", "  time: frame\n");
  map = Replaced(map, "['x', 'y', 'z']", "['{} x', '{} y', '{} z']");
  map = Replaced(map, "  quaternion: [qw, qx, qy, qz]\n", "");
  const Said wide = ImportCsv(folder, csv, map);
  EXPECT_EQ(wide.exit_code, 0) << wide.err;
  EXPECT_EQ(Events(folder), events);
}

TEST(Import, AnOffsetIsInTheFrameOfTheBodyAsItStandsUpright) {
  const auto folder = FreshFolder("import");
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  const std::string events = Events(folder);
  // The cup's markers hang 5 cm above it, and its frame lies on its side.
  const Said said = ImportCsv(
      folder, Csv([](const char* name, Row row) {
        if (name[0] == 'G') return AsWritten(name, row);
        row.z += 0.05;
        return Replaced(AsWritten(name, row), ",1,0,0,0\n", ",0.70710678,0.70710678,0,0\n");
      }),
      Replaced(kCupMap, "{from: Mug,", "{from: Mug, upright_at_s: 0.5, offset_m: [0, 0, -0.05],"));
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Events(folder), events);
}

TEST(Import, MarkersAxesHoldForEachTakeHoweverTheThingStands) {
  const auto folder = FreshFolder("import");
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  const std::string events = Events(folder);
  // The cup's markers are 5 cm beside it, their frame lies on its side, and in the second take it
  // is turned round.
  const auto take = [](double beside_m, const std::string& quaternion) {
    return Csv([=](const char* name, Row row) {
      if (name[0] == 'G') return AsWritten(name, row);
      row.x += beside_m;
      return Replaced(AsWritten(name, row), ",1,0,0,0\n", "," + quaternion + "\n");
    });
  };
  const std::string first = take(0.05, "0.70710678,0.70710678,0,0");
  const std::string second = take(-0.05, "0,0,0.70710678,0.70710678");
  const auto map = [](const std::string& axes) {
    return Replaced(kCupMap, "{from: Mug,", "{from: Mug, offset_m: [-0.05, 0, 0], " + axes + ",");
  };
  const Said told = ImportCsv(folder, first, map("upright_at_s: 0.5"));
  EXPECT_EQ(Events(folder), events);
  const std::string axes = "axes_quat_wxyz: [0.70711, -0.70711, 0.00000, 0.00000]";
  EXPECT_NE(told.out.find("cup: upright_at_s of this file is " + axes + "\n"), std::string::npos)
      << told.out;
  for (const std::string& csv : {first, second}) {
    const Said said = ImportCsv(folder, csv, map(axes));
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(Events(folder), events);
  }
  const Said both = ImportCsv(folder, first, map(axes + ", upright_at_s: 0"));
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_NE(both.err.find("axes_quat_wxyz"), std::string::npos) << both.err;
}

TEST(Import, AShortGapIsBridgedAndALongOneIsRefusedOrHeld) {
  const auto folder = FreshFolder("import");
  const auto without = [](double from_s, double until_s) {
    return Csv([=](const char* name, Row row) {
      const bool lost = name[0] == 'M' && row.t_s > from_s && row.t_s < until_s;
      return lost ? std::string() : AsWritten(name, row);
    });
  };
  const Said bridged = ImportCsv(folder, without(2.5, 2.58), kCupMap);
  EXPECT_EQ(bridged.exit_code, 0) << bridged.err;
  EXPECT_NE(
      bridged.out.find("cup              Mug                  297    59.9        1     0.083"),
      std::string::npos)
      << bridged.out;

  std::filesystem::remove(folder / "take.jsonl");
  const Said lost = ImportCsv(folder, without(2.2, 2.9), kCupMap);
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(
      lost.err.find("map.yaml:14:15: error: 'Mug' is not tracked for 0.700 s from 2.200 s on"),
      std::string::npos)
      << lost.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "take.jsonl"));

  const Said held = ImportCsv(folder, without(2.2, 2.9), std::string(kCupMap) + "lost: hold\n");
  EXPECT_EQ(held.exit_code, 0) << held.err;
  EXPECT_NE(held.err.find("held where it was"), std::string::npos) << held.err;
  // It does not fly to where it is found again.
  EXPECT_EQ(held.err.find("jumps"), std::string::npos) << held.err;
}

TEST(Import, CheckWritesNothingAndSaysWhatAGrammarWillMiss) {
  const auto folder = FreshFolder("import");
  const Said said = ImportCsv(folder, Csv(), kCupMap, {"--check"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("Glove"), std::string::npos);
  const Said touches =
      ImportCsv(folder, Csv(), kCupMap, {"--check", "--grammar", "pick_and_place"});
  EXPECT_EQ(touches.exit_code, 4);
  EXPECT_NE(touches.err.find("this recording has no touches"), std::string::npos) << touches.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "take.jsonl"));
}

/// What is done to a good file and its map, and what is said of it.
struct Fault {
  const char* name;
  std::string csv, map, says;
};

std::string Semicolons(std::string csv) {
  std::ranges::replace(csv, ',', ';');
  return csv;
}

TEST(Import, EveryFaultIsFoundAndNamedAndNothingIsWritten) {
  const auto scaled = [](double factor) {
    return Csv([=](const char* name, Row row) {
      return AsWritten(name, {row.t_s, row.x * factor, row.y * factor, row.z * factor});
    });
  };
  const auto change = [](const std::string& from, const std::string& to) {
    return Replaced(Csv(), from, to);
  };
  const std::string mug = AsWritten("Mug", CupAt(1));
  const std::vector<Fault> faults = {
      {"millimetres", scaled(1e3), kCupMap, "map.yaml:3:7: error: the poses are 8"},
      {"metres as mm", Csv(), Replaced(kCupMap, "unit: m", "unit: mm"),
       "map.yaml:3:7: error: all poses are within 0.9"},
      {"y up", Csv([](const char* name, Row row) {
         return AsWritten(name, {row.t_s, row.x, row.z, row.y});
       }),
       kCupMap, "map.yaml:4:7: error: nothing is lifted along z, but 'Mug' rises 0.2"},
      {"milliseconds", Csv([](const char* name, Row row) {
         return AsWritten(name, {row.t_s * 1e3, row.x, row.y, row.z});
       }),
       kCupMap,
       "map.yaml:6:12: error: poses are 16.67 s apart: 0.06 Hz; the times look like millis"},
      {"another rate", Csv(), Replaced(kCupMap, "time_unit: s", "time_unit: s\nrate_hz: 120"),
       "map.yaml:7:10: error: rate_hz: 120, but poses are 0.0167 s apart: 59.88 Hz"},
      {"not of length one", Replaced(Csv(), mug, Replaced(mug, ",1,0,0,0\n", ",1,0,0.5,0\n")),
       kCupMap,
       "poses.csv:122:36: error: 'Mug': expected a unit quaternion, found one of length 1.118"},
      {"time goes back", change("\n1.0000,Mug", "\n0.9000,Mug"), kCupMap,
       "poses.csv:122:1: error: the times of 'Mug' must increase from row to row: 0.9 s after"},
      {"nan", change("\n1.0000,Mug,0.00000", "\n1.0000,Mug,nan"), kCupMap,
       "poses.csv:122:12: error: expected a number, found 'nan'"},
      {"no number", change("\n1.0000,Mug,0.00000", "\n1.0000,Mug,left"), kCupMap,
       "poses.csv:122:12: error: expected a number, found 'left'"},
      {"cut", Csv().substr(0, Csv().size() - 12), kCupMap, "is the file cut off?"},
      {"half a pose", change("\n1.0000,Mug,0.00000", "\n1.0000,Mug,"), kCupMap,
       "poses.csv:122:12: error: 'Mug' has a pose without 'x'"},
      {"twice", Replaced(Csv(), mug, mug + mug), kCupMap,
       "poses.csv:123:42: error: 'Mug' has two poses at 1 s"},
      {"lost as zero", Csv([](const char* name, Row row) {
         if (name[0] == 'M' && row.t_s > 2.5 && row.t_s < 2.58) row = {row.t_s, 0, 0, 0};
         return AsWritten(name, row);
       }),
       kCupMap, "map.yaml:14:15: error: 'Mug' is at exactly 0, 0, 0 in 4 of 301 poses"},
      {"far from the table", Csv(), Replaced(kCupMap, "at_m: [0, 0, 0.7]", "at_m: [5, 0, 0.7]"),
       "map.yaml:13:3: error: nothing tracked comes nearer to 'table' than 3.6"},
      {"no such column", Csv(), Replaced(kCupMap, "time: t", "time: tt"),
       "map.yaml:8:9: error: no column is called 'tt'"},
      {"no such body", Csv(), Replaced(kCupMap, "from: Mug", "from: Mugg"),
       "map.yaml:14:15: error: 'Mugg' has 0 poses in the file"},
      {"a built-in class", Csv(), Replaced(kCupMap, "class: Cup", "class: Hand"),
       "map.yaml:14:27: error: class: 'Hand' is built in, and 'cup' is Movable\n"},
      {"no such key", Csv(), Replaced(kCupMap, "unit: m", "units: m"), "did you mean 'unit'?"},
      {"a column twice", Replaced(Csv(), "t,name,x,y,z", "t,name,x,y,x"), kCupMap,
       "poses.csv:1:12: error: a second column is called 'x'"},
      {"a position of one column", Csv(), Replaced(kCupMap, "['x', 'y', 'z']", "['x', 'y', 'x']"),
       "map.yaml:10:24: error: 'x' is named twice"},
      {"a quaternion of one column", Csv(), Replaced(kCupMap, "qx, qy, qz]", "qx, qx, qz]"),
       "map.yaml:11:24: error: 'qx' is named twice"},
      {"a column of a position that turns", Csv(), Replaced(kCupMap, "[qw, qx", "['z', qx"),
       "map.yaml:11:16: error: 'z' is named twice"},
      {"a matrix of one column", Csv(),
       Replaced(kCupMap, "quaternion: [qw, qx, qy, qz]", "matrix: [a, b, c, d, e, f, g, h, a]"),
       "map.yaml:11:36: error: 'a' is named twice"},
      {"angles of one column", Csv(),
       Replaced(kCupMap, "quaternion: [qw, qx, qy, qz]", "euler: [qx, qy, qx]"),
       "map.yaml:11:19: error: 'qx' is named twice"},
      {"a time that is a place", Csv(), Replaced(kCupMap, "['x', 'y', 'z']", "['x', 'y', t]"),
       "map.yaml:10:24: error: 't' is named twice"},
      {"a marker twice", Csv(), Replaced(kCupMap, "from: Mug", "markers: [a, b, c, a]"),
       "map.yaml:14:28: error: 'a' is named twice"},
      {"semicolons", Semicolons(Csv()), kCupMap,
       "poses.csv:1:2: error: the names of the columns are separated by semicolons"},
      {"only numbers", "0,1,2,3,4\n1,1,2,3,4\n", kCupMap,
       "poses.csv:1:1: error: expected the names of the columns, found numbers"},
      {"UTF-16", std::string("\xFF\xFEt\0,\0", 6), kCupMap,
       "poses.csv:1:1: error: expected UTF-8, found UTF-16"},
      {"no rows", "t,name,x,y,z,qw,qx,qy,qz\n", kCupMap, "0 rows; a recording has at least 2"},
      {"empty", "", kCupMap, "poses.csv: error: the file is empty"},
  };
  for (const Fault& fault : faults) {
    const auto folder = FreshFolder("import");
    const Said said = ImportCsv(folder, fault.csv, fault.map);
    EXPECT_EQ(said.exit_code, 2) << fault.name << "\n" << said.out;
    EXPECT_NE(said.err.find(fault.says), std::string::npos) << fault.name << "\n" << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "take.jsonl")) << fault.name;
    const std::string takes = (folder / "takes.episodes").string();
    EXPECT_EQ(ImportCsv(folder, fault.csv, fault.map, {"-o", takes}).exit_code, 2) << fault.name;
    EXPECT_FALSE(std::filesystem::exists(takes)) << fault.name;
  }
}

// Nothing turns in it, so one sign alone tells the order of quaternions.
TEST(Import, OneSignAloneIsAWarningWithBothReadings) {
  const auto folder = FreshFolder("import");
  const Said said = ImportCsv(folder, Csv([](const char* name, Row row) {
                                return Replaced(AsWritten(name, row), ",1,0,0,0\n", ",0,0,0,1\n");
                              }),
                              kCupMap);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.err.find("warning: the first of four numbers, as w, is 0.00 (median, without its "
                          "sign), the last is 1.00: this looks like xyzw: quaternion_order: xyzw; "
                          "or, if it is right, sure: [quaternion_order]\n"),
            std::string::npos)
      << said.err;
}

TEST(Import, WhatTheMapIsSureOfIsNoError) {
  const auto folder = FreshFolder("import");
  const Said said = ImportCsv(
      folder, Csv(),
      Replaced(kCupMap, "at_m: [0, 0, 0.7]", "at_m: [5, 0, 0.7]") + std::string("sure: [place]\n"));
  EXPECT_EQ(said.exit_code, 0) << said.err;
}

/// The page's map is the shipped one, and its transport is that of the simulated run, within a
/// frame.
TEST(Import, AWarningIsCalledAsThePageAndTheMapCallIt) {
  const auto folder = FreshFolder("import");
  for (const char* warning : {"unit", "axes", "quaternion_order", "time", "place", "zero"}) {
    const Said said = ImportCsv(folder, Csv(), std::string(kCupMap) + "sure: [" + warning + "]\n");
    EXPECT_EQ(said.exit_code, 0) << warning << said.err;
  }
}

// As files of one body each, put together: the glove began a frame earlier.
TEST(Import, OneBodyMayFollowTheOther) {
  const auto folder = FreshFolder("import");
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  const std::string in_turn = ReadFile(folder / "take.jsonl");
  std::string of_mug, of_glove;
  Csv([&](const char* name, Row row) {
    (name[0] == 'M' ? of_mug : of_glove) += AsWritten(name, row);
    return std::string();
  });
  const std::string head = "t,name,x,y,z,qw,qx,qy,qz\n";
  ASSERT_EQ(ImportCsv(folder, head + of_mug + of_glove, kCupMap).exit_code, 0);
  EXPECT_EQ(ReadFile(folder / "take.jsonl"), in_turn);
  const std::size_t second = of_mug.find('\n') + 1;
  const Said late = ImportCsv(folder, head + of_mug.substr(second) + of_glove,
                              kCupMap + std::string("lost: unknown\n"), {"--check"});
  EXPECT_EQ(late.exit_code, 0) << late.err;
  EXPECT_TRUE(late.out.starts_with("a_cup_is_carried: 301 frames, 5.000 s\n")) << late.out;
}

// The cup is 4 mm to one side and 4 mm to the other, from frame to frame.
std::string TremblingCsv() {
  int frame = 0;
  return Csv([&frame](const char* name, Row row) {
    if (std::string(name) == "Mug") row.x += ++frame % 2 == 0 ? 0.004 : -0.004;
    return AsWritten(name, row);
  });
}

TEST(Import, AThingThatTremblesIsNamedAndMeansOverATimeMakeItSmooth) {
  const auto folder = FreshFolder("import");
  const Said rough = ImportCsv(folder, TremblingCsv(), kCupMap);
  EXPECT_EQ(rough.exit_code, 0);
  EXPECT_NE(rough.err.find("warning: 'Mug' trembles by 4.2 mm from frame to frame, which hides how "
                           "it moves; smooth_s: 0.2 takes means over that long\n"),
            std::string::npos)
      << rough.err;
  const Said smooth = ImportCsv(folder, TremblingCsv(), kCupMap + std::string("smooth_s: 0.2\n"));
  EXPECT_EQ(smooth.exit_code, 0);
  EXPECT_EQ(smooth.err, "");
  const std::string events = Events(folder);
  for (const char* event : {"picking_up", "transporting", "putting_down", "pick_and_place"})
    EXPECT_NE(events.find(event), std::string::npos) << event << "\n" << events;
}

TEST(Import, AllThatTrembleByAMillimetreAreNamedInOneLine) {
  const auto folder = FreshFolder("import");
  int frame = 0;
  const Said rough = ImportCsv(folder, Csv([&frame](const char* name, Row row) {
                                 row.x += ++frame % 4 < 2 ? 0.001 : -0.001;
                                 return AsWritten(name, row);
                               }),
                               kCupMap);
  EXPECT_EQ(rough.exit_code, 0);
  EXPECT_NE(rough.err.find("warning: 'Mug', 'Glove' tremble by up to 1.1 mm from frame to frame, "
                           "which hides how they move; smooth_s: 0.2 takes means over that long\n"),
            std::string::npos)
      << rough.err;
}

TEST(Import, NothingIsSmoothedOverATimeInWhichItWasLost) {
  const auto folder = FreshFolder("import");
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 120; ++i) {
    const double t = i / 60.0;
    if (t < 0.7 || t > 1.3) csv += AsWritten("Mug", {t, t < 1 ? 0.0 : 0.25, 0, 0.75});
    csv += AsWritten("Glove", {t, 0.125, 0, 0.875});
  }
  const std::string map = kCupMap + std::string("lost: unknown\n");
  ASSERT_EQ(ImportCsv(folder, csv, map).exit_code, 0);
  const std::string as_is = ReadFile(folder / "take.jsonl");
  ASSERT_EQ(ImportCsv(folder, csv, map + "smooth_s: 0.5\n").exit_code, 0);
  EXPECT_EQ(ReadFile(folder / "take.jsonl"), as_is);
}

TEST(Import, ThingsThatRestOnNothingAreNamedWithWhatTheMapCouldSay) {
  const auto folder = FreshFolder("import");
  std::string map = kCupMap;
  const std::size_t table = map.find("  table:");
  map.erase(table, map.find('\n', table) + 1 - table);
  const Said without = ImportCsv(folder, Csv(), map);
  EXPECT_EQ(without.exit_code, 0) << without.err;
  const std::size_t begin = without.err.find("could be 'table:"),
                    end = without.err.find("'\n", begin);
  EXPECT_NE(without.err.find("warning: 'cup' rests with the lowest point at 0.72 m, and nothing in "
                             "the map has its top within 8 cm of that: no support, pick-up or "
                             "put-down is recognised"),
            std::string::npos)
      << without.err;
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(Events(folder).find("picking_up"), std::string::npos);

  // The map that the warning proposes.
  const std::string proposed = without.err.substr(begin + 10, end - begin - 10);
  const Said with = ImportCsv(folder, Csv(), map + "  " + proposed + "\n");
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(with.err, "");
  EXPECT_NE(Events(folder).find("picking_up"), std::string::npos);

  const Said low = ImportCsv(folder, Csv(), Replaced(kCupMap, "[0, 0, 0.7]", "[0, 0, 0.6]"));
  EXPECT_NE(low.err.find("rests with the lowest point at 0.72 m"), std::string::npos) << low.err;
}

TEST(Import, TheDocumentedRecordingIsSegmentedAsThePageSays) {
  const std::filesystem::path docs = std::filesystem::path(PREHEND_SOURCE_DIR) / "docs";
  const std::string page = ReadFile(docs / "motion-capture.md"),
                    map = ReadFile(docs / "motion_capture" / "bodies.yaml");
  EXPECT_NE(page.find("```yaml\n" + map.substr(map.find('\n') + 1) + "```"), std::string::npos);
  const auto file = FreshFolder("import") / "milk.jsonl";
  const Said said = Prehend({"import", (docs / "motion_capture" / "poses.csv").string(), "--map",
                             (docs / "motion_capture" / "bodies.yaml").string(), "-o",
                             file.string(), "--grammar", "pick_and_place_from_motion"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err, "");
  EXPECT_NE(page.find(said.out), std::string::npos) << said.out;
  const std::string events = Prehend({"episode", "resegment", file.string()}).out;
  EXPECT_NE(page.find(events), std::string::npos) << events;
}

/// In their order; what they write lies in a folder of its own.
TEST(Import, EachCommandOfThePageRuns) {
  const auto folder = FreshFolder("import_page");
  std::istringstream page(
      ReadFile(std::filesystem::path(PREHEND_SOURCE_DIR) / "docs" / "motion-capture.md"));
  bool shell = false;
  int commands = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) shell = line == "```sh";
    if (!shell || !line.starts_with("prehend ")) continue;
    std::vector<std::string> words;
    std::istringstream in(line.substr(std::string("prehend ").size()));
    for (std::string word; in >> std::quoted(word);)
      words.push_back(word.find('/') == std::string::npos &&
                              (word.ends_with(".jsonl") || word.ends_with(".yaml") ||
                               word.ends_with(".episodes"))
                          ? (folder / word).string()
                          : word);
    const Said said = Prehend(words, {"CI="});
    const bool is_pending = words.front() == "review" && said.exit_code == 5;
    EXPECT_TRUE(said.exit_code == 0 || is_pending) << line << "\n" << said.exit_code << said.err;
    ++commands;
  }
  EXPECT_GE(commands, 9);
}

/// The same five seconds as joints and as transforms, which have fewer digits.
TEST(Import, TheOtherDocumentedFilesHaveTheSameEvents) {
  const std::filesystem::path docs =
      std::filesystem::path(PREHEND_SOURCE_DIR) / "docs" / "motion_capture";
  const auto folder = FreshFolder("import");
  const auto events = [&](const char* poses, const char* map) {
    const Said said = Prehend({"import", (docs / poses).string(), "--map", (docs / map).string(),
                               "-o", (folder / "take.jsonl").string()});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(said.err, "") << poses;
    std::map<std::string, std::pair<double, double>> found;
    std::istringstream table(Events(folder));
    std::string line;
    std::getline(table, line);  // the heading
    while (std::getline(table, line)) {
      std::istringstream cells(line);
      std::string event;
      double begin = 0, end = 0;
      if (!(cells >> event >> begin >> end)) continue;
      while (found.contains(event)) event += "'";
      found[event] = {begin, end};
    }
    return found;
  };
  const auto csv = events("poses.csv", "bodies.yaml");
  EXPECT_GE(csv.size(), 12u);
  for (const auto& [poses, map] :
       {std::pair("take.bvh", "bvh_bodies.yaml"), std::pair("run.mcap", "mcap_bodies.yaml")}) {
    const auto other = events(poses, map);
    EXPECT_EQ(other.size(), csv.size()) << poses;
    for (const auto& [event, interval] : csv) {
      if (!other.contains(event)) {
        ADD_FAILURE() << poses << " has no " << event;
        continue;
      }
      EXPECT_NEAR(other.at(event).first, interval.first, 0.04) << poses << " " << event;
      EXPECT_NEAR(other.at(event).second, interval.second, 0.04) << poses << " " << event;
    }
  }
}

TEST(Import, TheSchemaOfMapsIsJson) {
  const Said said = Prehend({"scenario", "schema", "import-map"});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.out.find("\"quaternion_order\""), std::string::npos);
}

TEST(Import, EpisodeFilesTakePosesAndRecordings) {
  const auto folder = FreshFolder("import");
  const std::string takes = (folder / "takes.episodes").string(),
                    lines = (folder / "take.jsonl").string();
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  EXPECT_EQ(ImportCsv(folder, Csv(), kCupMap, {"-o", takes}).exit_code, 0);
  const Said said = Prehend({"import", lines, "-o", takes});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.out, takes + ": a_cup_is_carried, 301 frames\n");

  EXPECT_EQ(Prehend({"episode", "verify", takes}).out,
            "2 of 2 episodes have the frames and events that were recorded\n");
  for (const char* which : {"1", "2"})
    EXPECT_EQ(Prehend({"episode", "resegment", takes, "--episode", which}).out, Events(folder))
        << which;
  EXPECT_EQ(Prehend({"grammar", "tracks", takes, "--episode", "2"}).out,
            Prehend({"grammar", "tracks", lines}).out);
  EXPECT_EQ(Prehend({"explain", takes, "--episode", "2", "--event", "transporting"}).out,
            Prehend({"explain", lines, "--event", "transporting"}).out);
  const Said asked = Prehend({"episode", "query", takes, "--event", "transporting", "--csv"});
  EXPECT_NE(asked.out.find("a_cup_is_carried"), std::string::npos) << asked.out;
}

TEST(Import, WhatHappensBeforeTickZeroIsKept) {
  const auto folder = FreshFolder("import");
  const std::string takes = (folder / "takes.episodes").string(),
                    lines = (folder / "take.jsonl").string(),
                    early = (folder / "early.jsonl").string();
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  std::ofstream out(early);
  std::istringstream in(ReadFile(lines));
  constexpr int kEarlier = 20'000;
  for (std::string line; std::getline(in, line);) {
    const std::string key = "{\"tick\":";
    const std::size_t comma = line.find(',');
    if (line.starts_with(key))
      line =
          key + std::to_string(std::stol(line.substr(key.size())) - kEarlier) + line.substr(comma);
    out << line << "\n";
  }
  out.close();
  ASSERT_EQ(Prehend({"import", early, "-o", takes}).exit_code, 0);
  const auto events = [](const Said& said) {
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return std::ranges::count(said.out, '\n');
  };
  const auto kept = Prehend({"episode", "query", lines, "--event", "transporting", "--csv"});
  EXPECT_GT(events(kept), 1);
  EXPECT_EQ(events(Prehend({"episode", "query", takes, "--event", "transporting", "--csv"})),
            events(kept));
}

TEST(Import, EpisodesOfRecordingsAreCheckedAgainstTheGoldenBesideTheirSource) {
  const auto folder = FreshFolder("import");
  const std::string takes = (folder / "takes.episodes").string(),
                    lines = (folder / "take.jsonl").string();
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  ASSERT_EQ(Prehend({"import", lines, "-o", takes}).exit_code, 0);
  const Said pending = Prehend({"check", takes});
  EXPECT_EQ(pending.exit_code, 5) << "no golden yet";
  EXPECT_NE(pending.out.find("    next: prehend review " + lines + "\n"), std::string::npos)
      << pending.out;
  EXPECT_EQ(Prehend({"review", lines}).exit_code, 5) << "the command works";
  ASSERT_EQ(Prehend({"accept", lines, "--reason", "looked at"}, {"CI="}).exit_code, 0);
  EXPECT_EQ(Prehend({"check", takes}).exit_code, 0);
  EXPECT_EQ(Prehend({"check", takes, "--grammar", "contact"}).exit_code, 1);
}

TEST(Import, WhatARecordingDoesNotHaveIsSaid) {
  const auto folder = FreshFolder("import");
  const std::string takes = (folder / "takes.episodes").string(),
                    lines = (folder / "take.jsonl").string();
  ASSERT_EQ(ImportCsv(folder, Csv(), kCupMap).exit_code, 0);
  ASSERT_EQ(Prehend({"import", lines, "-o", takes}).exit_code, 0);
  const Said score = Prehend({"score", takes});
  EXPECT_EQ(score.exit_code, 2);
  EXPECT_NE(score.err.find("takes.episodes was not simulated, so its physical truth is not known"),
            std::string::npos)
      << score.err;
  EXPECT_EQ(
      Prehend({"import", lines, "-o", (folder / "b.jsonl").string()}).err,
      "prehend: " + lines + " is a recording already; -o NAME.episodes keeps it as an episode\n");
  EXPECT_EQ(Prehend({"import", (folder / "poses.csv").string(), "-o", takes}).err,
            "prehend: " + (folder / "poses.csv").string() +
                " needs --map, a file that says what it means (docs/motion-capture.md); --propose "
                "writes a first one\n");
  EXPECT_EQ(Prehend({"import", lines, "-o", "/proc/nowhere/takes.episodes"}).exit_code, 2);
}

}  // namespace
}  // namespace prehend::house
