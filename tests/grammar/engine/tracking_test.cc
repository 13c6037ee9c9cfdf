// SPDX-License-Identifier: Apache-2.0
// Of what is not tracked, no condition holds, and neither does its opposite; what held ends there.
#include "grammar/base/tracking.h"

#include "grammar/base/solid.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::CompileText;
using testing::Scene;

/// Intervals of the only event, "begin..end; ": 100 frames of 10 ms, in which these are not tracked
/// from 300 to 500 ms.
std::string Held(const std::string& grammar, const std::vector<int>& lost) {
  const auto program = CompileText(grammar);
  if (!program) return "";
  Scene scene;
  scene.entity_table.entities[Scene::kCup].half_size_m = {0.05, 0.05, 0.05};
  scene.entity_table.entities[Scene::kCup].solid = Solid({{.shape = Box{{0.05, 0.05, 0.05}}}});
  scene.entity_table.entities[Scene::kTray].half_size_m = {0.5, 0.5, 0.5};
  const std::vector<EntitySample> all = scene.looks;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 1000; tick += 10) {
    scene.looks = all;
    if (tick >= 300 && tick < 500) {
      for (const int entity : lost) scene.looks[static_cast<std::size_t>(entity)] = NotTracked();
    }
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(1000, events);
  EXPECT_EQ(monitor.error(), "");
  std::string text;
  for (const Event& event : events)
    text += std::to_string(event.interval.begin) + ".." + std::to_string(event.interval.end) + "; ";
  return text;
}

std::string While(const std::string& condition) {
  return "grammar t\nevent e(hand: Hand, cup: Cup, tray: Movable) while part_of(cup, tray) and "
         "height(hand) < 100 m and (" +
         condition + ")\n";
}

TEST(NotTracked, NeitherAConditionNorItsOppositeHolds) {
  // All of it is about the cup, which is where hand and tray are, at rest.
  const char* conditions[] = {"distance(hand, cup) < 1 m",
                              "height(cup) < 1 m",
                              "speed(cup) < 1 m/s",
                              "vertical_speed(cup) < 1 m/s",
                              "relative_speed(cup, hand) < 1 m/s",
                              "tilt(cup) < 1 rad",
                              "gap(hand, cup) < 1 m",
                              "clearance(cup, tray) < 5 m",
                              "joint_fraction(cup) < 0.5",
                              "distance(hand, cup) + 1 m < 3 m",
                              "1 m - abs(height(cup)) > 0 m",
                              "in_sphere(cup, position(hand), 1 m)",
                              "in_sphere(position(hand), position(cup), 1 m)",
                              "inside(cup, tray)",
                              "height(cup) == 0 m"};
  for (const std::string condition : conditions) {
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..300; 500..1000; ") << condition;
    EXPECT_EQ(Held(While("not (not (" + condition + "))"), {Scene::kCup}), "0..300; 500..1000; ")
        << condition;
    EXPECT_EQ(Held(While("not (" + condition + ")"), {Scene::kCup}), "") << condition;
    EXPECT_EQ(Held(While(condition), {}), "0..1000; ") << condition;
  }
  for (const std::string condition :
       {"not (height(cup) > 1 m)", "not (tilt(cup) > 1 rad)", "height(cup) != 1 m"})
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..300; 500..1000; ") << condition;
}

TEST(NotTracked, WindowsThatReachIntoTheGapHaveNoValueEither) {
  for (const std::string signal : {"mean(height(cup), 100 ms)", "min(height(cup), 100 ms)",
                                   "max(height(cup), 100 ms)", "median(height(cup), 100 ms)"}) {
    EXPECT_EQ(Held(While(signal + " < 1 m"), {Scene::kCup}), "0..250; 550..1000; ") << signal;
    EXPECT_EQ(Held(While("not (" + signal + " > 1 m)"), {Scene::kCup}), "0..250; 550..1000; ");
  }
  // These look at both ends of their window.
  for (const std::string condition :
       {"rate(height(cup), 100 ms) < 1 m/s", "speed(cup, 100 ms) < 1 m/s"})
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..250; 550..1000; ") << condition;
}

TEST(NotTracked, EitherOneOfTwoIsEnough) {
  for (const int lost : {Scene::kHand, Scene::kCup})
    EXPECT_EQ(Held(While("gap(hand, cup) < 1 m and distance(cup, hand) < 1 m"), {lost}),
              "0..300; 500..1000; ");
  EXPECT_EQ(Held(While("not (in_sphere(cup, position(hand), 1 m))"), {Scene::kHand}), "");
  EXPECT_EQ(Held(While("distance(hand, cup) < 1 m or height(tray) < 1 m"), {Scene::kCup}),
            "0..1000; ");
  EXPECT_EQ(Held(While("not (distance(hand, cup) < 1 m and height(tray) < 1 m)"), {Scene::kCup}),
            "");
}

TEST(NotTracked, AShortGapMayBeBridgedByARuleAndItsBeginIsAnEnd) {
  EXPECT_EQ(
      Held("grammar t\nevent e(cup: Cup) while height(cup) < 1 m bridging 300 ms\n", {Scene::kCup}),
      "0..1000; ");
  EXPECT_EQ(Held("grammar t\nevent e(cup: Cup) from height(cup) < 1 m ends to height(cup) < 1 m "
                 "begins\n",
                 {Scene::kCup}),
            "300..500; ");
}

TEST(NotTracked, OnlyWhatIsTrackedIsNearest) {
  const std::string nearest =
      "grammar t\nevent e(thing: Thing, hand: Hand) while nearest(thing, hand)\n";
  // Cup and tray are both there; of two that are equally near, the first one is.
  EXPECT_EQ(Held(nearest, {Scene::kCup}), "0..300; 300..500; 500..1000; ");
  EXPECT_EQ(Held(nearest, {Scene::kHand}), "0..300; 500..1000; ");
}

}  // namespace
}  // namespace prehend::grammar
