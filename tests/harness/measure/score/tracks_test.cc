// SPDX-License-Identifier: Apache-2.0
// Edit scores are of sequences: hands at the same time are two of them.
#include <gtest/gtest.h>

#include "harness/measure/score/score.h"

namespace prehend::measure {
namespace {

grammar::NamedEvent Of(const std::string& event, std::vector<grammar::Role> roles,
                       grammar::Tick begin, grammar::Tick end) {
  return {.event = event, .roles = std::move(roles), .interval = {begin, end}, .decided = end};
}
using Events = std::vector<grammar::NamedEvent>;

double Edit(Events truth, Events found) {
  const EpisodeToScore episode{"s/x", 1000, {100, std::move(truth)}, {100, std::move(found)}, {}};
  return ScoreOf("g", {episode}, 0.05).total.edit;
}

Events Hands(grammar::Tick left, grammar::Tick right, const char* role) {
  Events events = {Of("contact", {{"a", "cup"}, {role, "left"}}, left, 100),
                   Of("contact", {{"a", "cup"}, {role, "right"}}, right, 100)};
  if (right < left) std::swap(events[0], events[1]);
  return events;
}

TEST(Tracks, TwoHandsAFrameApartAreTwoSequences) {
  EXPECT_EQ(Edit(Hands(51, 50, "b"), Hands(50, 51, "b")), 100);
  EXPECT_EQ(Edit(Hands(51, 50, "hand"), Hands(50, 51, "hand")), 100);
}

// Of an event of the grammar, its one role of the class Hand; two hands do what neither does.
TEST(Tracks, TheClassSaysWhichRoleIsTheHand) {
  const truth::HandRoles hands =
      truth::HandRolesOf({{.name = "reach", .roles = {"h", "object"}, .classes = {"Hand", "Thing"}},
                          {.name = "give", .roles = {"h", "taker"}, .classes = {"Hand", "Hand"}},
                          {.name = "shown", .roles = {"hand", "who"}, .classes = {"Thing", "Hand"}},
                          {.name = "resting", .roles = {"hand"}, .classes = {"Thing"}}});
  const auto name = [&](const char* event, std::vector<grammar::Role> roles) {
    return truth::NameByHand(Of(event, std::move(roles), 0, 10), hands);
  };
  EXPECT_EQ(name("reach", {{"h", "left"}, {"object", "cup"}}), "reach of left");
  EXPECT_EQ(name("give", {{"h", "left"}, {"taker", "right"}}), "give");
  EXPECT_EQ(name("shown", {{"hand", "glove"}, {"who", "right"}}), "shown of right");
  EXPECT_EQ(name("resting", {{"hand", "glove"}}), "resting");
  EXPECT_EQ(name("somebody_elses", {{"hand", "left"}}), "somebody_elses of left");
  const Events two = {Of("reach", {{"h", "left"}, {"object", "cup"}}, 0, 10),
                      Of("reach", {{"h", "left"}, {"object", "can"}}, 20, 30)};
  EXPECT_EQ(TracksOf({100, two}, {100, two}, 1000).size(), 2u);
  EXPECT_EQ(TracksOf({100, two}, {100, two}, 1000, hands).size(), 1u);
}

// What lasts while others happen is no part of their sequence.
TEST(Tracks, WhatOverlapsIsNoSequence) {
  const std::vector<grammar::Role> roles = {{"hand", "right"}, {"object", "cup"}};
  const auto actions = [&](grammar::Tick grasp, grammar::Tick lift) {
    return Events{Of("grasping", roles, grasp, 400), Of("picking_up", roles, lift, 170),
                  Of("transporting", roles, 170, 300)};
  };
  EXPECT_EQ(Edit(actions(110, 150), actions(148, 147)), 100);
  const auto tracks = TracksOf({100, actions(110, 150)}, {100, actions(148, 147)}, 1000);
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].truth.size(), 1u);
  EXPECT_EQ(tracks[1].prediction.size(), 2u);
}

TEST(Tracks, AnOrderThatDiffersCosts) {
  const std::vector<grammar::Role> roles = {{"hand", "right"}};
  const Events truth = {Of("reach", roles, 0, 10), Of("grasp", roles, 10, 20),
                        Of("carry", roles, 20, 30)};
  EXPECT_NEAR(Edit(truth, {truth[0], Of("carry", roles, 10, 20), Of("grasp", roles, 20, 30)}),
              100.0 / 3, 1e-9);
  EXPECT_NEAR(Edit(truth, {truth[0], truth[1]}), 200.0 / 3, 1e-9);
  // The mean of a track that is right and of one that is not there.
  Events both = truth;
  both.push_back(Of("reach", {{"hand", "left"}}, 0, 10));
  EXPECT_EQ(Edit(both, truth), 50);
  EXPECT_EQ(Edit({}, {}), 100);
}

// Whether a false event comes first or last says nothing of how sure anybody was.
TEST(MeanAveragePrecision, DoesNotDependOnWhenAFalseEventHappens) {
  const Events truth = {Of("a", {}, 10, 20), Of("a", {}, 40, 50)};
  for (const grammar::Tick begin : {0, 25, 90}) {
    Events found = truth;
    found.push_back(Of("a", {}, begin, begin + 5));
    std::ranges::sort(found, {}, [](const auto& one) { return one.interval.begin; });
    EXPECT_NEAR(MeanAveragePrecision({Labelled({100, truth}, {100, found}, 100)}, 0.5), 2.0 / 3,
                1e-12)
        << begin;
  }
}

// As ActivityNet does it: all videos of a class together, and only classes of the truth.
TEST(MeanAveragePrecision, IsOfAllEpisodesTogether) {
  const auto a = Of("a", {}, 10, 20), b = Of("b", {}, 10, 20), c = Of("c", {}, 10, 20);
  const auto episode = [](const Events& truth, const Events& found) {
    return Labelled({100, truth}, {100, found}, 100);
  };
  const LabelledEpisode right = episode({a, b}, {a, b}), false_a = episode({}, {a}),
                        false_c = episode({}, {c}), with_c = episode({a}, {a, c});
  EXPECT_EQ(MeanAveragePrecision({right}, 0.5), 1);
  EXPECT_EQ(MeanAveragePrecision({right, false_a}, 0.5), 0.75) << "a: 1 of 2; b: 1";
  EXPECT_EQ(MeanAveragePrecision({right, false_c}, 0.5), 1) << "c is true nowhere";
  EXPECT_EQ(MeanAveragePrecision({with_c}, 0.5), 1) << "nor here";
  EXPECT_EQ(MeanAveragePrecision({false_c}, 0.5), 0) << "nothing is true";
  EXPECT_EQ(MeanAveragePrecision({}, 0.5), 1);
}

TEST(MeanOfKinds, CountsEachKindOnce) {
  const auto slide = [](grammar::Tick begin) { return Of("slide", {}, begin, begin + 10); };
  Events truth = {slide(0), slide(20), slide(40), Of("hold", {}, 0, 100)};
  const EpisodeToScore episode{
      "s/x", 1000, {100, truth}, {100, {truth[0], truth[1], truth[2]}}, {}};
  const Score score = ScoreOf("g", {episode}, 0.05);
  EXPECT_NEAR(score.total.overlap_50.F1(), 6.0 / 7, 1e-12);
  EXPECT_EQ(score.mean.f1_50, 0.5);
  EXPECT_EQ(score.mean.edit, 50);
  ASSERT_EQ(score.rows.size(), 1u);
  EXPECT_EQ(score.rows[0].hits.at("hold").missed, 1);
}

}  // namespace
}  // namespace prehend::measure
