// SPDX-License-Identifier: Apache-2.0
// Things whose axes are not those that their map says: they rest turned otherwise than upright.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"

namespace prehend::house {
namespace {

/// By how many degrees a body is turned about x, in time.
using Degrees = std::function<double(double)>;

/// Before that it is rolled about its own z.
std::string RowOf(double t_s, const char* name, double x, double y, double z, double degrees,
                  double roll_degrees = 0) {
  // No tracker sees the same orientation twice.
  const double half = (degrees + 0.01 * std::sin(100 * t_s)) * std::numbers::pi / 360;
  const double roll = roll_degrees * std::numbers::pi / 360;
  char text[200];
  std::snprintf(text, sizeof text, "%.4f,%s,%.6f,%.6f,%.6f,%.8f,%.8f,%.8f,%.8f\n", t_s, name, x, y,
                z, std::cos(half) * std::cos(roll), std::sin(half) * std::cos(roll),
                -std::sin(half) * std::sin(roll), std::cos(half) * std::sin(roll));
  return text;
}

/// The carried cup and a jar that stands on the table.
std::string Csv(const Degrees& cup, double jar_degrees, double cup_roll = 0) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 300; ++i) {
    const double t_s = i / 60.0;
    const Row at = CupAt(t_s), hand = HandAt(t_s);
    csv += RowOf(t_s, "Mug", at.x, at.y, at.z, cup(t_s), cup_roll);
    csv += RowOf(t_s, "Glove", hand.x, hand.y, hand.z, 0);
    csv += RowOf(t_s, "Jar", 0.5, -0.3, 0.77, jar_degrees);
  }
  return csv;
}

std::string Map(const char* cup = "", const char* jar = "", const char* hand = "") {
  return std::string(R"(import: 1
unit: m
axes: z_up
quaternion_order: wxyz
time_unit: s
columns: {time: t, body: name, position: [x, 'y', z], quaternion: [qw, qx, qy, qz]}
entities:
  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}
  cup: {from: Mug, class: Cup, size_m: [0.08, 0.08, 0.1])") +
         cup + "}\n  jar: {from: Jar, size_m: [0.1, 0.1, 0.1]" + jar +
         "}\n  hand: {from: Glove, hand: true, size_m: [0, 0, 0]" + hand + "}\n";
}

class ImportRestPoses : public testing::Test {
 protected:
  std::string Warnings(const Degrees& cup, double jar_degrees, const std::string& map) const {
    const Said said = ImportCsv(folder_, Csv(cup, jar_degrees), map, {"--check"});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.err;
  }
  static Degrees Always(double degrees) {
    return [degrees](double) { return degrees; };
  }
  const std::filesystem::path folder_ = FreshFolder("import_rest_poses");
};

TEST_F(ImportRestPoses, AxesThatTheTrackerGaveAreNamedWithTheTimeThatMendsThem) {
  EXPECT_EQ(Warnings(Always(0), 0, Map()), "");
  EXPECT_EQ(Warnings(Always(40), 0, Map()),
            "warning: 'cup' rests with its z axis 40 degrees away from upright: trackers give "
            "bodies any axes; if it stands upright at 0 s, in the map: cup: {.., upright_at_s: "
            "0}\n");
  EXPECT_EQ(Warnings(Always(40), 0, Map(", upright_at_s: 0")), "");
  EXPECT_EQ(Warnings(Always(40), 0, Map() + "sure: [upright]\n"), "");
}

TEST_F(ImportRestPoses, ATimeAtWhichItWasTippedIsNotWhenItIsUpright) {
  const Degrees pours = [](double t) {
    return Along({{2.2, 0}, {2.3, 60}, {2.7, 60}, {2.8, 0}}, t);
  };
  EXPECT_EQ(Warnings(pours, 0, Map(", upright_at_s: 0")), "");
  EXPECT_EQ(Warnings(pours, 0, Map(", upright_at_s: 2.5")),
            "warning: 'cup' rests with its z axis 60 degrees away from upright: at its "
            "upright_at_s, 2.5 s, it was turned otherwise than it rests; if it stands upright at 0 "
            "s, in the map: cup: {.., upright_at_s: 0}\n");
}

TEST_F(ImportRestPoses, WhatLiesOrIsUpsideDownMayDoSo) {
  for (const double degrees : {80.0, 90.0, 100.0, 170.0, 180.0})
    EXPECT_EQ(Warnings(Always(degrees), 0, Map()), "") << degrees;
  // But not if it would stand where, lying, it would be beside the table's top.
  const std::string tall =
      Replaced(Map(", offset_m: [0, 0, 0.06]"), "[0.08, 0.08, 0.1]", "[0.08, 0.08, 0.22]");
  EXPECT_EQ(Warnings(Always(0), 0, tall), "");
  EXPECT_NE(Warnings(Always(180), 0, tall).find("'cup' rests with its z axis 180 degrees away"),
            std::string::npos);
}

// Nothing lies on an edge of its box; what is as deep as wide may be round, and roll.
TEST_F(ImportRestPoses, WhatLiesDoesSoOnASide) {
  const std::string flat = Replaced(Map(), "[0.08, 0.08, 0.1]", "[0.08, 0.05, 0.1]");
  const auto doubts = [&](double roll, const std::string& map) {
    const Said said = ImportCsv(folder_, Csv(Always(90), 0, roll), map, {"--check"});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.err.find("'cup' rests with its z axis 90 degrees away") != std::string::npos;
  };
  for (const double roll : {0.0, 10.0, 90.0, 170.0}) EXPECT_FALSE(doubts(roll, flat)) << roll;
  for (const double roll : {20.0, 45.0, 70.0, 110.0}) EXPECT_TRUE(doubts(roll, flat)) << roll;
  EXPECT_FALSE(doubts(45, Map()));
}

TEST_F(ImportRestPoses, WhatSeemsToLieHasAnyAxesAsTheOthersHave) {
  const std::string said =
      Warnings(Always(90), 50, Map("", "", ", offset_m: [0.05, 0, 0], ahead: [1, 0, 0]"));
  EXPECT_NE(said.find("'cup' rests with its z axis 90 degrees away"), std::string::npos) << said;
  EXPECT_NE(said.find("'jar' rests with its z axis 50 degrees away"), std::string::npos) << said;
  EXPECT_NE(said.find("warning: 'hand' has no upright_at_s either, and offset_m and ahead count in "
                      "the axes that the tracker gave: it is a time at which the hand is flat, as "
                      "it is described\n"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("'table: {"), std::string::npos) << said;
}

TEST_F(ImportRestPoses, ThingsThatAreTurnedTheSameWayAreNotWrongEach) {
  EXPECT_EQ(Warnings(Always(25), 25, Map()).find("upright"), std::string::npos);
}

}  // namespace
}  // namespace prehend::house
