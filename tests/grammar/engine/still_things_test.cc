// SPDX-License-Identifier: Apache-2.0
// Facts from motion over hands that carry things about while most things tremble where they are.
// Rules rest, follow others and look only at what is new in a window; the replay's monitor does not
// rest because things are far apart, and in the thorough program nobody follows. All must give the
// same events; and the replay decides each when the monitor does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "grammar/replay_monitor.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/scene.h"
#include "tests/grammar/thorough.h"

namespace prehend::grammar {
namespace {

using Eigen::Vector3d;

constexpr int kThings = 4, kHands = 2, kFirstHand = 1 + kThings;

EntityTable Kitchen() {
  EntityTable table{.ticks_per_second = 1000};
  table.entities.push_back({.name = "table", .classes = {"Table", "Fixed", "Thing", "Entity"}});
  table.entities.back().half_size_m = {1, 1, 0.02};
  for (int i = 0; i < kThings; ++i) {
    table.entities.push_back(
        {.name = "thing_" + std::to_string(i), .classes = {"Cup", "Movable", "Thing", "Entity"}});
    table.entities.back().half_size_m = {0.04, 0.04, 0.06};
  }
  for (int i = 0; i < kHands; ++i) {
    table.entities.push_back({.name = "hand_" + std::to_string(i), .classes = {"Hand", "Entity"}});
    table.entities.back().half_size_m = {0.05, 0.04, 0.015};
  }
  return table;
}

// Hands go to places and things, wait, take things along and leave them; sight is lost at times.
class Story {
 public:
  explicit Story(unsigned seed) : random_(seed), looks_(1 + kThings + kHands) {
    looks_[0].p_WB_m.z() = -0.02;
    noise_m_ = std::array{0.0, 0.0003, 0.0005, 0.003}[random_() % 4];
    step_ = std::array{8, 10, 20, 33}[random_() % 4];
    for (int i = 0; i < kThings; ++i) places_[1 + i] = {0.25 * i - 0.4, Uniform(0.2), 0.06};
    for (int i = 0; i < kHands; ++i) places_[kFirstHand + i] = goals_[i] = Somewhere();
  }
  Tick step() const { return step_; }

  const std::vector<EntitySample>& Next() {
    const double dt_s = 0.001 * static_cast<double>(step_);
    for (int i = 0; i < kHands; ++i) {
      Vector3d& hand = places_[kFirstHand + i];
      const Vector3d way = goals_[i] - hand;
      const Vector3d step = way * std::min(1.0, speeds_[i] * dt_s / (way.norm() + 1e-9));
      if (waits_s_[i] > 0) {
        waits_s_[i] -= dt_s;
      } else if (hand += step; held_[i] > 0) {
        places_[held_[i]] += step;
      }
      if (way.norm() < 0.01 && waits_s_[i] <= 0) Choose(i);
    }
    for (std::size_t i = 1; i < looks_.size(); ++i) {
      lost_[i] = lost_[i] ? random_() % 10 != 0 : random_() % 1500 == 0;
      const Vector3d before = looks_[i].p_WB_m;
      looks_[i] = EntitySample{.p_WB_m = places_[i] + Noise()};
      looks_[i].v_WB_m_per_s = (looks_[i].p_WB_m - before) / dt_s;
      if (lost_[i]) looks_[i] = NotTracked();
    }
    return looks_;
  }

 private:
  double Uniform(double most) {
    return std::uniform_real_distribution<double>(-most, most)(random_);
  }
  Vector3d Noise() { return {Uniform(noise_m_), Uniform(noise_m_), Uniform(noise_m_)}; }
  Vector3d Somewhere() { return {Uniform(0.6), Uniform(0.5), 0.25 + Uniform(0.15)}; }

  void Choose(int i) {
    constexpr double kSpeeds[] = {0.03, 0.15, 0.4, 1.0};
    speeds_[i] = kSpeeds[random_() % std::size(kSpeeds)];
    waits_s_[i] = random_() % 3 == 0 ? 0.4 + Uniform(0.35) : 0;
    const Vector3d grip(0, 0, 0.08);
    if (held_[i] > 0 && random_() % 4 == 0) {
      goals_[i] = places_[kFirstHand + i];  // lets go, here
      if (random_() % 2 == 0) places_[held_[i]].z() = 0.06;
      held_[i] = 0;
    } else if (held_[i] > 0) {
      goals_[i] = random_() % 2 == 0 ? Somewhere() : Vector3d(Uniform(0.6), Uniform(0.5), 0.14);
    } else if (random_() % 2 == 0) {
      const int thing = 1 + static_cast<int>(random_() % kThings);
      goals_[i] = places_[thing] + grip;
      if ((goals_[i] - places_[kFirstHand + i]).norm() < 0.01) held_[i] = thing;
    } else {
      goals_[i] = Somewhere();
    }
  }

  std::mt19937 random_;
  std::vector<EntitySample> looks_;
  double noise_m_ = 0;
  Tick step_ = 10;
  Vector3d places_[1 + kThings + kHands], goals_[kHands];
  double speeds_[kHands] = {0.4, 0.4}, waits_s_[kHands] = {};
  int held_[kHands] = {};
  bool lost_[1 + kThings + kHands] = {};
};

using Found = std::tuple<Tick, Tick, int, Binding, bool, Tick>;
std::vector<Found> Sorted(const std::vector<Event>& events, bool decided) {
  std::vector<Found> all;
  for (const Event& event : events)
    all.emplace_back(event.interval.begin, event.interval.end, event.rule.number(), event.roles,
                     event.open_end, decided ? event.decided : 0);
  std::ranges::sort(all);
  return all;
}

// So many more stories: STORIES=1000.
int Stories(int usual) {
  const char* const more = std::getenv("STORIES");
  return more == nullptr ? usual : std::atoi(more);
}

// The cup goes 1 m/s from 1 s to 1.5 s. At 1.5 s it has gone 5 cm in the window of 100 ms, at 1.51
// s 4 cm, which is known when that window is over. Nobody who asks for it in turn knows it later.
TEST(StillThings, WhatWindowsSayIsToldInTime) {
  const auto program = testing::CompileText(R"(grammar t
condition fast(a: Thing) while speed(a, 100 ms) > 45 cm/s
condition high(a: Thing) while height(a) > 1 m
condition moves(a: Thing) while fast(a) or high(a)
event trip(a: Thing) while moves(a) and not high(a)
event stop(a: Thing) from moves(a) begins to moves(a) ends
event soon(a: Thing) from trip(a) begins to trip(a) ends within 2 s
event late(a: Thing) from trip(a) begins to trip(a) ends within 0.2 s
event gone(a: Thing) until moves(a) ends since fast(a) or distance(position(a), position(a)@end) < 1 cm at most 1 s back
)");
  ASSERT_TRUE(program);
  testing::Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> out;
  for (Tick tick = 0; tick < 3000; tick += 10) {
    scene.looks[1].p_WB_m.x() = 0.001 * static_cast<double>(std::clamp<Tick>(tick - 1000, 0, 500));
    scene.looks[2].p_WB_m.y() = tick % 20 == 0 ? 0.0004 : 0;  // the tray trembles
    monitor.Advance(scene.At(tick), out);
  }
  monitor.Finish(3000, out);
  std::vector<std::string> found;
  for (const Event& event : out) {
    found.push_back(program->rules[event.rule].name + " of " + std::to_string(event.roles[0]) +
                    " [" + std::to_string(event.interval.begin) + "," +
                    std::to_string(event.interval.end) + ") at " + std::to_string(event.decided));
  }
  EXPECT_EQ(found, (std::vector<std::string>{
                       "trip of 1 [1000,1510) at 1560", "stop of 1 [1000,1510) at 1560",
                       "soon of 1 [1000,1510) at 1560", "gone of 1 [1000,1510) at 1560"}));
}

TEST(StillThings, CostNoEvent) {
  for (const std::string grammar : {"pick_and_place_from_motion", "hand_actions_from_motion"}) {
    const auto program = testing::CompileLibrary(grammar);
    ASSERT_TRUE(program);
    std::size_t events = 0;
    for (int seed = 1; seed <= Stories(6); ++seed) {
      const EntityTable kitchen = Kitchen();
      Monitor monitor(program, kitchen), thorough(testing::Thorough(*program), kitchen);
      ReplayMonitor replay(program, kitchen);
      Story story(static_cast<unsigned>(seed));
      std::vector<Event> out, all;
      Tick tick = 0;
      for (int frame = 0; frame < 600; ++frame, tick += story.step()) {
        const Frame shown{.tick = tick, .entities = story.Next(), .hands = {}, .touches = {}};
        monitor.Advance(shown, out);
        thorough.Advance(shown, all);
        replay.Advance(shown);
      }
      monitor.Finish(tick, out);
      thorough.Finish(tick, all);
      replay.Finish(tick);
      ASSERT_EQ(monitor.error(), "");
      EXPECT_EQ(Sorted(out, false), Sorted(all, false)) << grammar << ", story " << seed;
      EXPECT_EQ(Sorted(out, true), Sorted(replay.events(), true)) << grammar << ", story " << seed;
      events += out.size();
    }
    EXPECT_GT(events, 50u) << grammar;
  }
}

}  // namespace
}  // namespace prehend::grammar
