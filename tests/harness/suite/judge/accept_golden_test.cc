// SPDX-License-Identifier: Apache-2.0
// What a person wrote into a golden survives the next acceptance, and the count of events that
// follow from the definitions is renewed when it is not true any more.
#include <gtest/gtest.h>

#include "harness/suite/judge/validate_golden.h"

namespace prehend::suite {
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

using Lines = std::vector<std::string>;

truth::Golden Old() { return truth::ReadGolden("old", kOld).value(); }

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

TEST(EventLines, HaveTheValuesThatAreAccepted) {
  truth::Golden golden = Old();
  golden.events.resize(1);
  golden.events[0].event.values = {{.name = "way", .value = 0.6002}};
  EXPECT_EQ(EventLines(golden), "reaching  0.5000  1.0000  hand=hand  object=cup    way=0.6002\n");
}

TEST(ProposeGolden, KeepsWhatPeopleWrote) {
  const truth::Golden golden =
      ProposeGolden(Old(), kShiftedWithoutFixation,
                    {.scenario = "slide/x",
                     .grammar = "pick_and_place",
                     .derived = {},
                     .acceptance = truth::Acceptance{"2026-02-01", "no fixation any more"}});
  EXPECT_EQ(truth::WriteGolden(golden), R"(# scenario: slide/x
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
                          .acceptance = truth::Acceptance{"2026-02-01", "a longer grasp"},
                          .tolerance = 4};
  const truth::Golden golden =
      ProposeGolden(truth::ReadGolden("old", text).value(), recognised, proposal);
  const std::string grasp = "grasping   1.5000   3.0000  hand=hand  object=cup\n";
  text.replace(text.find(grasp), grasp.size(),
               "grasping  1.5000   3.1250  hand=hand  object=cup  accepted=2\n");
  text.insert(text.find("# ticks_per_second"), "# accepted: 2026-02-01 \"a longer grasp\"\n");
  const std::string title = "# event    begin_s  end_s   roles";
  text.replace(text.find(title), title.size(), "# event   begin_s  end_s   roles");
  EXPECT_EQ(truth::WriteGolden(golden), text);
  Proposal exact = proposal;
  exact.tolerance = 3;
  EXPECT_EQ(
      ProposeGolden(truth::ReadGolden("old", text).value(), recognised, exact).events[1].accepted,
      3)
      << "a tick beyond the tolerance";
}

TEST(ProposeGolden, ExactTakesWhatMovedWithinTheTolerance) {
  const auto recognised =
      Recognised({{.event = "reaching", .interval = {246, 474}},  // 12.5 ms, of 20
                  {.event = "fixation", .interval = {480, 720}},  // where it was
                  {.event = "grasping", .interval = {722, 1440}}});
  const truth::Golden golden =
      ProposeGolden(Old(), recognised,
                    {.scenario = "slide/x",
                     .grammar = "pick_and_place",
                     .derived = {},
                     .acceptance = truth::Acceptance{"2026-02-01", "where they are now"},
                     .tolerance = 4,
                     .exact = true});
  const std::string text = truth::WriteGolden(golden);
  EXPECT_EQ(text.substr(text.find("# above the reach")), R"(# above the reach
reaching  0.5125   0.9875  hand=hand  object=cup  accepted=2  tolerance=20ms because "soft start"
# above the fixation
fixation   1.0000   1.5000  hand=hand  object=cup
# above the grasp
grasping  1.5042   3.0000  hand=hand  object=cup  accepted=2
# below
)");
}

TEST(ProposeGolden, AnotherTickRateWritesEveryLineAnew) {
  auto recognised = Recognised({{.event = "reaching", .interval = {120, 240}},
                                {.event = "fixation", .interval = {240, 360}},
                                {.event = "grasping", .interval = {360, 720}}});
  recognised.ticks_per_second = 240;
  const truth::Golden golden =
      ProposeGolden(Old(), recognised,
                    {.scenario = "slide/x",
                     .grammar = "g",
                     .derived = {},
                     .acceptance = truth::Acceptance{"2026-02-01", "slower"},
                     .tolerance = 2});
  EXPECT_EQ(golden.ticks_per_second, 240);
  EXPECT_EQ(golden.events[2].event.interval, (grammar::Interval{360, 720}));
  EXPECT_EQ(golden.events[2].accepted, 1) << "it is when it was";
  EXPECT_EQ(truth::ReadGolden("x", truth::WriteGolden(golden)).value(), golden);
}

TEST(ProposeGolden, StartsFromNothing) {
  const truth::Golden golden = ProposeGolden(
      std::nullopt, kShiftedWithoutFixation,
      {.scenario = "slide/x", .grammar = "g", .derived = {"by eye"}, .acceptance = {}});
  EXPECT_EQ(golden.derived, std::vector<std::string>{"by eye"});
  EXPECT_TRUE(golden.accepted.empty());
  EXPECT_EQ(golden.events.size(), 2u);
  EXPECT_EQ(truth::ReadGolden("x", truth::WriteGolden(golden)).value(), golden);
}

TEST(PendingGolden, RenewsTheOracleLineWhenItsCountIsNotTrueAnyMore) {
  truth::Golden old = Old();
  const auto derived = [&](const OracleComparison& truth) {
    return PendingGolden(old, kShiftedWithoutFixation, "slide/x", "g", truth).derived;
  };
  const OracleComparison agrees{.judged = 0}, one_differs{.judged = 1};
  const std::string one = "oracle: 0 of 1 events follow from the definitions of docs/events.md";
  EXPECT_EQ(derived(agrees), Lines({"from the script"})) << "no line says that all follow";
  EXPECT_EQ(derived(one_differs), Lines({"from the script", one}));
  old.derived.push_back("oracle: 4 of 5 events follow from what was known then");
  EXPECT_EQ(derived(one_differs), old.derived) << "one differs, as the golden says";
  EXPECT_EQ(derived(agrees).size(), 2u);
  EXPECT_NE(derived(agrees), old.derived);
}

TEST(Fingerprint, TellsEveryTickAndEveryOldGoldenApart) {
  const OracleComparison agrees;
  const truth::Golden pending =
      PendingGolden(Old(), kShiftedWithoutFixation, "slide/x", "g", agrees);
  EXPECT_EQ(Fingerprint(pending).size(), 16u);
  EXPECT_EQ(Fingerprint(pending),
            Fingerprint(truth::ReadGolden("x", truth::WriteGolden(pending)).value()));
  auto a_tick_later = kShiftedWithoutFixation;
  a_tick_later.events[0].interval.begin += 1;
  EXPECT_NE(Fingerprint(PendingGolden(Old(), a_tick_later, "slide/x", "g", agrees)),
            Fingerprint(pending));
  EXPECT_NE(
      Fingerprint(PendingGolden(std::nullopt, kShiftedWithoutFixation, "slide/x", "g", agrees)),
      Fingerprint(pending));
}

}  // namespace
}  // namespace prehend::suite
