// SPDX-License-Identifier: Apache-2.0
// What a person wrote into a golden survives the next acceptance.
#include "harness/accept_golden.h"

#include <gtest/gtest.h>

namespace prehend::harness {
namespace {

constexpr const char* kOld =
    R"(# scenario: slide/x
# grammar: pick_and_place
# derived: from the script
# accepted: 2026-01-31 "first"
# ticks_per_second: 480
# in the header
# event    begin_s  end_s   roles
# above the reach
reaching   0.5000   1.0000  hand=hand  object=cup  tolerance=20ms because "soft start"
# above the fixation
fixation   1.0000   1.5000  hand=hand  object=cup
# above the grasp
grasping   1.5000   3.0000  hand=hand  object=cup
# below
)";

Golden Old() { return ReadGolden("old", kOld).value.value(); }

grammar::Timeline Recognised(std::vector<grammar::NamedEvent> events) {
  for (auto& event : events) {
    event.roles = {{"hand", "hand"}, {"object", "cup"}};
    event.decided = event.interval.end + 7;
  }
  return {.ticks_per_second = 480, .events = std::move(events)};
}

const grammar::Timeline kShiftedWithoutFixation =
    Recognised({{.event = "reaching", .interval = {250, 500}},
                {.event = "grasping", .interval = {500, 1440}}});

TEST(ProposeGolden, KeepsWhatPeopleWrote) {
  const Golden golden =
      ProposeGolden(Old(), kShiftedWithoutFixation,
                    {.scenario = "slide/x",
                     .grammar = "pick_and_place",
                     .derived = {},
                     .acceptance = Acceptance{"2026-02-01", "no fixation any more"},
                     .notes = {}});
  EXPECT_EQ(WriteGolden(golden), R"(# scenario: slide/x
# grammar: pick_and_place
# derived: from the script
# accepted: 2026-01-31 "first"
# accepted: 2026-02-01 "no fixation any more"
# ticks_per_second: 480
# in the header
# event   begin_s  end_s   roles
# above the reach
reaching  0.5208   1.0417  hand=hand  object=cup  accepted=2  tolerance=20ms because "soft start"
# above the grasp
grasping  1.0417   3.0000  hand=hand  object=cup  accepted=2
# below
# was above fixation(hand, cup) 1.0000..1.5000 s, which is gone:
# above the fixation
)");
}

TEST(ProposeGolden, AnEventKeepsTheAcceptanceThatMadeItSo) {
  const auto recognised = Recognised({{.event = "reaching", .interval = {240, 480}},
                                      {.event = "fixation", .interval = {480, 720}},
                                      {.event = "grasping", .interval = {720, 1500}}});
  const Proposal proposal{.scenario = "slide/x",
                          .grammar = "pick_and_place",
                          .derived = {},
                          .acceptance = Acceptance{"2026-02-01", "a longer grasp"},
                          .notes = {}};
  const Golden golden = ProposeGolden(Old(), recognised, proposal);
  ASSERT_EQ(golden.events.size(), 3u);
  EXPECT_EQ(golden.events[0].accepted, 1);
  EXPECT_EQ(golden.events[1].accepted, 1);
  EXPECT_EQ(golden.events[2].accepted, 2);
  const Golden again = ProposeGolden(golden, recognised, proposal);
  EXPECT_EQ(again.events[2].accepted, 2);
}

TEST(ProposeGolden, StartsFromNothing) {
  const Golden golden = ProposeGolden(std::nullopt, kShiftedWithoutFixation,
                                      {.scenario = "slide/x",
                                       .grammar = "g",
                                       .derived = {"by eye"},
                                       .acceptance = {},
                                       .notes = {}});
  EXPECT_EQ(golden.derived, std::vector<std::string>{"by eye"});
  EXPECT_TRUE(golden.accepted.empty());
  EXPECT_EQ(golden.events.size(), 2u);
  EXPECT_EQ(ReadGolden("x", WriteGolden(golden)).value, golden);
}

TEST(ProposeGolden, WhatTheOracleSeesOtherwiseStandsInTheLineWithAReason) {
  Proposal proposal{.scenario = "slide/x",
                    .grammar = "g",
                    .derived = {},
                    .acceptance = Acceptance{"2026-02-01", "it bounces"},
                    .notes = {{kShiftedWithoutFixation.events[1], "+20.8/-4.2ms"}}};
  const Golden first = ProposeGolden(std::nullopt, kShiftedWithoutFixation, proposal);
  EXPECT_EQ(first.events[0].oracle, "");
  EXPECT_EQ(first.events[1].oracle, "+20.8/-4.2ms");
  EXPECT_EQ(first.events[1].oracle_because, "it bounces");
  EXPECT_EQ(ReadGolden("x", WriteGolden(first)).value, first);
  proposal.acceptance = Acceptance{"2026-02-02", "again"};
  EXPECT_EQ(ProposeGolden(first, kShiftedWithoutFixation, proposal).events[1].oracle_because,
            "it bounces")
      << "the reason stays with what it explains";
  proposal.notes.clear();
  EXPECT_EQ(ProposeGolden(first, kShiftedWithoutFixation, proposal).events[1].oracle, "")
      << "now they agree";
}

TEST(Fingerprint, TellsEveryTickAndEveryOldGoldenApart) {
  const Golden pending = PendingGolden(Old(), kShiftedWithoutFixation, "slide/x", "g");
  EXPECT_EQ(Fingerprint(pending).size(), 8u);
  EXPECT_EQ(Fingerprint(pending), Fingerprint(ReadGolden("x", WriteGolden(pending)).value.value()));
  auto a_tick_later = kShiftedWithoutFixation;
  a_tick_later.events[0].interval.begin += 1;
  EXPECT_NE(Fingerprint(PendingGolden(Old(), a_tick_later, "slide/x", "g")), Fingerprint(pending));
  EXPECT_NE(Fingerprint(PendingGolden(std::nullopt, kShiftedWithoutFixation, "slide/x", "g")),
            Fingerprint(pending));
}

TEST(SaysTheSame, IsExact) {
  const auto same = Recognised({{.event = "reaching", .interval = {240, 480}},
                                {.event = "fixation", .interval = {480, 720}},
                                {.event = "grasping", .interval = {720, 1440}}});
  EXPECT_TRUE(SaysTheSame(Old(), same));
  EXPECT_FALSE(SaysTheSame(Old(), kShiftedWithoutFixation));
  auto a_tick_later = same;
  a_tick_later.events[0].interval.begin += 1;  // within the line's tolerance, but not the same
  EXPECT_FALSE(SaysTheSame(Old(), a_tick_later));
}

}  // namespace
}  // namespace prehend::harness
