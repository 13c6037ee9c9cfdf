// SPDX-License-Identifier: Apache-2.0
// The facts that the library makes of grippers: how far one is open, and where it and cubes on a
// table are, 20 times a second, is all that anybody knows. Fingers of 8 cm way close and open at 10
// cm/s and stop at what is between them, so it is known when they hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "grammar/name_events.h"
#include "tests/grammar/corpus.h"

namespace prehend::grammar {
namespace {

using Eigen::Vector3d;

constexpr double kOpen_m = 0.08, kFrame_s = 0.05;

struct Arm {
  std::function<Vector3d(double s)> at;
  std::function<double(double s)> opening_m;
};

struct Box {
  std::string name;
  Vector3d size_m;
  std::function<Vector3d(double s)> at;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  std::function<double(double s)> open = nullptr;  ///< of a part on a joint
  int part_of = kNoEntity;
};

using Found = std::map<std::string, std::pair<double, double>>;

std::function<Vector3d(double)> Stays(const Vector3d& p) {
  return [p](double) { return p; };
}

/// Between points in time, straight lines.
double Line(const std::vector<std::pair<double, double>>& points, double s) {
  std::size_t i = 1;
  while (i + 1 < points.size() && points[i].first < s) ++i;
  const auto [s0, v0] = points[i - 1];
  const auto [s1, v1] = points[i];
  return v0 + (v1 - v0) * std::clamp((s - s0) / (s1 - s0), 0.0, 1.0);
}

/// What is found in so long, by "event(roles)"; the second one of a kind has a ' behind it.
Found Watch(const std::string& grammar, const std::vector<Arm>& arms, const std::vector<Box>& boxes,
            double until_s, double frame_s = kFrame_s, const Overrides& overrides = {}) {
  EntityTable entities{.ticks_per_second = 1000};
  entities.entities = {{.name = "table", .classes = {"Fixed", "Thing", "Entity"}}};
  entities.entities[0].half_size_m = {1, 1, 0.02};
  for (const Box& box : boxes) {
    const char* kind = box.open ? "Jointed" : box.part_of != kNoEntity ? "Attached" : "Movable";
    entities.entities.push_back(
        {.name = box.name, .classes = {kind, "Thing", "Entity"}, .part_of = box.part_of});
    entities.entities.back().half_size_m = box.size_m / 2;
  }
  for (std::size_t i = 0; i < arms.size(); ++i)
    entities.entities.push_back(
        {.name = i == 0 ? "arm" : "other_arm", .classes = {"Hand", "Entity"}});
  const auto program = testing::CompileLibrary(grammar, overrides);
  Monitor monitor(program, entities);
  std::vector<Event> events;
  std::vector<EntitySample> looks(entities.entities.size());
  looks[0].p_WB_m.z() = -0.02;
  Tick tick = 0;
  for (int i = 0; i * frame_s <= until_s + 1e-9; ++i) {
    const double s = i * frame_s;
    const auto move = [&](EntitySample& look, const Vector3d& p) {
      look.v_WB_m_per_s = i == 0 ? Vector3d(0, 0, 0) : Vector3d((p - look.p_WB_m) / frame_s);
      look.p_WB_m = p;
    };
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      move(looks[k + 1], boxes[k].at(s));
      looks[k + 1].q_WB = boxes[k].q;
      if (boxes[k].open) looks[k + 1].joint_fraction = boxes[k].open(s);
    }
    std::vector<HandSample> hands;
    std::vector<std::vector<CollisionSphere>> spheres;
    spheres.reserve(arms.size());
    for (std::size_t k = 0; k < arms.size(); ++k) {
      EntitySample& look = looks[boxes.size() + 1 + k];
      move(look, arms[k].at(s));
      spheres.push_back({{look.p_WB_m, 0}});
      hands.push_back({.entity = static_cast<int>(boxes.size() + 1 + k),
                       .trigger = 1 - arms[k].opening_m(s) / kOpen_m,
                       .collision_spheres = spheres.back()});
    }
    tick = static_cast<Tick>(std::lround(s * 1000));
    monitor.Advance({.tick = tick, .entities = looks, .hands = hands, .touches = {}}, events);
  }
  monitor.Finish(tick + 1, events);
  EXPECT_EQ(monitor.error(), "");
  Found found;
  for (const NamedEvent& event : NameEvents(*program, entities, events).events) {
    std::string label = event.Label();
    while (found.contains(label)) label += "'";
    found[label] = {static_cast<double>(event.interval.begin) / 1000,
                    static_cast<double>(event.interval.end) / 1000};
  }
  return found;
}

/// Closes from 1 s on down to so far, and opens from 3 s on.
std::function<double(double)> Closes(double width_m) {
  return [width_m](double s) {
    return Line({{1, kOpen_m},
                 {1 + (kOpen_m - width_m) / 0.1, width_m},
                 {3, width_m},
                 {3.1 + (kOpen_m - width_m) / 0.1, kOpen_m}},
                s);
  };
}

Box Cube(const std::string& name, const Vector3d& at, double edge_m = 0.047) {
  return {.name = name, .size_m = {edge_m, edge_m, edge_m}, .at = Stays(at)};
}

void ExpectGrasp(const Found& found, const std::string& label, double begin_s, double end_s,
                 double within_s = kFrame_s) {
  ASSERT_TRUE(found.contains(label)) << label << " of " << found.size();
  EXPECT_NEAR(found.at(label).first, begin_s, within_s + 1e-6) << label;
  EXPECT_NEAR(found.at(label).second, end_s, within_s + 1e-6) << label;
}

TEST(GraspFromGripper, FingersThatStopAtAThingHoldIt) {
  for (const double width_m : {0.003, 0.02, 0.047, 0.06}) {
    const Box box{.name = "cube", .size_m = {0.04, width_m, 0.04}, .at = Stays({0, 0, 0.02})};
    const Found found =
        Watch("grasp_from_gripper", {{Stays({0, 0, 0.03}), Closes(width_m)}}, {box}, 4);
    EXPECT_EQ(found.size(), 1u) << width_m;
    ExpectGrasp(found, "grasping(arm, cube)", 1 + (kOpen_m - width_m) / 0.1, 3);
  }
}

TEST(GraspFromGripper, FingersThatMeetHoldNothing) {
  for (const double last_m : {0.0, 0.0002, 0.001}) {
    EXPECT_TRUE(Watch("grasp_from_gripper", {{Stays({0, 0, 0.05}), Closes(last_m)}},
                      {Cube("cube", {0.02, 0.04, 0.0235})}, 4)
                    .empty())
        << last_m;
  }
}

TEST(GraspFromGripper, ActionsThatOnlySayOpenOrClosedNeedAnotherLimit) {
  // +1 and -1, as a map makes 0 and 1 of them: nobody sees what stops the fingers.
  const auto act = [](double s) { return s >= 1 && s < 3 ? 0.0 : kOpen_m; };
  const std::vector<Box> boxes = {Cube("cube", {0, 0, 0.0235})};
  EXPECT_TRUE(Watch("grasp_from_gripper", {{Stays({0, 0, 0.03}), act}}, boxes, 4).empty());
  const Found found = Watch("grasp_from_gripper", {{Stays({0, 0, 0.03}), act}}, boxes, 4, kFrame_s,
                            {{"grip_full", "1"}});
  EXPECT_EQ(found.size(), 1u);
  ExpectGrasp(found, "grasping(arm, cube)", 1, 3);
}

TEST(GraspFromGripper, AGripperThatOpensHalfWayLetsGoAndOneThatBeginsClosedHolds) {
  const auto half = [](double s) {
    return Line({{1, 0.08}, {1.33, 0.047}, {3, 0.047}, {3.1, 0.057}}, s);
  };
  const std::vector<Box> boxes = {Cube("cube", {0, 0, 0.0235})};
  const Found opened = Watch("grasp_from_gripper", {{Stays({0, 0, 0.03}), half}}, boxes, 5);
  EXPECT_EQ(opened.size(), 1u);
  ExpectGrasp(opened, "grasping(arm, cube)", 1.33, 3);
  const auto held = [](double s) { return Line({{1, 0.047}, {1.33, 0.08}}, s); };
  ExpectGrasp(Watch("grasp_from_gripper", {{Stays({0, 0, 0.03}), held}}, boxes, 3),
              "grasping(arm, cube)", 0, 1);
}

TEST(GraspFromGripper, WhatIsDroppedInMidAirIsHeldNoMore) {
  const auto arm = [](double s) { return Vector3d(0, 0, Line({{1.5, 0.03}, {2, 0.3}}, s)); };
  const auto cube = [&](double s) {
    return Vector3d(
        0, 0,
        s < 2.5 ? arm(s).z() - 0.0065 : std::max(0.0235, 0.2935 - 4.9 * (s - 2.5) * (s - 2.5)));
  };
  const auto fingers = [](double s) {
    return s < 2.5 ? Closes(0.047)(s) : Line({{2.5, 0.047}, {2.97, 0}}, s);
  };
  const Found found = Watch("grasp_from_gripper", {{arm, fingers}},
                            {{.name = "cube", .size_m = {0.047, 0.047, 0.047}, .at = cube}}, 4);
  EXPECT_EQ(found.size(), 1u);
  ExpectGrasp(found, "grasping(arm, cube)", 1.33, 2.55, 0.1);
}

TEST(GraspFromGripper, ARegraspIsASecondGrasp) {
  const auto fingers = [](double s) {
    return Line(
        {{1, 0.08}, {1.33, 0.047}, {2, 0.047}, {2.1, 0.057}, {2.2, 0.047}, {3, 0.047}, {3.3, 0.08}},
        s);
  };
  const Found found = Watch("grasp_from_gripper", {{Stays({0, 0, 0.03}), fingers}},
                            {Cube("cube", {0, 0, 0.0235})}, 4);
  EXPECT_EQ(found.size(), 2u);
  ExpectGrasp(found, "grasping(arm, cube)", 1.33, 2);
  ExpectGrasp(found, "grasping(arm, cube)'", 2.2, 3);
}

TEST(GraspFromGripper, EachOfTwoArmsHoldsItsOwnOrBothTheSame) {
  const std::vector<Box> cubes = {Cube("cube", {0, 0, 0.0235}), Cube("other", {0.05, 0, 0.0235})};
  const Found own = Watch(
      "grasp_from_gripper",
      {{Stays({0, 0, 0.03}), Closes(0.047)}, {Stays({0.05, 0, 0.03}), Closes(0.047)}}, cubes, 4);
  EXPECT_EQ(own.size(), 2u);
  ExpectGrasp(own, "grasping(arm, cube)", 1.33, 3);
  ExpectGrasp(own, "grasping(other_arm, other)", 1.33, 3);
  const Found both =
      Watch("grasp_from_gripper",
            {{Stays({0, 0, 0.03}), Closes(0.047)}, {Stays({0, 0.01, 0.03}), Closes(0.047)}},
            {cubes[0]}, 4);
  EXPECT_EQ(both.size(), 2u);
  ExpectGrasp(both, "grasping(other_arm, cube)", 1.33, 3);
}

TEST(GraspFromGripper, AClosedGripperThatPushesAndATableAreNoGrasps) {
  const auto arm = [](double s) { return Vector3d(Line({{1, -0.2}, {2, 0}}, s), 0, 0.02); };
  const auto cube = [](double s) {
    return Vector3d(std::max(0.0, Line({{1, -0.17}, {2, 0.03}}, s)), 0, 0.0235);
  };
  EXPECT_TRUE(Watch("grasp_from_gripper", {{arm, [](double) { return 0.0; }}},
                    {{.name = "cube", .size_m = {0.047, 0.047, 0.047}, .at = cube}}, 3)
                  .empty());
  EXPECT_TRUE(Watch("grasp_from_gripper", {{Stays({0, 0, 0.01}), Closes(0.02)}}, {}, 4).empty());
}

TEST(SupportFromMotion, OfSeveralThingsBelowThoseThatTouchBear) {
  const auto supports = [](const std::vector<Box>& boxes) {
    std::set<std::string> labels;
    for (const auto& [label, times] :
         Watch("pick_and_place_from_motion", {{Stays({0.4, 0, 0.4}), Closes(0.08)}}, boxes, 2)) {
      if (label.starts_with("supported_by")) labels.insert(label);
    }
    return labels;
  };
  using Labels = std::set<std::string>;
  const Labels on_table = {"supported_by(a, table)"};
  const Box a = Cube("a", {0, 0, 0.0235}), b = Cube("b", {0.01, 0.005, 0.0705}),
            c = Cube("c", {0, 0, 0.1175});
  EXPECT_EQ(supports({a, b}), (Labels{"supported_by(a, table)", "supported_by(b, a)"}));
  EXPECT_EQ(supports({a, b, c}),
            (Labels{"supported_by(a, table)", "supported_by(b, a)", "supported_by(c, b)"}));
  // Tilted by 5 degrees; 2 mm above what it lies on, as poses of 32 bits and soft contacts have it.
  Box tilted = Cube("b", {0, 0, 0.0725});
  tilted.q = Eigen::AngleAxisd(5 * std::numbers::pi / 180, Vector3d::UnitX());
  tilted.at = Stays({0, 0, 0.047 + 0.0235 * 1.083});
  EXPECT_EQ(supports({a, tilted}), (Labels{"supported_by(a, table)", "supported_by(b, a)"}));
  // Side by side, pressed into each other by 0.1 mm.
  EXPECT_EQ(supports({a, Cube("b", {0.0469, 0, 0.0235})}),
            (Labels{"supported_by(a, table)", "supported_by(b, table)"}));
  // A board over two posts has two supports.
  const Box board{.name = "board", .size_m = {0.3, 0.1, 0.02}, .at = Stays({0.1, 0, 0.057})};
  EXPECT_EQ(supports({a, Cube("b", {0.2, 0, 0.0235}), board}),
            (Labels{"supported_by(a, table)", "supported_by(b, table)", "supported_by(board, a)",
                    "supported_by(board, b)"}));
  // What lies in a box, a cup or a bowl lies on nothing else, and bears nothing that is round it.
  for (const double floor_m : {0.001, 0.005, 0.02}) {
    for (const double high_m : {0.03, 0.06, 0.09}) {
      const Box bowl{.name = "bowl", .size_m = {0.1, 0.12, 0.1}, .at = Stays({0, 0, 0.05})};
      const Box ball{.name = "a",
                     .size_m = {0.04, 0.04, high_m},
                     .at = Stays({0, 0.01, floor_m + high_m / 2})};
      EXPECT_EQ(supports({bowl, ball}),
                (Labels{"supported_by(bowl, table)", "supported_by(a, bowl)"}))
          << floor_m << " " << high_m;
    }
  }
  // A table that is thought to be 5 cm too low or too high is one as before.
  EXPECT_EQ(supports({Cube("a", {0, 0, 0.0735})}), on_table);
  EXPECT_EQ(supports({Cube("a", {0, 0, -0.0265})}), on_table);
}

/// A cube is carried for 12 cm and put onto another one.
Found Stacked(const std::string& grammar, double frame_s) {
  const auto arm = [](double s) {
    return Vector3d(0, Line({{0, -0.1}, {0.8, 0}, {2, 0}, {2.8, 0.12}, {4, 0.12}, {4.6, 0.12}}, s),
                    Line({{0, 0.2},
                          {0.8, 0.0235},
                          {1.4, 0.0235},
                          {2, 0.12},
                          {2.8, 0.12},
                          {3.2, 0.0705},
                          {3.7, 0.0705},
                          {4.3, 0.2}},
                         s));
  };
  const auto fingers = [](double s) {
    return Line({{1, 0.08}, {1.33, 0.047}, {3.4, 0.047}, {3.73, 0.08}}, s);
  };
  const auto cube = [&](double s) {
    return s < 1.4 ? Vector3d(0, 0, 0.0235)
                   : Vector3d(0, arm(std::min(s, 3.4)).y(), arm(std::min(s, 3.4)).z());
  };
  return Watch(grammar, {{arm, fingers}},
               {Cube("below", {0, 0.12, 0.0235}),
                {.name = "cube", .size_m = {0.047, 0.047, 0.047}, .at = cube}},
               5, frame_s);
}

TEST(RobotPickAndPlace, ACubeIsStackedOnAnother) {
  for (const double frame_s : {0.05, 0.02, 0.1}) {
    const Found found = Stacked("robot_pick_and_place", frame_s);
    ExpectGrasp(found, "grasping(arm, cube)", 1.33, 3.4, std::max(frame_s, kFrame_s));
    for (const char* event :
         {"picking_up", "transporting", "putting_down", "pick_and_place", "reaching"})
      EXPECT_TRUE(found.contains(std::string(event) + "(arm, cube)")) << event << " at " << frame_s;
    ASSERT_TRUE(found.contains("supported_by(cube, below)"));
    EXPECT_NEAR(found.at("supported_by(cube, below)").first, 3.2, frame_s + 1e-6);
    EXPECT_FALSE(found.contains("supported_by(cube, table)'"));
    EXPECT_FALSE(found.contains("grasping(arm, below)"));
  }
}

// A drawer of 30 cm is pulled out by its handle from 1.5 to 3 s, and swings on by itself later.
TEST(FurnitureByHolder, WhoHoldsTheHandleOpensTheDrawer) {
  const auto open = [](double s) { return Line({{1.5, 0}, {3, 0.6}, {4.5, 0.6}, {5.5, 0.2}}, s); };
  const auto handle = [&](double s) { return Vector3d(-0.3 * open(s), 0, 0.4); };
  const auto arm = [&](double s) -> Vector3d {
    return handle(std::min(s, 3.2)) -
           Vector3d(Line({{0, 0.3}, {0.9, 0}, {3.6, 0}, {4.2, 0.3}}, s), 0, 0);
  };
  const std::vector<Box> boxes = {
      {.name = "drawer", .size_m = {0.3, 0.4, 0.2}, .at = Stays({0.2, 0, 0.4}), .open = open},
      {.name = "handle", .size_m = {0.02, 0.1, 0.02}, .at = handle, .part_of = 1}};
  for (const char* grammar : {"furniture_from_gripper", "furniture_from_motion"}) {
    const Found found = Watch(grammar, {{arm, Closes(0.02)}}, boxes, 6);
    ASSERT_TRUE(found.contains("opened_by(drawer, arm)")) << grammar;
    EXPECT_NEAR(found.at("opened_by(drawer, arm)").first, 1.5, 0.15) << grammar;
    EXPECT_NEAR(found.at("opened_by(drawer, arm)").second, 3, 0.15) << grammar;
    EXPECT_TRUE(found.contains("closing(drawer)"));
    EXPECT_FALSE(found.contains("closed_by(drawer, arm)"));
  }
}

// It opens or shuts at half of its range per second, to the end or to 0.2 s before it.
TEST(Joints, WhatStillMovesWhenTheEpisodeEndsIsOpenThen) {
  for (const double frame_s : {0.002, 1.0 / 30, 0.05, 1.0 / 15, 0.1}) {
    for (const double stop_s : {2.0, 1.8}) {
      for (const bool opens : {true, false}) {
        const auto open = [&](double s) {
          const double way = Line({{1, 0}, {stop_s, (stop_s - 1) / 2}}, s);
          return opens ? way : 1 - way;
        };
        const Box drawer = {
            .name = "drawer", .size_m = {0.3, 0.4, 0.2}, .at = Stays({0.2, 0, 0.4}), .open = open};
        const Found found = Watch("joints", {}, {drawer}, 2, frame_s);
        const std::string label = opens ? "opening(drawer)" : "closing(drawer)";
        ASSERT_TRUE(found.contains(label)) << frame_s;
        EXPECT_NEAR(found.at(label).first, 1, frame_s + 0.002) << frame_s;
        if (stop_s == 2)
          EXPECT_EQ(found.at(label).second, 2.001) << frame_s;
        else
          EXPECT_NEAR(found.at(label).second, stop_s, frame_s + 0.002) << frame_s;
      }
    }
  }
}

// No frame is within 50 ms of another.
TEST(Joints, AMotionIsOneHoweverRareFramesAre) {
  const auto open = [](double s) { return Line({{1, 0}, {2.8, 0.9}, {4, 0.9}, {5.5, 0.1}}, s); };
  const Box drawer = {
      .name = "drawer", .size_m = {0.3, 0.4, 0.2}, .at = Stays({0.2, 0, 0.4}), .open = open};
  for (const double frame_s : {0.0502, 0.06, 0.0667, 0.08, 0.1, 0.14, 0.16, 0.2, 0.33, 0.5}) {
    const Found found = Watch("joints", {}, {drawer}, 7, frame_s);
    const double within_s = (frame_s > 0.1 ? 2 : 1) * frame_s + 0.002;
    ExpectGrasp(found, "opening(drawer)", 1, 2.8, within_s);
    ExpectGrasp(found, "closing(drawer)", 4, 5.5, within_s);
    EXPECT_FALSE(found.contains("opening(drawer)'") || found.contains("closing(drawer)'"));
  }
}

// It gets less far with every swing.
TEST(Joints, SwingsAreMotionsOfTheirOwnAndReboundsAreNone) {
  const auto watch = [](const std::function<double(double)>& open) {
    return Watch(
        "joints", {},
        {{.name = "drawer", .size_m = {0.3, 0.4, 0.2}, .at = Stays({0.2, 0, 0.4}), .open = open}},
        4, 1.0 / 250);
  };
  for (const double half_s : {0.1, 0.15, 0.25}) {  // of a period
    const Found swings = watch([&](double s) {
      constexpr std::array kTurns = {0.0, 0.8, 0.3, 0.6, 0.45, 0.5, 0.5};
      const double since = std::clamp((s - 1) / half_s, 0.0, kTurns.size() - 1.001);
      const auto last = static_cast<std::size_t>(since);
      return std::lerp(kTurns[last], kTurns[last + 1],
                       (1 - std::cos(std::numbers::pi * (since - std::floor(since)))) / 2);
    });
    ExpectGrasp(swings, "opening(drawer)", 1, 1 + half_s, 0.02);
    ExpectGrasp(swings, "closing(drawer)", 1 + half_s, 1 + 2 * half_s, 0.02);
    ExpectGrasp(swings, "opening(drawer)'", 1 + 2 * half_s, 1 + 3 * half_s, 0.02);
    ExpectGrasp(swings, "closing(drawer)'", 1 + 3 * half_s, 1 + 4 * half_s, 0.02);
    EXPECT_FALSE(swings.contains("opening(drawer)''")) << half_s;
  }
  for (const double rebound : {0.0015, 0.015}) {  // and down again within 0.1 s
    const Found shut = watch([&](double s) {
      return Line({{1, 0.9}, {1.5, 0}, {1.54, rebound}, {1.6, 0}}, s);
    });
    ExpectGrasp(shut, "closing(drawer)", 1, 1.5, 0.01);
    EXPECT_FALSE(shut.contains("opening(drawer)"));
  }
  const Found halts = watch([](double s) {  // goes on after 0.1 s, in which it comes back a little
    return Line({{1, 0}, {1.5, 0.5}, {1.55, 0.48}, {1.6, 0.48}, {2, 0.9}}, s);
  });
  ExpectGrasp(halts, "opening(drawer)", 1, 2, 0.01);
  EXPECT_FALSE(halts.contains("opening(drawer)'"));
}

TEST(Reached, ATargetThatNobodyGrasps) {
  const auto arm = [](double s) {
    return Vector3d(Line({{1, 0.3}, {2, 0}, {3, 0}, {4, 0.3}}, s), 0, 0.3);
  };
  const Found found =
      Watch("reached", {{arm, [](double) { return 0.0; }}}, {Cube("target", {0, 0, 0.3}, 0.01)}, 5);
  EXPECT_EQ(found.size(), 1u);
  ExpectGrasp(found, "reached(arm, target)", 1 + 0.25 / 0.3, 3.2);
}

}  // namespace
}  // namespace prehend::grammar
