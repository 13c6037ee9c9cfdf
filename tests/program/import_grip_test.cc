// SPDX-License-Identifier: Apache-2.0
// How far grippers and joints are open, as files of poses say it, becomes trigger and
// joint_fraction of a recording; what is wrong with it is named.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kMap = R"(import: 1
unit: m
axes: z_up
time_unit: s
columns: {time: t, position: ['{}_x', '{}_y', '{}_z']}
entities:
  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}
  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}
  hand: {from: eef, hand: true, size_m: [0, 0, 0], grip: {from: [q1, q2], sum_abs: true, open: 0.08, closed: 0}}
  door: {at_m: [0.7, 0, 0.9], class: Door, size_m: [0.4, 0.02, 0.3], joint: {from: hinge, closed: 0.1, open: 1.3}}
)";

/// One finger's way from the middle: open, on a cup of 43 mm, open again.
double FingerAt(double t) {
  return Along({{0.9, 0.04}, {1.2, 0.0215}, {3.5, 0.0215}, {3.7, 0.04}}, t);
}
double HingeAt(double t) { return Along({{1, 0.1}, {3, 1.3}}, t); }

using Cells = std::function<std::string(double t, double finger, double hinge)>;

std::string ThreeCells(double, double finger, double hinge) {
  char text[100];
  std::snprintf(text, sizeof text, "%.5f,%.5f,%.5f", finger, -finger, hinge);
  return text;
}

/// Five seconds at 20 Hz.
std::string Csv(const Cells& cells = ThreeCells, const char* names = "q1,q2,hinge") {
  std::string csv = "t,cup_x,cup_y,cup_z,eef_x,eef_y,eef_z," + std::string(names) + "\n";
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 20.0;
    const Row cup = CupAt(t), hand = HandAt(t);
    char text[200];
    std::snprintf(text, sizeof text, "%.4f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,", t, cup.x, cup.y, cup.z,
                  hand.x, hand.y, hand.z);
    csv += text + cells(t, FingerAt(t), HingeAt(t)) + "\n";
  }
  return csv;
}

struct Facts {
  double trigger = 0, fraction = 0, position = 0;
};

/// Of the recording, at a time.
Facts FactsAt(const std::filesystem::path& folder, double t_s) {
  std::istringstream lines(ReadFile(folder / "take.jsonl"));
  std::string line;
  Facts facts;
  while (std::getline(lines, line)) {
    const auto json = nlohmann::json::parse(line);
    if (!json.contains("tick")) continue;
    if (json["tick"].get<double>() > t_s * 1e4 + 0.5) break;
    if (json.contains("hands") && json["hands"].contains("hand"))
      facts.trigger = json["hands"]["hand"]["trigger"];
    if (!json.contains("samples") || !json["samples"].contains("door")) continue;
    facts.fraction = json["samples"]["door"].value("joint_fraction", 0.0);
    facts.position = json["samples"]["door"].value("joint_position", 0.0);
  }
  return facts;
}

TEST(ImportGrip, ColumnsBecomeFractionsOfOpenAndClosed) {
  const auto folder = FreshFolder("import_grip");
  const Said said = ImportCsv(folder, Csv(), kMap);
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("hand: grip 'q1 + q2': 101 values at 20.0 Hz, 54 to 100 % open\n"
                          "door: joint 'hinge': 101 values at 20.0 Hz, 0 to 100 % open\n"),
            std::string::npos)
      << said.out;
  for (const double t : {0.0, 0.5, 1.0, 1.05, 2.0, 3.0, 3.6, 4.9}) {
    const Facts facts = FactsAt(folder, t);
    EXPECT_NEAR(facts.trigger, 1 - 2 * FingerAt(t) / 0.08, 5e-4) << t;
    EXPECT_NEAR(facts.fraction, (HingeAt(t) - 0.1) / 1.2, 1e-5) << t;
    EXPECT_NEAR(facts.position, HingeAt(t), 1e-5) << t;
  }
  const Said doors =
      Prehend({"episode", "resegment", (folder / "take.jsonl").string(), "--grammar", "furniture"});
  EXPECT_NE(doors.out.find("opening"), std::string::npos) << doors.out << doors.err;
}

TEST(ImportGrip, APositionIsInMetresOrRadians) {
  std::string csv = Csv();
  for (const auto& [unit, says, position] :
       std::vector<std::tuple<const char*, const char*, double>>{{"m", "", 1.3},
                                                                 {"mm", "", 0.0013},
                                                                 {"mm", ", unit: rad", 1.3},
                                                                 {"m", ", unit: cm", 0.013},
                                                                 {"m", ", unit: deg", 0.022689}}) {
    const auto folder = FreshFolder("import_grip");
    const std::string map =
        Replaced(Replaced(kMap, "unit: m", std::string("unit: ") + unit + "\nsure: [unit]"),
                 "open: 1.3}", std::string("open: 1.3") + says + "}");
    const Said said = ImportCsv(folder, csv, map);
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_NEAR(FactsAt(folder, 4).position, position, 1e-6) << unit << says;
    EXPECT_EQ(
        said.err.find("'door': 'hinge' counts as in the file's unit of positions; if it turns, or "
                      "has another, unit: rad beside 'open' says it") != std::string::npos,
        unit == std::string("mm") && *says == 0)
        << said.err;
  }
}

TEST(ImportGrip, AnActionIsOneAndBeyondTheEndsNothingMore) {
  const auto folder = FreshFolder("import_grip");
  // +1 opens; -1.2 is a little more than closed.
  const auto cells = [](double t, double, double) {
    return std::string(t > 1 && t < 3.5 ? "-1.2" : "1") + "," + std::to_string(t * 0.3);
  };
  std::string map = Replaced(kMap, "{from: [q1, q2], sum_abs: true, open: 0.08, closed: 0}",
                             "{from: act, open: 1, closed: -1}");
  const Said said = ImportCsv(folder, Csv(cells, "act,hinge"), map);
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err.find("act"), std::string::npos) << said.err;
  EXPECT_EQ(FactsAt(folder, 0.5).trigger, 0);
  EXPECT_EQ(FactsAt(folder, 2).trigger, 1);
  EXPECT_EQ(FactsAt(folder, 4.9).fraction, 1);
  EXPECT_NEAR(FactsAt(folder, 4.9).position, 1.47, 1e-6);
  EXPECT_EQ(FactsAt(folder, 0.2).fraction, 0);
}

TEST(ImportGrip, AHandleIsAPartOfItsDrawer) {
  const auto folder = FreshFolder("import_grip");
  const std::string map =
      Replaced(kMap, "cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}",
               "knob: {from: cup, class: Handle, size_m: [0.02, 0.02, 0.02], part_of: door}");
  const Said said = ImportCsv(folder, Csv(), map);
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const std::string text = ReadFile(folder / "take.jsonl");
  EXPECT_NE(text.find("\"part_of\":\"door\""), std::string::npos) << text.substr(0, 900);
  EXPECT_NE(text.find("\"attached\":true"), std::string::npos) << text.substr(0, 900);
  const Said doors = Prehend({"episode", "resegment", (folder / "take.jsonl").string(), "--grammar",
                              "furniture_from_gripper"});
  EXPECT_EQ(doors.exit_code, 0) << doors.err;
  const Said wrong = ImportCsv(folder, Csv(), Replaced(map, "part_of: door", "part_of: dor"));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("no entity is called 'dor'"), std::string::npos) << wrong.err;
  EXPECT_EQ(ImportCsv(folder, Csv(), Replaced(map, "part_of: door", "part_of: knob")).exit_code, 2);
}

TEST(ImportGrip, OneBodyPerRowHasTheValuesOfItsRows) {
  const auto folder = FreshFolder("import_grip");
  std::string csv = "t,name,x,y,z,w\n";
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 20.0;
    const Row cup = CupAt(t), hand = HandAt(t);
    char text[300];
    std::snprintf(text, sizeof text,
                  "%.4f,cup,%.5f,%.5f,%.5f,\n%.4f,eef,%.5f,%.5f,%.5f,%.5f\n%.4f,door,,,,%.5f\n", t,
                  cup.x, cup.y, cup.z, t, hand.x, hand.y, hand.z, 2 * FingerAt(t), t, HingeAt(t));
    csv += text;
  }
  std::string map = Replaced(kMap, "{time: t, position: ['{}_x', '{}_y', '{}_z']}",
                             "{time: t, body: name, position: [x, 'y', z]}");
  map = Replaced(map, "from: [q1, q2], sum_abs: true", "from: w");
  map = Replaced(map, "from: hinge", "from: w");
  const Said said = ImportCsv(folder, csv, map);
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NEAR(FactsAt(folder, 2).trigger, 1 - 0.043 / 0.08, 1e-6);
  EXPECT_NEAR(FactsAt(folder, 2).fraction, 0.5, 1e-6);
}

TEST(ImportGrip, WhatTheMapGetsWrongIsNamed) {
  const auto folder = FreshFolder("import_grip");
  struct Case {
    const char *from, *to, *message;
  };
  for (const auto& [from, to, message] : std::vector<Case>{
           {"from: [q1, q2]", "from: [q1, q3]", "no column is called 'q3'"},
           {"open: 0.08, closed: 0}", "open: 0, closed: 0}", "'open' and 'closed' are both 0"},
           {"hand: true, size_m: [0, 0, 0]", "size_m: [0, 0, 0]",
            "only a hand has a grip, and 'hand' is none"},
           {"class: Door", "fixed: true, class: Door", "'door' is fixed, and nothing on a joint"},
           {"open: 0.08, closed: 0}", "open: 0.08}", "closed"},
           {"from: [q1, q2]", "from: []", "from"},
           {"from: hinge", "from: {a: b}", "from"},
       }) {
    const Said said = ImportCsv(folder, Csv(), Replaced(kMap, from, to));
    EXPECT_EQ(said.exit_code, 2) << to;
    EXPECT_NE(said.err.find(message), std::string::npos) << to << "\n" << said.err;
    EXPECT_NE(said.err.find("map.yaml:"), std::string::npos) << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "take.jsonl"));
  }
}

TEST(ImportGrip, MissingValuesAreBridgedHeldOrRefused) {
  const auto folder = FreshFolder("import_grip");
  const auto without = [](double from, double until, const char* cell) {
    return [=](double t, double finger, double hinge) {
      const std::string cells = ThreeCells(t, finger, hinge);
      if (t < from || t > until) return cells;
      return cell + cells.substr(cells.find(','));
    };
  };
  ASSERT_EQ(ImportCsv(folder, Csv(without(1.02, 1.06, "")), kMap).exit_code, 0);
  EXPECT_NEAR(FactsAt(folder, 1.05).trigger, 1 - 2 * FingerAt(1.05) / 0.08, 1e-3);

  const std::string gap = Csv(without(1.02, 2.06, ""));
  std::filesystem::remove(folder / "take.jsonl");
  const Said refused = ImportCsv(folder, gap, kMap);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("'q1 + q2' has no value for 1.100 s from 1.000 s on"),
            std::string::npos)
      << refused.err;
  const Said held = ImportCsv(folder, gap, Replaced(kMap, "axes: z_up", "axes: z_up\nlost: hold"));
  EXPECT_EQ(held.exit_code, 0) << held.err;
  EXPECT_NE(held.err.find("it stays as it was"), std::string::npos) << held.err;
  EXPECT_NEAR(FactsAt(folder, 2).trigger, 1 - 2 * FingerAt(1) / 0.08, 1e-3);

  const std::string nan = Csv(without(1.02, 1.06, "nan"));
  const Said no_number = ImportCsv(folder, nan, kMap);
  EXPECT_EQ(no_number.exit_code, 2);
  EXPECT_NE(no_number.err.find("poses.csv:23:"), std::string::npos) << no_number.err;
  EXPECT_NE(no_number.err.find("missing: [nan]"), std::string::npos) << no_number.err;
  const std::string map = Replaced(kMap, "axes: z_up", "axes: z_up\nmissing: [nan, -1, 'lost']");
  const Said missing = ImportCsv(folder, nan, map);
  EXPECT_EQ(missing.exit_code, 0) << missing.err;
}

TEST(ImportGrip, ValuesFarBeyondTheEndsAndGrippersThatNeverMoveAreNamed) {
  const auto folder = FreshFolder("import_grip");
  const Said metres = ImportCsv(folder, Csv(), Replaced(kMap, "open: 0.08", "open: 80"));
  EXPECT_EQ(metres.exit_code, 0);
  EXPECT_NE(
      metres.err.find("'q1 + q2' hardly changes: from 0.043 to 0.08, of open 80 and closed 0"),
      std::string::npos)
      << metres.err;
  const auto spike = [](double t, double finger, double hinge) {
    return ThreeCells(t, t == 2 ? 1 : finger, hinge);
  };
  const Said some = ImportCsv(folder, Csv(spike), kMap);
  EXPECT_EQ(some.exit_code, 0) << some.err;
  EXPECT_NE(some.err.find("1 of 101 values of 'q1 + q2' are more than a quarter"),
            std::string::npos)
      << some.err;
  EXPECT_NE(some.err.find("poses.csv:42: 2, of open 0.08 and closed 0"), std::string::npos)
      << some.err;
  std::filesystem::remove(folder / "take.jsonl");
  const Said degrees = ImportCsv(folder, Csv([](double t, double finger, double hinge) {
                                   return ThreeCells(t, finger, hinge * 57.3);
                                 }),
                                 kMap);
  EXPECT_EQ(degrees.exit_code, 2);
  EXPECT_NE(degrees.err.find("is it another column, or another unit?"), std::string::npos)
      << degrees.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "take.jsonl"));
}

}  // namespace
}  // namespace prehend::house
