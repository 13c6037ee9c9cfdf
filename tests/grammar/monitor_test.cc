// SPDX-License-Identifier: Apache-2.0
// The monitor as its users meet it: order of events, decision ticks, wrong frames, and no
// allocation once it is warm.
#include "grammar/monitor.h"

#include <cstdlib>
#include <functional>
#include <limits>
#include <new>

#include "grammar/name_events.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/scene.h"

namespace {
std::size_t allocations = 0;  // by this test binary, from its start
}

// Sanitizers bring an allocator of their own, so there nothing is counted.
// Inlined, these make the compiler warn of memory from `new` that is given to free().
#if !defined(__SANITIZE_ADDRESS__)
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
#endif

namespace prehend::grammar {
namespace {

using testing::Scene;

// One round of two seconds at 100 Hz: touch, grasp, lift, carry, put down, release.
void PlayRound(Scene& scene, Monitor& monitor, Tick start, std::vector<Event>& events) {
  for (Tick t = 0; t < 2000; t += 10) {
    const double lift = t < 600    ? 0
                        : t < 1000 ? (t - 600) * 0.0004
                        : t < 1400 ? 0.16
                        : t < 1800 ? (1800 - t) * 0.0004
                                   : 0;
    const double speed = t >= 600 && t < 1000 ? 0.4 : t >= 1400 && t < 1800 ? -0.4 : 0;
    scene.looks[Scene::kCup].p_WB_m.z() = lift;
    scene.looks[Scene::kCup].v_WB_m_per_s.z() = speed;
    scene.looks[Scene::kHand].p_WB_m = {t < 300 ? 0.3 - static_cast<double>(t) * 0.001 : 0, 0,
                                        lift};
    scene.collision_sphere.p_W_m = scene.looks[Scene::kHand].p_WB_m;
    scene.hand.ahead_W = {-1, 0, 0};
    scene.hand.trigger = t >= 300 && t < 1900 ? 1 : 0;
    scene.touches.clear();
    if (t >= 300 && t < 1900)
      scene.touches.push_back({.a = 0, .b = 1, .up_on_a = 0, .up_on_b = 0, .sensor_sets = 3});
    if (lift == 0) scene.touches.push_back({.a = 1, .b = 2, .up_on_a = 1, .up_on_b = -1});
    monitor.Advance(scene.At(start + t), events);
  }
}

TEST(Monitor, AllocatesNothingOnceItIsWarm) {
  Scene scene;
  Monitor monitor(testing::CompileLibrary("pick_and_place"), scene.entity_table);
  std::vector<Event> events;
  events.reserve(10000);
  scene.touches.reserve(8);
  Tick start = 0;
  for (; start < 40'000; start += 2000) PlayRound(scene, monitor, start, events);
  const std::size_t warm = allocations;
  const std::size_t seen = events.size();
  for (; start < 80'000; start += 2000) PlayRound(scene, monitor, start, events);
  EXPECT_EQ(allocations, warm);
  EXPECT_GE(events.size(), seen + 20 * 6);
  EXPECT_EQ(monitor.error(), "");
}

TEST(Monitor, GivesEventsInOrderAndNeverBeforeTheyAreCertain) {
  Scene scene;
  Monitor monitor(testing::CompileLibrary("pick_and_place"), scene.entity_table);
  std::vector<Event> events;
  PlayRound(scene, monitor, 0, events);
  for (std::size_t i = 1; i < events.size(); ++i)
    EXPECT_LE(events[i - 1].decided, events[i].decided);
  for (const Event& event : events) {
    EXPECT_LT(event.interval.begin, event.interval.end);
    EXPECT_LE(event.interval.end, event.decided);
    EXPECT_FALSE(event.open_end);
  }
  const std::size_t before = events.size();
  monitor.Finish(2000, events);
  ASSERT_GT(events.size(), before);
  for (std::size_t i = before; i < events.size(); ++i) EXPECT_EQ(events[i].decided, 2000);
  EXPECT_TRUE(std::any_of(events.begin() + static_cast<std::ptrdiff_t>(before), events.end(),
                          [](const Event& e) { return e.open_end && e.interval.end == 2000; }));
}

// When the only event of the story is decided, in ticks: a hand touches the cup up to `apart`.
Tick DecidedAt(const std::string& rules, Tick apart) {
  const auto program = testing::CompileText("grammar soon\n" + rules);
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick t = 0; t < 500; t += 10) {
    scene.touches.clear();
    if (t >= 10 && t < apart) scene.touches.push_back({.a = 0, .b = 1});
    monitor.Advance(scene.At(t), events);
  }
  monitor.Finish(500, events);
  EXPECT_EQ(events.size(), 1u);
  return events.empty() ? -1 : events[0].decided;
}

// The hand never closes, so it does not matter whether the touch, short as it is, is an end of
// `came`.
TEST(Monitor, AnEndThatNothingLeadsToDelaysNothing) {
  EXPECT_EQ(DecidedAt(R"(
condition long_touch(hand: Hand, object: Movable) while touching(hand, object) bridging 100 ms lasting 200 ms
condition came(hand: Hand, object: Movable)
  until long_touch(hand, object) begins since trigger(hand) > 0.5 at most 100 ms back
event plain(hand: Hand, object: Movable) while touching(hand, object) and not came(hand, object)
)",
                      50),
            50);
}

// The hand never closes, so it does not matter how fast the object rises where the touch begins,
// which is known only when the window is over. Nor does it where the end comes at once.
TEST(Monitor, AValueAtABeginThatIsNoneDelaysNothing) {
  const std::string end = R"(
event plain(hand: Hand, object: Movable) while touching(hand, object) and not rising(hand, object)
)";
  EXPECT_EQ(DecidedAt(R"(
condition rising(hand: Hand, object: Movable)
  from touching(hand, object) begins to rate(height(object), 200 ms) >= rate(height(object), 200 ms)@begin + 1 m/s begins
  during trigger(hand) > 0.5
)" + end,
                      50),
            50);
  EXPECT_EQ(DecidedAt(R"(
condition rising(hand: Hand, object: Movable)
  from (touching(hand, object) begins or trigger(hand) > 0.5 begins) to touching(hand, object) begins
  during rate(height(object), 200 ms) >= rate(height(object), 200 ms)@begin + 1 m/s
)" + end,
                      50),
            50);
}

// Nothing changes when an open interval has lasted long enough to be one.
TEST(Monitor, WhatTimeMakesCertainIsKnownInTime) {
  const std::string end = R"(
event touched(hand: Hand, object: Movable) while touching(hand, object) and waiting(hand, object)
)";
  EXPECT_EQ(DecidedAt(R"(
condition waiting(hand: Hand, object: Movable)
  from touching(hand, object) begins to trigger(hand) > 0.5 begins lasting 100 ms
)" + end,
                      50),
            110);
  EXPECT_EQ(DecidedAt(R"(
condition squeezed(hand: Hand) while trigger(hand) > 0.5
condition waiting(hand: Hand, object: Movable) rest of early(hand, object) outside squeezed(hand) lasting 100 ms
condition early(hand: Hand, object: Movable) from touching(hand, object) begins to squeezed(hand) begins
)" + end,
                      50),
            110);
}

TEST(Monitor, TellsTheStyleOfAGrasp) {
  Scene scene;
  const auto program = testing::CompileLibrary("grasp");
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  scene.hand.style = 1;
  PlayRound(scene, monitor, 0, events);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].style, 1);
  EXPECT_EQ(events[0].interval, (Interval{300, 1900}));
  EXPECT_EQ(NameEvents(*program, scene.entity_table, events).events[0].roles.back(),
            (Role{"style", "pinch"}));
}

TEST(Monitor, RefusesFramesThatCannotBe) {
  const auto program = testing::CompileLibrary("contact");
  const auto error_after = [&](auto&& spoil) {
    Scene scene;
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    monitor.Advance(scene.At(10), events);
    Frame frame = scene.At(20);
    spoil(scene, frame);
    monitor.Advance(frame, events);
    monitor.Finish(30, events);
    return monitor.error();
  };
  EXPECT_EQ(error_after([](Scene&, Frame&) {}), "");
  EXPECT_EQ(error_after([](Scene&, Frame& f) { f.tick = 10; }),
            "the frames are not in order of time");
  EXPECT_EQ(error_after([](Scene&, Frame& f) { f.entities = f.entities.first(2); }),
            "a frame has another number of entities than the entity table");
  EXPECT_EQ(error_after([](Scene&, Frame& f) { f.entities = {}; }),
            "a frame has another number of entities than the entity table");
  EXPECT_EQ(error_after([](Scene&, Frame& f) { f.tick = std::numeric_limits<Tick>::max(); }),
            "a frame's tick is too large");
  EXPECT_EQ(error_after([](Scene&, Frame& f) { f.tick = std::numeric_limits<Tick>::min(); }),
            "a frame's tick is too large");
  static const std::vector<HandSample> kTwice(2, HandSample{.entity = Scene::kHand});
  EXPECT_EQ(error_after([](Scene&, Frame& f) { f.hands = kTwice; }),
            "a frame has a hand twice, or its hands are not in the order of the entity table");
  EXPECT_EQ(
      error_after([](Scene& s, Frame& f) {
        s.touches = {{.a = 1, .b = 7}};
        f.touches = s.touches;
      }),
      "a frame has a touch of entities that are not in the entity table, or not in its order");
}

// Whatever a frame says of the hand, the monitor goes on: nothing of it is needed to be there.
TEST(Monitor, SurvivesStrangeFrames) {
  const auto program = testing::CompileText(R"(
grammar strange
event styled(hand: Hand, object: Movable) until touching(hand, object) begins since distance(hand, object) < 100 m
  approaching gap(hand, object) receding at most 1 cm, slower than 1 cm/s at most 1 s at most 1 s back
  with style = style(hand)
event held(hand: Hand, object: Movable) while sensor_sets(hand, object) >= 1 bridging 20 ms with style = style(hand)
event carried(hand: Hand, object: Movable) from held(hand, object) begins
  to in_sphere(object, ahead(hand, 1 m), tilt(object) / 1 rad * 1 m) begins during drift_along(object, hand, 1 s) < 1 m/s
  requires displacement(object, hand) < 1000 m
)");
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<const char*, std::function<void(Scene&, Frame&)>> spoilers[] = {
      {"hand not shown", [](Scene&, Frame& f) { f.hands = {}; }},
      {"no collision spheres", [](Scene& s, Frame&) { s.hand.collision_spheres = {}; }},
      {"style unknown", [](Scene& s, Frame&) { s.hand.style = 99; }},
      {"not a number",
       [](Scene& s, Frame&) {
         s.looks[Scene::kCup].p_WB_m.setConstant(kNan);
         s.looks[Scene::kHand].v_WB_m_per_s.setConstant(kNan);
         s.hand.ahead_W.setConstant(kNan);
         s.collision_sphere.p_W_m.setConstant(kNan);
       }},
      {"infinite", [](Scene& s, Frame&) { s.looks[Scene::kCup].p_WB_m.setConstant(1 / 0.0); }},
      {"touch twice",
       [](Scene& s, Frame& f) {
         s.touches.insert(s.touches.end(), s.touches.begin(), s.touches.end());
         f.touches = s.touches;
       }},
      {"a cup as a hand", [](Scene& s, Frame&) { s.hand.entity = Scene::kCup; }}};
  for (const auto& [what, spoil] : spoilers) {
    for (const bool always : {true, false}) {
      SCOPED_TRACE(what);
      Scene scene;
      Monitor monitor(program, scene.entity_table);
      std::vector<Event> events;
      for (int i = 0; i < 100; ++i) {
        const Scene sound = scene;
        scene.touches.clear();
        if (i / 10 % 2 == 1) scene.touches = {{.a = 0, .b = 1, .sensor_sets = 1}};
        Frame frame = scene.At(10 * i);
        if (always || i % 7 == 0) spoil(scene, frame);
        monitor.Advance(frame, events);
        scene = sound;
      }
      monitor.Finish(1000, events);
      EXPECT_EQ(monitor.error(), "");
      EXPECT_FALSE(events.empty());
      NameEvents(*program, scene.entity_table, events);
    }
  }
}

TEST(Monitor, SurvivesEmptyFramesOfAnEmptyCast) {
  Monitor monitor(testing::CompileLibrary("pick_and_place"), {});
  std::vector<Event> events;
  for (Tick t = 0; t < 100; ++t) monitor.Advance({.tick = t}, events);
  monitor.Finish(100, events);
  EXPECT_EQ(monitor.error(), "");
  EXPECT_TRUE(events.empty());
}

TEST(Monitor, RefusesTooManyBindings) {
  const auto program = testing::CompileText(
      "grammar t\nevent far(a: Thing, b: Thing, c: Thing)\n"
      "  while distance(a, b) > 1 m and distance(b, c) > 1 m\n");
  EntityTable entity_table;
  for (int i = 0; i < 200; ++i)
    entity_table.entities.push_back({.name = std::to_string(i), .classes = {"Thing", "Entity"}});
  const Monitor monitor(program, entity_table);
  EXPECT_EQ(monitor.error(),
            "more than 1000000 bindings with those of 'far(a: Thing, b: Thing, c: Thing)': "
            "there are 200 for a, 200 for b, 200 for c; give the roles narrower classes");
}

TEST(Monitor, WithoutFramesThereIsNothing) {
  Monitor monitor(testing::CompileLibrary("pick_and_place"), Scene().entity_table);
  std::vector<Event> events;
  monitor.Finish(100, events);
  EXPECT_TRUE(events.empty());
}

}  // namespace
}  // namespace prehend::grammar
