// SPDX-License-Identifier: Apache-2.0
// A hand that holds still holds still, by friction alone: physics/bullet/core/friction_anchors.h.
// The bench of holding, bench/holding.py, does the same with 30 things for a minute.
#include <gtest/gtest.h>

#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

struct Way {
  double turned_deg = 0, moved_m = 0;
};

/// How far the object turns and moves in the hand between two times.
Way WayInTheHand(Simulation& simulation, double from_s, double to_s) {
  std::optional<Pose> begin;
  Way way;
  while (simulation.Step() && simulation.snapshot().tick < to_s * 480) {
    const Snapshot& now = simulation.snapshot();
    if (now.tick < from_s * 480) continue;
    const Pose pose = now.hands[0].palm.X_WB.inverse() * now.bodies[kObject].X_WB;
    if (!begin) begin = pose;
    way.turned_deg =
        std::max(way.turned_deg, RotationVector(pose.q * begin->q.conjugate()).norm() / kRadPerDeg);
    way.moved_m = std::max(way.moved_m, (pose.p_m - begin->p_m).norm());
  }
  return way;
}

/// Takes it, lifts it by so much, and holds it for 8 s.
Script Hold(const std::string& style, Approach approach, double lift_m) {
  Script script;
  const auto add = [&](StepAction action, double over_s) {
    script.stages.push_back({{{HandIndex(0), std::move(action), over_s}}});
  };
  add(ReachStep{"object", style, approach}, 0.8);
  add(TriggerStep{1}, 0.6);
  if (lift_m > 0) add(MoveStep{{0, 0, lift_m}}, 0.6);
  add(WaitStep{}, 8);
  return script;
}

TEST(Holding, WhatIsHeldInTheAirNeitherTurnsNorCreeps) {
  const struct {
    Shape shape;
    double mass_kg;
    std::string style;
    Approach approach;
  } cases[] = {{Box{{0.07, 0.07, 0.20}}, 0.4, "wrap", Approach::kSide},
               {Box{{0.06, 0.06, 0.14}}, 0.1, "pinch", Approach::kAbove},
               {Cylinder{0.033, 0.12}, 0.35, "wrap", Approach::kSide},
               {Sphere{0.035}, 0.2, "wrap", Approach::kAbove}};
  for (const auto& [shape, mass_kg, style, approach] : cases) {
    Simulation simulation(MakeScene(Tabletop{.shape = shape, .mass_kg = mass_kg}),
                          Hold(style, approach, 0.15));
    const Way way = WayInTheHand(simulation, 3, 10);
    EXPECT_LT(way.turned_deg, 0.1) << style << " " << mass_kg << " kg";
    EXPECT_LT(way.moved_m, 0.0001) << style << " " << mass_kg << " kg";
    EXPECT_GT(simulation.snapshot().bodies[kObject].X_WB.p_m.z(), kTop_m + 0.12) << "it is held";
  }
}

TEST(Holding, WhatIsHeldOnATableIsNotLifted) {
  for (const double mass_kg : {0.1, 0.3, 1.0, 1.5}) {
    Simulation simulation(MakeScene(Tabletop{.shape = Box{{0.06, 0.06, 0.14}}, .mass_kg = mass_kg}),
                          Hold("wrap", Approach::kSide, 0));
    double highest_m = 0;
    std::optional<Eigen::Vector3d> held_at_m;
    Eigen::Vector3d at_m;
    while (simulation.Step() && simulation.snapshot().tick < 9.4 * 480) {
      at_m = simulation.snapshot().bodies[kObject].X_WB.p_m;
      if (simulation.snapshot().tick < 1.65 * 480) continue;
      highest_m = std::max(highest_m, at_m.z() - (kTop_m + 0.07));
      if (!held_at_m) held_at_m = at_m;
    }
    EXPECT_LT(highest_m, 0.00005) << mass_kg << " kg";
    EXPECT_LT((at_m - *held_at_m).norm(), 0.005) << mass_kg << " kg: hand and thing settle";
  }
}

TEST(Holding, WhatTwoHandsCloseOnStays) {
  for (const Shape& shape : {Shape(Box{{0.06, 0.4, 0.12}}), Shape(Box{{0.05, 0.5, 0.08}})}) {
    Scene scene = MakeScene(Tabletop{.shape = shape, .mass_kg = 0.8, .at_m = {0.1, 0}});
    scene.hands[0].X_WH.p_m = {-0.2, -0.3, 1.05};
    scene.hands.push_back({"left_hand", LibraryHand("human_left"), {{-0.2, 0.3, 1.05}}});
    const auto both = [](const auto& action_of, double over_s) {
      return ScriptStage{
          {{HandIndex(0), action_of(-1), over_s}, {HandIndex(1), action_of(1), over_s}}};
    };
    const double half_m = std::get<Box>(shape).size_m.z() / 2;
    Simulation simulation(
        scene, {.stages = {both(
                               [](double side) {
                                 return StepAction(
                                     ReachStep{.object = "object",
                                               .approach = Approach::kAbove,
                                               .point_m = Eigen::Vector3d(0, 0.12 * side, 0)});
                               },
                               0.8),
                           both([](double) { return StepAction(TriggerStep{1}); }, 0.6),
                           both([](double) { return StepAction(WaitStep{}); }, 2)}});
    double rise_m = 0, tilt_deg = 0;
    while (simulation.Step()) {
      const Pose& X_WB = simulation.snapshot().bodies[kObject].X_WB;
      rise_m = std::max(rise_m, X_WB.p_m.z() - kTop_m - half_m);
      tilt_deg = std::max(
          tilt_deg, std::acos(std::min((X_WB.q * Eigen::Vector3d::UnitZ()).z(), 1.0)) / kRadPerDeg);
    }
    EXPECT_LT(rise_m, 0.001);
    EXPECT_LT(tilt_deg, 2);
  }
}

/// How far the lowest corner of the object is above the table in the first of the ticks (8 ms) with
/// which their contact ends; -1: never.
double GapAtTheEndOfContact_m(const Tabletop& tabletop, const Eigen::Vector3d& way_m) {
  Script script = Hold("wrap", Approach::kAuto, 0);
  script.stages.back() = {{{HandIndex(0), MoveStep{way_m}, 0.9}}};
  Simulation simulation(MakeScene(tabletop), script);
  const Eigen::Vector3d half_m = std::get<Box>(tabletop.shape).size_m / 2;
  std::vector<double> gaps_m;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    bool touch = now.tick < 480;
    for (const auto& points : now.AllContacts())
      for (const ContactPoint& point : points)
        touch |= point.a.body == BodyIndex(0) && point.b.body == BodyIndex(kObject);
    double lowest_m = 1e9;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      lowest_m = std::min(
          lowest_m, (now.bodies[kObject].X_WB * Eigen::Vector3d(half_m.cwiseProduct(sign))).z());
    }
    gaps_m.push_back(lowest_m - kTop_m);
    if (!touch) return gaps_m[gaps_m.size() - 5];
  }
  return -1;
}

// Bullet drops the points of what slides in a gap. A contact that was over then ended at any height
// between 0 and half a millimetre, 25 ms sooner or later.
TEST(Holding, WhatLeavesItsTableTouchesItUntilItIsApart) {
  for (const double along_m : {0.0, 0.1, 0.25})
    for (const double width_m : {0.06, 0.065, 0.07})
      EXPECT_NEAR(
          GapAtTheEndOfContact_m({.shape = Box{{width_m, width_m, 0.20}}}, {along_m, 0, 0.09}),
          0.0006, 0.00015)
          << along_m << " " << width_m;
}

TEST(Holding, FrictionBearsNoMoreThanItsLimit) {
  // Thumb and fingers press with some 30 N: 6 kg are too heavy.
  Simulation simulation(MakeScene(Tabletop{.mass_kg = 6}), Hold("wrap", Approach::kSide, 0.15));
  while (simulation.Step()) {
  }
  EXPECT_LT(simulation.snapshot().bodies[kObject].X_WB.p_m.z(), kTop_m + 0.105);
}

TEST(Holding, WhatIsPutDownLandsFlatAndIsNotPushed) {
  for (const double mass_kg : {0.05, 0.3, 0.8}) {
    Script script = MakeScript({.style = "wrap", .approach = Approach::kSide});
    Simulation simulation(MakeScene(Tabletop{.shape = Cylinder{0.033, 0.12}, .mass_kg = mass_kg}),
                          script);
    std::optional<Eigen::Vector3d> landed_m;
    double tilt_deg = 0, pushed_m = 0;
    while (simulation.Step()) {
      const Snapshot& now = simulation.snapshot();
      const Pose& X_WB = now.bodies[kObject].X_WB;
      const bool stands = std::ranges::any_of(now.contacts, [](const ContactPoint& contact) {
        return contact.a.body == BodyIndex(kTable) && contact.b.body == BodyIndex(kObject);
      });
      if (now.tick < 3 * 480 || !(stands || landed_m)) continue;
      if (!landed_m) {
        landed_m = X_WB.p_m;
        tilt_deg = std::acos(std::min((X_WB.q * Eigen::Vector3d::UnitZ()).z(), 1.0)) / kRadPerDeg;
      }
      pushed_m = std::max(pushed_m, (X_WB.p_m - *landed_m).head<2>().norm());
    }
    ASSERT_TRUE(landed_m) << mass_kg << " kg";
    EXPECT_LT(tilt_deg, 1) << mass_kg << " kg";
    EXPECT_LT(pushed_m, 0.003) << mass_kg << " kg";
  }
}

TEST(Holding, AHandThatLetsGoStaysWhereItIs) {
  // The hand is turned, and has pushed the thing 2 mm into its place.
  for (const Approach approach : {Approach::kSide, Approach::kAbove}) {
    Simulation simulation(MakeScene(Tabletop{.shape = Cylinder{0.033, 0.12}, .mass_kg = 0.3}),
                          MakeScript({.style = "wrap", .approach = approach}));
    std::optional<Eigen::Vector3d> let_go_m;
    double farthest_m = 0;
    while (simulation.Step()) {
      const Snapshot& now = simulation.snapshot();
      const bool touches = std::ranges::any_of(now.contacts, [](const ContactPoint& contact) {
        return contact.b.hand != kNone || contact.a.hand != kNone;
      });
      const double trigger = now.hands[0].trigger;
      if (now.tick < 3 * 480 || trigger == 0 || trigger == 1) continue;
      EXPECT_FALSE(let_go_m && touches) << "at tick " << now.tick;
      if (!touches && !let_go_m) let_go_m = now.hands[0].palm.X_WB.p_m;
      if (let_go_m)
        farthest_m = std::max(farthest_m, (now.hands[0].palm.X_WB.p_m - *let_go_m).norm());
    }
    EXPECT_TRUE(let_go_m);
    EXPECT_LT(farthest_m, 0.0008);
  }
}

/// The last tick in which a cube that is lifted touches the table.
std::int64_t LeavesTheTable(double moved_m) {
  const Tabletop tabletop{.shape = Box{{0.04, 0.04, 0.04}},
                          .mass_kg = 0.1,
                          .at_m = {0.2 + moved_m, 0.1},
                          .hand_at_m = {-0.2 + moved_m, -0.2, 1.05}};
  Simulation simulation(MakeScene(tabletop), Hold("wrap", Approach::kAbove, 0.15));
  std::int64_t last = 0;
  while (simulation.Step() && simulation.snapshot().tick < 2 * 480)
    for (const ContactPoint& contact : simulation.snapshot().contacts)
      if (contact.a.body == BodyIndex(kTable) && contact.b.body == BodyIndex(kObject))
        last = simulation.snapshot().tick;
  return last;
}

TEST(Holding, WhenALiftBeginsIsNoChance) {
  // The hand gives way while it closes. Its orientation at rest is interpolated, and the same but
  // for the last bit.
  const std::int64_t here = LeavesTheTable(0);
  for (const double moved_m : {1e-6, 1e-3, 0.05})
    EXPECT_NEAR(static_cast<double>(LeavesTheTable(moved_m)), static_cast<double>(here), 8)
        << moved_m;
}

/// Begins and ends of touches between the hand and the thing, seconds.
std::vector<double> Touches(int rate_hz, const Tabletop& tabletop, const std::string& style) {
  Scene scene = MakeScene(tabletop);
  scene.world.rate_hz = rate_hz;
  Simulation simulation(scene, MakeScript({.style = style}));
  std::vector<double> changes_s;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    const bool touches = std::ranges::any_of(now.contacts, [](const ContactPoint& contact) {
      return contact.b.hand != kNone || contact.a.hand != kNone;
    });
    if (touches == (changes_s.size() % 2 == 0))
      changes_s.push_back(static_cast<double>(now.tick) / rate_hz);
  }
  return changes_s;
}

TEST(Holding, AHandTakesAndLetsGoAlikeInShorterTicks) {
  const std::pair<Tabletop, std::string> cases[] = {
      {{}, "wrap"},
      {{.shape = Cylinder{0.033, 0.12}, .mass_kg = 0.3}, "wrap"},
      {{.shape = Box{{0.04, 0.04, 0.04}}, .mass_kg = 0.1}, "pinch"}};
  for (const auto& [tabletop, style] : cases) {
    const std::vector<double> here_s = Touches(480, tabletop, style);
    const std::vector<double> there_s = Touches(960, tabletop, style);
    ASSERT_EQ(here_s.size(), there_s.size()) << style;
    for (std::size_t i = 0; i < here_s.size(); ++i)
      EXPECT_NEAR(there_s[i], here_s[i], 0.006) << style << ", change " << i;
  }
}

/// How far a can or a box moves, metres, after it was turned half round and put down and the hand
/// has let go of it and retreated.
double MovesAfterATurn_m(const Shape& shape, Approach approach, const Eigen::Vector3d& by_deg) {
  Script script = MakeScript({.style = "wrap", .approach = approach});
  script.stages[3].steps[0].action = TurnHandStep{by_deg * kRadPerDeg};
  Simulation simulation(MakeScene(Tabletop{.shape = shape, .mass_kg = 0.35}), script);
  std::optional<Eigen::Vector3d> put_down_m;
  while (simulation.Step()) {
    const HandState& hand = simulation.snapshot().hands[0];
    if (simulation.snapshot().tick > 3 * 480 && !put_down_m && hand.trigger < 1)
      put_down_m = simulation.snapshot().bodies[kObject].X_WB.p_m;
  }
  return (simulation.snapshot().bodies[kObject].X_WB.p_m - *put_down_m).norm();
}

// Contacts that held at the grasp would push along directions of that time.
TEST(Holding, WhatWasTurnedStandsWhenTheHandLetsGo) {
  const Shape can = Cylinder{0.033, 0.12}, box = Box{{0.06, 0.06, 0.12}};
  for (const Approach approach : {Approach::kAbove, Approach::kSide})
    for (const double yaw_deg : {-180, 90, 150})
      for (const Shape& shape : {can, box})
        EXPECT_LT(MovesAfterATurn_m(shape, approach, {0, 0, yaw_deg}), 0.001)
            << "shape " << shape.index() << ", by " << yaw_deg << " degrees";
}

/// Tilt of a carton, degrees, when it is put down after the hand has turned it by 6 degrees.
double TiltAtTheLanding(std::optional<bool> keep_upright) {
  Script script;
  const auto add = [&](StepAction action, double over_s) -> Step& {
    script.stages.push_back({{{HandIndex(0), std::move(action), over_s}}});
    return script.stages.back().steps.back();
  };
  add(ReachStep{"object", "wrap", Approach::kSide}, 0.8);
  add(TriggerStep{1}, 0.6);
  add(MoveStep{{0, 0, 0.15}}, 0.6);
  add(TurnHandStep{{6 * kRadPerDeg, 0, 0}}, 0.6);
  add(PlaceStep{"table"}, 0.8).keep_upright = keep_upright;
  Simulation simulation(MakeScene(Tabletop{}), script);
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    const bool lands = std::ranges::any_of(now.contacts, [](const ContactPoint& contact) {
      return contact.a.body == BodyIndex(kTable) && contact.b.body == BodyIndex(kObject);
    });
    if (now.tick < 2.6 * 480 || !lands) continue;
    const Pose& X_WB = now.bodies[kObject].X_WB;
    return std::acos(std::min((X_WB.q * Eigen::Vector3d::UnitZ()).z(), 1.0)) / kRadPerDeg;
  }
  return -1;
}

TEST(Holding, APutDownLevelsWhatLeansUnlessTheScriptSaysNo) {
  EXPECT_NEAR(TiltAtTheLanding({}), 0, 0.5);
  EXPECT_NEAR(TiltAtTheLanding(true), 0, 0.5);
  EXPECT_NEAR(TiltAtTheLanding(false), 6, 1.5);
}

}  // namespace
}  // namespace prehend::physics
