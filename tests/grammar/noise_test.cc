// SPDX-License-Identifier: Apache-2.0
// Sensors err and hands tremble: what the library recognises through that.
#include <random>

#include "grammar/name_events.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::Scene;

constexpr Tick kFrame = 4;  // ms: 250 frames per second

/// An error of a place, of this standard deviation along each axis.
class Errors {
 public:
  Errors(unsigned seed, double deviation_m) : random_(seed), error_m_(0, deviation_m) {}
  Eigen::Vector3d Next() { return {error_m_(random_), error_m_(random_), error_m_(random_)}; }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> error_m_;
};

/// From 0 to 1 between two times.
double Ramp(Tick t, Tick from, Tick to) {
  return std::clamp(static_cast<double>(t - from) / static_cast<double>(to - from), 0.0, 1.0);
}

/// Plays three seconds; `show` sets the scene at a time.
template <typename Show>
std::vector<Interval> Recognised(const std::string& event, Show&& show) {
  const auto program = testing::CompileLibrary("pick_and_place");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick t = 0; t < 3000; t += kFrame) {
    show(t, scene);
    monitor.Advance(scene.At(t), events);
  }
  monitor.Finish(3000, events);
  EXPECT_EQ(monitor.error(), "");
  std::vector<Interval> found;
  for (const Event& one : events)
    if (program->rules[one.rule].name == event) found.push_back(one.interval);
  return found;
}

Touch Held() {
  return {.a = Scene::kHand, .b = Scene::kCup, .normal_force_n = 5, .sensor_sets = 0b11};
}

Touch Standing() {
  return {.a = Scene::kCup, .b = Scene::kTray, .up_on_a = 1, .up_on_b = -1, .normal_force_n = 2};
}

// Lifted by 6 cm, held there for 0.6 s, put back; the sensor errs by 3 mm.
TEST(Noise, APutDownBeginsAfterThePauseThroughASensorThatErrsByThreeMillimetres) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Errors errors(seed, 0.003);
    const std::vector<Interval> put_downs = Recognised("putting_down", [&](Tick t, Scene& scene) {
      const double z = 0.06 * (Ramp(t, 500, 900) - Ramp(t, 1500, 1900));
      scene.hand.trigger = 1;
      scene.looks[Scene::kCup].p_WB_m = Eigen::Vector3d(0, 0, z) + errors.Next();
      scene.touches = {Held()};
      if (t < 500 || t >= 1900) scene.touches.push_back(Standing());
    });
    ASSERT_EQ(put_downs.size(), 1u) << seed;
    EXPECT_NEAR(static_cast<double>(put_downs[0].begin), 1500, 60) << seed;
    EXPECT_EQ(put_downs[0].end, 1900) << seed;
  }
}

// It comes within 20 cm, rests there while it trembles by 0.3 mm, and goes on after 1.5 s.
TEST(Noise, AHandThatTremblesAtRestIdlesUntilItLeavesItsPlace) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Errors errors(seed, 0.0003);
    const std::vector<Interval> reaches = Recognised("reaching", [&](Tick t, Scene& scene) {
      const double x = 0.1 * Ramp(t, 0, 500) + 0.2 * Ramp(t, 2000, 2500);
      scene.looks[Scene::kCup].p_WB_m = {0.3, 0, 0};
      scene.looks[Scene::kHand].p_WB_m = Eigen::Vector3d(x, 0, 0) + errors.Next();
      scene.collision_sphere.p_W_m = scene.looks[Scene::kHand].p_WB_m;
      scene.hand.trigger = 1;
      scene.touches = {Standing()};
      if (t >= 2500) scene.touches.insert(scene.touches.begin(), Held());
    });
    ASSERT_EQ(reaches.size(), 1u) << seed;
    EXPECT_NEAR(static_cast<double>(reaches[0].begin), 2000, 20) << seed;
    EXPECT_EQ(reaches[0].end, 2500) << seed;
  }
}

}  // namespace
}  // namespace prehend::grammar
