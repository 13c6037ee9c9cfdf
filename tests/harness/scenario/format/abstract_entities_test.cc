// SPDX-License-Identifier: Apache-2.0
// What has a place but no matter, and hulls: from YAML to bodies, and what is said when they make
// no sense.
#include <gtest/gtest.h>

#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/format/scenario_formats.h"
#include "harness/scenario/read/read_scenario.h"
#include "physics/scene/geometry.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;
using physics::Abstract;

/// A table, a cup on it, and one more entity, in line 6.
std::string With(const std::string& entity, const std::string& more = "") {
  return "scenario: probe\nshows: probe\nentities:\n"
         "  table: {fixed: true, box: {size_m: [1, 1, 0.1]}, at_m: [0, 0, 0.7]}\n"
         "  cup: {box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 0.1, on: table, at_m: [0, 0]}\n"
         "  it: {" +
         entity + "}\n" + more;
}

Result<Scenario> Read(const std::string& text) {
  return ReadScenarioText("probe.yaml", text, {}, ProbeLibrary());
}

std::string Complaint(const std::string& entity, const std::string& more = "") {
  return Brief(ErrorsOf(Read(With(entity, more))));
}

TEST(AbstractEntities, StandWhereTheyAreAndAreNoThings) {
  const struct {
    const char* entity;
    Abstract abstract;
    std::vector<std::string> classes;
  } table[] = {
      {"region: {size_m: [1, 1, 1]}, at_m: [0, 0, 0.8]",
       Abstract::kRegion,
       {"Object", "Region", "Abstract", "Entity"}},
      {"class: Goal, region: {radius_m: 0.5}, at_m: [0, 0, 0.8]",
       Abstract::kRegion,
       {"Goal", "Region", "Abstract", "Entity"}},
      {"gaze_target: {}, at_m: [0, 0, 0.8]",
       Abstract::kGazeTarget,
       {"Object", "GazeTarget", "Abstract", "Entity"}},
      {"camera: {toward_m: [0, 0, 0]}, at_m: [1, 0, 0.8]",
       Abstract::kCamera,
       {"Object", "Camera", "Abstract", "Entity"}},
      {"light: {}, at_m: [0, 0, 0.8]", Abstract::kLight, {"Object", "Light", "Abstract", "Entity"}},
  };
  for (const auto& row : table) {
    const auto read = Read(With(row.entity));
    ASSERT_TRUE(read) << Brief(ErrorsOf(read));
    const physics::Body& body = read->scene.bodies[2];
    EXPECT_EQ(body.abstract, row.abstract);
    EXPECT_FALSE(physics::IsThing(body));
    EXPECT_EQ(episode::MakeEntityTable(*read).entities[2].classes, row.classes);
  }
}

TEST(AbstractEntities, ARoundRegionHasNoCorners) {
  const auto read = Read(With("region: {radius_m: 0.5}, at_m: [1, 0, 0.8]"));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const physics::Body& ball = read->scene.bodies[2];
  EXPECT_TRUE(episode::MakeEntityTable(*read).entities[2].round);
  EXPECT_TRUE(physics::IsInside(ball, ball.X_WB, {1.49, 0, 0.8}));
  EXPECT_FALSE(physics::IsInside(ball, ball.X_WB, {1.4, 0.4, 0.8}));
}

TEST(AbstractEntities, ACameraLooksTowards) {
  for (const char* toward : {"[0, 0, 0.8]", "[1, 0, 0]", "[1, 5, 3]"}) {
    const auto read =
        Read(With("camera: {toward_m: " + std::string(toward) + "}, at_m: [1, 0, 0.8]"));
    ASSERT_TRUE(read) << Brief(ErrorsOf(read));
    const Eigen::Matrix3d R = read->scene.bodies[2].X_WB.q.toRotationMatrix();
    EXPECT_NEAR(R.determinant(), 1, 1e-9);
    EXPECT_GE(R(2, 2), -1e-9) << "up is not below";
  }
}

TEST(AbstractEntities, WhatOnlyMatterHasIsRefused) {
  EXPECT_EQ(Complaint("region: {size_m: [1, 1, 1]}, at_m: [0, 0, 0.8], mass_kg: 1"),
            "6:56: mass_kg: a region is abstract; this key does not apply to it\n");
  EXPECT_EQ(Complaint("light: {}, at_m: [0, 0, 0.8], yaw_deg: 30"),
            "6:38: yaw_deg: a light has no rotation\n");
  EXPECT_EQ(Complaint("region: {size_m: [1, 1, 1], radius_m: 1}, at_m: [0, 0, 0.8]"),
            "6:36: a region cannot have both 'size_m' and 'radius_m'\n");
  EXPECT_EQ(
      Complaint("camera: {toward_m: [0, 0, 0.8]}, at_m: [0, 0, 0.8]"),
      "6:27: toward_m: this is the camera's own position | give the point that it looks at\n");
  EXPECT_EQ(
      Complaint(
          "region: {radius_m: 1}, at_m: [0, 0, 0.8]",
          "actors: {hand: {hand: human_right, at_m: [0, 0, 2]}}\nscript: [hand: {reach: it}]\n"),
      "8:24: reach: 'it' is a region, not a physical object | hands cannot touch it\n");
  EXPECT_EQ(Complaint("region: {radius_m: 1}, at_m: [0, 0, 0.8]",
                      "  can: {sphere: {radius_m: 0.1}, mass_kg: 1, on: it, at_m: [0, 0]}\n"),
            "7:50: on: 'it' is a region, which cannot support anything\n");
}

TEST(AbstractEntities, PicturesAreMadeFromTheScenariosCameras) {
  const std::string camera = "camera: {toward_m: [0, 0, 0.8]}, at_m: [1, 0, 1]";
  EXPECT_EQ(Complaint(camera, "pictures: [{at: 0, camera: it}]\n"), "");
  EXPECT_EQ(Complaint(camera, "pictures: [{at: 0, camera: cup}]\n"),
            "7:28: camera: no camera is called 'cup' | known: front, left, right, top, "
            "three_quarter, hand, action, body, it\n");
}

TEST(AbstractEntities, AHullIsReadWithThePlaceOfEachMistake) {
  const auto read =
      Read(With("hull: {points_m: [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]}, mass_kg: "
                "0.1, on: table, at_m: [0.3, 0.3]"));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  EXPECT_NEAR(read->scene.bodies[2].X_WB.p_m.z(), 0.75, 1e-12);
  const std::string end = "}, mass_kg: 0.1, at_m: [0.3, 0.3, 1]";
  EXPECT_EQ(Complaint("hull: {points_m: [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]" + end),
            "6:25: points_m: expected at least 4 items, found 3\n");
  EXPECT_EQ(
      Complaint("hull: {points_m: [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0.1, 0.1, 0]]" + end),
      "6:25: points_m: the points lie in a plane, or within 1 mm of one | a hull is a solid: add "
      "points on both sides of the plane\n");
  EXPECT_EQ(
      Complaint("hull: {points_m: [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1], [0.01, 0.01, "
                "0.01]]" +
                end),
      "6:76: points_m: point 4 is not a corner: it lies inside, on a face or on an edge of the "
      "hull | "
      "leave it out; build a shape that is not convex from 'parts'. The first point is point 0\n");
}

}  // namespace
}  // namespace prehend::scenario
