// SPDX-License-Identifier: Apache-2.0
// The engine against the reference: all small streams, and many random ones with frames at uneven
// times.
#include "tests/grammar/reference/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "grammar/base/allen.h"
#include "grammar/monitor.h"
#include "grammar/program/program.h"
#include "tests/grammar/reference/reference_trial.h"
#include "tests/grammar/scene.h"
#include "tests/grammar/thorough.h"

namespace prehend::grammar {
namespace {

using reference::Runs;
using reference::Stream;
using reference::Ticks;

// Three facts: x touches p, q, r. One tick is 1 ms.
constexpr const char* kForms = R"(
grammar forms
event plain(x: X, p: P) while touching(x, p)
event bridged(x: X, p: P) while touching(x, p) bridging 2 ms lasting 3 ms
event mixed(x: X, p: P, q: Q, r: R) while touching(x, p) and not touching(x, q) or touching(x, r)
event between(x: X, p: P, q: Q) from touching(x, p) begins to touching(x, q) begins
event cut(x: X, p: P, q: Q, r: R) from touching(x, p) begins to touching(x, q) ends during touching(x, r)
event dropped(x: X, p: P, q: Q, r: R) from bridged(x, p) begins to touching(x, q) begins during touching(x, r) or drop
event approach(x: X, p: P, q: Q) until touching(x, p) begins since touching(x, q) at most 4 ms back
event late(x: X, p: P, q: Q, r: R)
  until bridged(x, p) ends since touching(x, q) and not touching(x, r) at most 9 ms back lasting 2 ms
event remaining(x: X, p: P, q: Q, r: R) rest of bridged(x, p) outside approach(x, p, q), touching(x, r)
event tangled(x: X, p: P, q: Q, r: R)
  while not bridged(x, p) and (touching(x, q) or approach(x, p, q) or remaining(x, p, q, r)) bridging 1 ms
event confirmed_one(x: X, p: P, q: Q, r: R)
  until touching(x, p) begins since touching(x, q) at most 20 ms back
  confirmed by plain_r(x, r) within bridged(x, p)
event plain_r(x: X, r: R) while touching(x, r)
event cut_by_later(x: X, p: P, q: Q, r: R)
  from touching(x, r) ends to (approach(x, p, q) begins or touching(x, r) begins) during not plain(x, p)
event held(x: X, p: P, q: Q) while touching(x, p) until touching(x, q) bridging 1 ms
event in_time(x: X, p: P, q: Q, r: R) from touching(x, p) begins to touching(x, q) begins within 4 ms during touching(x, r)
event timely(x: X, p: P, q: Q, r: R)
  from bridged(x, p) ends to touching(x, q) begins within 5 ms during not touching(x, r) or drop
event missed(x: X, p: P, q: Q, r: R)
  from touching(x, p) begins without touching(x, q) begins within 3 ms during touching(x, r)
event missed_late(x: X, p: P, q: Q) from bridged(x, p) ends without touching(x, q) ends within 4 ms
event after_missed(x: X, p: P, q: Q, r: R) while missed(x, p, q, r) or in_time(x, p, q, r) bridging 1 ms
event plain_q(x: X, q: Q) while touching(x, q)
event story(x: X, p: P, q: Q) compose a: plain(x, p), b: plain_q(x, q) where a before|overlaps|contains|finishes b
event ends_in_r(x: X, p: P, r: R) while touching(x, p) bridging 1 ms requires touching(x, r)
event anywhere(x: X, p: P) while mixed(x, p, any, any) or late(x, p, any, any)
)";

std::shared_ptr<const Program> CompileForms() {
  CompileResult result = Compile({"forms", kForms}, nullptr);
  EXPECT_TRUE(result.program) << Format(result.diagnostics);
  return result.program;
}

struct Episode {
  Stream p, q, r;
  Ticks ticks;  // and the end
};

std::vector<Interval> TicksOf(const std::vector<reference::Timed>& timed) {
  std::vector<Interval> intervals;
  for (const auto& one : timed) intervals.push_back(one.ticks);
  return intervals;
}

std::vector<Interval> TicksOf(const Runs& runs, const Ticks& ticks) {
  return TicksOf(reference::InTicks(runs, ticks));
}

// What must not come: with deadlines between frames, hence in ticks.
std::vector<std::pair<std::string, std::vector<Interval>>> ExpectedDeadlines(const Episode& e) {
  using namespace reference;
  const int n = static_cast<int>(e.p.size());
  const auto run = [&](const Stream& s) { return While(s, e.ticks, 0); };
  const Stream always(n, true);
  const Runs bridged = Lasting(While(e.p, e.ticks, 2), e.ticks, 3);
  const Stream p_begins = Begins(run(e.p), n);
  const Stream q_begins = Begins(run(e.q), n);
  const Runs in_time = FromTo(p_begins, q_begins, e.r, false, e.ticks, 4);
  const std::vector<Timed> missed = FromWithout(p_begins, q_begins, e.r, e.ticks, 3);
  const Stream after = Or(Truth(RunsOf(missed), n), Truth(in_time, n));
  const auto related = [](const std::vector<Interval>& chosen) {
    const Allen relation = Relate(chosen[0], chosen[1]);
    return relation == Allen::kBefore || relation == Allen::kOverlaps ||
           relation == Allen::kContains || relation == Allen::kFinishes;
  };
  Runs ends_in_r;
  for (const auto& one : While(e.p, e.ticks, 1)) {
    if (e.r[std::min(one.end, n - 1)]) ends_in_r.push_back(one);
  }
  return {
      {"story", TicksOf(Compose(
                    {reference::InTicks(run(e.p), e.ticks), reference::InTicks(run(e.q), e.ticks)},
                    related))},
      {"ends_in_r", TicksOf(ends_in_r, e.ticks)},
      {"held", TicksOf(Hold(e.p, e.q, e.ticks, 1), e.ticks)},
      {"in_time", TicksOf(in_time, e.ticks)},
      {"timely", TicksOf(FromTo(Ends(bridged, n), q_begins, Not(e.r), true, e.ticks, 5), e.ticks)},
      {"missed", TicksOf(missed)},
      {"missed_late",
       TicksOf(FromWithout(Ends(bridged, n), Ends(run(e.q), n), always, e.ticks, 4))},
      {"after_missed", TicksOf(While(after, e.ticks, 1), e.ticks)}};
}

// The rules of kForms, by the meaning table.
std::vector<std::pair<std::string, Runs>> Expected(const Episode& e) {
  using namespace reference;
  const int n = static_cast<int>(e.p.size());
  const auto run = [&](const Stream& s) { return While(s, e.ticks, 0); };
  const auto begins = [&](const Stream& s) { return Begins(run(s), n); };
  const auto ends = [&](const Stream& s) { return Ends(run(s), n); };
  const Stream always(n, true);
  const Runs bridged = Lasting(While(e.p, e.ticks, 2), e.ticks, 3);
  const Stream in_bridged = Truth(bridged, n);
  const Stream mixed = Or(And(e.p, Not(e.q)), e.r);
  const Runs approach = UntilSince(begins(e.p), e.q, e.ticks, 4);
  const Stream in_approach = Truth(approach, n);
  const Runs late =
      Lasting(UntilSince(Ends(bridged, n), And(e.q, Not(e.r)), e.ticks, 9), e.ticks, 2);
  const Runs remaining =
      reference::RunsOf(RestOf(reference::InTicks(bridged, e.ticks), {in_approach, e.r}, e.ticks));
  const Stream tangled = And(Not(in_bridged), Or(e.q, Or(in_approach, Truth(remaining, n))));
  return {{"plain", run(e.p)},
          {"bridged", bridged},
          {"mixed", run(mixed)},
          {"between", FromTo(begins(e.p), begins(e.q), always, false, e.ticks)},
          {"cut", FromTo(begins(e.p), ends(e.q), e.r, false, e.ticks)},
          {"dropped", FromTo(Begins(bridged, n), begins(e.q), e.r, true, e.ticks)},
          {"approach", approach},
          {"late", late},
          {"remaining", remaining},
          {"tangled", While(tangled, e.ticks, 1)},
          {"confirmed_one",
           ConfirmedBy(UntilSince(begins(e.p), e.q, e.ticks, 20), run(e.r), in_bridged)},
          {"plain_r", run(e.r)},
          {"plain_q", run(e.q)},
          {"cut_by_later",
           FromTo(ends(e.r), Or(Begins(approach, n), begins(e.r)), Not(e.p), false, e.ticks)},
          {"anywhere", run(Or(mixed, Truth(late, n)))}};
}

std::vector<Event> Watch(const std::shared_ptr<const Program>& program, const Episode& episode) {
  EntityTable entity_table{.ticks_per_second = 1000};
  for (const char* name : {"X", "P", "Q", "R"})
    entity_table.entities.push_back({.name = name, .classes = {name, "Thing", "Entity"}});
  Monitor monitor(program, entity_table);
  const std::vector<EntitySample> looks(entity_table.entities.size());
  std::vector<Event> events;
  for (std::size_t i = 0; i < episode.p.size(); ++i) {
    std::vector<Touch> touches;
    if (episode.p[i]) touches.push_back({.a = 0, .b = 1});
    if (episode.q[i]) touches.push_back({.a = 0, .b = 2});
    if (episode.r[i]) touches.push_back({.a = 0, .b = 3});
    monitor.Advance({.tick = episode.ticks[i], .entities = looks, .hands = {}, .touches = touches},
                    events);
  }
  monitor.Finish(episode.ticks.back(), events);
  EXPECT_EQ(monitor.error(), "");
  return events;
}

std::string Drawn(const Episode& episode) {
  std::string text;
  const auto row = [&](char name, const Stream& stream) {
    text += name + std::string(" ");
    for (const bool b : stream) text += b ? '#' : '.';
    text += '\n';
  };
  row('p', episode.p);
  row('q', episode.q);
  row('r', episode.r);
  text += "ticks";
  for (const Tick tick : episode.ticks) text += " " + std::to_string(tick);
  return text;
}

std::string IntervalsText(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  std::string text;
  for (const Interval& i : intervals)
    text += "[" + std::to_string(i.begin) + "," + std::to_string(i.end) + ") ";
  return text;
}

// One comparison of all rules; false at the first difference.
bool Agrees(const std::shared_ptr<const Program>& program, const Episode& episode) {
  const std::vector<Event> events = Watch(program, episode);
  std::vector<std::pair<std::string, std::vector<Interval>>> all = ExpectedDeadlines(episode);
  for (const auto& [name, runs] : Expected(episode))
    all.push_back({name, TicksOf(runs, episode.ticks)});
  for (const auto& [name, expected] : all) {
    std::vector<Interval> found;
    for (const Event& event : events) {
      if (program->rules[event.rule].name != name) continue;
      found.push_back(event.interval);
      EXPECT_GE(event.decided, event.interval.begin);
    }
    EXPECT_EQ(IntervalsText(expected), IntervalsText(found)) << name << " of\n" << Drawn(episode);
    if (::testing::Test::HasFailure()) return false;
  }
  return true;
}

TEST(Reference, AgreesOnAllSmallStreams) {
  const auto program = CompileForms();
  constexpr int kFrames = 5;
  for (int bits = 0; bits < 1 << (3 * kFrames); ++bits) {
    Episode episode;
    for (int i = 0; i < kFrames; ++i) {
      episode.p.push_back((bits >> (3 * i)) & 1);
      episode.q.push_back((bits >> (3 * i + 1)) & 1);
      episode.r.push_back((bits >> (3 * i + 2)) & 1);
    }
    for (int i = 0; i <= kFrames; ++i) episode.ticks.push_back(i);
    if (!Agrees(program, episode)) return;
  }
}

TEST(Reference, AgreesOnRandomStreams) {
  const auto program = CompileForms();
  std::mt19937_64 random(20260101);
  for (int round = 0; round < 6000; ++round) {
    Episode episode;
    const int frames = 1 + static_cast<int>(random() % 60);
    const unsigned stay = 1 + random() % 8;  // how long a fact stays, roughly
    bool p = false, q = false, r = false;
    Tick tick = static_cast<Tick>(random() % 5);
    for (int i = 0; i < frames; ++i) {
      if (random() % stay == 0) p = !p;
      if (random() % stay == 0) q = !q;
      if (random() % stay == 0) r = !r;
      episode.p.push_back(p);
      episode.q.push_back(q);
      episode.r.push_back(r);
      episode.ticks.push_back(tick);
      tick += 1 + static_cast<Tick>(random() % 4 == 0 ? random() % 6 : 0);
    }
    episode.ticks.push_back(tick);
    if (!Agrees(program, episode)) return;
  }
}

// The intervals of one are those of the other, or longer.
bool Covers(const std::vector<Interval>& wide, const std::vector<Interval>& narrow) {
  return std::ranges::all_of(narrow, [&](const Interval& one) {
    return std::ranges::any_of(wide, [&](const Interval& other) {
      return other.begin <= one.begin && one.end <= other.end;
    });
  });
}

// What is bridged lasts longer, never shorter, whatever ends it.
TEST(Reference, BridgingOnlyAddsTime) {
  constexpr std::array kRules = {
      "(x: Hand, p: P) while touching(x, p)",
      "(x: Hand, p: P, q: Q) while touching(x, p) or touching(x, q)",
      "(x: Hand, p: P, q: R) while touching(x, p) until touching(x, q)",
      "(x: Hand, p: P) while touching(x, p) until displacement(x) >= 2 m",
      "(x: Hand, p: P) while touching(x, p) until height(x) < height(x)@begin",
      "(x: Hand, p: P) while height(x) >= 1 m until touching(x, p) and height(x) > "
      "height(x)@begin"};
  std::string text = "grammar g\n";
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    for (const int bridging : {0, 1, 4, 9}) {
      text += "event e" + std::to_string(i) + "_" + std::to_string(bridging) + kRules[i] +
              " bridging " + std::to_string(bridging) + " ms\n";
    }
  }
  const CompileResult compiled = Compile({"g", text}, nullptr);
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  std::mt19937_64 random(20261126);
  for (int round = 0; round < 500; ++round) {
    const testing::RandomEpisode episode =
        testing::MakeEpisode(random, 60, 1 + static_cast<unsigned>(random() % 8));
    Monitor monitor(compiled.program, testing::RandomEntityTable());
    testing::EpisodeFeed feed(episode, monitor);
    std::vector<Event> events;
    while (!feed.done()) feed.Step(testing::Shown::kWhole, events);
    std::map<std::string, std::vector<Interval>> found;
    for (const Event& event : events) {
      if (event.roles[1] == 1)
        found[compiled.program->rules[event.rule].name].push_back(event.interval);
    }
    for (std::size_t i = 0; i < kRules.size(); ++i) {
      const std::string name = "e" + std::to_string(i) + "_";
      ASSERT_TRUE(Covers(found[name + "1"], found[name + "0"])) << kRules[i];
      ASSERT_TRUE(Covers(found[name + "4"], found[name + "1"])) << kRules[i];
      ASSERT_TRUE(Covers(found[name + "9"], found[name + "4"])) << kRules[i];
    }
  }
}

// `rule1` asks about others that are known late, but what it measures itself is known sooner.
TEST(Reference, WhoFollowsIsKnownNoLater) {
  const auto program = testing::CompileText(R"(grammar random
event rule0(x: Hand, p: P, q: Q, r: R)
  from touching(x, r) begins without (touching(x, q) or touching(x, r)) ends within 5 ms lasting 1 ms requires touching(x, p)
event rule1(x: Hand, q: Q, r: R)
  while rule0(x, any, q, r) until rate(height(x), 2 ms) >= rate(height(x), 2 ms)@begin + -250 m/s
event rule2(x: Hand, p: P, q: Q, r: R)
  from ((touching(x, p) or rule1(x, q, r)) ends) without ((touching(x, q) or rule1(x, q, r)) begins) within 5 ms
  during ((rate(height(x), 9 ms) >= -250 m/s or touching(x, r)) or height(x) >= height(x)@begin + 1 m)
  lasting 5 ms requires touching(x, r)
)");
  testing::RandomEpisode episode;
  const std::array<std::string, 4> touches = {
      ".###....###....................", "....#...........#...##...##....",
      "...#....####............###...#", "#################...##########."};
  for (std::size_t i = 0; i < touches.size(); ++i) {
    for (const char one : touches[i]) episode.touches[i].push_back(one == '#');
  }
  for (const char high : std::string("0000002222222222222222222222200"))
    episode.height_m.push_back(high - '0');
  episode.lost.assign(episode.height_m.size(), false);
  episode.grips = episode.lost;
  episode.ticks = {0,  1,  2,  3,  4,  10, 11, 13, 14, 16, 17, 18, 19, 20, 26, 27,
                   28, 34, 35, 36, 37, 40, 41, 42, 43, 44, 50, 51, 52, 53, 58, 59};
  const auto decided = [&](const std::shared_ptr<const Program>& by) {
    Monitor monitor(by, testing::RandomEntityTable());
    testing::EpisodeFeed feed(episode, monitor);
    std::vector<Event> events;
    while (!feed.done()) feed.Step(testing::Shown::kWhole, events);
    return testing::Lines(events, *program);
  };
  EXPECT_EQ(decided(program), decided(testing::Thorough(*program)));
}

// As long as the hand does not grip, `gripped` is known to be false, though `late` is not: who asks
// about it rests. When the hand grips, that is not known any more.
TEST(Reference, WhoRestsIsToldThatAnotherIsKnownNoLonger) {
  using testing::Scene;
  const std::string rules = R"(grammar t
condition late(h: Hand, o: Movable)
  from touching(o, h) ends to mean(height(o), 100 ms) > 55.3 mm begins within 67 ms
condition gripped(h: Hand, o: Movable) while late(h, o) and trigger(h) >= 0.4
condition above(h: Hand, o: Thing) while height(o) > 0 cm and height(h) < 1 m
event e(h: Hand, o: Thing) )";
  const std::pair<std::string, std::string> cases[] = {
      {"while above(h, o) and gripped(h, any) and height(o) < 50 cm", "280..300"},
      {"while above(h, o) until gripped(h, any) and height(o) < 50 cm", "20..280; 300..500"},
      {"while above(h, o) and not (gripped(h, any) and height(o) < 50 cm)", "20..280; 300..500"},
      {"from above(h, o) begins to (gripped(h, any) and height(o) < 50 cm) begins", "20..280"},
      {"from above(h, o) begins to height(o) > 5 m begins during not gripped(h, any)", "20..280"},
      {"from above(h, o) begins without (gripped(h, any) and height(o) < 50 cm) begins within 300 "
       "ms",
       ""}};
  const std::string touched = "...#.#..#.#..#...........", gripped = "....#####.....###########";
  for (const auto& [form, held] : cases) {
    Scene scene;
    const auto program = testing::CompileText(rules + form + "\n");
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    for (std::size_t i = 0; i < touched.size(); ++i) {
      scene.looks[Scene::kTray].p_WB_m.z() = i == 0 ? 0 : 0.07;
      scene.looks[Scene::kCup].p_WB_m.z() = i == 0 ? 0 : i < 10 ? 0.08 : i < 16 ? 0.02 : 0.12;
      scene.hand.trigger = gripped[i] == '#' ? 0.6 : 0;
      scene.touches.clear();
      if (touched[i] == '#') scene.touches = {{.a = Scene::kHand, .b = Scene::kCup}};
      monitor.Advance(scene.At(20 * static_cast<Tick>(i)), events);
    }
    monitor.Finish(500, events);
    for (const int thing : {Scene::kCup, Scene::kTray}) {
      std::string found;
      for (const Event& event : events) {
        if (program->rules[event.rule].name != "e" || event.roles[1] != thing) continue;
        found += (found.empty() ? "" : "; ") + std::to_string(event.interval.begin) + ".." +
                 std::to_string(event.interval.end);
      }
      EXPECT_EQ(found, held) << form << ", of " << scene.entity_table.entities[thing].name;
    }
  }
}

// `reference_run` does the same for as many ticks as one likes.
TEST(Reference, AgreesOnRandomGrammars) {
  const testing::TrialResult result = testing::TryRandomGrammars(20260101, 200'000);
  EXPECT_EQ(result.mismatches, 0) << result.Text() << "\n" << result.first;
  EXPECT_LT(result.refused, 2 * result.grammars);  // of each rule that nothing can come of
}

TEST(Reference, RandomGrammarsAgreeOnAllSmallEpisodes) {
  const testing::TrialResult result = testing::TryAllEpisodes(7, 40, 3);
  EXPECT_EQ(result.mismatches, 0) << result.Text() << "\n" << result.first;
}

}  // namespace
}  // namespace prehend::grammar
