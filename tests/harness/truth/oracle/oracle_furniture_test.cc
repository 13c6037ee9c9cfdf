// SPDX-License-Identifier: Apache-2.0
// The oracle on hand-made motions of a drawer and a door: what moves, when, and by whom.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "physics/scene/joint.h"
#include "tests/harness/truth/oracle/oracle_stage.h"

namespace prehend::truth {
namespace {

constexpr double kRate_hz = 480;
grammar::Tick At(double seconds) { return std::lround(seconds * kRate_hz); }

/// A drawer of 40 cm with a handle, in one tick after the other. Its joint is a slider or a hinge
/// of 90 degrees. Beside it: a foot, a ball, two hands.
class Cupboard {
 public:
  explicit Cupboard(physics::JointKind kind = physics::JointKind::kSlider) {
    cabinet = AddBody({.name = "cabinet", .fixed = true});
    drawer = AddBody({.name = "drawer", .mass_kg = 1});
    handle = AddBody({.name = "handle", .mass_kg = 0.1});
    foot = AddBody({.name = "foot", .kinematic = true});
    ball = AddBody({.name = "ball", .mass_kg = 1});
    const bool slides = kind == physics::JointKind::kSlider;
    scene.joints = {{.kind = kind,
                     .body = physics::BodyIndex(drawer),
                     .base = physics::BodyIndex(cabinet),
                     .pivot_W_m = {0, 0.3, 0},
                     .axis_W = slides ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ(),
                     .upper = slides ? 0.4 : std::numbers::pi / 2},
                    {.body = physics::BodyIndex(handle), .base = physics::BodyIndex(drawer)}};
    for (const char* name : {"left", "right"})
      scene.hands.push_back({.name = name, .model = SmallHand()});
  }

  /// Its fraction as a function of the seconds since now, while `agents` touch it, or its handle.
  void Play(double seconds, const std::function<double(double)>& fraction,
            const std::vector<std::string>& agents = {}, bool by_handle = false) {
    const grammar::Tick begin = now();
    for (grammar::Tick i = 0; i < At(seconds); ++i) {
      last = fraction(static_cast<double>(i) / kRate_hz);
      physics::Snapshot& frame = frames.emplace_back();
      frame.tick = begin + i;
      for (const physics::Body& body : scene.bodies) frame.bodies.push_back({.X_WB = body.X_WB});
      frame.bodies[drawer].X_WB =
          physics::MotionAlong(scene, scene.joints[0], {}, last * scene.joints[0].upper);
      frame.hands.resize(2);
      for (physics::HandState& hand : frame.hands) hand.X_WL.resize(2);
      for (const std::string& agent : agents)
        frame.contacts.push_back({.a = Stage::BodySide(by_handle ? handle : drawer),
                                  .b = agent == "left"    ? Stage::HandSide(0, 0)
                                       : agent == "right" ? Stage::HandSide(1, 0)
                                       : agent == "foot"  ? Stage::BodySide(foot)
                                                          : Stage::BodySide(ball)});
    }
    if (seconds > 0) last = fraction(seconds);
  }

  /// Steadily.
  void Move(double seconds, double to, const std::vector<std::string>& agents = {},
            bool by_handle = false) {
    const double from = last;
    Play(
        seconds, [=](double t_s) { return from + (to - from) * t_s / seconds; }, agents, by_handle);
  }
  void Rest(double seconds, const std::vector<std::string>& agents = {}) {
    Move(seconds, last, agents);
  }

  grammar::Tick now() const { return static_cast<grammar::Tick>(frames.size()); }
  grammar::Timeline Truth() const { return TrueTimeline(scene, frames, now()); }
  Intervals Truly(const std::string& label) const { return Of(label, Truth()); }

  double last = 0;

 private:
  int AddBody(const physics::Body& body) {
    scene.bodies.push_back(body);
    scene.bodies.back().shapes = {{physics::Box{}, {}}};
    return static_cast<int>(scene.bodies.size()) - 1;
  }

  int cabinet, drawer, handle, foot, ball;
  physics::Scene scene;
  std::vector<physics::Snapshot> frames;
};

TEST(OracleFurniture, ASlowPullIsDatedByTheMotion) {
  for (const double per_s : {0.06, 0.2, 1.0, 5.0}) {
    SCOPED_TRACE(per_s);
    Cupboard stage;
    stage.Rest(0.5, {"right"});
    stage.Move(0.6 / per_s, 0.6, {"right"});
    stage.Rest(0.5, {"right"});
    // It has moved by a thousandth of its range, and only as much is left.
    const grammar::Interval moves{At(0.5 + 0.001 / per_s), At(0.5 + 0.599 / per_s)};
    ExpectNear(stage.Truly("opening(drawer)"), {moves}, 1);
    ExpectNear(stage.Truly("opened_by(drawer, right)"), {moves}, 1);
    EXPECT_EQ(stage.Truly("closing(drawer)"), Intervals{});
    EXPECT_EQ(stage.Truly("opened_by(drawer, left)"), Intervals{});
  }
}

TEST(OracleFurniture, TellsTheWay) {
  Cupboard stage;
  stage.Move(1, 0.6);
  stage.Rest(0.5);
  for (const grammar::NamedEvent& event : stage.Truth().events) {
    if (event.event != "opening") continue;
    ASSERT_EQ(event.values.size(), 1u);
    EXPECT_EQ(event.values[0].name, "way");
    EXPECT_NEAR(event.values[0].value, 0.598, 0.002);
  }
}

TEST(OracleFurniture, WhatCreepsIsNotOpening) {
  Cupboard stage;
  stage.Move(10, 0.4, {"right"});
  stage.Rest(0.5);
  EXPECT_EQ(stage.Truly("opening(drawer)"), Intervals{});
  EXPECT_EQ(stage.Truly("opened_by(drawer, right)"), Intervals{});
}

TEST(OracleFurniture, AKickHasClosedIt) {
  Cupboard stage;
  stage.Move(0.5, 0.8);
  stage.Rest(0.5, {"right"});
  stage.Rest(0.5);
  const double kick_s = 0.025, speed_per_s = 1.6;
  const grammar::Tick touch = stage.now();
  const auto speeds_up = [&](double t_s) { return 0.8 - speed_per_s / kick_s * t_s * t_s / 2; };
  stage.Play(kick_s, speeds_up, {"foot"});
  const grammar::Tick leaves = stage.now();
  stage.Move(stage.last / speed_per_s, 0);
  stage.Rest(0.5);
  // It takes 5.6 ms for the first thousandth.
  const Intervals closes = stage.Truly("closing(drawer)");
  ASSERT_EQ(closes.size(), 1u);
  EXPECT_GE(closes[0].begin, touch) << "never before the touch";
  EXPECT_NEAR(static_cast<double>(closes[0].begin), static_cast<double>(touch) + 2.7, 1);
  ExpectNear(stage.Truly("closed_by(drawer, foot)"), {{closes[0].begin, leaves}}, 0);
  EXPECT_EQ(stage.Truly("closed_by(drawer, right)"), Intervals{}) << "it only held on before";
}

TEST(OracleFurniture, ABrushOnTheWayHasNot) {
  for (const double touch_s : {0.025, 0.2}) {
    Cupboard stage;
    stage.Rest(0.3, {"left"});
    stage.Move(0.3, 0.3, {"left"});
    const grammar::Tick begin = stage.now();
    stage.Move(touch_s, 0.3 + touch_s, {"left", "right"});
    const grammar::Tick end = stage.now();
    stage.Move(0.3, 0.6 + touch_s, {"left"});
    stage.Rest(0.3);
    EXPECT_EQ(stage.Truly("opened_by(drawer, left)"), stage.Truly("opening(drawer)"));
    EXPECT_EQ(stage.Truly("opened_by(drawer, right)"),
              (touch_s < 0.1 ? Intervals{} : Intervals{{begin, end}}));
  }
}

TEST(OracleFurniture, APushAfterCoastingIsOfWhoPushes) {
  for (const double halt_s : {0.0, 0.15, 0.3}) {
    SCOPED_TRACE(halt_s);
    Cupboard stage;
    stage.Move(0.5, 0.9);
    stage.Rest(0.5);
    stage.Move(0.4, 0.5);
    stage.Rest(halt_s);
    const grammar::Tick pushed = stage.now();
    stage.Move(0.5, 0, {"right"}, true);
    const grammar::Tick shut = stage.now();
    stage.Rest(0.5);
    ExpectNear(
        stage.Truly("closing(drawer)"),
        halt_s < 0.2 ? Intervals{{At(1.0), shut}} : Intervals{{At(1.0), At(1.4)}, {pushed, shut}},
        1);
    ExpectNear(stage.Truly("closed_by(drawer, right)"), {{pushed, shut}}, 1);
  }
}

TEST(OracleFurniture, ATugCountsIfThePullFollowsSoon) {
  for (const double halt_s : {0.14, 0.19}) {
    SCOPED_TRACE(halt_s);
    Cupboard stage;
    stage.Rest(0.5, {"right"});
    stage.Move(0.04, 0.008, {"right"});
    stage.Rest(halt_s, {"right"});
    const grammar::Tick pulls = stage.now();
    // It speeds up from nothing: the first thousandth takes 32 ms, which are part of the halt.
    stage.Play(0.6, [](double t_s) { return 0.008 + t_s * t_s; }, {"right"});
    const grammar::Tick begin = halt_s < 0.15 ? At(0.505) : pulls + At(0.0316);
    ExpectNear(stage.Truly("opening(drawer)"), {{begin, stage.now()}}, 1);
    ExpectNear(stage.Truly("opened_by(drawer, right)"), {{begin, stage.now()}}, 1);
  }
}

TEST(OracleFurniture, HalfOpenIsAState) {
  Cupboard stage;
  stage.Rest(0.5);
  stage.Move(0.6, 0.6);   // passes 0.1 and 0.5
  stage.Move(0.1, 0.49);  // back over the limit, by less than 0.02
  const grammar::Tick back = stage.now();
  stage.Move(0.1, 0.39);
  EXPECT_EQ(stage.Truly("closed(drawer)"), (Intervals{{0, At(0.6)}}));
  ExpectNear(stage.Truly("half_closed(drawer)"),
             {{At(0.6), At(1.0)}, {back + At(0.01), stage.now()}}, 1);
  ExpectNear(stage.Truly("half_open(drawer)"), {{At(1.0), back + At(0.01)}}, 1);
  EXPECT_EQ(stage.Truly("open(drawer)"), Intervals{});
}

TEST(OracleFurniture, HasOneStateAtATime) {
  Cupboard stage;
  stage.last = 0.95;
  stage.Rest(0.1);
  stage.Move(1, 0);
  stage.Move(0.05, 1);
  Intervals all;
  for (const char* state : {"closed", "half_closed", "half_open", "open"})
    for (const grammar::Interval& interval : stage.Truly(std::string(state) + "(drawer)"))
      all.push_back(interval);
  std::ranges::sort(all, {}, &grammar::Interval::begin);
  ASSERT_EQ(all.size(), 7u);
  EXPECT_EQ(all.front().begin, 0);
  EXPECT_EQ(all.back().end, stage.now());
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i].begin, all[i - 1].end);
}

TEST(OracleFurniture, TwoHandsEachOpenIt) {
  Cupboard stage;
  stage.Rest(0.5, {"left", "right"});
  stage.Move(0.3, 0.3, {"left", "right"});
  const grammar::Tick lets_go = stage.now();
  stage.Move(0.3, 0.6, {"right"}, true);
  stage.Rest(0.5);
  ExpectNear(stage.Truly("opening(drawer)"), {{At(0.5), At(1.1)}}, 1);
  ExpectNear(stage.Truly("opened_by(drawer, left)"), {{At(0.5), lets_go}}, 1);
  ExpectNear(stage.Truly("opened_by(drawer, right)"), {{At(0.5), At(1.1)}}, 1);
}

TEST(OracleFurniture, AHandThatChangesFromFrontToHandleIsOneTouch) {
  Cupboard stage;
  stage.Move(0.07, 0.07, {"right"});
  stage.Move(0.05, 0.12);
  stage.Move(0.07, 0.19, {"right"}, true);
  stage.Rest(0.5);
  EXPECT_EQ(stage.Truly("opened_by(drawer, right)"), stage.Truly("opening(drawer)"));
}

TEST(OracleFurniture, NoiseAtRestIsNoMotion) {
  for (const double noise : {0.0004, 0.004, 0.03}) {
    SCOPED_TRACE(noise);
    const auto trembles = [&](double at) {
      return [=](double t_s) { return at + noise * std::sin(2 * std::numbers::pi * 10 * t_s); };
    };
    Cupboard stage;
    stage.last = 0.1;
    stage.Play(2, trembles(0.1), {"right"});
    EXPECT_EQ(stage.Truly("opening(drawer)"), Intervals{});
    EXPECT_EQ(stage.Truly("closing(drawer)"), Intervals{});
    const grammar::Tick begin = stage.now();
    stage.Move(0.6, 0.7, {"right"});
    const grammar::Tick end = stage.now();
    stage.Play(2, trembles(0.7), {"right"});
    // Neither trembling before nor after belongs to it: at most a part of a swing of 25 ms does.
    ExpectNear(stage.Truly("opening(drawer)"), {{begin, end}}, noise < 0.001 ? 1 : At(0.05));
    EXPECT_EQ(stage.Truly("closing(drawer)"), Intervals{});
  }
}

TEST(OracleFurniture, WhatAThrownThingClosesNobodyCloses) {
  Cupboard stage;
  stage.Move(0.5, 0.8, {"left"});
  stage.Rest(0.5);
  stage.Move(0.02, 0.78, {"ball"});
  stage.Move(0.78, 0);
  stage.Rest(0.5);
  ExpectNear(stage.Truly("closing(drawer)"), {{At(1.0), At(1.8)}}, 1);
  for (const char* agent : {"ball", "left", "right", "foot"})
    EXPECT_EQ(stage.Truly("closed_by(drawer, " + std::string(agent) + ")"), Intervals{});
  EXPECT_EQ(stage.Truly("opened_by(drawer, left)").size(), 1u);
}

TEST(OracleFurniture, ADoorThatSwingsBackIsClosedByNobody) {
  Cupboard stage(physics::JointKind::kHinge);
  stage.Rest(0.5, {"right"});
  stage.Move(0.5, 0.5, {"right"});
  // Let go at the turning point: it swings back without a pause, to a third, and open again.
  const grammar::Tick turns = stage.now();
  stage.Move(0.1, 0.35);
  const grammar::Tick back = stage.now();
  stage.Move(0.2, 0.5);
  stage.Rest(0.5);
  ExpectNear(stage.Truly("opening(drawer)"), {{At(0.5), turns}, {back, back + At(0.2)}}, 1);
  ExpectNear(stage.Truly("opened_by(drawer, right)"), {{At(0.5), turns}}, 1);
  ExpectNear(stage.Truly("closing(drawer)"), {{turns, back}}, 1);
  EXPECT_EQ(stage.Truly("closed_by(drawer, right)"), Intervals{});
}

TEST(OracleFurniture, ABounceIsAHalt) {
  Cupboard stage;
  stage.last = 0.8;
  stage.Rest(0.5, {"foot"});
  stage.Move(0.4, 0, {"foot"});
  stage.Move(0.05, 0.05);
  stage.Move(0.05, 0);
  stage.Rest(0.5);
  ExpectNear(stage.Truly("closing(drawer)"), {{At(0.5), At(0.9)}}, 1);
  EXPECT_EQ(stage.Truly("opening(drawer)"), Intervals{});
}

TEST(OracleFurniture, WhatStillMovesAtTheEndIsOpen) {
  for (const double rest_s : {0.0, 0.1}) {
    Cupboard stage;
    stage.Rest(0.5);
    stage.Move(0.5, 0.5, {"left"});
    stage.Rest(rest_s);
    const grammar::Timeline truth = stage.Truth();
    const auto opening = std::ranges::find(truth.events, "opening", &grammar::NamedEvent::event);
    ASSERT_NE(opening, truth.events.end());
    EXPECT_EQ(opening->open_end, rest_s == 0);
    EXPECT_NEAR(static_cast<double>(opening->interval.end), static_cast<double>(At(1.0)), 1);
  }
}

TEST(OracleFurniture, IsAboutParts) {
  EXPECT_TRUE(OracleDefines("closing", "part"));
  EXPECT_FALSE(OracleDefines("closing", "hand")) << "a grammar's own event";
  EXPECT_TRUE(OracleDefines("grasping", "whoever"));
}

}  // namespace
}  // namespace prehend::truth
