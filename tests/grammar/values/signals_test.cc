// SPDX-License-Identifier: Apache-2.0
// Every signal and test of the language, with its unit, on a scene whose values are known by hand.
#include <numbers>

#include "grammar/program/operators.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::Scene;

// A tray that turns by 1 rad/s about z at the origin and rises by 5 cm/s; a cup 0.4 m to its left,
// 10 cm long each way, that moves straight up by 6 cm/s; a hand 1 m in front, closing by 10 mm per
// frame of 10 ms.
Scene KnownScene() {
  Scene s;
  s.entity_table.entities[Scene::kCup].half_size_m = {0.05, 0.05, 0.05};
  s.entity_table.entities[Scene::kCup].p_BC_m = {0, 0, 0.05};
  s.looks[Scene::kTray].v_WB_m_per_s = {0, 0, 0.05};
  s.looks[Scene::kTray].w_WB_rad_per_s = {0, 0, 1};
  s.looks[Scene::kTray].q_WB = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  s.looks[Scene::kCup].p_WB_m = {0, 0.4, 0.2};
  s.looks[Scene::kCup].q_WB = Eigen::AngleAxisd(std::numbers::pi / 6, Eigen::Vector3d::UnitX());
  s.looks[Scene::kCup].v_WB_m_per_s = {0, 0, 0.06};
  s.looks[Scene::kHand].p_WB_m = {1, 0, 0.2};
  s.hand.ahead_W = {-1, 0, 0};
  s.hand.trigger = 0.7;
  s.hand.style = 1;
  s.collision_sphere = {.p_W_m = {0.55, 0.4, 0.2}, .radius_m = 0.01};
  s.touches = {{.a = Scene::kHand,
                .b = Scene::kCup,
                .up_on_a = -0.2,
                .up_on_b = 0.1,
                .normal_force_n = 3,
                .sensor_sets = 0b101},
               {.a = Scene::kCup,
                .b = Scene::kTray,
                .up_on_a = 0.9,
                .up_on_b = -0.9,
                .normal_force_n = 4,
                .vertical_speed_m_per_s = 0.03}};
  return s;
}

bool HoldsInScene(const std::string& condition) {
  const auto program = testing::CompileText(
      "grammar t\nevent e(hand: Hand, cup: Cup, tray: Movable) while distance(hand, cup) < 100 m "
      "and "
      "distance(cup, tray) < 100 m and " +
      condition);
  if (!program) return false;
  Scene scene = KnownScene();
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  monitor.Advance(scene.At(0), events);
  scene.collision_sphere.p_W_m.x() -= 0.01;
  monitor.Advance(scene.At(10), events);
  monitor.Finish(20, events);
  // The last frame decides: closing_speed has no value before there are two.
  return !events.empty() && events.back().interval.end == 20;
}

TEST(Signals, HaveTheirDocumentedValues) {
  const struct {
    const char* signal;
    double value;
    const char* unit;
  } cases[] = {
      {"trigger(hand)", 0.7, ""},
      {"sensor_sets(hand, cup)", 2, ""},
      {"sensor_sets(hand, tray)", 0, ""},
      {"up(cup, tray)", 0.9, ""},
      {"up(tray, cup)", -0.9, ""},
      {"up(cup, hand)", 0.1, ""},
      {"up(hand, tray)", -1, ""},
      {"force(tray, cup)", 4, "N"},
      {"touch_speed(tray, cup)", 0.03, "m/s"},
      {"touch_speed(hand, tray)", 0, "m/s"},
      {"gap(hand, cup)", 0.48, "m"},
      {"closing_speed(hand, cup)", 1, "m/s"},
      {"surface_speed(hand)", 1, "m/s"},
      {"distance(hand, position(tray))", std::sqrt(1.04), "m"},
      {"height(cup)", 0.2, "m"},
      {"height(ahead(hand, 0.3 m))", 0.2, "m"},
      {"distance(hand, ahead(hand, 30 cm))", 0.3, "m"},
      {"speed(cup)", 0.06, "m/s"},
      {"vertical_speed(cup)", 0.06, "m/s"},
      {"relative_vertical_speed(cup, tray)", 0.01, "m/s"},
      {"relative_speed(cup, tray)", std::hypot(0.4, 0.01), "m/s"},
      {"mean(gap(hand, cup), 100 ms)", 0.485, "m"},
      {"min(gap(hand, cup), 100 ms)", 0.48, "m"},
      {"max(gap(hand, cup), 100 ms)", 0.49, "m"},
      {"median(gap(hand, cup), 19 ms)", 0.48, "m"},
      {"speed_along(cup, tray)", 0.4, "m/s"},
      {"tilt(cup)", std::numbers::pi / 6, "rad"},
      {"height(position_on(cup, tray))", 0.2, "m"},
      {"abs(up(hand, tray))", 1, ""},
      {"(2 * height(cup) - 10 cm)", 0.3, "m"},
      {"height(cup) / 0.1 s", 2, "m/s"},
  };
  // A bound beyond what a signal can be is refused; of a product with the cup's height nobody knows
  // what it can be.
  constexpr const char* kTimesOne = " * (height(cup) / 20 cm) ";
  for (const auto& c : cases) {
    const auto compare = [&](const char* op, double value) {
      std::ostringstream text;
      text.precision(17);
      text << c.signal << kTimesOne << op << ' ' << value << ' ' << c.unit;
      return HoldsInScene(text.str());
    };
    EXPECT_TRUE(compare(">", c.value - 1e-9)) << c.signal;
    EXPECT_TRUE(compare("<", c.value + 1e-9)) << c.signal;
  }
}

// The cup turns about its own axis, which leans, by 10 rad/s to the left; the tray by 6 rad/s.
// Where an interval that begins at 0 ends, a frame every 10 ms; 1000: nowhere.
Tick EndsWhenTurning(const std::string& until) {
  const auto program = testing::CompileText(
      "grammar t\nevent e(cup: Cup, tray: Movable) while part_of(cup, tray) until " + until);
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  const Eigen::Quaterniond leaning(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  const auto turned = [&](double rad) {
    return leaning * Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ());
  };
  for (Tick t = 0; t < 1000; t += 10) {
    scene.looks[Scene::kCup].q_WB = turned(0.01 * static_cast<double>(t));
    scene.looks[Scene::kTray].q_WB = turned(0.006 * static_cast<double>(t));
    monitor.Advance(scene.At(t), events);
  }
  monitor.Finish(1000, events);
  return events.empty() ? -1 : events.front().interval.end;
}

TEST(Signals, RotationIsMeasuredFromTheBeginAndSpinOverAWindow) {
  EXPECT_EQ(EndsWhenTurning("rotation(cup) > 0.495 rad"), 50);
  EXPECT_EQ(EndsWhenTurning("rotation(cup, z) > 0.495 rad"), 50);
  EXPECT_EQ(EndsWhenTurning("rotation(cup, tray) > 0.495 rad"), 130);
  EXPECT_EQ(EndsWhenTurning("rotation(cup, tray, z) > 0.495 rad"), 130);
  EXPECT_EQ(EndsWhenTurning("rotation(tray, cup, z) < -0.495 rad"), 130);
  EXPECT_EQ(EndsWhenTurning("rotation(cup, z) < -0.1 rad"), 320) << "half a turn is the most";
  EXPECT_EQ(EndsWhenTurning("abs(rotation(cup, x)) > 0.1 rad"), 1000);
  EXPECT_EQ(EndsWhenTurning("aligned(cup, x, tray, x) > 0.495 rad"), 130);
  EXPECT_EQ(EndsWhenTurning("aligned(cup, y, tray, x) < 1.2 rad"), 880) << "past the half turn";
  EXPECT_EQ(EndsWhenTurning("aligned(cup, z, tray, z) > 0.001 rad"), 1000);
  EXPECT_EQ(EndsWhenTurning("spin(cup, z, 100 ms) < 9.999 rad/s"), 1000);
  EXPECT_EQ(EndsWhenTurning("spin(cup, z, 100 ms) < 10.001 rad/s"), -1);
  EXPECT_EQ(EndsWhenTurning("abs(spin(cup, y, 100 ms)) > 0.001 rad/s"), 1000);
  for (const char* window : {"400 ms", "800 ms", "2 s"}) {  // more than half a turn
    const std::string spin = "spin(cup, z, " + std::string(window) + ")";
    EXPECT_EQ(EndsWhenTurning(spin + " < 9.999 rad/s"), 1000);
    EXPECT_EQ(EndsWhenTurning(spin + " < 10.001 rad/s"), -1);
  }
}

// Where `drift_along` of the cup on the tray is above 1 cm/s, when the cup is at x_m(t) and a frame
// comes every step ms.
template <typename Where>
std::vector<Interval> Drifting(Where&& x_m, Tick step, Tick end, double tray_m_per_s = 0) {
  const auto program = testing::CompileText(
      "grammar t\nevent drifting(cup: Cup, tray: Movable) while drift_along(cup, tray, 100 ms) > 1 "
      "cm/s");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  std::vector<Interval> drifting;
  for (Tick t = 0; t < end; t += step) {
    const double tray_m = tray_m_per_s * static_cast<double>(t) / 1000;
    scene.looks[Scene::kTray].p_WB_m.x() = tray_m;
    scene.looks[Scene::kCup].p_WB_m.x() = tray_m + x_m(t);
    monitor.Advance(scene.At(t), events);
  }
  monitor.Finish(end, events);
  for (const Event& event : events) drifting.push_back(event.interval);
  return drifting;
}

TEST(Signals, DriftIsTheWayOverAWindow) {
  using Intervals = std::vector<Interval>;
  // A jump by 2 mm is 2 cm/s over every window that contains it, whoever carries the tray.
  const auto jump = [](Tick t) { return t < 500 ? 0.0 : 0.002; };
  EXPECT_EQ(Drifting(jump, 10, 1000), (Intervals{{450, 550}}));
  EXPECT_EQ(Drifting(jump, 10, 1000, 0.3), (Intervals{{450, 550}}));
  // The window reaches to the next frames that are far enough away: 60 ms here.
  EXPECT_EQ(Drifting([](Tick t) { return t < 510 ? 0.0 : 0.002; }, 30, 990),
            (Intervals{{450, 570}}));
  // Trembling gets nowhere: 0.4 mm to and fro is 4 cm/s.
  EXPECT_EQ(
      Drifting([](Tick t) { return 0.0004 * static_cast<double>(t / 10 % 2); }, 10, 1000, 0.3),
      (Intervals{}));
  // At the episode's begin and end the window is cut off and the time with it.
  EXPECT_EQ(Drifting([](Tick t) { return t < 10 ? 0.0 : 0.0009; }, 10, 1000), (Intervals{{0, 40}}));
  EXPECT_EQ(Drifting([](Tick t) { return t < 990 ? 0.0 : 0.0009; }, 10, 1000),
            (Intervals{{960, 1000}}));
  EXPECT_EQ(Drifting(jump, 10, 10), (Intervals{}));
}

// A cup that touches the tray below its origin, with this normal on it, or `beside_m` from there,
// while it moves and turns like that for a second.
std::vector<Event> MovedAlong(const Eigen::Vector3d& nhat_W, const Eigen::Vector3d& way_m,
                              const Eigen::Vector3d& turn_rad = Eigen::Vector3d::Zero(),
                              const Eigen::Vector3d& beside_m = Eigen::Vector3d::Zero()) {
  const auto program = testing::CompileText(
      "grammar t\n"
      "event fast(cup: Cup, tray: Movable) while speed_along(cup, tray) > 9 mm/s\n"
      "event drifting(cup: Cup, tray: Movable) while drift_along(cup, tray, 100 ms) > 9 mm/s\n"
      "event far(cup: Cup, tray: Movable) from touching(cup, tray) begins\n"
      "  to displacement_along(cup, tray) > 9 mm begins during touching(cup, tray) or drop");
  Scene scene;
  scene.looks[Scene::kTray].q_WB = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ());
  scene.touches = {{.a = Scene::kCup,
                    .b = Scene::kTray,
                    .up_on_a = nhat_W.z(),
                    .up_on_b = -nhat_W.z(),
                    .nhat_BA_W = nhat_W}};
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  const Eigen::Vector3d middle_m(0, 0, 0.1);  // of the cup, above the touch
  EntitySample& cup = scene.looks[Scene::kCup];
  for (Tick t = 0; t <= 1000; t += 10) {
    const double part = static_cast<double>(t) / 1000;
    const Eigen::AngleAxisd turned(turn_rad.norm() * part, turn_rad.normalized());
    scene.touches[0].p_W_m = way_m * part + beside_m;
    cup.q_WB = turned;
    cup.p_WB_m = way_m * part + turned * middle_m;
    cup.w_WB_rad_per_s = turn_rad;
    cup.v_WB_m_per_s = way_m + cup.w_WB_rad_per_s.cross(turned * middle_m);
    monitor.Advance(scene.At(t), events);
  }
  monitor.Finish(1010, events);
  return events;
}

TEST(Signals, AlongIsInThePlaneInWhichTheTwoTouch) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), slope(-0.8, 0, 0.6), still(0, 0, 0);
  const Eigen::Vector3d tip = Eigen::Vector3d::UnitY(), twist = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(MovedAlong(up, {0.01, 0, 0}).size(), 3u);
  EXPECT_EQ(MovedAlong(up, {0.007, 0, 0}).size(), 0u);
  EXPECT_EQ(MovedAlong(up, {0, 0, 0.1}).size(), 0u) << "a rise leads nowhere";
  EXPECT_EQ(MovedAlong(slope, {0.006, 0, 0.008}).size(), 3u) << "on a slope, along the slope";
  EXPECT_EQ(MovedAlong(slope, {-0.1, 0, 0.075}).size(), 0u) << "away from the slope";
  EXPECT_EQ(MovedAlong(up, still, tip).size(), 0u) << "tipped over an edge that stays";
  EXPECT_EQ(MovedAlong(up, {0.01, 0, 0}, tip).size(), 3u) << "over one that moves";
  EXPECT_EQ(MovedAlong(up, still, twist, {0.05, 0, 0}).size(), 0u) << "turned on the spot";
  EXPECT_EQ(MovedAlong(still, still, tip).size(), 3u) << "at its middle, if nobody knows";
}

// The cup goes 2 mm to the left and 1 mm up at 0.5 s, on a tray that is carried and turned.
TEST(Signals, SpeedsOverAWindowAreWaysPerTime) {
  const auto program = testing::CompileText(
      "grammar t\n"
      "event moves(cup: Cup) while speed(cup, 100 ms) > 2 cm/s\n"
      "event slips(cup: Cup, tray: Movable) while relative_speed(cup, tray, 100 ms) > 2.2 cm/s\n"
      "event leaps(cup: Cup, tray: Movable) while relative_speed(cup, tray, 100 ms) > 2.3 cm/s");
  const auto events_of = [&](double tray_m_per_s) {
    Scene scene;
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    for (Tick t = 0; t < 1000; t += 10) {
      const double seconds = static_cast<double>(t) / 1000;
      EntitySample& tray = scene.looks[Scene::kTray];
      tray.p_WB_m.y() = tray_m_per_s * seconds;
      tray.q_WB = Eigen::AngleAxisd(tray_m_per_s * seconds, Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d on_tray_m(0.1, t < 500 ? 0 : 0.002, t < 500 ? 0 : 0.001);
      scene.looks[Scene::kCup].p_WB_m = tray.p_WB_m + tray.q_WB * on_tray_m;
      monitor.Advance(scene.At(t), events);
    }
    monitor.Finish(1000, events);
    std::vector<std::pair<int, Interval>> found;
    for (const Event& event : events) found.push_back({event.rule.number(), event.interval});
    return found;
  };
  using Found = std::vector<std::pair<int, Interval>>;
  EXPECT_EQ(events_of(0), (Found{{1, {450, 550}}, {2, {450, 550}}}));
  EXPECT_EQ(events_of(0.5), (Found{{2, {450, 550}}, {1, {0, 1000}}}));
}

// Frames at uneven times; the window of 40 ms has those at most 20 ms before or after.
TEST(Signals, WindowsHaveTheFramesAtMostHalfOfThemAway) {
  const auto intervals = [](const std::string& condition) {
    const auto program =
        testing::CompileText("grammar t\nevent e(cup: Cup) while " + condition + " > 2.9 m");
    Scene scene;
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    const std::pair<Tick, double> heights[] = {{0, 1},  {10, 1}, {20, 6}, {40, 1},
                                               {60, 3}, {61, 3}, {80, 3}, {100, 1}};
    for (const auto& [tick, height_m] : heights) {
      scene.looks[Scene::kCup].p_WB_m.z() = height_m;
      monitor.Advance(scene.At(tick), events);
    }
    monitor.Finish(120, events);
    std::string text;
    for (const Event& event : events)
      text += "[" + std::to_string(event.interval.begin) + "," +
              std::to_string(event.interval.end) + ") at " + std::to_string(event.decided) + " ";
    return text;
  };
  EXPECT_EQ(intervals("max(height(cup), 40 ms)"), "[0,120) at 120 ");
  EXPECT_EQ(intervals("min(height(cup), 40 ms)"), "[61,80) at 100 ");
  EXPECT_EQ(intervals("mean(height(cup), 40 ms)"), "[40,60) at 80 [61,80) at 100 ");
  EXPECT_EQ(intervals("median(height(cup), 40 ms)"), "[40,120) at 120 ");
}

TEST(Signals, DriftIsKnownWhenItsWindowIsComplete) {
  const auto program = testing::CompileText(
      "grammar t\nevent drifting(cup: Cup, tray: Movable) while drift_along(cup, tray, 100 ms) > 1 "
      "cm/s\n"
      "event jumped(cup: Cup, tray: Movable) from drift_along(cup, tray, 100 ms) > 1 cm/s begins\n"
      "  to drift_along(cup, tray, 100 ms) < drift_along(cup, tray, 100 ms)@begin / 2 begins");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick t = 0; t < 1000; t += 10) {
    scene.looks[Scene::kCup].p_WB_m.x() = t < 500 ? 0 : 0.002;
    monitor.Advance(scene.At(t), events);
  }
  ASSERT_EQ(events.size(), 2u);
  for (const Event& event : events) {
    EXPECT_EQ(event.interval, (Interval{450, 550}));
    EXPECT_EQ(event.decided, 600);
  }
}

TEST(Signals, TestsHoldAsDocumented) {
  const std::pair<const char*, bool> cases[] = {
      {"touching(hand, cup)", true},
      {"touching(cup, hand)", true},
      {"touching(hand, tray)", false},
      {"is(cup, Cup)", true},
      {"is(tray, Cup)", false},
      {"nearest(tray, cup)", true},
      {"nearest(tray, hand)", false},  // the cup is a Movable, too, and its box is nearer
      {"nearest(hand, cup)", true},
      {"nearest(cup, hand)", true},
      {"part_of(cup, tray)", true},
      {"part_of(tray, cup)", false},
      {"in_sphere(position(cup), tray, 0.45 m)", true},
      {"in_sphere(position(cup), tray, 0.44 m)", false},
      {"in_sphere(cup, tray, 0.40 m)", true},   // it reaches nearer than its origin
      {"in_sphere(hand, cup, 0.531 m)", true},  // as its sphere does
      {"in_sphere(hand, cup, 0.529 m)", false},
      {"in_cylinder(cup, tray, 0.41 m, 0.21 m)", true},
      {"in_cylinder(cup, tray, 0.39 m, 0.21 m)", false},
      {"in_cylinder(cup, tray, 0.41 m, 0.19 m)", false},
      {"in_cylinder(tray, cup, 0.41 m, 0.21 m)", true},  // above and below
  };
  for (const auto& [condition, holds] : cases)
    EXPECT_EQ(HoldsInScene(condition), holds) << condition;
}

TEST(Signals, DistancesFromSurfacesAreThoseOfTheTrueShape) {
  // A foot of 40 cm with a column of 4 cm on it, lying on its side: up is to +y. The hand is 18 cm
  // beside the column and 10 cm above the foot, in the bounding box of the two.
  Scene scene;
  EntityInfo& column = scene.entity_table.entities[Scene::kCup];
  column.half_size_m = {0.2, 0.2, 0.2};
  column.p_BC_m = {0, 0, 0.2};
  scene.looks[Scene::kCup].p_WB_m = {1, 0, 0};
  scene.looks[Scene::kCup].q_WB =
      Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  scene.collision_sphere = {.p_W_m = {1.2, 0.12, 0}, .radius_m = 0.01};
  scene.looks[Scene::kHand].p_WB_m = {1.2, 0.12, 0};
  const auto holds = [&](const std::string& condition) {
    const auto program = testing::CompileText(
        "grammar t\nevent e(hand: Hand, cup: Cup) while distance(hand, cup) < 1 m and " +
        condition);
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(0), events);
    monitor.Finish(10, events);
    return !events.empty();
  };
  EXPECT_TRUE(holds("gap(hand, cup) <= 0 m")) << "without parts it is its bounding box";
  EXPECT_TRUE(holds("in_sphere(cup, position(hand), 1 mm)"));
  column.solid =
      Solid({{Box{{0.2, 0.2, 0.01}}, {0, 0, 0.01}}, {Box{{0.02, 0.02, 0.2}}, {0, 0, 0.2}}});
  EXPECT_TRUE(holds("gap(hand, cup) > 89.99 mm and gap(hand, cup) < 90.01 mm"));
  EXPECT_TRUE(holds("in_sphere(cup, position(hand), 100.01 mm)"));
  EXPECT_FALSE(holds("in_sphere(cup, position(hand), 99.99 mm)"));
  column.solid = Solid({{Capsule{0.02, 0.18}, {0, 0, 0.2}}});
  EXPECT_TRUE(holds("gap(hand, cup) > 169.99 mm and gap(hand, cup) < 170.01 mm"));
}

TEST(Signals, APartOfAPartIsAPartOfTheWhole) {
  const auto program = testing::CompileText(
      "grammar t\nevent e(part: Entity, whole: Entity) while part_of(part, whole)");
  Scene scene;
  scene.entity_table.entities[Scene::kTray].part_of =
      Scene::kHand;  // and the cup is a part of the tray
  const auto pairs = [&] {
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(0), events);
    monitor.Finish(10, events);
    return events.size();
  };
  EXPECT_EQ(pairs(), 3u);
  scene.entity_table.entities[Scene::kHand].part_of =
      Scene::kCup;  // a ring ends, too: each is a part of both others
  EXPECT_EQ(pairs(), 6u);
}

TEST(Signals, AHandIsAPartOfItsPersonOnly) {
  const auto program = testing::CompileText(
      "grammar t\nevent e(hand: Hand, person: Person) while part_of(hand, person)");
  Scene scene;
  auto& entities = scene.entity_table.entities;
  entities[Scene::kTray].classes = {"Person", "Entity"};
  entities[Scene::kCup].classes = {"Person", "Entity"};
  entities[Scene::kCup].part_of = kNoEntity;
  const auto owners = [&] {
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(0), events);
    monitor.Finish(10, events);
    std::vector<int> found;
    for (const Event& event : events) found.push_back(event.roles[1]);
    return found;
  };
  EXPECT_EQ(owners(), std::vector<int>{});
  entities[Scene::kHand].part_of = Scene::kTray;
  EXPECT_EQ(owners(), std::vector<int>{Scene::kTray});
  entities[Scene::kHand].part_of = Scene::kCup;
  EXPECT_EQ(owners(), std::vector<int>{Scene::kCup});
}

TEST(Signals, ClearanceIsFromTheLowestPointToTheTop) {
  Scene scene;
  EntityInfo& cup = scene.entity_table.entities[Scene::kCup];
  EntityInfo& tray = scene.entity_table.entities[Scene::kTray];
  cup.half_size_m = {0.03, 0.03, 0.05};
  tray.half_size_m = {0.3, 0.2, 0.01};
  scene.looks[Scene::kCup].p_WB_m = {0.1, 0, 0.08};
  const auto is = [&](double from_m, double to_m) {
    const auto program = testing::CompileText(
        "grammar t\nevent e(cup: Cup, tray: Movable) while clearance(cup, tray) >= " +
        std::to_string(from_m) + " m and clearance(cup, tray) <= " + std::to_string(to_m) + " m");
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(0), events);
    monitor.Finish(10, events);
    return !events.empty();
  };
  EXPECT_TRUE(is(0.0199, 0.0201));
  scene.looks[Scene::kCup].q_WB = Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(is(0.0134, 0.0135)) << "it stands on an edge";
  scene.looks[Scene::kTray].q_WB = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(is(0.0134, 0.0135)) << "the tray lies upside down";
  scene.looks[Scene::kCup].p_WB_m.x() = 0.34;
  EXPECT_FALSE(is(-100, 100)) << "it is beside the tray";
  scene.looks[Scene::kCup].p_WB_m.x() = 0.32;
  EXPECT_TRUE(is(0.0134, 0.0135)) << "a part of it is above";
  cup.solid = Solid({{Ball{0.03}}});
  EXPECT_TRUE(is(0.0399, 0.0401)) << "a ball has no corners";
  // A shelf has two boards; the cup is between them.
  tray.solid = Solid({{Box{{0.3, 0.2, 0.01}}}, {Box{{0.3, 0.2, 0.01}}, {0, 0, -0.3}}});
  EXPECT_TRUE(is(0.0399, 0.0401));
}

TEST(Signals, InsideAsksTheCentreOfTheBox) {
  const auto program =
      testing::CompileText("grammar t\nevent e(cup: Cup, tray: Movable) while inside(cup, tray)");
  Scene scene;
  EntityInfo& room = scene.entity_table.entities[Scene::kTray];
  room.half_size_m = {0.5, 0.5, 0.1};
  room.p_BC_m = {0, 0, 0.1};
  scene.entity_table.entities[Scene::kCup].p_BC_m = {0, 0, 0.05};
  const auto holds = [&](const Eigen::Vector3d& p_W_m) {
    scene.looks[Scene::kCup].p_WB_m = p_W_m;
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(0), events);
    monitor.Finish(10, events);
    return !events.empty();
  };
  EXPECT_TRUE(holds({0.49, 0.49, 0.14}));
  EXPECT_FALSE(holds({0.49, 0.49, 0.16})) << "the centre is 5 cm above the origin";
  scene.looks[Scene::kTray].q_WB =
      Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(holds({0.49, 0.49, 0.05})) << "the tray has turned";
  EXPECT_TRUE(holds({0.69, 0, 0.05}));
  room.half_size_m.setConstant(0.5);
  room.round = true;
  EXPECT_FALSE(holds({0.3, 0.3, 0.4})) << "a ball has no corners";
  EXPECT_TRUE(holds({0.3, 0.3, 0.1}));
}

TEST(Signals, OfTwoInEachOtherTheWiderOneIsRoundTheOther) {
  const auto program =
      testing::CompileText("grammar t\nevent in(a: Movable, b: Movable) while inside(a, b)");
  Scene scene;
  const auto found = [&](const Eigen::Vector3d& half_m, double cup_z_m, double turn_rad = 0) {
    scene.entity_table.entities[Scene::kTray].half_size_m = {0.07, 0.07, 0.025};
    scene.entity_table.entities[Scene::kCup].half_size_m = half_m;
    scene.looks[Scene::kCup].p_WB_m = {0, 0, cup_z_m};
    scene.looks[Scene::kCup].q_WB = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitX());
    scene.looks[Scene::kTray].p_WB_m = {0, 0, 0.025};
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(0), events);
    monitor.Finish(10, events);
    std::string text;
    for (const Event& event : events)
      text += event.roles[0] == Scene::kCup ? "cup in tray " : "tray in cup ";
    return text;
  };
  for (const double turn_rad : {0.0, 0.2, 0.8, 1.5})
    EXPECT_EQ(found({0.037, 0.037, 0.037}, 0.041, turn_rad), "cup in tray ") << "a ball in a bowl";
  EXPECT_EQ(found({0.02, 0.02, 0.06}, 0.04), "cup in tray ") << "a bottle in a cup";
  EXPECT_EQ(found({0.07, 0.07, 0.025}, 0.03), "cup in tray ") << "nested";
  EXPECT_EQ(found({0.07, 0.07, 0.025}, 0.02), "tray in cup ");
  EXPECT_EQ(found({0.037, 0.037, 0.06}, 0.055), "tray in cup ") << "one centre alone";
}

// Where frames are lost, the window around the frame before an edge reaches far back. The cup falls
// from one frame to the next; 5 ms without a frame later the window no longer shows it.
TEST(Signals, WindowsReachBackOverLostFrames) {
  const auto program = testing::CompileText(
      "grammar t\nevent e(cup: Cup) while rate(height(cup), 4 ms) >= 0 m/s begins");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (const Tick tick : {10, 11, 12, 13, 14, 15, 16, 17, 22, 23, 28, 29, 30}) {
    scene.looks[Scene::kCup].p_WB_m.z() = tick < 16 ? 2 : 0;
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(31, events);
  ASSERT_EQ(events.size(), 2u) << "in the first frame, and when it no longer falls";
  EXPECT_EQ(events[1].interval, (Interval{22, 23}));
}

// Users look signals up in the reference; it lists each of them.
TEST(Signals, AreAllDocumented) {
  const std::string docs = testing::ReadFile(PREHEND_SOURCE_DIR "/docs/grammar-language.md");
  const auto is_documented = [&](std::string_view name) {
    return docs.find("| `" + std::string(name) + "(") != std::string::npos;
  };
  for (const Operator& row : Operators())
    EXPECT_TRUE(row.name.empty() || is_documented(row.name)) << row.name;
  for (const OverInterval& signal : SignalsOverIntervals())
    EXPECT_TRUE(is_documented(signal.name)) << signal.name;
}

}  // namespace
}  // namespace prehend::grammar
