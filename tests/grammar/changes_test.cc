// SPDX-License-Identifier: Apache-2.0
// Whoever rests misses nothing: whole frames, changes only, and frames that repeat what has not changed, which keeps
// lanes awake, give the same events at the same decision ticks. And what rests for long is freed.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "grammar/monitor.h"
#include "grammar/program.h"
#include "grammar/timeline.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/random_world.h"

namespace prehend::grammar {
namespace {

using testing::RandomWorld;

// Keeps the last frame and says what is new in the next one.
class Differ {
 public:
  explicit Differ(bool repeat) : repeat_(repeat) {}

  FrameChanges operator()(const Frame& frame) {
    moved_.clear();
    partings_.clear();
    touches_.clear();
    std::map<std::pair<int, int>, Touch> now;
    for (const Touch& touch : frame.touches) now[{touch.a, touch.b}] = touch;
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
      const EntityLook& look = frame.entities[i];
      const bool is_new = looks_.empty() || look.p_WB_m != looks_[i].p_WB_m || look.v_WB_m_per_s != looks_[i].v_WB_m_per_s;
      if (is_new || repeat_) moved_.push_back({static_cast<int>(i), look});
    }
    for (const auto& [pair, touch] : before_) {
      if (!now.contains(pair)) partings_.push_back({pair.second, pair.first});
    }
    for (const auto& [pair, touch] : now) {
      const auto old = before_.find(pair);
      const bool is_new = old == before_.end() || old->second.up_on_a != touch.up_on_a ||
                          old->second.normal_force_n != touch.normal_force_n || old->second.sensor_sets != touch.sensor_sets;
      if (is_new || repeat_) touches_.push_back(touch);
    }
    before_ = std::move(now);
    looks_.assign(frame.entities.begin(), frame.entities.end());
    return {frame.tick, moved_, frame.hands, touches_, partings_};
  }

 private:
  bool repeat_;
  std::vector<EntityLook> looks_;
  std::map<std::pair<int, int>, Touch> before_;
  std::vector<EntityChange> moved_;
  std::vector<Touch> touches_;
  std::vector<Parting> partings_;
};

std::vector<std::string> Lines(const std::vector<Event>& events, const Program& program) {
  std::vector<std::string> lines;
  for (const Event& e : events) {
    lines.push_back(program.events[e.rule].name + " " + std::to_string(e.roles[0]) + " " + std::to_string(e.roles[1]) +
                    " [" + std::to_string(e.interval.begin) + "," + std::to_string(e.interval.end) + ") at " +
                    std::to_string(e.decided) + (e.open_end ? " open" : "") + " style " + std::to_string(e.style));
  }
  return lines;
}

TEST(Changes, SayTheSameAsWholeFrames) {
  const CompileResult compiled =
      Compile({"both", std::string("grammar both\n") + testing::kRestlessRules}, testing::LibraryIncluder());
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  const auto program = compiled.program;
  std::size_t count = 0;
  for (int round = 0; round < 20; ++round) {
    RandomWorld world(900 + round);
    Monitor whole(program, world.cast), changes(program, world.cast), repeated(program, world.cast);
    Differ differ(false), repeater(true);
    std::vector<Event> a, b, c;
    for (int i = 0; i < 1500; ++i) {
      const Frame frame = world.Next();
      whole.Advance(frame, a);
      changes.AdvanceBy(differ(frame), b);
      repeated.AdvanceBy(repeater(frame), c);
    }
    for (auto [monitor, events] : {std::pair{&whole, &a}, {&changes, &b}, {&repeated, &c}}) {
      monitor->Finish(world.tick + 5, *events);
      EXPECT_EQ(monitor->error(), "");
    }
    ASSERT_EQ(Lines(a, *program), Lines(b, *program)) << "round " << round;
    ASSERT_EQ(Lines(a, *program), Lines(c, *program)) << "round " << round;
    count += a.size();
  }
  EXPECT_GT(count, 10000u);
}

// Without thresholds, opening moments and what is measured everything that changes wakes everybody who asks about it.
TEST(Changes, WhoeverIsNotWokenHasNothingToSay) {
  const CompileResult compiled =
      Compile({"both", std::string("grammar both\n") + testing::kRestlessRules}, testing::LibraryIncluder());
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  const auto plain = std::make_shared<Program>(*compiled.program);
  int opened = 0, guarded = 0, compared = 0, measured = 0;
  for (Rule& rule : plain->events) {
    opened += rule.opened_by != kNone ? 1 : 0;
    rule.opened_by = kNone;
    guarded += rule.guarded_begin ? 1 : 0;
    rule.guarded_begin = false;
    measured += rule.measured.is_empty() ? 0 : 1;
    rule.measured = {};
    rule.watches_press = rule.watches_grips = ~ThresholdSet{0};
  }
  for (Node& node : plain->nodes) {
    compared += node.by_threshold.value != kNone ? 1 : 0;
    node.by_threshold = {};
  }
  plain->asks_touches = true;
  EXPECT_GE(opened, 5);
  EXPECT_GE(guarded, 3);
  EXPECT_GE(compared, 5);
  EXPECT_GE(measured, 5);
  std::size_t count = 0, object_frames = 0;
  for (int round = 0; round < 100; ++round) {
    RandomWorld world(7000 + round);
    Monitor quick(compiled.program, world.cast), thorough(plain, world.cast);
    std::vector<Event> a, b;
    for (int i = 0; i < 1200; ++i, object_frames += world.looks.size()) {
      const Frame frame = world.Next();
      quick.Advance(frame, a);
      thorough.Advance(frame, b);
    }
    quick.Finish(world.tick + 5, a);
    thorough.Finish(world.tick + 5, b);
    ASSERT_EQ(Lines(a, *plain), Lines(b, *plain)) << "round " << round;
    count += a.size();
  }
  EXPECT_GT(count, 50000u);
  EXPECT_GT(object_frames, 1000000u);
}

// A hand feels its way along many things; what it has left behind is forgotten, and found again.
TEST(Changes, WhatRestsForLongIsFreed) {
  constexpr int kThings = 500;
  const auto program = testing::CompileLibrary("pick_and_place", {{"reach_back", "1 s"}, {"put_back", "1 s"}});
  Cast cast{.ticks_per_second = 1000, .entities = {{.name = "hand", .classes = {"Hand", "Entity"}}}};
  for (int i = 0; i < kThings; ++i) {
    cast.entities.push_back({.name = "thing" + std::to_string(i), .classes = {"Movable", "Thing", "Entity"}});
  }
  Monitor monitor(program, cast);
  std::vector<Event> events;
  const HandLook hand{.entity = 0, .trigger = 1};
  monitor.AdvanceBy({.tick = 0, .hands = {&hand, 1}}, events);
  int most = 0;
  Tick tick = 0;
  for (int round = 0; round < 3; ++round) {
    for (int thing = 1; thing <= kThings; ++thing) {
      const Touch touch{.a = 0, .b = thing, .sensor_sets = 3};
      const Parting parting{0, thing};
      monitor.AdvanceBy({.tick = tick += 10, .touches = {&touch, 1}}, events);
      monitor.AdvanceBy({.tick = tick += 300, .partings = {&parting, 1}}, events);
      most = std::max(most, monitor.lanes_in_use());
    }
  }
  EXPECT_LT(most, 160) << "of " << kThings << " things, a few seconds at a time";
  for (int i = 0; i < 500; ++i) monitor.AdvanceBy({.tick = tick += 10}, events);
  EXPECT_LT(monitor.lanes_in_use(), 20) << "only what no touch guards is left";
  const auto count = [&](std::string_view name) {
    return std::count_if(events.begin(), events.end(), [&](const Event& e) { return program->events[e.rule].name == name; });
  };
  EXPECT_EQ(count("contact"), 3 * kThings);
  EXPECT_EQ(count("grasping"), 3 * kThings);
}

}  // namespace
}  // namespace prehend::grammar
