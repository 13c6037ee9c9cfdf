// SPDX-License-Identifier: Apache-2.0
// What a planar world refuses, with its full text.
#include <gtest/gtest.h>

#include "harness/episode/run/find_scenario.h"
#include "harness/scenario/resolve/resolve.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

constexpr const char* kPlanar = R"(scenario: probe
shows: a box in a plane
world: {engine: box2d}
entities:
  table: {fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  box: {box: {size_m: [0.06, 0.06, 0.10]}, mass_kg: 0.3, on: table, at_m: [0.2, 0]}
actors:
  gripper: {hand: planar_gripper, at_m: [-0.2, 0, 1.05]}
script:
  - gripper: {reach: box, style: parallel}
)";

struct Probe {
  const char* from;
  const char* to;
  const char* complaint;
};

std::string With(const std::string& from, const std::string& to) {
  std::string text = kPlanar;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Result<Scenario> ReadPlanar(const std::string& text) {
  return ReadScenarioText("probe.yaml", text, {}, episode::ProjectLibrary(PREHEND_SOURCE_DIR));
}

TEST(CheckPlanarTest, AGoodOneIsReadForBothEngines) {
  for (const char* world :
       {"{engine: box2d}", "{engine: box2d, planar: true}", "{engine: bullet, planar: true}"}) {
    const auto read = ReadPlanar(With("{engine: box2d}", world));
    ASSERT_TRUE(read) << grammar::Format(ErrorsOf(read));
    EXPECT_TRUE(read->scene.world.planar);
  }
  const auto spatial = ReadPlanar(With("{engine: box2d}", "{engine: bullet}"));
  ASSERT_TRUE(spatial) << grammar::Format(ErrorsOf(spatial));
  EXPECT_FALSE(spatial->scene.world.planar) << "the default";
  EXPECT_EQ(spatial->scene.world.engine, physics::Engine::kBullet);
}

TEST(CheckPlanarTest, WhatDoesNotFitIsRefused) {
  const Probe probes[] = {
      {"{engine: box2d}", "{engine: box2d, planar: false}",
       "3:32: planar: engine box2d is always planar | planar: true, or engine: bullet"},
      {"{engine: box2d}", "{engine: box3d}",
       "3:17: engine: expected one of bullet, box2d, bullet_stock, found 'box3d' | did you mean "
       "'box2d'?"},
      {"at_m: [0.2, 0]", "at_m: [0.2, 0.1]",
       "6:75: 'box' does not fit a planar world: its centre is off the plane y = 0 | y must be 0 "
       "in a planar world"},
      {"at_m: [0.2, 0]", "at_m: [0.2, 0], yaw_deg: 10",
       "6:3: 'box' does not fit a planar world: it is turned out of the plane | rotate it about y "
       "only, and keep its parts in the plane; see docs/scenario-format.md"},
      {"box: {size_m: [0.06, 0.06, 0.10]}", "tray: {size_m: [0.06, 0.06, 0.10]}",
       "6:3: 'box' does not fit a planar world: a part of it is not in the plane y = 0 | rotate it "
       "about y only, and keep its parts in the plane; see docs/scenario-format.md"},
      {"at_m: [0.2, 0]", "at_m: [0.2, 0], ball_joint: {to: table, at_m: [0.2, 0, 0.9]}",
       "6:97: the joint of 'box' does not fit a planar world: a ball joint turns out of the plane "
       "| hinge with axis: [0, 1, 0]"},
      {"hand: planar_gripper", "hand: human_right",
       "8:19: hand 'human_right' does not fit a planar world: its link 'index_proximal' is "
       "not in its plane y = 0 | use the hand 'planar_gripper'"},
      {"at_m: [-0.2, 0, 1.05]", "at_m: [-0.2, 0.1, 1.05]",
       "8:41: at_m: 'gripper' starts outside the plane y = 0 | y must be 0 in a planar world"},
      {"at_m: [-0.2, 0, 1.05]", "at_m: [-0.2, 0, 1.05], rpy_deg: [0, 0, 90]",
       "8:3: 'gripper' is turned out of the plane y = 0 | a hand turns about y only: rpy_deg: [0, "
       "pitch, 0]"},
      {"style: parallel}", "style: parallel, offset_m: [0, 0.01, 0]}",
       "10:54: offset_m: this leaves the plane y = 0 | y must be 0 in a planar world"},
      {"{reach: box, style: parallel}", "{move_by_m: [0, 0.1, 0]}",
       "10:26: move_by_m: this leaves the plane y = 0 | y must be 0 in a planar world"},
      {"style: parallel}", "style: parallel}\n  - gripper: {carry_to_m: [0, 0.1]}",
       "11:27: carry_to_m: this leaves the plane y = 0 | y must be 0 in a planar world"},
      {"{reach: box, style: parallel}", "{poses: [{t_s: 1, at_m: [0, 0.1, 1]}]}",
       "10:23: at_m: this leaves the plane y = 0 | y must be 0 in a planar world"},
      {"{reach: box, style: parallel}",
       "{poses: [{t_s: 1, at_m: [0, 0, 1], rpy_deg: [0, 0, 180]}]}",
       "10:23: this pose turns the hand out of the plane y = 0 | a hand turns about y only: "
       "rpy_deg: [0, pitch, 0]"},
  };
  for (const Probe& probe : probes) {
    const auto read = ReadPlanar(With(probe.from, probe.to));
    const std::string wanted = std::string(probe.complaint) + "\n";
    EXPECT_EQ(Brief(ErrorsOf(read)).substr(0, wanted.size()), wanted) << probe.to;
  }
}

TEST(CheckPlanarTest, APlaneOfBulletRefusesTheSame) {
  std::string text = With("{engine: box2d}", "{engine: bullet, planar: true}");
  text.replace(text.find("at_m: [0.2, 0]"), 14, "at_m: [0.2, 0.1]");
  EXPECT_EQ(Brief(ErrorsOf(ReadPlanar(text))),
            "6:75: 'box' does not fit a planar world: its centre is off the plane y = 0 | y must "
            "be 0 in a planar world\n");
}

}  // namespace
}  // namespace prehend::scenario
