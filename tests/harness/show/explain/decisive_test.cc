// SPDX-License-Identifier: Apache-2.0
// The decisive clause, against a search that writes other numbers into the text of the grammar and
// watches again: on 200 random rules of every form and random episodes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "grammar/name_events.h"
#include "harness/show/explain/why_event.h"
#include "tests/harness/show/explain/explain_stage.h"

namespace prehend::show::testing {
namespace {

using grammar::Timeline;
using grammar::testing::Scene;

constexpr grammar::Tick kFrameTicks = 10;

/// Frames that can be watched by any program.
struct Play {
  std::vector<Scene> scenes;

  std::unique_ptr<grammar::ReplayMonitor> Watched(const std::string& text) {
    auto past = std::make_unique<grammar::ReplayMonitor>(grammar::testing::CompileText(text),
                                                         scenes.front().entity_table);
    for (std::size_t i = 0; i < scenes.size(); ++i)
      past->Advance(scenes[i].At(static_cast<grammar::Tick>(i) * kFrameTicks));
    past->Finish(static_cast<grammar::Tick>(scenes.size()) * kFrameTicks);
    return past;
  }
  std::optional<Timeline> Recognised(const std::shared_ptr<const grammar::Program>& program) {
    if (!program) return std::nullopt;
    grammar::Monitor monitor(program, scenes.front().entity_table);
    if (!monitor.error().empty()) return std::nullopt;
    std::vector<grammar::Event> events;
    for (std::size_t i = 0; i < scenes.size(); ++i)
      monitor.Advance(scenes[i].At(static_cast<grammar::Tick>(i) * kFrameTicks), events);
    monitor.Finish(static_cast<grammar::Tick>(scenes.size()) * kFrameTicks, events);
    return grammar::NameEvents(*program, scenes.front().entity_table, events);
  }
};

/// A text with `{}` where its numbers stand.
struct Template {
  std::string text;
  std::vector<double> numbers;

  std::string With(std::size_t changed, double value) const {
    std::string out;
    std::size_t next = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text.compare(i, 2, "{}") != 0) {
        out += text[i];
        continue;
      }
      const double number = next == changed ? value : numbers[next];
      char shown[40];
      std::snprintf(shown, sizeof shown, "%.17g", number);
      out += shown;
      ++next;
      ++i;
    }
    return out;
  }
  std::string Text() const { return With(numbers.size(), 0); }
  bool IsCount(std::size_t number) const {
    std::size_t at = 0;
    for (std::size_t i = 0; i <= number; ++i) at = text.find("{}", at + (i > 0 ? 2 : 0));
    return at >= 9 && text.compare(at - 9, 9, "at least ") == 0;
  }
  /// The line of a number; none has two.
  std::string PlaceOf(std::size_t number) const {
    std::size_t at = text.find("{}");
    for (std::size_t i = 0; i < number; ++i) at = text.find("{}", at + 2);
    const auto lines = std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
    return "test:" + std::to_string(lines + 1);
  }
};

class Cases {
 public:
  explicit Cases(unsigned seed) : random_(seed) {}

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::size_t Below(std::size_t n) { return random_() % n; }

  /// Smooth heights and grips, touches that come and go.
  Play Episode() {
    Play play;
    Scene scene;
    double z = Uniform(0.2, 0.8), v = 0, grip = Uniform(0.2, 0.8);
    bool touches = false;
    for (int frame = 0; frame < 60; ++frame) {
      v = 0.8 * v + Uniform(-0.04, 0.04);
      z = std::clamp(z + v, 0.05, 1.0);
      if (Below(8) == 0) grip = Uniform(0.1, 0.95);
      if (Below(9) == 0) touches = !touches;
      scene.looks[Scene::kCup].p_WB_m.z() = z;
      scene.hand.trigger = grip;
      scene.touches.clear();
      if (touches) scene.touches.push_back({.a = Scene::kHand, .b = Scene::kCup});
      play.scenes.push_back(scene);
    }
    return play;
  }

  Template Rule() {
    rule_ = {.text =
                 "grammar test\n"
                 "condition held(h: Hand, c: Cup) while touching(h, c)\n",
             .numbers = {}};
    const std::string head = "event e(h: Hand, c: Cup)\n  ";
    switch (Below(12)) {
      case 0:
        return Done(
            head,
            "while height(c) > {} m\n    and trigger(h) > {}\n  bridging {} s\n  lasting {} s",
            {Metre(), Grip(), Time(), 3 * Time()});
      case 1:
        return Done(
            head,
            "from held(h, c) begins\n  to (height(c) > {} m) begins\n  during held(h, c) or drop",
            {Metre()});
      case 2:
        return Done(
            "condition high(h: Hand, c: Cup)\n  while held(h, c) and height(c) > {} m\n  lasting "
            "{} "
            "s\n" +
                head,
            "from held(h, c) begins\n  to high(h, c) ends\n  during trigger(h) > {} or drop",
            {Metre(), Time(), Grip()});
      case 3:
        return Done(head, "from held(h, c) begins\n  to (trigger(h) > {}) begins\n  within {} s",
                    {Grip(), 2 * Time()});
      case 4:
        return Done(head,
                    "until held(h, c) begins\n  since height(c) > {} m\n  at most {} s back\n  "
                    "lasting {} s",
                    {Metre(), 4 * Time(), 2 * Time()});
      case 5:
        return Done(Two() + head,
                    "compose a: high(h, c), b: tight(h, c)\n  where a before within {} s b",
                    {Metre(), Grip(), Time()});
      case 6:
        return Done(Two() + head, "all of high(h, c), tight(h, c), held(h, c) within {} s",
                    {Metre(), Grip(), 3 * Time()});
      case 7:
        return Done(head, "repeat held(h, c) at least {},\n  gap at most {} s",
                    {Count(), 2 * Time()});
      case 8:
        return Done(head, "repeat held(h, c) at least {}\n  within {} s", {Count(), 5 * Time()});
      case 9:
        return Done(Two() + head, "rest of high(h, c) outside tight(h, c)\n  lasting {} s",
                    {Metre(), Grip(), 2 * Time()});
      case 10:
        return Done(head,
                    "from held(h, c) ends\n  without (height(c) > {} m) begins\n  within {} s",
                    {Metre(), 3 * Time()});
      default:
        return Done(head,
                    "while held(h, c)\n  requires rise(c) > {} m\n    or trigger(h) > {}\n  "
                    "lasting {} s to\n    {} s",
                    {0.3 * Metre(), Grip(), Time(), 6 * Time()});
    }
  }

 private:
  static std::string Two() {
    return "condition high(h: Hand, c: Cup)\n  while trigger(h) >= 0 and height(c) > {} m\n"
           "condition tight(h: Hand, c: Cup)\n  while height(c) >= 0 m and trigger(h) > {}\n";
  }
  Template Done(const std::string& head, const std::string& form, std::vector<double> numbers) {
    rule_.text += head + form + "\n";
    rule_.numbers = std::move(numbers);
    return rule_;
  }
  double Metre() { return Uniform(0.2, 1.1); }
  double Grip() { return Uniform(0.3, 0.99); }
  double Time() { return Uniform(0.02, 0.12); }
  double Count() { return 2 + static_cast<double>(Below(4)); }

  std::mt19937 random_;
  Template rule_;
};

/// By hundredths, all numbers at once: the first share at which some number makes the difference,
/// and the lines of those that do.
struct BruteForce {
  int hundredths = 0;
  std::set<std::string> lines;
};
BruteForce Search(const Template& rule, Play& play,
                  const std::function<bool(const Timeline&)>& is_as_wanted) {
  BruteForce found;
  for (int hundredths = 1; hundredths <= 99 && found.lines.empty(); ++hundredths) {
    for (std::size_t number = 0; number < rule.numbers.size(); ++number) {
      for (const bool up : {false, true}) {
        const double kept = 1 - hundredths / 100.0;
        double value = up ? rule.numbers[number] / kept : rule.numbers[number] * kept;
        if (rule.IsCount(number)) value = std::round(value);
        if (value == rule.numbers[number]) continue;
        const auto compiled = grammar::Compile({"test", rule.With(number, value)}, nullptr);
        const auto timeline = play.Recognised(compiled.program);
        if (!timeline || !is_as_wanted(*timeline)) continue;
        found.hundredths = hundredths;
        found.lines.insert(rule.PlaceOf(number));
      }
    }
  }
  return found;
}

TEST(Decisive, AgreesWithTryingEveryNumber) {
  Cases cases(51);
  int missing = 0, happened = 0, none = 0;
  for (int round = 0; round < 200; ++round) {
    Play play = cases.Episode();
    Template rule = cases.Rule();
    while (!grammar::Compile({"test", rule.Text()}, nullptr).program) rule = cases.Rule();
    const auto past = play.Watched(rule.Text());
    const auto recognise = [&](const auto& program) { return play.Recognised(program); };
    const std::vector<WhyEvent> events = ExplainEvents(*past, Asked(*past, "e"));
    std::optional<Decisive> decisive;
    BruteForce brute;
    if (events.empty() || cases.Below(3) == 0) {
      const double at_s = cases.Uniform(0, 0.59);
      char asked[40];
      std::snprintf(asked, sizeof asked, "e@%.3fs", at_s);
      const auto tick = static_cast<grammar::Tick>(std::lround(std::stod(asked + 2) * 1000));
      if (!ExplainEvents(*past, Asked(*past, asked)).empty()) {
        --round;
        continue;
      }
      WhyMissing why = ExplainMissing(*past, Asked(*past, asked));
      FindDecisive(*past, Asked(*past, asked), recognise, why);
      decisive = why.decisive;
      brute = Search(rule, play, [&](const Timeline& timeline) {
        return std::ranges::any_of(timeline.events, [&](const grammar::NamedEvent& event) {
          return event.event == "e" && event.interval.begin <= tick + 1 &&
                 tick <= event.interval.end;
        });
      });
      ++missing;
    } else {
      WhyEvent why = events.front();
      FindDecisive(*past, Asked(*past, "e"), recognise, why);
      decisive = why.decisive;
      brute = Search(rule, play, [&](const Timeline& timeline) {
        return std::ranges::none_of(timeline.events, [&](const grammar::NamedEvent& event) {
          return event.event == "e" && event.interval.begin < why.interval.end &&
                 why.interval.begin < event.interval.end;
        });
      });
      ++happened;
    }
    ASSERT_TRUE(decisive);
    EXPECT_EQ(decisive->clause.empty(), brute.lines.empty()) << rule.Text() << decisive->clause;
    if (brute.lines.empty() || decisive->clause.empty()) {
      ++none;
      continue;
    }
    EXPECT_TRUE(brute.lines.contains(decisive->where)) << rule.Text() << decisive->clause;
    EXPECT_LE(decisive->share, brute.hundredths / 100.0 + 1e-9) << rule.Text();
    EXPECT_GE(decisive->share, (brute.hundredths - 1) / 100.0) << rule.Text();
  }
  EXPECT_GT(missing, 60);
  EXPECT_GT(happened, 30);
  EXPECT_LT(none, 100);
}

// The cup comes to 302 mm, and has to come to 200 mm for 0.3 s. That the hold ends is no reason.
TEST(Decisive, OfADrinkingThatNeverReachedTheMouthNamesTheDistance) {
  const char* text =
      "grammar test\n"
      "condition grasping(hand: Hand, cup: Cup) while touching(hand, cup)\n"
      "event at_mouth(hand: Hand, cup: Cup, person: Movable)\n"
      "  while grasping(hand, cup) and distance(cup, person) <= 20 cm  lasting 0.3 s\n"
      "event drinking(hand: Hand, cup: Cup, person: Movable)\n"
      "  from grasping(hand, cup) begins to at_mouth(hand, cup, person) ends\n"
      "  during grasping(hand, cup) or drop\n";
  Play play;
  for (int frame = 0; frame < 200; ++frame) {
    Scene scene;
    scene.looks[Scene::kCup].p_WB_m.x() = std::max(0.302, 1 - 0.01 * std::min(frame, 180 - frame));
    if (frame >= 10 && frame < 180) scene.touches.push_back({.a = Scene::kHand, .b = Scene::kCup});
    play.scenes.push_back(scene);
  }
  const auto past = play.Watched(text);
  const Ask ask = Asked(*past, "drinking person=tray");
  WhyMissing why = ExplainMissing(*past, ask);
  EXPECT_TRUE(
      why.because.starts_with("distance(cup, tray) <= 0.2 m: is 302 mm, "
                              "102 mm above 200 mm"))
      << why.because;
  EXPECT_NE(Find(why.reasons, "to at_mouth(hand, cup, tray) ends"), nullptr);
  FindDecisive(
      *past, ask, [&](const auto& program) { return play.Recognised(program); }, why);
  ASSERT_TRUE(why.decisive);
  EXPECT_EQ(why.decisive->rule, "at_mouth");
  EXPECT_EQ(why.decisive->clause, "distance(cup, person) <= 0.2 m");
  EXPECT_EQ(why.decisive->where, "test:4");
  EXPECT_NEAR(why.decisive->instead, 0.302, 0.002);
}

// The parameter would have to be smaller in one clause, and not in the other.
TEST(Decisive, SaysWhereElseAParameterStands) {
  const char* text =
      "grammar test\n"
      "param far = 20 cm\n"
      "event away(thing: Movable, hand: Hand)\n"
      "  while distance(thing, hand) > far\n"
      "    and height(thing) > far\n";
  Play play;
  for (int frame = 0; frame < 20; ++frame) {
    Scene scene;
    scene.looks[Scene::kTray].p_WB_m.z() = 0.3;
    scene.looks[Scene::kHand].p_WB_m.z() = 0.101;
    play.scenes.push_back(scene);
  }
  const auto past = play.Watched(text);
  const Ask ask = Asked(*past, "away thing=tray");
  WhyMissing why = ExplainMissing(*past, ask);
  FindDecisive(
      *past, ask, [&](const auto& program) { return play.Recognised(program); }, why);
  ASSERT_TRUE(why.decisive);
  EXPECT_EQ(why.decisive->where, "test:4");
  EXPECT_EQ(why.decisive->param, "far");
  EXPECT_EQ(why.decisive->elsewhere, std::vector<std::string>{"test:5"});
  EXPECT_NE(Text(why, 1000).find(" it would have happened, if 'far' stayed as it is in test:5\n"),
            std::string::npos);
}

// The cup was away, but far too short; the tray is 1 mm too near all the time. So a threshold of
// 19.8 cm brings the tray's event, and it is the tray whose clauses are told.
TEST(Decisive, WhatIsToldIsOfThoseToWhomItWouldHaveHappened) {
  const char* text =
      "grammar test\n"
      "event away(thing: Movable, hand: Hand) while distance(thing, hand) > 20 cm lasting 0.1 s\n";
  Play play;
  for (int frame = 0; frame < 100; ++frame) {
    Scene scene;
    scene.looks[Scene::kCup].p_WB_m.x() = frame == 50 ? 0.5 : 0;
    scene.looks[Scene::kTray].p_WB_m.x() = 0.199;
    play.scenes.push_back(scene);
  }
  const auto past = play.Watched(text);
  const Ask ask = Asked(*past, "away");
  WhyMissing why = ExplainMissing(*past, ask);
  EXPECT_EQ(why.event, "away(cup, hand)");
  FindDecisive(
      *past, ask, [&](const auto& program) { return play.Recognised(program); }, why);
  EXPECT_EQ(why.event, "away(tray, hand)");
  EXPECT_TRUE(why.because.starts_with("distance(tray, hand) > 0.2 m: is 199 mm")) << why.because;
  ASSERT_TRUE(why.decisive);
  EXPECT_EQ(why.decisive->clause, "distance(thing, hand) > 0.2 m");
  EXPECT_EQ(why.decisive->instead, 0.198);
}

}  // namespace
}  // namespace prehend::show::testing
