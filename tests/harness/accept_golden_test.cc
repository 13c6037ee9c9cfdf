// SPDX-License-Identifier: Apache-2.0
// What a person wrote into a golden survives the next acceptance, and what the oracle objects to is
// answered.
#include "harness/accept_golden.h"

#include <gtest/gtest.h>

#include "harness/compare.h"
#include "harness/oracle_notes.h"

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

TEST(ProposeGolden, LinesThatAgreeStayByteForByte) {
  const std::string written = "fixation   1.0000   1.5000  hand=hand  object=cup";
  const std::string by_hand = "fixation 1 1.5   hand=hand object=cup";
  std::string text = kOld;
  text.replace(text.find(written), written.size(), by_hand);
  const auto recognised =
      Recognised({{.event = "reaching", .interval = {246, 474}},  // 12.5 ms, of 20
                  {.event = "fixation", .interval = {484, 716}},  // 8.3 ms, of 8.3
                  {.event = "grasping", .interval = {720, 1500}}});
  const Proposal proposal{.scenario = "slide/x",
                          .grammar = "pick_and_place",
                          .derived = {},
                          .acceptance = Acceptance{"2026-02-01", "a longer grasp"},
                          .notes = {},
                          .tolerance = 4};
  const Golden golden = ProposeGolden(ReadGolden("old", text).value, recognised, proposal);
  const std::string grasp = "grasping   1.5000   3.0000  hand=hand  object=cup\n";
  text.replace(text.find(grasp), grasp.size(),
               "grasping  1.5000   3.1250  hand=hand  object=cup  accepted=2\n");
  text.insert(text.find("# ticks_per_second"), "# accepted: 2026-02-01 \"a longer grasp\"\n");
  const std::string title = "# event    begin_s  end_s   roles";
  text.replace(text.find(title), title.size(), "# event   begin_s  end_s   roles");
  EXPECT_EQ(WriteGolden(golden), text);
  Proposal exact = proposal;
  exact.tolerance = 3;
  EXPECT_EQ(ProposeGolden(ReadGolden("old", text).value, recognised, exact).events[1].accepted, 3)
      << "a tick beyond the tolerance";
}

TEST(ProposeGolden, AnotherTickRateWritesEveryLineAnew) {
  auto recognised = Recognised({{.event = "reaching", .interval = {120, 240}},
                                {.event = "fixation", .interval = {240, 360}},
                                {.event = "grasping", .interval = {360, 720}}});
  recognised.ticks_per_second = 240;
  const Golden golden = ProposeGolden(Old(), recognised,
                                      {.scenario = "slide/x",
                                       .grammar = "g",
                                       .derived = {},
                                       .acceptance = Acceptance{"2026-02-01", "slower"},
                                       .notes = {},
                                       .tolerance = 2});
  EXPECT_EQ(golden.ticks_per_second, 240);
  EXPECT_EQ(golden.events[2].event.interval, (grammar::Interval{360, 720}));
  EXPECT_EQ(golden.events[2].accepted, 1) << "it is when it was";
  EXPECT_EQ(ReadGolden("x", WriteGolden(golden)).value, golden);
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

class WithOracle : public testing::Test {
 protected:
  Golden Proposed(const std::optional<Golden>& old, std::vector<OracleNote> notes) const {
    return PendingGolden(old, kShiftedWithoutFixation, "slide/x", "g",
                         {.agrees = false, .lines = {}, .notes = std::move(notes), .tolerance = 4});
  }
  const grammar::NamedEvent grasp_ = kShiftedWithoutFixation.events[1];
  const grammar::NamedEvent slide_ =
      Recognised({{.event = "sliding", .interval = {600, 700}}}).events[0];
};

TEST_F(WithOracle, WhatItSeesOtherwiseWantsAReasonAndKeepsIt) {
  Golden first = Proposed(std::nullopt, {{grasp_, "+20.8/-4.2ms"}});
  EXPECT_EQ(first.events[0].oracle, "");
  EXPECT_EQ(first.events[1].oracle, "+20.8/-4.2ms");
  EXPECT_EQ(first.events[1].oracle_because, kReasonWanted);
  EXPECT_EQ(ReadGolden("x", WriteGolden(first)).value, first);
  EXPECT_EQ(GiveReasons({"it bounces"}, first), "");
  EXPECT_EQ(first.events[1].oracle_because, "it bounces");
  EXPECT_EQ(Proposed(first, {{grasp_, "+20.8/-4.2ms"}}), first);
  EXPECT_EQ(Proposed(first, {{grasp_, "+25.0/+0.0ms"}}), first)
      << "within two frames it is the same";
  EXPECT_EQ(Proposed(first, {{grasp_, "+41.7/-4.2ms"}}).events[1].oracle_because, kReasonWanted)
      << "that was another objection";
  const Golden agrees = Proposed(first, {});
  EXPECT_EQ(agrees.events[1].oracle, "");
  EXPECT_EQ(Text(Objections(first, agrees)),
            "the oracle agrees by now, and the note oracle=+20.8/-4.2ms is out of date: "
            "grasping(hand, cup) 1.0417..3.0000 s\n");
  EXPECT_TRUE(Objections(first, first).empty());
}

TEST_F(WithOracle, WhatOnlyItSeesHasALineThatExpectsNothing) {
  Golden first = Proposed(std::nullopt, {{slide_, kOnlyOracle}});
  ASSERT_EQ(first.events.size(), 3u);
  EXPECT_EQ(first.events[2].event.event, "sliding");
  EXPECT_FALSE(first.events[2].IsExpected());
  EXPECT_EQ(Text(Objections(std::nullopt, first)),
            "only the oracle sees this event: sliding(hand, cup) 1.2500..1.4583 s\n");
  EXPECT_EQ(ToTimeline(first).events.size(), 2u);
  EXPECT_TRUE(Compare(first, kShiftedWithoutFixation, 4).Agrees());
  EXPECT_EQ(GiveReasons({"sliding(hand, cup): it is pushed"}, first), "");
  EXPECT_EQ(ReadGolden("x", WriteGolden(first)).value, first);
  auto a_frame_later = slide_;
  a_frame_later.interval.begin += 2;
  EXPECT_EQ(Proposed(first, {{a_frame_later, kOnlyOracle}}), first);
  first.events[2].comments = {"why it slides"};
  auto longer = slide_;
  longer.interval.end += 100;
  const Golden lengthened = Proposed(first, {{longer, kOnlyOracle}});
  EXPECT_EQ(lengthened.events[2].comments, first.events[2].comments);
  EXPECT_EQ(lengthened.closing_comments, first.closing_comments);
  const Golden gone = Proposed(first, {});
  EXPECT_EQ(gone.closing_comments.back(), "why it slides");
  EXPECT_EQ(gone.events.size(), 2u);
  EXPECT_EQ(Summary(Objections(first, gone)), "a note about the physical oracle is out of date");
}

TEST_F(WithOracle, EveryObjectionIsAnsweredOrNothingIs) {
  const Golden pending = Proposed(std::nullopt, {{grasp_, kNotOfOracle}, {slide_, kOnlyOracle}});
  const auto given = [&](const std::vector<std::string>& reasons) {
    Golden golden = pending;
    return GiveReasons(reasons, golden);
  };
  EXPECT_EQ(given({}), "the physical oracle objects to grasping(hand, cup), sliding(hand, cup)");
  EXPECT_EQ(given({"sliding(hand, cup): why"}),
            "the physical oracle objects to grasping(hand, cup)");
  EXPECT_EQ(given({"sliding(hand, cup): why", "the others: so"}), "");
  EXPECT_EQ(
      given({"sliding(hand, mug): why"}),
      "--against-the-oracle: the physical oracle does not object to sliding(hand, mug), but to "
      "grasping(hand, cup), sliding(hand, cup)");
  EXPECT_EQ(given({"a", "b"}), "--against-the-oracle gives two reasons for the same events");
  EXPECT_EQ(given({" "}), "--against-the-oracle needs a reason");
  Golden without = Proposed(std::nullopt, {});
  EXPECT_EQ(GiveReasons({"why"}, without),
            "--against-the-oracle: the physical oracle objects to nothing here");
  EXPECT_EQ(Summary(Objections(std::nullopt, pending)), "the physical oracle objects to 2 events");
}

TEST(Fingerprint, TellsEveryTickAndEveryOldGoldenApart) {
  const Derivation none;
  const Golden pending = PendingGolden(Old(), kShiftedWithoutFixation, "slide/x", "g", none);
  EXPECT_EQ(Fingerprint(pending).size(), 8u);
  EXPECT_EQ(Fingerprint(pending), Fingerprint(ReadGolden("x", WriteGolden(pending)).value.value()));
  auto a_tick_later = kShiftedWithoutFixation;
  a_tick_later.events[0].interval.begin += 1;
  EXPECT_NE(Fingerprint(PendingGolden(Old(), a_tick_later, "slide/x", "g", none)),
            Fingerprint(pending));
  EXPECT_NE(Fingerprint(PendingGolden(std::nullopt, kShiftedWithoutFixation, "slide/x", "g", none)),
            Fingerprint(pending));
}

}  // namespace
}  // namespace prehend::harness
