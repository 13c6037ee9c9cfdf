// SPDX-License-Identifier: Apache-2.0
// Compositions on drawn facts: which combinations are taken and when they are certain.
#include <algorithm>
#include <array>

#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::Scene;

constexpr const char* kGrammar = R"(
grammar t
condition held(hand: Hand, cup: Cup) while touching(hand, cup)
condition placed(hand: Hand, cup: Cup, tray: Movable) while touching(cup, tray) and distance(hand, tray) < 10 m
event served(hand: Hand, cup: Cup, tray: Movable)
  compose take: reached(hand, cup, tray), put: placed(hand, cup, tray)
  where take before|meets put
event taken(hand: Hand, cup: Cup, tray: Movable) compose take: reached(hand, cup, tray) where take equals take
event served_taken(hand: Hand, cup: Cup, tray: Movable)
  compose take: taken(hand, cup, tray), put: placed(hand, cup, tray)
  where take before|meets put
event reached(hand: Hand, cup: Cup, tray: Movable) while held(hand, cup) and distance(hand, tray) < 10 m bridging 2 ms
)";

// One character per tick. A composition of a part alone is that part, and whoever is made of it
// waits for it as well.
std::string Served(const std::string& held, const std::string& placed) {
  const auto program = testing::CompileText(kGrammar);
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (std::size_t t = 0; t < held.size(); ++t) {
    scene.touches.clear();
    if (held[t] == '#') scene.touches.push_back({.a = 0, .b = 1});
    if (placed[t] == '#') scene.touches.push_back({.a = 1, .b = 2});
    monitor.Advance(scene.At(static_cast<Tick>(t)), events);
  }
  monitor.Finish(static_cast<Tick>(held.size()), events);
  const auto text = [&](const std::string& name) {
    std::string found;
    for (const Event& e : events) {
      if (program->rules[e.rule].name != name) continue;
      found += "[" + std::to_string(e.interval.begin) + "," + std::to_string(e.interval.end) +
               ")@" + std::to_string(e.decided) + " ";
    }
    return found;
  };
  EXPECT_EQ(text("served_taken"), text("served"));
  return text("served");
}

TEST(Compose, JoinsPartsWhoseRelationsHold) {
  EXPECT_EQ(Served("###.........", "......##...."), "[0,8)@8 ");
  EXPECT_EQ(Served("###.........", "...##......."), "[0,5)@5 ");
  EXPECT_EQ(Served("###.........", "..##........"), "");
}

TEST(Compose, TakesTheLatestBeginAndNeverOverlaps) {
  EXPECT_EQ(Served("##...##.......", ".........##..."), "[5,11)@11 ");
  EXPECT_EQ(Served("##.......##......", "....##......##..."), "[0,6)@6 [9,14)@14 ");
  EXPECT_EQ(Served("##...............", "....##......##..."), "[0,6)@6 ");
}

// The gap at 9 may be bridged, so whether a later take has ended before the put is open until it is
// not.
TEST(Compose, WaitsUntilNoBetterPartCanCome) {
  EXPECT_EQ(Served("#....####.......", ".........#......"), "[5,10)@11 ");
}

TEST(Compose, AGapMayBeLimited) {
  const auto found = [](const std::string& relation) {
    const auto program = testing::CompileText(
        "grammar t\nevent a(h: Hand, c: Cup) while touching(h, c)\n"
        "event b(h: Hand, t: Movable) while touching(h, t)\n"
        "event e(h: Hand, c: Cup, t: Movable) compose a: a(h, c), b: b(h, t) where " +
        relation);
    Scene scene;
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    const std::string first = "##....##......##....", second = "......##..##....##..";
    for (std::size_t t = 0; t < first.size(); ++t) {
      scene.touches.clear();
      if (first[t] == '#') scene.touches.push_back({.a = 0, .b = 1});
      if (second[t] == '#') scene.touches.push_back({.a = 0, .b = 2});
      monitor.Advance(scene.At(static_cast<Tick>(t)), events);
    }
    monitor.Finish(static_cast<Tick>(first.size()), events);
    std::string text;
    for (const Event& event : events) {
      if (program->rules[event.rule].name == "e")
        text += "[" + std::to_string(event.interval.begin) + "," +
                std::to_string(event.interval.end) + ") ";
    }
    return text;
  };
  EXPECT_EQ(found("a before b"), "[0,8) ") << "meets is not before";
  EXPECT_EQ(found("a before within 4 ms b"), "[0,8) ");
  EXPECT_EQ(found("a before within 3.9 ms b"), "[6,12) ");
  EXPECT_EQ(found("a meets|before within 1 ms b"), "[14,18) ");
}

// Seven parts with 64 intervals each have 4e12 combinations; choosing part by part finds the first
// at once, and knows that there is no other.
TEST(Compose, OfManyPartsIsFoundWithoutTryingAllCombinations) {
  const auto program = testing::CompileText(R"(
grammar t
event shown(hand: Hand, cup: Cup, tray: Movable) while touching(hand, cup) and distance(hand, tray) < 10 m
event placed(hand: Hand, cup: Cup, tray: Movable) while touching(cup, tray) and distance(hand, tray) < 10 m
event all(hand: Hand, cup: Cup, tray: Movable)
  compose p0: shown(hand, cup, tray), p1: shown(hand, cup, tray), p2: shown(hand, cup, tray),
    p3: shown(hand, cup, tray), p4: shown(hand, cup, tray), p5: shown(hand, cup, tray), p6: placed(hand, cup, tray)
  where p0 before p6, p1 before p6, p2 before p6, p3 before p6, p4 meets|overlaps p6, p5 equals p6
)");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick t = 0; t < 2000; ++t) {
    scene.touches.clear();
    const bool both = t >= 1990;
    if (both || t % 20 < 8) scene.touches.push_back({.a = 0, .b = 1});
    if (both || t % 20 >= 10) scene.touches.push_back({.a = 1, .b = 2});
    monitor.Advance(scene.At(t), events);
  }
  monitor.Finish(2000, events);
  EXPECT_EQ(std::ranges::count_if(
                events, [&](const Event& e) { return program->rules[e.rule].name == "all"; }),
            0);
}

// What is found of two rows of touches, of the cup and of the tray, one character per tick.
std::string Found(const std::string& rule, const std::string& cup, const std::string& tray,
                  Tick ticks_per_second = 1000) {
  const auto program = testing::CompileText(
      "grammar t\nevent a(h: Hand, c: Cup) while touching(h, c)\n"
      "event b(h: Hand, t: Movable) while touching(h, t)\n"
      "event e(h: Hand, c: Cup, t: Movable) " +
      rule);
  Scene scene;
  scene.entity_table.ticks_per_second = ticks_per_second;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (std::size_t t = 0; t < cup.size(); ++t) {
    scene.touches.clear();
    if (cup[t] == '#') scene.touches.push_back({.a = 0, .b = 1});
    if (tray[t] == '#') scene.touches.push_back({.a = 0, .b = 2});
    monitor.Advance(scene.At(static_cast<Tick>(t)), events);
  }
  monitor.Finish(static_cast<Tick>(cup.size()), events);
  std::string text = monitor.error();
  for (const Event& event : events) {
    if (program->rules[event.rule].name == "e")
      text += "[" + std::to_string(event.interval.begin) + "," +
              std::to_string(event.interval.end) + ") ";
  }
  return text;
}

std::string Times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

// What is found does not depend on how many candidates there are.
TEST(Compose, RemembersAsManyIntervalsAsThereAre) {
  for (const int count : {1, 60, 63, 64, 65, 70, 1000, 10'000}) {
    const std::string many = Times(count, "#."), whole(many.size(), '#');
    EXPECT_EQ(Found("compose a: a(h, c), b: b(h, t) where a contains b", "##" + whole + "#.",
                    "..." + many + "."),
              "[0,4) ")
        << count;
    // Each of the many may be the one before the last; it is the latest.
    EXPECT_EQ(Found("compose a: a(h, c), b: b(h, t) where a before b", many + ".....",
                    std::string(many.size(), '.') + "..#.."),
              "[" + std::to_string(2 * count - 2) + "," + std::to_string(2 * count + 3) + ") ")
        << count;
    // The first one is still there.
    EXPECT_EQ(Found("compose a: a(h, c), b: b(h, t), d: a(h, c) where a before b, b overlaps d",
                    many + "......####", std::string(many.size(), '.') + "....####.."),
              "[" + std::to_string(2 * count - 2) + "," + std::to_string(2 * count + 10) + ") ")
        << count;
  }
}

TEST(Compose, OfMoreIntervalsThanAreRememberedEndsTheRun) {
  const std::string many = Times(100'001, "#.");
  EXPECT_EQ(
      Found("compose a: a(h, c), b: b(h, t) where a before b", many, std::string(many.size(), '.')),
      "more than 100000 intervals may still become part of 'e': say how far apart its parts "
      "are at most: a before within 10 s b");
  EXPECT_EQ(Found("compose a: a(h, c), b: b(h, t) where a before within 2 s b", many,
                  std::string(many.size() - 1, '.') + "#"),
            "[199998,200002) ");
}

// At 100 Hz, one frame too long or too short: two signals never end at the same instant.
TEST(Compose, BoundariesMayBeEqualGiveOrTakeATime) {
  const std::string rule = "compose a: a(h, c), b: b(h, t) where a ";
  const auto found = [&](const std::string& relation, const std::string& a, const std::string& b) {
    return Found(rule + relation + " b", a, b, 100);
  };
  EXPECT_EQ(found("meets", "..###.....", ".....###.."), "[2,8) ");
  for (const std::string a : {"..###.....", "..####....", "..##......", "..#####...", "..#......."})
    EXPECT_EQ(found("meets within 20 ms", a, ".....###.."), "[2,8) ") << a;
  EXPECT_EQ(found("meets within 20 ms", ".#........", ".....###.."), "");
  EXPECT_EQ(found("meets within 20 ms", "..######..", ".....####."), "");
  EXPECT_EQ(found("meets within 20 ms|before", ".#........", ".....###.."), "[1,8) ");
  EXPECT_EQ(found("before within 30 ms|meets within 10 ms", ".#........", ".....###.."), "[1,8) ");
  EXPECT_EQ(found("equals", "..####....", "..#####..."), "");
  EXPECT_EQ(found("equals within 10 ms", "..####....", "..#####..."), "[2,7) ");
  EXPECT_EQ(found("equals within 10 ms", "..####....", "...####..."), "[2,7) ");
  EXPECT_EQ(found("equals within 10 ms", "..####....", "....###..."), "");
  EXPECT_EQ(found("starts within 20 ms", "..##......", "....#####."), "[2,9) ");
  EXPECT_EQ(found("starts within 20 ms", "..##......", ".....####."), "");
  EXPECT_EQ(found("finishes within 20 ms", ".....###..", "..####...."), "[5,6) ");
  EXPECT_EQ(found("started_by within 10 ms", "...######.", "..##......"), "[3,4) ");
}

TEST(Compose, TakesTheNearestPartnerOrTheFirst) {
  const std::string rest = "a: a(h, c), b: b(h, t) where a before b";
  const std::string a = ".#.#.#...........#....", b = ".........#..#.......#.";
  EXPECT_EQ(Found("compose " + rest, a, b, 100), "[5,10) [17,21) ");
  EXPECT_EQ(Found("compose first " + rest, a, b, 100), "[1,10) [17,21) ");
  const std::string soon = "a: a(h, c), b: b(h, t) where a before within 50 ms b";
  EXPECT_EQ(Found("compose first " + soon, a, b, 100), "[3,10) [17,21) ");
}

// Of the two that can stand for a part, intervals may overlap.
TEST(Compose, AnIntervalOfEitherStandsForThePart) {
  const std::string both = "compose a: a(h, c) or b(h, t), b: b(h, t) where a before b";
  EXPECT_EQ(Found(both, "..#.......", "......#...", 100), "[2,7) ");
  EXPECT_EQ(Found(both, "..........", "..#...#...", 100), "[2,7) ");
  EXPECT_EQ(Found(both, ".#####....", "..#...#...", 100), "[2,7) ");
  EXPECT_EQ(
      Found("all of a(h, c) or b(h, t), b(h, t) within 50 ms", "..........", "..#...#...", 100),
      "[2,7) ");
  EXPECT_EQ(
      Found("all of a(h, c) or b(h, t), b(h, t) within 50 ms", "..........", "..#.......", 100),
      "");
}

// While it is not complete, another rule that asks about it waits from the begin of the longest on.
TEST(Compose, AnIntervalOfEitherMayBeginBeforeAShorterOne) {
  const std::string rule = R"(while a(h, c) and not w(h, c, t)
condition late(h: Hand, t: Movable) while touching(h, t) bridging 10 ms
condition w(h: Hand, c: Cup, t: Movable) all of p: b(h, t) or a(h, c), q: late(h, t) where p contains q within 50 ms
)";
  EXPECT_EQ(Found(rule, ".....##########..............", "........##..................."), "");
  EXPECT_EQ(Found(rule, ".....##########..............", "..........................##."),
            "[5,15) ");
}

// Its first interval is out later than one that ends later.
TEST(Compose, WaitsForACompositionThatIsNotMadeYet) {
  const std::string rule = R"(all of x: w(h, c), y: b(h, t) within 50 ms
condition late(h: Hand, c: Cup) while touching(h, c) bridging 10 ms
condition w(h: Hand, c: Cup) compose p: late(h, c) where p equals p
)";
  EXPECT_EQ(Found(rule, ".....###....................", ".....####..................."), "[5,9) ");
  EXPECT_EQ(Found(rule, ".....###....................", "...##......................."), "[3,8) ");
}

// `any` may be whom the other part names: one interval is not two.
TEST(Compose, WhatIsNamedTwiceHappensTwiceAlsoByAny) {
  for (const std::string parts :
       {"a(h, any), a(any, c)", "a(h, c), a(h, any)", "a(h, any Cup), a(any, c)",
        "b(h, t) or a(h, any), a(h, c)", "touching(h, c), touching(c, h)"}) {
    const std::string rule = "all of x: " + parts.substr(0, parts.find("),") + 1) +
                             ", y:" + parts.substr(parts.find("),") + 2) +
                             ", z: b(h, t) within 80 ms";
    EXPECT_EQ(Found(rule, "..##......", "..#.......", 100), "") << parts;
    EXPECT_EQ(Found(rule, "..##.#....", "..#.......", 100), "[2,6) ") << parts;
  }
}

// One rule finds plate, cup and knife in each of the six orders, and reaches over all three.
TEST(Compose, FindsAllOfThemInAnyOrder) {
  const auto program = testing::CompileText(R"(
grammar t
event moved(hand: Hand, thing: Thing) while touching(hand, thing)
event table_set(hand: Hand, plate: Plate, cup: Cup, knife: Knife)
  all of moved(hand, plate), moved(hand, cup), moved(hand, knife) within 40 ms
)");
  EntityTable entity_table{.ticks_per_second = 1000,
                           .entities = {{.name = "hand", .classes = {"Hand", "Entity"}}}};
  for (const char* name : {"Plate", "Cup", "Knife"})
    entity_table.entities.push_back({.name = name, .classes = {name, "Thing", "Entity"}});
  std::array order = {1, 2, 3};
  int found = 0;
  do {
    for (const Tick pause : {5, 20}) {
      Monitor monitor(program, entity_table);
      const std::vector<EntitySample> looks(entity_table.entities.size());
      std::vector<Event> events;
      for (Tick t = 0; t < 100; ++t) {
        std::vector<Touch> touches;
        for (std::size_t i = 0; i < order.size(); ++i) {
          const Tick begin = 3 + static_cast<Tick>(i) * pause;
          if (t >= begin && t < begin + 3) touches.push_back({.a = 0, .b = order[i]});
        }
        monitor.Advance({.tick = t, .entities = looks, .hands = {}, .touches = touches}, events);
      }
      monitor.Finish(100, events);
      const auto one = std::ranges::find_if(
          events, [&](const Event& e) { return program->rules[e.rule].name == "table_set"; });
      EXPECT_EQ(one != events.end(), pause == 5) << "longer than it may be";
      if (one == events.end()) continue;
      EXPECT_EQ(one->interval, (Interval{3, 16}));
      EXPECT_EQ(one->decided, 16);
      ++found;
    }
  } while (std::ranges::next_permutation(order).found);
  EXPECT_EQ(found, 6);
}

// The hand is off the cup from 28 on, and until 35 it may be back on it: so long nobody knows what
// reaches back from 29 on. A tap at 31 is no reason to forget what it may follow.
TEST(Compose, WhatReachesBackMayBeKnownLate) {
  const auto program = testing::CompileText(
      "grammar t\nevent on(h: Hand, c: Cup) while touching(h, c)\n"
      "event tap(h: Hand, t: Movable) while touching(h, t)\n"
      "condition nearly(h: Hand, c: Cup)\n"
      "  until touching(h, c) begins since not touching(h, c) at most 7 ms back\n"
      "event left(h: Hand, c: Cup, t: Movable)\n"
      "  until touching(c, t) ends since not nearly(h, c) at most 5 ms back\n"
      "event both(h: Hand, c: Cup, t: Movable)\n"
      "  all of a: on(h, c), b: left(h, c, t), d: tap(h, t)\n"
      "  where a overlaps b, b before d within 22 ms\n");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 50; ++tick) {
    scene.touches.clear();
    if (tick >= 10 && tick < 28) scene.touches.push_back({.a = Scene::kHand, .b = Scene::kCup});
    if (tick >= 20 && tick < 29) scene.touches.push_back({.a = Scene::kCup, .b = 2});
    if (tick == 31) scene.touches.push_back({.a = Scene::kHand, .b = 2});
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(50, events);
  const auto both = std::ranges::find_if(
      events, [&](const Event& e) { return program->rules[e.rule].name == "both"; });
  ASSERT_NE(both, events.end());
  EXPECT_EQ(both->interval, (Interval{10, 32}));
}

// The press from 15 to 18 waits for its confirmation at 30; the next one begins at 22.
TEST(Compose, WhatWaitsForItsConfirmationIsNotForgotten) {
  const auto program = testing::CompileText(
      "grammar t\nevent tap(h: Hand, t: Movable) while touching(h, t)\n"
      "condition there(c: Cup) while height(c) > -1 m\ncondition high(c: Cup) while height(c) > 1 "
      "m\n"
      "event press(h: Hand, c: Cup) while touching(h, c) confirmed by high(c) within there(c)\n"
      "event both(h: Hand, c: Cup, t: Movable)\n"
      "  compose a: tap(h, t), b: press(h, c) where a before within 3 ms b\n");
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 50; ++tick) {
    scene.touches.clear();
    if ((tick >= 10 && tick < 14) || tick == 23)
      scene.touches.push_back({.a = Scene::kHand, .b = 2});
    if ((tick >= 15 && tick < 18) || tick >= 22)
      scene.touches.push_back({.a = Scene::kHand, .b = Scene::kCup});
    scene.looks[Scene::kCup].p_WB_m.z() = tick < 30 ? 0 : 2;
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(50, events);
  const auto both = std::ranges::find_if(
      events, [&](const Event& e) { return program->rules[e.rule].name == "both"; });
  ASSERT_NE(both, events.end());
  EXPECT_EQ(both->interval, (Interval{10, 18}));
}

TEST(Compose, ClosesAtTheEndOfTheEpisode) { EXPECT_EQ(Served("##......", "....####"), "[0,8)@8 "); }

}  // namespace
}  // namespace prehend::grammar
