// SPDX-License-Identifier: Apache-2.0
// Frames that do not stand upright, as of a camera that looks down, and files without orientations.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kHead = "import: 1\nepisode: a_cup_is_carried\nunit: m\n";
const std::string kTail = std::string(kCupMap).substr(std::string(kCupMap).find("quaternion"));

struct Vector3d {
  double x = 0, y = 0, z = 0;
};

/// About x.
struct Turn {
  double rad = 0;
  Vector3d operator*(const Vector3d& p) const {
    const double c = std::cos(rad), s = std::sin(rad);
    return {p.x, p.y * c - p.z * s, p.y * s + p.z * c};
  }
};
constexpr Vector3d kUp = {0, 0, 1};

/// From the recording's axes to those of a camera that looks down by 35 degrees: x right, y down, z
/// ahead.
constexpr Turn kToCamera = {125 * std::numbers::pi / 180};

std::string RowOf(double t_s, const char* name, const Vector3d& p, const Turn& turn) {
  char text[200];
  std::snprintf(text, sizeof text, "%.4f,%s,%.6f,%.6f,%.6f,%.6f,%.6f,0,0\n", t_s, name, p.x, p.y,
                p.z, std::cos(turn.rad / 2), std::sin(turn.rad / 2));
  return text;
}

Vector3d Position(const Row& row) { return {row.x, row.y, row.z}; }

/// The carried cup, and `more` things that stand on the table, in a frame that `turn` leads to.
std::string Csv(const Turn& turn, const std::vector<Vector3d>& more = {}) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 300; ++i) {
    const double t_s = i / 60.0;
    csv += RowOf(t_s, "Mug", turn * Position(CupAt(t_s)), turn);
    csv += RowOf(t_s, "Glove", turn * Position(HandAt(t_s)), turn);
    for (std::size_t k = 0; k < more.size(); ++k)
      csv += RowOf(t_s, ("Jar" + std::to_string(k)).c_str(), turn * more[k], turn);
  }
  return csv;
}

class ImportUp : public testing::Test {
 protected:
  Said Import(const std::string& csv, const std::string& up, const std::string& tail = kTail,
              bool check = false) const {
    return ImportCsv(folder_, csv, kHead + up + tail,
                     check ? std::vector<std::string>{"--check"} : std::vector<std::string>{});
  }
  std::string Events() const {
    return Prehend({"episode", "resegment", (folder_ / "take.jsonl").string()}).out;
  }
  static std::string UpLine(const Vector3d& up) {
    char text[100];
    std::snprintf(text, sizeof text, "up: [%.4f, %.4f, %.4f]\n", up.x, up.y, up.z);
    return text;
  }

  const std::filesystem::path folder_ = FreshFolder("import_up");
};

TEST_F(ImportUp, ACameraThatLooksDownHasTheSameEvents) {
  const Said level = Import(Csv(Turn{}), "axes: z_up\n");
  ASSERT_EQ(level.exit_code, 0) << level.err;
  const std::string wanted = Events();
  EXPECT_NE(wanted.find("pick_and_place"), std::string::npos) << wanted;
  const Turn turn = kToCamera;
  const Vector3d up = turn * kUp;
  EXPECT_NEAR(up.y, -0.819, 0.001);
  EXPECT_NEAR(up.z, -0.574, 0.001);
  // The table of the map stands in the middle, so it does not matter how the world is turned about
  // up.
  for (const double length : {1.0, 250.0}) {
    const Said said = Import(Csv(turn), UpLine({0, length * up.y, length * up.z}));
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(said.err, "");
    EXPECT_EQ(Events(), wanted);
  }
}

TEST_F(ImportUp, BesideAxesItIsThatAxisMadeUpright) {
  const Turn tilted = {0.3};
  Import(Csv(Turn{}), "axes: z_up\n");
  const std::string wanted = Events();
  const Said said = Import(Csv(tilted), "axes: z_up\n" + UpLine(tilted * kUp));
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Events(), wanted);
}

TEST_F(ImportUp, TheWorldIsTurnedTheShortestWayWhicheverAxisOfABodyIsUp) {
  std::string csv = "t,x,y,z\n";
  for (int i = 0; i < 100; ++i)
    csv += std::to_string(i / 50.0) + "," + std::to_string(0.1 + i / 200.0) + ",0.3,0.2\n";
  const auto places = [&](const std::string& up) {
    const Said said =
        ImportCsv(folder_, csv,
                  kHead + up +
                      "time_unit: s\nsure: [axes, place]\ncolumns: {time: t, position: "
                      "[x, 'y', z]}\nentities:\n  cup: {from: poses, size_m: [0.1, 0.1, "
                      "0.1]}\n");
    EXPECT_EQ(said.exit_code, 0) << said.err;
    const std::string take = ReadFile(folder_ / "take.jsonl");
    std::string all;
    for (std::size_t at = 0; (at = take.find("\"at_m\":", at)) != std::string::npos; ++at)
      all += take.substr(at + 7, take.find(']', at) - at - 6) + "\n";
    return all;
  };
  // Up is turned to z about x: what lies along x stays, and y leans.
  const std::string leaning = places("up: [0, 0.6, 0.8]\n");
  double x = 0, y = 0, z = 0;
  ASSERT_EQ(std::sscanf(leaning.c_str(), "[%lf,%lf,%lf]", &x, &y, &z), 3) << leaning;
  EXPECT_NEAR(x, 0.1, 1e-12);
  EXPECT_NEAR(y, 0.12, 1e-12);
  EXPECT_NEAR(z, 0.34, 1e-12);
  EXPECT_EQ(places("axes: z_up\nup: [0.2, 0.1, 0.9]\n"), places("up: [0.2, 0.1, 0.9]\n"));
  // What axes alone does is done first: the heading is the same with a tilt of nothing.
  const auto first = [&](const std::string& up) {
    const std::string all = places(up);
    EXPECT_EQ(std::sscanf(all.c_str(), "[%lf,%lf,%lf]", &x, &y, &z), 3) << all;
    return Vector3d{x, y, z};
  };
  for (const auto& [axes, up] :
       {std::pair("axes: x_up\n", "up: [1, 0, 0]\n"), {"axes: y_up\n", "up: [0, 1, 0]\n"}}) {
    const Vector3d alone = first(axes), both = first(std::string(axes) + up);
    EXPECT_NEAR(both.x, alone.x, 1e-12) << axes;
    EXPECT_NEAR(both.y, alone.y, 1e-12) << axes;
    EXPECT_NEAR(both.z, alone.z, 1e-12) << axes;
  }
}

TEST_F(ImportUp, WhatMeansNothingIsAnError) {
  const std::string csv = Csv(Turn{});
  const auto expect = [&](const std::string& up, const std::string& says) {
    const Said said = Import(csv, up);
    EXPECT_EQ(said.exit_code, 2) << up;
    EXPECT_NE(said.err.find(says), std::string::npos) << up << said.err;
  };
  expect("up: [0, 0, 0]\n",
         "map.yaml:4:5: error: expected the direction of up, found a vector of length 0");
  expect("axes: z_up\nup: [0, 1, 0.2]\n",
         "map.yaml:5:5: error: up is 79 degrees away from the z of the file, which 'axes' says "
         "points up");
  expect("", "error: 'axes' is missing: which axis of the file points up");
}

constexpr const char* kJars = R"(  a: {from: Jar0, size_m: [0.1, 0.1, 0.2]}
  b: {from: Jar1, size_m: [0.1, 0.1, 0.1]}
  c: {from: Jar2, size_m: [0.1, 0.1, 0.3]}
  d: {from: Jar3, size_m: [0.1, 0.1, 0.06]}
)";

std::vector<Vector3d> Jars() {
  return {{-0.5, -0.3, 0.82}, {0.5, -0.3, 0.77}, {-0.5, 0.35, 0.87}, {0.4, 0.35, 0.75}};
}

TEST_F(ImportUp, CheckSaysWhereUpIsIfThingsRestOnATiltedPlane) {
  const std::string tail = kTail + kJars + "sure: [axes, place]\n";
  const Turn tilted = {0.3};
  const Said said = Import(Csv(tilted, Jars()), "axes: z_up\n", tail, true);
  EXPECT_NE(said.err.find("warning: things rest on a plane that is tilted by 17.2 degrees: 6 of 6 "
                          "places of rest, of 5 things, are 0.0 mm off it (root mean square); in "
                          "the map: up: [0, -0.296, 0.955]; or, if they stand at several "
                          "heights, what they stand on\n"),
            std::string::npos)
      << said.err;
  // With that line, nothing is to be said.
  const Said upright = Import(Csv(tilted, Jars()), "up: [0, -0.296, 0.955]\n", tail, true);
  EXPECT_EQ(upright.err.find("tilted"), std::string::npos) << upright.err;
  // Nor of a level table, of a tilt of 3 degrees, or of three places.
  const Turn little = {0.05};
  for (const Turn& turn : {Turn{}, little}) {
    const Said level = Import(Csv(turn, Jars()), "axes: z_up\n", tail, true);
    EXPECT_EQ(level.err.find("tilted"), std::string::npos) << level.err;
  }
  const Said few = Import(Csv(tilted), "axes: z_up\n", kTail + "sure: [axes, place]\n", true);
  EXPECT_EQ(few.err.find("tilted"), std::string::npos) << few.err;
}

TEST_F(ImportUp, OfACameraTheWayUpIsWhereHandsAre) {
  const std::string tail = kTail + kJars + "sure: [axes, place]\n";
  const Said said = Import(Csv(kToCamera, Jars()), "axes: z_up\n", tail, true);
  EXPECT_NE(said.err.find("up: [0, -0.819, -0.574]"), std::string::npos) << said.err;
}

TEST_F(ImportUp, WithoutOrientationsItIsSaidOnceWhatCannotBeJudged) {
  std::string tail = kTail;
  tail.erase(tail.find("quaternion_order: wxyz\n"), 23);
  tail.erase(tail.find("  quaternion: "), std::string("  quaternion: [qw, qx, qy, qz]\n").size());
  for (const bool check : {false, true}) {
    const Said said = Import(Csv(Turn{}), "axes: z_up\n", tail, check);
    EXPECT_EQ(said.exit_code, 0);
    EXPECT_EQ(said.err,
              "warning: the file has positions only, of 2 bodies, and no orientations: every "
              "tilt(..) is 0, so no pouring is recognised, hold_tips cannot tell what is tipped in "
              "a hand from what was put down, and up is always up in a thing (boxes, offset_m)\n");
  }
}

}  // namespace
}  // namespace prehend::house
