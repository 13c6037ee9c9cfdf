// SPDX-License-Identifier: Apache-2.0
// How a run ended, by name: judged on snapshots made by hand.
#include <gtest/gtest.h>

#include "harness/episode/run/run_trials.h"
#include "harness/scenario/read/read_scenario.h"
#include "physics/scene/compounds.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::episode {
namespace {

Result<scenario::Scenario> Read(const std::string& outcomes) {
  return scenario::ReadScenarioText("probe.yaml", scenario::kProbe + ("outcomes:\n" + outcomes), {},
                                    scenario::ProbeLibrary());
}

/// Judges a run of one tick a snapshot in which the milk is at these places.
std::string Judge(const std::string& outcomes, const std::vector<physics::Pose>& milk) {
  const auto read = Read(outcomes);
  EXPECT_TRUE(read) << scenario::Brief(ErrorsOf(read));
  if (!read) return "";
  OutcomeWatch watch(read->scene, read->outcomes);
  physics::Snapshot snapshot;
  snapshot.bodies.resize(2);
  for (const physics::Pose& pose : milk) {
    ++snapshot.tick;
    snapshot.bodies[1].X_WB = pose;
    watch.Look(snapshot);
  }
  return watch.Judge(snapshot);
}

physics::Pose Upright(double x, double z) { return {{x, 0, z}}; }
physics::Pose Lying(double x, double z) {
  return {{x, 0, z}, Eigen::Quaterniond(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX()))};
}

TEST(Outcome, TheFirstThatHoldsIsTheOne) {
  const std::string outcomes =
      "  placed: [{entity: milk, near_m: [0.5, 0], within_m: 0.02, tilt_below_deg: 10}]\n"
      "  tipped: [{entity: milk, tilt_above_deg: 45, above_m: 0.5}]\n"
      "  dropped: [{entity: milk, below_m: 0.5}]\n";
  EXPECT_EQ(Judge(outcomes, {Upright(0.51, 0.8)}), "placed");
  EXPECT_EQ(Judge(outcomes, {Upright(0.53, 0.8)}), "other");
  EXPECT_EQ(Judge(outcomes, {Lying(0.5, 0.8)}), "tipped");
  EXPECT_EQ(Judge(outcomes, {Lying(0.5, 0.1)}), "dropped");
}

TEST(Outcome, AMomentAfterTheEndIsRefused) {
  EXPECT_EQ(scenario::Brief(ErrorsOf(Read("  held: [{entity: milk, at_s: 2.5, above_m: 1}]\n"))),
            "16:10: at_s: 2.5 s is after the end of the run at 1.900 s | without at_s the "
            "condition is checked at the end\n");
  EXPECT_TRUE(Read("  held: [{entity: milk, at_s: 1.9, above_m: 1}]\n"));
}

TEST(Outcome, WhatAlwaysOrNeverHoldsIsRefused) {
  const std::pair<const char*, const char*> refused[] = {
      {"bad: [{entity: milk}]", "this condition always holds"},
      {"bad: [{entity: milk, at_s: 1}]", "this condition always holds"},
      {"bad: [{entity: milk, within_m: 0.1}]", "within_m: there is no 'near_m'"},
      {"bad: [{entity: milk, share: 0.5, above_m: 1}]", "share: there is no 'inside'"},
      {"bad: [{entity: milk, above_m: 1, below_m: 0}]",
       "below_m: no value lies between 'above_m' and 'below_m'"},
      {"bad: [{entity: milk, tilt_above_deg: 9, tilt_below_deg: 5}]",
       "tilt_below_deg: no value lies between 'tilt_above_deg' and 'tilt_below_deg'"},
      {"bad: [{entity: milk, inside: milk}]", "inside: an entity cannot be inside itself"},
      {"failed: [{entity: milk, below_m: 1}]", "'failed' is reserved for trials that went wrong"},
      {"other: [{entity: milk, below_m: 1}]",
       "'other' is reserved for trials that match no outcome"},
  };
  for (const auto& [outcome, complaint] : refused) {
    const auto read = Read("  " + std::string(outcome) + "\n");
    EXPECT_FALSE(read) << outcome;
    EXPECT_NE(scenario::Brief(ErrorsOf(read)).find(complaint), std::string::npos)
        << outcome << "\n"
        << scenario::Brief(ErrorsOf(read));
  }
}

TEST(Outcome, AMomentIsLookedAtWhenItComes) {
  const std::string outcomes =  // at_s is that of tick 3
      "  held: [{entity: milk, at_s: 0.00625, above_m: 1}, {entity: milk, below_m: 0.9}]\n";
  EXPECT_EQ(Judge(outcomes, {Upright(0, 0.8), Upright(0, 0.8), Upright(0, 1.1), Upright(0, 0.8)}),
            "held");
  EXPECT_EQ(Judge(outcomes, {Upright(0, 1.1), Upright(0, 1.1), Upright(0, 0.8), Upright(0, 0.8)}),
            "other");
  EXPECT_EQ(Judge(outcomes, {Upright(0, 0.8)}), "other");  // it never came
}

TEST(Outcome, InsideIsInTheBoundingBox) {
  const std::string outcomes = "  through: [{entity: milk, inside: table}]\n";
  EXPECT_EQ(Judge(outcomes, {Upright(0.59, 0.01)}), "through");
  EXPECT_EQ(Judge(outcomes, {Upright(0.59, 0.03)}), "other");
  EXPECT_EQ(Judge(outcomes, {Upright(0.61, 0.01)}), "other");
}

TEST(Outcome, OfGrainsAShareIsInside) {
  const physics::Body cup{.name = "cup",
                          .shapes = physics::ShapesOf(physics::Tray{{0.1, 0.1, 0.1}, 0.01})};
  physics::Body peas{.name = "peas", .shapes = {}, .grains = physics::Grains{}};
  peas.grains->p_WG_m.resize(4);
  const physics::Scene scene{.bodies = {cup, peas}};
  physics::Snapshot snapshot;
  snapshot.bodies.resize(2);
  snapshot.grains = {
      {0, 0, 0}, {0.04, 0.04, 0}, {0, 0, -0.04}, {0.06, 0, 0}};  // the last one is outside
  const auto judge = [&](double share) {
    scenario::ConditionYaml wanted{.entity = "peas"};
    wanted.inside = Located<std::string>{"cup", {}};
    wanted.share = share;
    const std::vector<scenario::Outcome> outcomes = {
        {"kept",
         {{.body = physics::BodyIndex(1), .vessel = physics::BodyIndex(0), .wanted = wanted}}}};
    return OutcomeWatch(scene, outcomes).Judge(snapshot);
  };
  EXPECT_EQ(judge(0.75), "kept");
  EXPECT_EQ(judge(0.76), "other");
}

TEST(Outcome, RefusesWhatIsNotThere) {
  EXPECT_EQ(scenario::Brief(ErrorsOf(Read("  held: [{entity: mlik, above_m: 1}]\n"))),
            "16:10: entity: no entity is called 'mlik' | did you mean 'milk'?\n");
  EXPECT_EQ(scenario::Brief(ErrorsOf(Read("  open: [{entity: milk, joint_above: 0.5}]\n"))),
            "16:10: entity: 'milk' has no joint\n");
  EXPECT_EQ(scenario::Brief(ErrorsOf(Read("  in: [{entity: milk, inside: table, share: 0.5}]\n"))),
            "16:8: share: 'milk' is not of grains; its centre is inside or not\n");
  EXPECT_EQ(scenario::Brief(ErrorsOf(Read("  kept: [{entity: milk, inside: tabel}]\n"))),
            "16:33: inside: no entity is called 'tabel' | did you mean 'table'?\n");
}

}  // namespace
}  // namespace prehend::episode
