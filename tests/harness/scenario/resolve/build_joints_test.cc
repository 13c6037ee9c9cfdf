// SPDX-License-Identifier: Apache-2.0
// From YAML to joints, parts and compounds; and everything that is said when they make no sense.
#include <gtest/gtest.h>

#include <numbers>

#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/scenario/resolve/resolve.h"
#include "physics/scene/geometry.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;
using physics::JointKind;

/// A chest with a drawer, whose handle is fixed to it, and a door. Line 3 is the chest's.
std::string Furniture(const std::string& drawer, const std::string& handle,
                      const std::string& more = "") {
  return "scenario: probe\nshows: furniture\nentities:\n"
         "  chest: {fixed: true, shelf: {size_m: [0.4, 0.5, 0.6]}, at_m: [0.5, 0, 0.5]}\n"
         "  drawer: {mass_kg: 2, box: {size_m: [0.3, 0.3, 0.1]}, at_m: [0.4, 0, 0.5], " +
         drawer +
         "}\n"
         "  handle: {mass_kg: 0.1, box: {size_m: [0.01, 0.1, 0.01]}, at_m: [0.2, 0, 0.5], " +
         handle + "}\n" + more;
}

const char* const kSlider =
    "slider: {to: chest, axis: [-1, 0, 0], range_m: [0, 0.3], friction_n: 3}";
const char* const kFixed = "part_of: drawer, fixed_to: drawer";

Result<Scenario> Read(const std::string& text) {
  return ReadScenarioText("probe.yaml", text, {}, ProbeLibrary());
}

TEST(BuildJoints, ADrawerWithAHandle) {
  const auto read = Read(Furniture(kSlider, kFixed));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const auto& joints = read->scene.joints;
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[0].kind, JointKind::kSlider);
  EXPECT_EQ(joints[0].body, physics::BodyIndex(1));
  EXPECT_EQ(joints[0].base, physics::BodyIndex(0));
  EXPECT_LT((joints[0].axis_W + Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_EQ(joints[0].upper, 0.3);
  EXPECT_EQ(joints[0].friction, 3);
  EXPECT_EQ(joints[1].kind, JointKind::kFixed);
  EXPECT_EQ(joints[1].base, physics::BodyIndex(1));
  const grammar::EntityTable entity_table = episode::MakeEntityTable(*read);
  EXPECT_EQ(entity_table.entities[2].part_of, 1);
  EXPECT_EQ(entity_table.entities[1].part_of, grammar::kNoEntity);
  EXPECT_EQ(entity_table.entities[0].classes[1], "Fixed");
  EXPECT_EQ(entity_table.entities[1].classes[1], "Jointed");
  EXPECT_EQ(entity_table.entities[2].classes[1], "Attached");
}

TEST(BuildJoints, AHingeIsInDegrees) {
  const auto read = Read(
      Furniture("hinge: {to: chest, at_m: [0.3, 0.15, 0.5], axis: [0, 0, 1], range_deg: [-90, 45], "
                "spring_nm_per_rad: 2, rest_deg: 90}",
                kFixed));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const physics::Joint& joint = read->scene.joints[0];
  EXPECT_NEAR(joint.lower, -std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(joint.rest, std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(joint.spring, 2);
  EXPECT_EQ(joint.pivot_W_m, Vector3d(0.3, 0.15, 0.5));
}

TEST(BuildJoints, CompoundsAndWhatStandsInThem) {
  const auto read = Read(
      "scenario: probe\nshows: a cup in a turned tray\nentities:\n"
      "  floor: {fixed: true, box: {size_m: [2, 2, 0.1]}, at_m: [0, 0, -0.05]}\n"
      "  tray: {mass_kg: 1, tray: {size_m: [0.4, 0.3, 0.05], wall_m: 0.01}, on: floor, at_m: [0, "
      "0], "
      "yaw_deg: 30}\n"
      "  cup: {mass_kg: 0.2, mug: {radius_m: 0.04, height_m: 0.1}, on: tray, at_m: [0.02, 0.01]}\n"
      "  bell: {mass_kg: 1, on: floor, at_m: [0.6, 0], parts: [{sphere: {radius_m: 0.05}}, "
      "{box: {size_m: [0.1, 0.02, 0.02]}, at_m: [0.1, 0, 0], rpy_deg: [0, 0, 90]}]}\n");
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const auto& bodies = read->scene.bodies;
  EXPECT_EQ(bodies[1].shapes.size(), 5u);
  EXPECT_NEAR(bodies[2].X_WB.p_m.z(), 0.01 + 0.05, 1e-9);  // on the tray's floor, not on its rim
  ASSERT_EQ(bodies[3].shapes.size(), 2u);
  EXPECT_NEAR(physics::WorldBounds(bodies[3], bodies[3].X_WB).max().y(), 0.05, 1e-9);
}

struct Case {
  const char* name;
  std::string text;
  std::string errors;
};

TEST(BuildJoints, RefusesWhatCannotBe) {
  const Case cases[] = {
      {"unknown", Furniture("slider: {to: chset, axis: [1, 0, 0], range_m: [0, 1]}", kFixed),
       "5:90: slider: no entity is called 'chset' | did you mean 'chest'?\n"},
      {"ring", Furniture("fixed_to: handle", "fixed_to: drawer"),
       "6:91: fixed_to: 'handle', directly or not, is attached to itself\n"},
      {"part_of_itself", Furniture(kSlider, "part_of: handle, fixed_to: drawer"),
       "6:90: part_of: 'handle', directly or not, is part of itself\n"},
      {"fixed_to_fixed", Furniture("fixed_to: chest", kFixed),
       "5:87: fixed_to: 'chest' never moves | give 'drawer' 'fixed: true' instead\n"},
      {"empty_range",
       Furniture("slider: {to: chest, axis: [1, 0, 0], range_m: [0.1, 0.3]}", kFixed),
       "5:123: expected a range [min, max] that contains 0, the position as placed, found [0.1, "
       "0.3]\n"},
      {"no_axis", Furniture("slider: {to: chest, axis: [0, 0, 0], range_m: [0, 0.3]}", kFixed),
       "5:103: axis: expected a direction other than [0, 0, 0]\n"},
      {"surface", Furniture(kSlider, "fixed_to: drawer, friction: 0.5"),
       "6:99: friction: an entity that is fixed to another has the surface of that one | give it "
       "to 'drawer'\n"},
      {"two_joints", Furniture(std::string(kSlider) + ", fixed_to: chest", kFixed),
       "5:150: entity 'drawer' cannot have both 'slider' and 'fixed_to'\n"},
      {"jointed_and_fixed", Furniture(kSlider, "fixed_to: drawer, fixed: true"),
       "6:21: entity 'handle' is fixed: it cannot have a mass | remove fixed or mass_kg\n"
       "6:81: entity 'handle' is fixed: it cannot have a joint | remove fixed or fixed_to\n"},
      {"thick_walls",
       "scenario: probe\nshows: a tray\nentities:\n"
       "  tray: {fixed: true, tray: {size_m: [0.3, 0.3, 0.05], wall_m: 0.2}, at_m: [0, 0, 0]}\n",
       "4:64: wall_m: walls of 0.2 leave no room inside | walls must be thinner than half of the "
       "narrowest side\n"},
      {"no_joint_to_follow",
       Furniture(kSlider, kFixed,
                 "  block: {mass_kg: 1, box: {size_m: [0.1, 0.1, 0.1]}, at_m: [-1, 0, 0]}\n"
                 "actors:\n  hand: {hand: human_right, at_m: [-0.5, 0, 1]}\n"
                 "script:\n  - hand: {follow_joint: block}\n"),
       "11:26: follow_joint: 'block' has no slider or hinge | give it one, or use 'move_by_m'\n"}};
  for (const Case& c : cases) {
    const auto read = Read(c.text);
    EXPECT_FALSE(read) << c.name;
    EXPECT_EQ(Brief(ErrorsOf(read)), c.errors) << c.name;
  }
}

}  // namespace
}  // namespace prehend::scenario
