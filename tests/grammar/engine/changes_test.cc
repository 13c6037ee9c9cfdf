// SPDX-License-Identifier: Apache-2.0
// Whoever rests misses nothing: whole frames, changes only, and frames that repeat what has not
// changed, which keeps instances awake, give the same events at the same decision ticks. And what
// rests for long is freed.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "grammar/program/program.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/random_world.h"
#include "tests/grammar/thorough.h"

namespace prehend::grammar {
namespace {

using testing::Lines;
using testing::RandomWorld;

// Keeps the last frame and says what is new in the next one.
class Differ {
 public:
  explicit Differ(bool repeat) : repeat_(repeat) {}

  FrameChanges operator()(const Frame& frame) {
    moved_.clear();
    contact_ends_.clear();
    touches_.clear();
    std::map<std::pair<int, int>, Touch> now;
    for (const Touch& touch : frame.touches) now[{touch.a, touch.b}] = touch;
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
      const EntitySample& look = frame.entities[i];
      const bool is_new = looks_.empty() || look.p_WB_m != looks_[i].p_WB_m ||
                          look.v_WB_m_per_s != looks_[i].v_WB_m_per_s;
      if (is_new || repeat_) moved_.push_back({static_cast<int>(i), look});
    }
    for (const auto& [pair, touch] : before_) {
      if (!now.contains(pair)) contact_ends_.push_back({pair.second, pair.first});
    }
    for (const auto& [pair, touch] : now) {
      const auto old = before_.find(pair);
      const bool is_new = old == before_.end() || old->second.up_on_a != touch.up_on_a ||
                          old->second.normal_force_n != touch.normal_force_n ||
                          old->second.vertical_speed_m_per_s != touch.vertical_speed_m_per_s ||
                          old->second.p_W_m != touch.p_W_m ||
                          old->second.nhat_BA_W != touch.nhat_BA_W ||
                          old->second.sensor_sets != touch.sensor_sets;
      if (is_new || repeat_) touches_.push_back(touch);
    }
    before_ = std::move(now);
    looks_.assign(frame.entities.begin(), frame.entities.end());
    return {frame.tick, moved_, frame.hands, touches_, contact_ends_};
  }

 private:
  bool repeat_;
  std::vector<EntitySample> looks_;
  std::map<std::pair<int, int>, Touch> before_;
  std::vector<EntityChange> moved_;
  std::vector<Touch> touches_;
  std::vector<ContactEnd> contact_ends_;
};

TEST(Changes, SayTheSameAsWholeFrames) {
  const CompileResult compiled =
      Compile({"both", std::string("grammar both\n") + testing::kTimeDependentRules},
              testing::LibraryIncluder());
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  const auto program = compiled.program;
  std::size_t count = 0;
  for (int round = 0; round < 20; ++round) {
    RandomWorld world(900 + round);
    Monitor whole(program, world.entity_table), changes(program, world.entity_table),
        repeated(program, world.entity_table);
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

struct Compared {
  std::size_t events = 0;
  std::size_t object_frames = 0;
};

// Worlds in which anything may happen, watched by both.
Compared CompareWithThorough(const std::shared_ptr<const Program>& program, int rounds) {
  const auto thorough = testing::Thorough(*program);
  Compared compared;
  for (int round = 0; round < rounds; ++round) {
    RandomWorld world(7000 + round);
    Monitor quick(program, world.entity_table), slow(thorough, world.entity_table);
    std::vector<Event> a, b;
    for (int i = 0; i < 1200; ++i, compared.object_frames += world.looks.size()) {
      const Frame frame = world.Next();
      quick.Advance(frame, a);
      slow.Advance(frame, b);
    }
    quick.Finish(world.tick + 5, a);
    slow.Finish(world.tick + 5, b);
    EXPECT_EQ(Lines(a, *program), Lines(b, *program)) << "round " << round;
    if (::testing::Test::HasFailure()) break;
    compared.events += a.size();
  }
  return compared;
}

TEST(Changes, WhoeverIsNotWokenHasNothingToSay) {
  const CompileResult compiled =
      Compile({"both", std::string("grammar both\n") + testing::kTimeDependentRules},
              testing::LibraryIncluder());
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  const auto rules = [&](auto which) {
    return std::ranges::count_if(compiled.program->rules, which);
  };
  EXPECT_GE(rules([](const Rule& rule) { return rule.opened_by != kNone; }), 5);
  EXPECT_GE(rules([](const Rule& rule) { return rule.guarded_begin; }), 3);
  EXPECT_GE(rules([](const Rule& rule) { return !rule.measured.is_empty(); }), 5);
  EXPECT_GE(
      std::ranges::count_if(compiled.program->nodes,
                            [](const Node& node) { return node.by_threshold.value != kNone; }),
      5);
  const Compared compared = CompareWithThorough(compiled.program, 100);
  EXPECT_GT(compared.events, 50000u);
  EXPECT_GT(compared.object_frames, 1000000u);
}

// Rules that are decided where a touch is seen, and those that are made of them.
constexpr const char* kInstantRules = R"(
grammar instant
event gripped(hand: Hand, object: Movable) while trigger(hand) >= 0.3 and sensor_sets(hand, object) >= 2
event loose(hand: Hand, object: Movable) while sensor_sets(hand, object) < 2 and trigger(hand) < 0.3
event pressed(object: Movable, other: Thing) while touching(object, other) and force(object, other) > 1.5 N
event on(object: Movable, support: Thing) while touching(object, support) and up(object, support) >= 0.5
event under(object: Movable, load: Thing) while up(load, object) > 0.4 lasting 30 ms
event stands(object: Movable, support: Thing) while on(object, support) lasting 30 ms
event open_hand(hand: Hand) while trigger(hand) < 0.3
event lifted(hand: Hand, object: Movable)
  from on(object, any) ends to gripped(hand, object) ends during gripped(hand, object)
event felt(hand: Hand, object: Movable)
  from touching(hand, object) begins to gripped(hand, object) begins during touching(hand, object) lasting 20 ms
event left(hand: Hand, object: Movable)
  from gripped(hand, object) ends without gripped(hand, object) begins within 200 ms
event taken(hand: Hand, object: Movable)
  compose grip: gripped(hand, object), lift: lifted(hand, object) where grip contains|finished_by|overlaps lift
event plain(hand: Hand, object: Movable) rest of gripped(hand, object) outside pressed(object, any), stands(object, any)
)";

TEST(Changes, WhatIsDecidedAtOnceNeedsNoPast) {
  const CompileResult compiled = Compile({"instant", kInstantRules}, nullptr);
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  EXPECT_GE(std::ranges::count_if(compiled.program->rules,
                                  [](const Rule& rule) { return rule.measured.instant; }),
            5);
  EXPECT_FALSE(compiled.program->recalls_touches);
  EXPECT_GT(CompareWithThorough(compiled.program, 20).events, 10000u);
}

bool BringsNothing(const FrameChanges& frame) {
  return frame.entities.empty() && frame.hands.empty() && frame.touches.empty() &&
         frame.contact_ends.empty();
}

// What the rules do not ask for is not shown, so most frames bring nothing.
TEST(Changes, FramesThatBringNothingMayBeLeftOut) {
  const CompileResult compiled = Compile({"instant", kInstantRules}, nullptr);
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  const auto program = compiled.program;
  std::size_t count = 0, left_out = 0, later = 0;
  for (int round = 0; round < 20; ++round) {
    RandomWorld world(4000 + round);
    Monitor all(program, world.entity_table), some(program, world.entity_table);
    Differ differ(false);
    std::map<int, double> grips;
    std::vector<Event> a, b;
    for (int i = 0; i < 1500; ++i) {
      const Frame frame = world.Next();
      FrameChanges changes = differ(frame);
      changes.entities = {};
      std::vector<HandSample> hands;
      for (const HandSample& hand : frame.hands) {
        const auto [before, is_new] = grips.try_emplace(hand.entity, hand.trigger);
        if (is_new || before->second != hand.trigger) hands.push_back(hand);
        before->second = hand.trigger;
      }
      changes.hands = hands;
      all.AdvanceBy(changes, a);
      if (BringsNothing(changes)) {
        ++left_out;
      } else {
        some.AdvanceBy(changes, b);
      }
    }
    all.Finish(world.tick + 5, a);
    some.Finish(world.tick + 5, b);
    const auto by_interval = [](const Event& x, const Event& y) {
      return std::tie(x.rule, x.roles, x.interval.begin) <
             std::tie(y.rule, y.roles, y.interval.begin);
    };
    std::ranges::sort(a, by_interval);
    std::ranges::sort(b, by_interval);
    ASSERT_EQ(a.size(), b.size()) << "round " << round;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].rule, b[i].rule);
      EXPECT_EQ(a[i].roles, b[i].roles);
      EXPECT_EQ(a[i].interval, b[i].interval);
      EXPECT_LE(a[i].decided, b[i].decided);
      if (a[i].decided < b[i].decided) ++later;
    }
    count += a.size();
  }
  EXPECT_GT(count, 5000u);
  EXPECT_GT(left_out, 1000u);
  EXPECT_GT(later, 0u) << "a deadline is told when a frame comes";
}

// A hand feels its way along many things; what it has left behind is forgotten, and found again.
TEST(Changes, WhatRestsForLongIsFreed) {
  constexpr int kThings = 500;
  const auto program = testing::CompileLibrary("pick_and_place", {{"reach_back", "1 s"},
                                                                  {"reach_window", "2 ms"},
                                                                  {"put_back", "1 s"},
                                                                  {"put_window", "2 ms"}});
  EntityTable entity_table{.ticks_per_second = 1000,
                           .entities = {{.name = "hand", .classes = {"Hand", "Entity"}}}};
  for (int i = 0; i < kThings; ++i) {
    entity_table.entities.push_back(
        {.name = "thing" + std::to_string(i), .classes = {"Movable", "Thing", "Entity"}});
  }
  Monitor monitor(program, entity_table);
  std::vector<Event> events;
  const HandSample hand{.entity = 0, .trigger = 1};
  monitor.AdvanceBy({.tick = 0, .hands = {&hand, 1}}, events);
  int most = 0;
  Tick tick = 0;
  for (int round = 0; round < 3; ++round) {
    for (int thing = 1; thing <= kThings; ++thing) {
      const Touch touch{.a = 0, .b = thing, .sensor_sets = 3};
      const ContactEnd contact_end{0, thing};
      monitor.AdvanceBy({.tick = tick += 10, .touches = {&touch, 1}}, events);
      monitor.AdvanceBy({.tick = tick += 300, .contact_ends = {&contact_end, 1}}, events);
      most = std::max(most, monitor.instances_in_use());
    }
  }
  EXPECT_LT(most, 220) << "of " << kThings << " things, a few seconds at a time";
  for (int i = 0; i < 500; ++i) monitor.AdvanceBy({.tick = tick += 10}, events);
  EXPECT_LT(monitor.instances_in_use(), 20) << "only what no touch guards is left";
  const auto count = [&](std::string_view name) {
    return std::count_if(events.begin(), events.end(),
                         [&](const Event& e) { return program->rules[e.rule].name == name; });
  };
  EXPECT_EQ(count("contact"), 3 * kThings);
  EXPECT_EQ(count("grasping"), 3 * kThings);
}

}  // namespace
}  // namespace prehend::grammar
