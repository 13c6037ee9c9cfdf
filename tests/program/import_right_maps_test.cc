// SPDX-License-Identifier: Apache-2.0
// Maps that are right and were once refused or doubted: a thing that is handed over, things of a
// table and a shelf, a thing that a hand holds in mid-air, a thing that nobody moves. How often
// guesses are wrong is counted by tests/program/import_guesses.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>

#include "tests/program/import_csv.h"

namespace prehend::house {
namespace {

using Point = std::array<double, 3>;
/// Where bodies are at a time.
using Story = std::function<std::map<std::string, Point>(double t_s)>;

double Smooth(double share) {
  const double u = std::min(std::max(share, 0.0), 1.0);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

std::string CsvOf(double until_s, const Story& story) {
  std::string csv = "t,name,x,y,z\n";
  for (int i = 0; i < until_s * 60; ++i) {
    for (const auto& [name, p] : story(i / 60.0)) {
      char row[100];
      std::snprintf(row, sizeof row, "%.4f,%s,%.4f,%.4f,%.4f\n", i / 60.0, name.c_str(), p[0], p[1],
                    p[2]);
      csv += row;
    }
  }
  return csv;
}

std::string MapOf(const std::string& entities) {
  return "import: 1\nunit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, body: name, position: "
         "[x, 'y', z]}\nentities:\n" +
         entities;
}

class ImportRightMaps : public testing::Test {
 protected:
  /// What import says but that the file has no orientations.
  std::string Warnings(const std::string& csv, const std::string& entities) const {
    const Said said = ImportCsv(folder_, csv, MapOf(entities));
    EXPECT_EQ(said.exit_code, 0) << said.err;
    std::string text = said.err;
    const std::size_t at = text.find("warning: the file has positions only");
    return at == std::string::npos ? text : text.erase(at, text.find('\n', at) + 1 - at);
  }
  const std::filesystem::path folder_ = FreshFolder("import_right_maps");
};

TEST_F(ImportRightMaps, AThingThatIsHandedOverCurvesSideways) {
  for (const double side : {0.5, -0.5, 0.2}) {
    const auto story = [&](double t_s) {
      const double u = Smooth((t_s - 1) / 1.2), v = Smooth((t_s - 2.8) / 1.5);
      const Point cup = {0.5 * u - 0.42 * v, side * (0.2 * u - v), 1.1 + 0.02 * u};
      const double back = Smooth((t_s - 2.6) / 1);
      Point a = {cup[0] + 0.05, cup[1], cup[2]}, b = {cup[0] - 0.05, cup[1], cup[2]};
      if (t_s >= 2.5) a = {0.55 - 0.6 * back, side * 0.2, 1.12};
      const double come = Smooth((t_s - 1.2) / 1.2);
      if (t_s < 2.5) b = {0.85 - 0.4 * come, -0.1 + (side * 0.2 + 0.1) * come, 1.12};
      return std::map<std::string, Point>{{"cup", cup}, {"giver", a}, {"taker", b}};
    };
    EXPECT_EQ(Warnings(CsvOf(6, story),
                       "  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}\n"
                       "  giver: {from: giver, hand: true, size_m: [0.1, 0.09, 0.04]}\n"
                       "  taker: {from: taker, hand: true, size_m: [0.1, 0.09, 0.04]}\n"),
              "")
        << side;
  }
}

/// Four things go from a table, its top at 0.7 m, to a shelf.
Story ToShelf(double shelf_m) {
  return [shelf_m](double t_s) {
    std::map<std::string, Point> at;
    Point hand = {0, -0.4, 1};
    for (int i = 0; i < 4; ++i) {
      const double u = Smooth((t_s - 1.5 - 4.5 * i) / 1.5);
      const Point from = {0.1 * (i % 2), 0.3 * i, 0.75},
                  to = {0.6 + 0.05 * (i % 2), 0.3 * i, shelf_m + 0.05};
      Point p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = from[k] + (to[k] - from[k]) * u;
      p[2] += 0.15 * std::sin(std::numbers::pi * u);
      at[std::string(1, static_cast<char>('a' + i))] = p;
      // From its place to the thing, with it, and back.
      const double there = Smooth((t_s - 0.2 - 4.5 * i) / 1),
                   away = Smooth((t_s - 3.2 - 4.5 * i) / 1);
      const double with = there * (1 - away);
      if (with > 0)
        for (std::size_t k = 0; k < 3; ++k)
          hand[k] += with * (p[k] + (k == 2 ? 0.06 : 0) - hand[k]);
    }
    at["hand"] = hand;
    return at;
  };
}

std::string ThingsOfShelf() {
  std::string text = "  right_hand: {from: hand, hand: true, size_m: [0.1, 0.09, 0.04]}\n";
  for (const char* name : {"a", "b", "c", "d"})
    text += std::string("  ") + name + ": {from: " + name + ", size_m: [0.08, 0.08, 0.1]}\n";
  return text;
}

TEST_F(ImportRightMaps, ATableAndAShelfAreNoTiltedPlane) {
  const std::string table =
      "  table: {at_m: [0, 0.4, 0.68], fixed: true, class: Table, size_m: [0.8, 2, 0.04]}\n";
  for (const double shelf_m : {0.8, 0.95}) {
    const std::string shelf = "  shelf: {at_m: [0.7, 0.4, " + std::to_string(shelf_m - 0.02) +
                              "], fixed: true, class: Table, size_m: [0.4, 2, 0.04]}\n";
    const std::string csv = CsvOf(20, ToShelf(shelf_m));
    EXPECT_EQ(Warnings(csv, ThingsOfShelf() + table + shelf), "") << shelf_m;
    // Two levels are levels, too, where the map does not have them.
    const std::string without = Warnings(csv, ThingsOfShelf());
    EXPECT_EQ(without.find("tilted"), std::string::npos) << without;
    EXPECT_NE(without.find("what it stands on could be 'table: "), std::string::npos) << without;
  }
}

TEST_F(ImportRightMaps, WhatAHandHoldsInMidAirStandsOnNothing) {
  for (const double shift_m : {0.07, 0.0, -0.07}) {
    const auto story = [&](double t_s) {
      const double lifted = Smooth(t_s - 1);
      const Point rod = {0.3 * lifted + 0.3 * Smooth((t_s - 3.5) / 1.2), 0, 1.1 + 0.1 * lifted};
      const double grip = 0.1 + shift_m * Smooth((t_s - 1.9) / 0.6);
      return std::map<std::string, Point>{{"rod", rod}, {"hand", {rod[0] - grip, 0, rod[2]}}};
    };
    EXPECT_EQ(Warnings(CsvOf(6, story),
                       "  rod: {from: rod, class: Rod, size_m: [0.1, 0.04, 0.04]}\n"
                       "  right_hand: {from: hand, hand: true, size_m: [0.06, 0.09, 0.04]}\n"),
              "")
        << shift_m;
  }
}

// That nothing moves is no question of the unit.
TEST_F(ImportRightMaps, AThingThatNobodyMovesHasAnyUnit) {
  const auto story = [](double) { return std::map<std::string, Point>{{"cup", {0.1, 0.2, 0.75}}}; };
  const std::string said =
      Warnings(CsvOf(2, story), "  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}\n");
  EXPECT_EQ(said.find("unit"), std::string::npos) << said;
}

// Unity's axes: what is read as left-handed is the mirror image, and a right hand is right again.
TEST_F(ImportRightMaps, LeftHandedAxesAreSeenInAMirror) {
  const auto two_hands = [](double mirror) {
    return [mirror](double t_s) {
      const double u = Smooth((t_s - 1) / 1), v = Smooth((t_s - 4) / 1);
      const Point cup = {0.1 * v, 0.4, 0.75 + 0.2 * std::sin(std::numbers::pi * v)};
      const double with = u * (1 - Smooth((t_s - 6) / 1));
      const Point right = {0.3 + with * (cup[0] - 0.3), -0.2 + with * 0.55,
                           0.8 + with * (cup[2] - 0.75)};
      std::map<std::string, Point> at = {
          {"cup", cup}, {"right", right}, {"left", {-0.3, -0.2, 0.8}}};
      for (auto& [name, p] : at) p[0] *= mirror;
      return at;
    };
  };
  const std::string entities =
      "  table: {at_m: [0, 0.2, 0.68], fixed: true, class: Table, size_m: [1.4, 1, 0.04]}\n"
      "  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}\n"
      "  right_hand: {from: right, hand: true, size_m: [0.1, 0.09, 0.04]}\n"
      "  left_hand: {from: left, hand: true, size_m: [0.1, 0.09, 0.04]}\n";
  const auto events = [&] {
    return Prehend({"episode", "resegment", (folder_ / "take.jsonl").string(), "--json"}).out;
  };
  const std::string right = CsvOf(12, two_hands(1)), mirrored = CsvOf(12, two_hands(-1));
  EXPECT_EQ(Warnings(right, entities).find("handed"), std::string::npos);
  const std::string wanted = events();
  const std::string said = Warnings(mirrored, entities);
  EXPECT_NE(said.find("the right hand is 0.59 m to the left of the left hand"), std::string::npos)
      << said;
  EXPECT_NE(said.find("handed: left; or, if it is right, sure: [handed]"), std::string::npos)
      << said;
  const std::string mended = Warnings(mirrored, entities + "handed: left\n");
  EXPECT_EQ(mended.find("handed"), std::string::npos) << mended;
  EXPECT_EQ(events(), wanted);
  // And the other way round: the file's axes are right-handed, and the map says left.
  EXPECT_NE(
      Warnings(right, entities + "handed: left\n")
          .find("the file's axes look right-handed, or the hands are exchanged: handed: right; "
                "or, if it is right, sure: [handed]"),
      std::string::npos);
}

}  // namespace
}  // namespace prehend::house
