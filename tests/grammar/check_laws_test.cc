// SPDX-License-Identifier: Apache-2.0
// Laws on made-up timelines: those of the library, each broken once, and what the forms mean.
#include "grammar/check_laws.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/grammar/corpus.h"

namespace prehend::grammar {
namespace {

NamedEvent Event(const std::string& event, std::vector<Role> roles, Tick begin, Tick end) {
  return {.event = event, .roles = std::move(roles), .interval = {begin, end}};
}

NamedEvent OfHand(const std::string& event, Tick begin, Tick end) {
  return Event(event, {{"hand", "hand"}, {"object", "cup"}}, begin, end);
}

EntityTable SmallEntityTable() {
  const auto thing = [](const std::string& name, const std::string& moves) {
    return EntityInfo{.name = name, .classes = {moves, "Thing", "Entity"}};
  };
  return {.entities = {{.name = "hand", .classes = {"Hand", "Entity"}},
                       {.name = "other_hand", .classes = {"Hand", "Entity"}},
                       thing("cup", "Movable"),
                       thing("book", "Movable"),
                       thing("shelf", "Fixed"),
                       thing("table", "Fixed")}};
}

std::string Violations(const Program& program, Timeline timeline) {
  Sort(timeline);
  std::string text;
  for (const LawViolation& violation : CheckLaws(program, SmallEntityTable(), timeline)) {
    text += violation.law->name + " " + std::to_string(violation.when.begin) + ".." +
            std::to_string(violation.when.end) + ": " + violation.what + "\n";
  }
  return text;
}

/// Reach, slide a little, lift, carry and put down again.
Timeline PickAndPlace() {
  return {.events = {
              Event("contact", {{"a", "cup"}, {"b", "table"}}, 0, 300),
              Event("supported_by", {{"object", "cup"}, {"support", "table"}}, 0, 300),
              OfHand("reaching", 50, 150),
              OfHand("fixation", 150, 200),
              OfHand("grasping", 200, 700),
              OfHand("sliding", 220, 300),
              OfHand("picking_up", 300, 400),
              OfHand("transporting", 400, 500),
              OfHand("putting_down", 500, 600),
              Event("contact", {{"a", "cup"}, {"b", "table"}}, 600, 1000),
              Event("supported_by", {{"object", "cup"}, {"support", "table"}}, 600, 1000),
          }};
}

NamedEvent& Find(Timeline& timeline, const std::string& event) {
  return *std::find_if(timeline.events.begin(), timeline.events.end(),
                       [&](const NamedEvent& candidate) { return candidate.event == event; });
}

TEST(CheckLaws, TheLibrarysHoldOfAnOrdinaryTimeline) {
  EXPECT_EQ(Violations(*testing::CompileLibrary("pick_and_place"), PickAndPlace()), "");
}

struct Break {
  const char* law;
  const char* violations;  ///< all of them
  void (*change)(Timeline& timeline);
};

const Break kBreaks[] = {
    {"phases_lie_inside_a_grasp",
     "phases_lie_inside_a_grasp 500..600: putting_down(hand, cup) lies inside no grasping(hand, "
     "cup)\n",
     [](Timeline& t) { Find(t, "grasping").interval.end = 590; }},
    {"phases_lie_inside_a_grasp",
     "phases_lie_inside_a_grasp 220..300: sliding(other_hand, cup) lies inside no "
     "grasping(other_hand, cup)\n",
     [](Timeline& t) { Find(t, "sliding").roles[0].value = "other_hand"; }},
    {"phases_do_not_overlap",
     "phases_do_not_overlap 390..400: transporting(hand, cup) overlaps picking_up(hand, cup)\n",
     [](Timeline& t) { Find(t, "transporting").interval.begin = 390; }},
    {"phases_cover_the_grasp",
     "phases_cover_the_grasp 400..410: grasping(hand, cup) lies outside supported_by(cup, any), "
     "picking_up(hand, cup), hovering(hand, cup), transporting(hand, cup), putting_down(hand, "
     "cup)\n",
     [](Timeline& t) { Find(t, "transporting").interval.begin = 410; }},
    {"slides_are_supported",
     "slides_are_supported 220..310: sliding(hand, cup) lies inside no supported_by(cup, any)\n",
     [](Timeline& t) { Find(t, "sliding").interval.end = 310; }},
    {"phases_do_not_overlap",
     "phases_do_not_overlap 290..300: picking_up(hand, cup) overlaps supported_by(cup, any)\n",
     [](Timeline& t) { Find(t, "picking_up").interval.begin = 290; }},
    {"reaches_meet_what_follows",
     "reaches_meet_what_follows 50..149: reaching(hand, cup) meets no fixation(hand, cup) and no "
     "grasping(hand, cup)\n",
     [](Timeline& t) { Find(t, "reaching").interval.end = 149; }},
    {"fixations_meet_a_grasp",
     "fixations_meet_a_grasp 150..199: fixation(hand, cup) meets no grasping(hand, cup)\n",
     [](Timeline& t) { Find(t, "fixation").interval.end = 199; }},
    {"supports_lie_inside_contacts",
     "supports_lie_inside_contacts 0..300: supported_by(cup, table) lies inside no contact(cup, "
     "table)\n",
     [](Timeline& t) { Find(t, "contact").interval.begin = 1; }},
};

TEST(CheckLaws, EachOfTheLibrarysIsFoundBroken) {
  const auto program = testing::CompileLibrary("pick_and_place");
  for (const Break& each : kBreaks) {
    Timeline timeline = PickAndPlace();
    each.change(timeline);
    EXPECT_EQ(Violations(*program, timeline), each.violations) << each.law;
  }
  for (const Law& law : program->laws) {
    EXPECT_TRUE(std::any_of(std::begin(kBreaks), std::end(kBreaks),
                            [&](const Break& each) { return law.name == each.law; }))
        << law.name << " belongs into the table above, too";
  }
}

TEST(CheckLaws, AHeldFixtureNeedsNoPhase) {
  const auto program = testing::CompileLibrary("pick_and_place");
  Timeline timeline{.events = {OfHand("grasping", 200, 700)}};
  EXPECT_NE(Violations(*program, timeline), "");
  timeline.events[0].roles[1].value = "shelf";
  EXPECT_EQ(Violations(*program, timeline), "");
}

TEST(CheckLaws, WhatTwoSupportsBearTogetherIsSupportedThroughout) {
  const auto program = testing::CompileLibrary("pick_and_place");
  Timeline timeline = PickAndPlace();
  Find(timeline, "supported_by").interval.end = 230;
  timeline.events.push_back(
      Event("supported_by", {{"object", "cup"}, {"support", "book"}}, 229, 300));
  timeline.events.push_back(Event("contact", {{"a", "book"}, {"b", "cup"}}, 229, 300));
  EXPECT_EQ(Violations(*program, timeline), "");
}

/// Laws over three events that a timeline may have in any way.
std::shared_ptr<const Program> WithLaws(const std::string& laws) {
  CompileResult compiled =
      Compile({"g",
               "grammar g\n"
               "symmetric event near(a: Movable, b: Movable) while touching(a, b)\n"
               "event holds(hand: Hand, object: Thing) while touching(hand, object)\n"
               "event on(object: Movable, place: Thing) while touching(object, place)\n" +
                   laws},
              nullptr);
  EXPECT_TRUE(compiled.program) << Format(compiled.diagnostics);
  return compiled.program;
}

std::string ViolationsOf(const std::string& laws, std::vector<NamedEvent> events) {
  return Violations(*WithLaws(laws), {.events = std::move(events)});
}

NamedEvent Holds(const std::string& hand, const std::string& object, Tick begin, Tick end) {
  return Event("holds", {{"hand", hand}, {"object", object}}, begin, end);
}

NamedEvent On(const std::string& object, const std::string& place, Tick begin, Tick end) {
  return Event("on", {{"object", object}, {"place", place}}, begin, end);
}

TEST(CheckLaws, TwoRolesAreNeverTheSameEntity) {
  const std::string law =
      "law one_hand(a: Hand, b: Hand, object: Thing) holds(a, object), holds(b, object) do not "
      "overlap";
  EXPECT_EQ(ViolationsOf(law, {Holds("hand", "cup", 0, 10), Holds("hand", "cup", 5, 15)}), "");
  EXPECT_EQ(ViolationsOf(law, {Holds("hand", "cup", 0, 10), Holds("other_hand", "book", 5, 15)}),
            "");
  EXPECT_EQ(ViolationsOf(law, {Holds("hand", "cup", 0, 10), Holds("other_hand", "cup", 10, 15)}),
            "");
  // Either hand may be a; it is one violation.
  EXPECT_EQ(ViolationsOf(law, {Holds("hand", "cup", 0, 10), Holds("other_hand", "cup", 5, 15)}),
            "one_hand 5..10: holds(other_hand, cup) overlaps holds(hand, cup)\n");
}

TEST(CheckLaws, ClassesSayForWhomALawHolds) {
  const std::string law =
      "law held_things_stand(object: Movable) on(object, any) lies inside holds(any, object)";
  const std::string shelf_only =
      "law only_shelves(object: Movable, hand: Hand) holds(hand, object) meets on(object, any "
      "Shelf)";
  EXPECT_EQ(ViolationsOf(law, {Holds("hand", "shelf", 0, 10)}), "");
  EXPECT_EQ(ViolationsOf(law, {On("cup", "table", 0, 10), Holds("hand", "cup", 0, 10)}), "");
  EXPECT_EQ(ViolationsOf(law, {On("cup", "table", 0, 11), Holds("hand", "cup", 0, 10)}),
            "held_things_stand 0..11: on(cup, any) lies inside no holds(any, cup)\n");
  EXPECT_EQ(ViolationsOf(shelf_only, {Holds("hand", "cup", 0, 10), On("cup", "table", 10, 20)}),
            "only_shelves 0..10: holds(hand, cup) meets no on(cup, any Shelf)\n");
}

TEST(CheckLaws, ASymmetricEventIsTheSameInEitherOrder) {
  const std::string law =
      "law neighbours_stand(a: Movable, b: Movable) near(a, b) lies inside on(a, b)";
  const NamedEvent near = Event("near", {{"a", "book"}, {"b", "cup"}}, 2, 8);
  EXPECT_EQ(ViolationsOf(law, {near, On("cup", "book", 0, 10)}),
            "neighbours_stand 2..8: near(book, cup) lies inside no on(book, cup)\n");
  const std::string either =
      "law one_stands(a: Movable, b: Movable) near(a, b) lies inside on(a, b) or on(b, a)";
  EXPECT_EQ(ViolationsOf(either, {near, On("cup", "book", 0, 10)}), "");
  EXPECT_EQ(ViolationsOf(either, {near}),
            "one_stands 2..8: near(book, cup) lies inside no on(book, cup) and no on(cup, book)\n"
            "one_stands 2..8: near(cup, book) lies inside no on(cup, book) and no on(book, cup)\n");
}

TEST(CheckLaws, RelationsAreAllens) {
  const std::string law =
      "law put_then_held(hand: Hand, object: Movable) holds(hand, object) met_by|after on(object, "
      "any)";
  EXPECT_EQ(ViolationsOf(law, {On("cup", "table", 0, 10), Holds("hand", "cup", 10, 20)}), "");
  EXPECT_EQ(ViolationsOf(law, {On("cup", "table", 0, 10), Holds("hand", "cup", 12, 20)}), "");
  EXPECT_EQ(ViolationsOf(law, {On("cup", "table", 0, 10), Holds("hand", "cup", 9, 20)}),
            "put_then_held 9..20: holds(hand, cup) met_by|after no on(cup, any)\n");
}

TEST(CheckLaws, AreThoseOfTheGrammarsThatAreUsed) {
  std::vector<std::string> names;
  const auto containers = testing::CompileLibrary("containers");
  for (const Law& law : containers->laws) names.push_back(law.name);
  EXPECT_EQ(names, std::vector<std::string>{"supports_lie_inside_contacts"});
  EXPECT_TRUE(testing::CompileLibrary("original_2020")->laws.empty());
}

}  // namespace
}  // namespace prehend::grammar
