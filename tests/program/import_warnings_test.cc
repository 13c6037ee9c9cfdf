// SPDX-License-Identifier: Apache-2.0
// What a file of poses or its map may lack, and what is no fault: noise against smooth motion,
// hands, grammars, quotes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

double SwingsOnceASecond(double t_s) { return 0.3 * std::sin(2 * M_PI * t_s); }

/// Of a hand that swings to and fro.
std::string SwingingCsv(double rate_hz, double noise_m = 0,
                        double (*x_m)(double t_s) = SwingsOnceASecond) {
  std::string csv = "cup_x,cup_y,cup_z,hand_x,hand_y,hand_z\n";
  unsigned random = 1;
  const auto noise = [&] {  // roughly normal
    double sum = 0;
    for (int i = 0; i < 12; ++i) {
      random = random * 1664525u + 1013904223u;
      sum += random / 4294967296.0 - 0.5;
    }
    return noise_m * sum;
  };
  for (int i = 0; i < 6 * rate_hz; ++i) {
    char text[200];
    std::snprintf(text, sizeof text, "0.3,0.2,0.75,%.6f,%.6f,%.6f\n", x_m(i / rate_hz) + noise(),
                  0.1 + noise(), 1 + noise());
    csv += text;
  }
  return csv;
}

std::string SwingingMap(const char* rate_hz, const std::string& hand = "hand: true, ") {
  return std::string("import: 1\nunit: m\naxes: z_up\ntime_unit: frame\nrate_hz: ") + rate_hz +
         "\ncolumns: {position: ['{}_x', '{}_y', '{}_z']}\nentities:\n"
         "  cup: {from: cup, size_m: [0.07, 0.07, 0.1]}\n  right_hand: {from: hand, " +
         hand + "size_m: [0.09, 0.08, 0.03]}\n";
}

TEST(ImportWarnings, AThingOfNoSizeAndAMapWithoutHandsAreTold) {
  const auto folder = FreshFolder("import_warnings");
  const auto told = [&](const std::string& map) {
    return ImportCsv(folder, SwingingCsv(60), map, {"--check"}).err;
  };
  const std::string map = SwingingMap("60");
  const std::string flat = "size_m has an edge of 0 m, and to be filled in, of 'cup': ",
                    no_hand = "no entity is a hand (hand: true), ";
  EXPECT_EQ(told(map).find("edge of 0"), std::string::npos);
  EXPECT_EQ(told(map).find(no_hand), std::string::npos);
  EXPECT_NE(told(Replaced(map, "[0.07, 0.07, 0.1]", "[0, 0, 0]")).find(flat), std::string::npos);
  EXPECT_NE(told(Replaced(map, "[0.07, 0.07, 0.1]", "[0.07, 0.07, 0]")).find(flat),
            std::string::npos);
  EXPECT_EQ(told(Replaced(map, "[0.09, 0.08, 0.03]", "[0, 0, 0]")).find("edge of 0"),
            std::string::npos)
      << "a hand may be a point";
  EXPECT_NE(told(SwingingMap("60", "")).find(no_hand), std::string::npos);
}

TEST(ImportWarnings, ASmoothPathDoesNotTremble) {
  const auto folder = FreshFolder("import_warnings");
  for (const char* rate_hz : {"3", "5", "15", "25", "30", "120"}) {
    const Said said =
        ImportCsv(folder, SwingingCsv(std::stod(rate_hz)), SwingingMap(rate_hz), {"--check"});
    EXPECT_EQ(said.err.find("tremble"), std::string::npos) << rate_hz << ": " << said.err;
  }
}

// A hand that goes to and fro, by 60 cm in half a second, and rests for 0.4 s.
TEST(ImportWarnings, AHandThatBrakesTremblesNoMoreThanWhereItRests) {
  const auto folder = FreshFolder("import_warnings");
  const auto trembles = [&](double noise_m) {
    const std::string csv = SwingingCsv(25, noise_m, [](double t_s) {
      const double turn = std::floor(t_s / 0.9), part = std::min(1.0, (t_s - 0.9 * turn) / 0.5);
      const double way = part * part * (3 - 2 * part);
      return 0.6 * (std::fmod(turn, 2) == 0 ? way : 1 - way);
    });
    return ImportCsv(folder, csv, SwingingMap("25"), {"--check"}).err.find("'hand' trembles by") !=
           std::string::npos;
  };
  EXPECT_FALSE(trembles(0.0004));
  EXPECT_TRUE(trembles(0.0015));
}

TEST(ImportWarnings, NoiseOnASmoothPathTremblesAndItsRemedyHelps) {
  const auto folder = FreshFolder("import_warnings");
  const std::string csv = SwingingCsv(30, 0.008);
  const Said rough = ImportCsv(folder, csv, SwingingMap("30"), {"--check"});
  EXPECT_NE(rough.err.find("'hand' trembles by"), std::string::npos) << rough.err;
  const std::size_t at = rough.err.find("smooth_s: ");
  ASSERT_NE(at, std::string::npos) << rough.err;
  const Said smooth =
      ImportCsv(folder, csv, SwingingMap("30") + rough.err.substr(at, 13) + "\n", {"--check"});
  EXPECT_EQ(smooth.err.find("tremble"), std::string::npos) << smooth.err;
}

TEST(ImportWarnings, NoMeansAreProposedThatTheMapRefuses) {
  const auto folder = FreshFolder("import_warnings");
  const Said said = ImportCsv(folder, SwingingCsv(10, 0.1), SwingingMap("10"), {"--check"});
  EXPECT_NE(said.err.find("'hand' trembles by"), std::string::npos) << said.err;
  EXPECT_EQ(said.err.find("smooth_s"), std::string::npos) << said.err;
}

TEST(ImportWarnings, OfFewPosesASecondItIsSaidWhatIsNotRecognised) {
  const auto folder = FreshFolder("import_warnings");
  const auto says = [&](const char* rate_hz, const std::string& more = "") {
    return ImportCsv(folder, SwingingCsv(std::stod(rate_hz)), SwingingMap(rate_hz) + more,
                     {"--check"})
        .err;
  };
  EXPECT_NE(says("5").find("warning: poses are 0.2 s apart, and what takes less than two of these, "
                           "like picking_up, is not recognised: correct rate_hz or time_unit; or, "
                           "if it is right, sure: [time]\n"),
            std::string::npos)
      << says("5");
  EXPECT_EQ(says("5", "sure: [time]\n").find("is not recognised"), std::string::npos);
  EXPECT_EQ(says("10").find("is not recognised"), std::string::npos) << says("10");
}

/// The errors, without what comes after the first line of each.
std::string ErrorsOf(const Said& said) {
  std::string errors;
  std::istringstream lines(said.err);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(": error: ");
    if (at != std::string::npos) errors += line.substr(at + 9) + "\n";
    if (line.starts_with("  hint: ")) errors += line + "\n";
  }
  return errors;
}

TEST(ImportWarnings, NamesOfColumnsOnAnotherLineAreFoundThere) {
  const auto folder = FreshFolder("import_warnings");
  const std::string csv = "Tracker 3,take 1\nrate,30\n" + SwingingCsv(30);
  const Said first = ImportCsv(folder, csv, SwingingMap("30"));
  EXPECT_EQ(ErrorsOf(first),
            "the names of the columns are on line 3, and not on line 1\n"
            "  hint: in the map: header_line: 3\n");
  EXPECT_NE(first.err.find("poses.csv:3:1: error: "), std::string::npos) << first.err;
  const Said later = ImportCsv(folder, csv, SwingingMap("30") + "header_line: 4\n");
  EXPECT_EQ(ErrorsOf(later),
            "the names of the columns are on line 3, and not on line 4\n"
            "  hint: in the map: header_line: 3\n");
  EXPECT_EQ(ImportCsv(folder, csv, SwingingMap("30") + "header_line: 3\n").exit_code, 0);
}

TEST(ImportWarnings, ALossSaysWhatWouldDo) {
  const auto folder = FreshFolder("import_warnings");
  std::string csv = SwingingCsv(30);
  std::size_t at = 0;
  for (int line = 0; line < 40; ++line) at = csv.find('\n', at) + 1;
  for (int line = 0; line < 10; ++line) {
    const std::size_t end = csv.find('\n', at);
    csv.replace(at, end - at, "0.3,0.2,0.75,,,");
    at = csv.find('\n', at) + 1;
  }
  const Said said = ImportCsv(folder, csv, SwingingMap("30"));
  EXPECT_EQ(ErrorsOf(said),
            "'hand' is not tracked for 0.367 s from 1.267 s on; in all 1 such time, 0.367 s\n"
            "  hint: in the map: lost: unknown (nobody knows where it is meanwhile), or bridge_s: "
            "0.37 (a straight line over the whole time), or lost: hold (it stays where it was)\n");
  for (const char* remedy : {"lost: unknown\n", "bridge_s: 0.37\n", "lost: hold\n"})
    EXPECT_EQ(ImportCsv(folder, csv, SwingingMap("30") + remedy).exit_code, 0) << remedy;
}

TEST(ImportWarnings, OrientationsThatAMapForgetsAreOneError) {
  const auto folder = FreshFolder("import_warnings");
  std::string map = SwingingMap("30");
  map = Replaced(map, "0.1]}", "0.1], upright_at_s: 0}");
  map = Replaced(map, "0.03]}", "0.03], upright_at_s: 0}");
  const Said said = ImportCsv(folder, SwingingCsv(30), map);
  EXPECT_EQ(ErrorsOf(said),
            "columns.quaternion is missing, and upright_at_s or axes_quat_wxyz of cup, right_hand "
            "needs bodies with "
            "orientations\n"
            "  hint: quaternion: [the four columns, in quaternion_order]; or, if the file has "
            "positions only, leave these out\n");
  EXPECT_NE(said.err.find("map.yaml:6:"), std::string::npos) << said.err;
}

/// The hand swings 0.6 m far.
TEST(ImportWarnings, HandsThatStayWithinAHandsWidthMakeTheUnitUnlikely) {
  const auto folder = FreshFolder("import_warnings");
  const std::string range =
      "all hands together stay within 0.06 m, and all that is tracked within 0.066 m; in m it "
      "would be 0.6 m";
  const std::string map = Replaced(SwingingMap("30"), "unit: m", "metres_per_unit: 0.1");
  const Said said = ImportCsv(folder, SwingingCsv(30), map, {"--check"});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find("warning: " + range + ": unit: m; or, if it is right, sure: [unit]\n"),
            std::string::npos)
      << said.err;
  // A wrong unit and no wrong table.
  EXPECT_EQ(said.err.find("'table: "), std::string::npos) << said.err;
  const std::string table =
      "  table: {at_m: [0, 0, 0.68], fixed: true, class: Table, size_m: [1, 1, 0.04]}\n";
  const Said far = ImportCsv(folder, SwingingCsv(30), map + table);
  EXPECT_EQ(ErrorsOf(far), range +
                               "; nothing tracked comes nearer to 'table' than 0.56 m ('hand')\n"
                               "  hint: unit: m; or, if it is right, sure: [unit]\n");
  const Said right = ImportCsv(folder, SwingingCsv(30), SwingingMap("30") + table, {"--check"});
  EXPECT_EQ(right.err.find("unit"), std::string::npos) << right.err;
}

TEST(ImportWarnings, AUnitInWhichTheTableIsReachedIsNamed) {
  const auto folder = FreshFolder("import_warnings");
  const std::string table =
      "  table: {at_m: [0, 0, 0.68], fixed: true, class: Table, size_m: [1, 1, 0.04]}\n";
  const Said said = ImportCsv(folder, SwingingCsv(30),
                              Replaced(SwingingMap("30"), "unit: m", "metres_per_unit: 3") + table);
  EXPECT_EQ(
      ErrorsOf(said),
      "nothing tracked comes nearer to 'table' than 1.60 m ('cup'); no hand comes nearer to a "
      "thing than 0.74 m\n  hint: unit: m; or, if it is right, sure: [unit]\n");
}

TEST(ImportWarnings, SizesThatNoHandMovesAreNamed) {
  const auto folder = FreshFolder("import_warnings");
  const Said said =
      ImportCsv(folder, SwingingCsv(30),
                Replaced(SwingingMap("30"), "[0.07, 0.07, 0.1]", "[7, 7, 10]"), {"--check"});
  EXPECT_NE(said.err.find("warning: 'cup' is 7 x 7 x 10 m large, and size_m is in metres; if these "
                          "are centimetres: size_m: [0.07, 0.07, 0.1]\n"),
            std::string::npos)
      << said.err;
  EXPECT_EQ(said.err.find("'table: "), std::string::npos) << said.err;
  const std::string map =
      Replaced(SwingingMap("30"), "unit: m", "metres_per_unit: 0.001\nsure: [unit]");
  const Said of_millimetres = ImportCsv(
      folder, SwingingCsv(30), Replaced(map, "[0.07, 0.07, 0.1]", "[70, 70, 100]"), {"--check"});
  EXPECT_NE(of_millimetres.err.find("if these are millimetres: size_m: [0.07, 0.07, 0.1]\n"),
            std::string::npos)
      << of_millimetres.err;
}

TEST(ImportWarnings, TimesThatCountFramesAreNamed) {
  const auto folder = FreshFolder("import_warnings");
  std::string csv;
  int frame = -1;
  std::istringstream lines(SwingingCsv(30));
  for (std::string line; std::getline(lines, line); ++frame)
    csv += (frame < 0 ? "frame" : std::to_string(frame)) + "," + line + "\n";
  const auto map = [](const std::string& unit, const std::string& rate) {
    return Replaced(Replaced(Replaced(SwingingMap("30"), "time_unit: frame", "time_unit: " + unit),
                             "rate_hz: 30\n", rate),
                    "{position", "{time: frame, position");
  };
  const std::string warning =
      "warning: the times of 'frame' are whole numbers that grow by 1 each: they look like frame "
      "numbers; in the map: time_unit: frame, and rate_hz; or, if they are times, sure: [time]\n";
  const Said said = ImportCsv(folder, csv, map("ms", ""), {"--check"});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find(warning), std::string::npos) << said.err;
  const Said sure = ImportCsv(folder, csv, map("ms", "sure: [time]\n"), {"--check"});
  EXPECT_EQ(sure.err.find("frame numbers"), std::string::npos) << sure.err;
  const Said frames = ImportCsv(folder, csv, map("frame", "rate_hz: 30\n"), {"--check"});
  EXPECT_EQ(frames.err.find("frame numbers"), std::string::npos) << frames.err;
  EXPECT_EQ(
      ErrorsOf(ImportCsv(folder, csv, map("ms", "rate_hz: 30\n"))),
      "rate_hz: 30, but poses are 0.001 s apart: 1000 Hz\n"
      "  hint: the times look like frame numbers: time_unit: frame; or, if it is right, sure: "
      "[time]\n");
  EXPECT_EQ(ErrorsOf(ImportCsv(folder, csv, map("s", ""))),
            "poses are 1 s apart: 1 Hz; they are whole numbers that grow by 1 each\n"
            "  hint: the times look like frame numbers: time_unit: frame and rate_hz; or, if it is "
            "right, sure: [time]\n");
}

TEST(ImportWarnings, AMapWithoutHandsIsWarnedOf) {
  const auto folder = FreshFolder("import_warnings");
  const Said said = ImportCsv(folder, SwingingCsv(30), SwingingMap("30", ""), {"--check"});
  EXPECT_NE(said.err.find("warning: no entity is a Hand, so what hands do is never recognised: "),
            std::string::npos)
      << said.err;
  EXPECT_NE(said.err.find("grasping"), std::string::npos) << said.err;
}

TEST(ImportWarnings, AGrammarThatDoesNotExistIsWrongWhereItIsNamed) {
  const auto folder = FreshFolder("import_warnings");
  const Said said = ImportCsv(folder, SwingingCsv(30), "grammar: contat\n" + SwingingMap("30"));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("map.yaml:1:10: error: grammar: no grammar is called 'contat'"),
            std::string::npos)
      << said.err;
  EXPECT_NE(said.err.find("did you mean 'contact'?"), std::string::npos) << said.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "take.jsonl"));

  ASSERT_EQ(ImportCsv(folder, SwingingCsv(30), SwingingMap("30")).exit_code, 0);
  const auto take = folder / "take.jsonl";
  WriteFile(take, Replaced(ReadFile(take), "\"pick_and_place_from_motion\"", "\"contat\""));
  for (std::vector<std::string> words : std::vector<std::vector<std::string>>{
           {"episode", "resegment"}, {"explain"}, {"grammar", "watch"}, {"check"}}) {
    const std::string command = words.back();
    words.push_back(take.string());
    const Said read = Prehend(words);
    EXPECT_EQ(read.exit_code, 2) << command;
    EXPECT_NE((read.out + read.err).find("take.jsonl:1:"), std::string::npos)
        << command << read.out << read.err;
    EXPECT_NE((read.out + read.err).find("no grammar is called 'contat'"), std::string::npos)
        << command << read.out << read.err;
  }
  // Recorded with a file of somebody's.
  WriteFile(take, Replaced(ReadFile(take), "\"contat\"", "\"somebodys_own_rules\""));
  const Said unnamed = Prehend({"episode", "export", take, "--to", "csv", "-o", folder / "x.csv"});
  EXPECT_EQ(unnamed.exit_code, 2);
  EXPECT_NE(unnamed.err.find("if it is a file of yours, --grammar FILE names it"),
            std::string::npos)
      << unnamed.err;
}

/// What `import` says of the story of tests/program/carried_cup.h.
std::string SaidOfCup(const std::string& from, const std::string& to) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 300; ++i) {
    csv += AsWritten("Mug", CupAt(i / 60.0));
    csv += AsWritten("Glove", HandAt(i / 60.0));
  }
  std::string map = Replaced(kCupMap, from, to);
  if (to == "from: Glove") map = Replaced(map, "from: Glove, hand", "from: Mug, hand");
  const Said said = ImportCsv(FreshFolder("import_warnings"), csv, map);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  return said.err;
}

TEST(ImportWarnings, AThingThatComesToAHandIsTakenForIt) {
  EXPECT_EQ(SaidOfCup("from: Mug", "from: Glove"),
            "warning: the thing 'Glove' goes 0.52 m with no hand near, and the hand 'Mug' moves "
            "only together with it: are they exchanged? (from: Mug and from: Glove); or, if not, "
            "sure: [place]\n");
}

TEST(ImportWarnings, WhatIsFixedAndMovesIsNamed) {
  EXPECT_EQ(SaidOfCup("class: Cup", "class: Cup, fixed: true"),
            "warning: 'cup' moves by 0.40 m, and the map says that it is fixed, which is only what "
            "never moves\n");
}

TEST(ImportWarnings, MeansOverLongTimesTellHowFarTheyAreOff) {
  for (const char* fine : {"0.1", "0.2"})
    EXPECT_EQ(SaidOfCup("import: 1", std::string("import: 1\nsmooth_s: ") + fine), "") << fine;
  const std::string said = SaidOfCup("import: 1", "import: 1\nsmooth_s: 1");
  EXPECT_NE(said.find("warning: smooth_s: 1 moves 'Mug' by more than 20 mm in "), said.npos)
      << said;
  EXPECT_NE(said.find(": what takes less time than that is smoothed away\n"), said.npos) << said;
}

TEST(ImportWarnings, ThingsThatStandInATableOrAboveItAreNamed) {
  const auto at = [](const char* z_m) { return SaidOfCup("[0, 0, 0.7]", z_m); };
  const std::string asks =
      "'table': is at_m or size_m of 'table', or offset_m or size_m of 'cup' wrong?\n";
  EXPECT_EQ(at("[0, 0, 0.71]"), "");
  EXPECT_EQ(at("[0, 0, 0.69]"), "");
  EXPECT_EQ(at("[0, 0, 0.73]"), "warning: 'cup' rests 30 mm deep in " + asks);
  EXPECT_EQ(at("[0, 0, 0.745]"), "warning: 'cup' rests 45 mm deep in " + asks);
  EXPECT_EQ(at("[0, 0, 0.68]"), "warning: 'cup' rests 20 mm above " + asks);
  // It is in a bowl, of which only the box is known.
  EXPECT_EQ(SaidOfCup("[2.0, 1.0, 0.04]", "[2.0, 1.0, 0.2]"), "");
}

// Two tops are near below it: the nearest counts, in whatever order the map has them.
TEST(ImportWarnings, WhatStandsOnAPadStandsOnNoTableBelowIt) {
  const std::string table =
      "  table: {at_m: [0, 0, 0.66], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}\n";
  const auto with_pad = [&](const std::string& z_m, bool first) {
    const std::string pad =
        "  pad: {at_m: [0, 0, " + z_m + "], fixed: true, class: Pad, size_m: [2.0, 1.0, 0.04]}\n";
    const std::string before = Replaced(table, "0.66", "0.7");
    return SaidOfCup(before, first ? pad + table : table + pad);
  };
  for (const bool first : {true, false}) {
    EXPECT_EQ(with_pad("0.7", first), "") << first;
    EXPECT_EQ(with_pad("0.68", first),
              "warning: 'cup' rests 20 mm above 'pad': is at_m or size_m of 'pad', or offset_m or "
              "size_m of 'cup' wrong?\n")
        << first;
  }
}

// At 0.4 of its size the hand is never out of reach; but as it comes and goes, the cup rests.
TEST(ImportWarnings, AWrongUnitOfNoNameIsSeenWhereThingsRest) {
  const std::string said = SaidOfCup("unit: m", "metres_per_unit: 0.4");
  EXPECT_NE(
      said.find("warning: 'cup' rests with the lowest point at 0.26 m, and nothing in the map "
                "has its top within 8 cm of that"),
      said.npos)
      << said;
  EXPECT_NE(said.find("; all that the map places is higher: is unit right?\n"), said.npos) << said;
  EXPECT_EQ(SaidOfCup("unit: m", "metres_per_unit: 1"), "");
}

TEST(ImportWarnings, OfTimesInAnotherUnitThatUnitIsNamed) {
  for (const auto& [of_map, per_second, named] :
       {std::tuple("ms", 1e6, "microseconds"), {"us", 1e3, "milliseconds"}, {"ms", 1, "seconds"}}) {
    std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
    for (int i = 0; i <= 300; ++i)
      for (const bool is_cup : {true, false}) {
        auto at = is_cup ? CupAt(i / 60.0) : HandAt(i / 60.0);
        at.t_s *= per_second;
        csv += AsWritten(is_cup ? "Mug" : "Glove", at);
      }
    const std::string map = Replaced(kCupMap, "time_unit: s", std::string("time_unit: ") + of_map);
    const Said said = ImportCsv(FreshFolder("import_warnings"), csv, map);
    EXPECT_NE(said.err.find(std::string("the times look like ") + named + ";"), said.err.npos)
        << said.err;
  }
}

// It was asked for the unit; in a smaller one nothing moves.
TEST(ImportWarnings, AFarOriginIsNoWrongUnit) {
  const auto folder = FreshFolder("import_warnings");
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 300; ++i)
    for (const bool is_cup : {true, false}) {
      auto at = is_cup ? CupAt(i / 60.0) : HandAt(i / 60.0);
      at.x += 35, at.y += 120, at.z += 90;
      csv += AsWritten(is_cup ? "Mug" : "Glove", at);
    }
  const std::string table =
      "  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}\n";
  const Said bare = ImportCsv(folder, csv, Replaced(kCupMap, table, ""), {"--check"});
  EXPECT_EQ(bare.exit_code, 0) << bare.err;
  EXPECT_NE(bare.err.find("what it stands on could be 'table"), std::string::npos) << bare.err;
  EXPECT_EQ(bare.err.find("unit"), std::string::npos) << bare.err;
  const std::string far = Replaced(kCupMap, "[0, 0, 0.7]", "[35, 120, 90.7]");
  EXPECT_EQ(ImportCsv(folder, csv, far, {"--check"}).err, "");
  const Said wrong = ImportCsv(folder, csv, Replaced(far, "unit: m", "unit: cm"), {"--check"});
  EXPECT_NE(wrong.err.find("hint: unit: m; or"), std::string::npos) << wrong.err;
}

TEST(ImportWarnings, BracesWithoutQuotesAreExplained) {
  const auto folder = FreshFolder("import_warnings");
  const Said said =
      ImportCsv(folder, SwingingCsv(30),
                Replaced(SwingingMap("30"), "['{}_x', '{}_y', '{}_z']", "[{}_x, {}_y, {}_z]"));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("text cannot begin with '{}', which is an empty mapping"),
            std::string::npos)
      << said.err;
}

}  // namespace
}  // namespace prehend::house
