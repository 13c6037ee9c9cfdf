// SPDX-License-Identifier: Apache-2.0
// Goldens as text: what is written is read back the same, and every mistake in a file is found
// where it is.
#include "harness/truth/golden/golden.h"

#include <gtest/gtest.h>

#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

constexpr const char* kCanonical =
    R"(# scenario: pick_and_place/milk_carton_wrap
# grammar: pick_and_place
# derived: the carton stands on the table from the first frame on
# derived: the reach begins with the hand's first motion
# accepted: 2026-01-31 "first golden, \"by eye\""
# accepted: 2026-02-01 "the contact gap became 100 ms"
# pictures: 2026-02-02 "the carton is seen in the hand"
# ensemble: 6 plays
# unsteady: "the \"last\" touch"
# ticks_per_second: 480
# anything else that somebody wrote
#
# event       begin_s  end_s   roles
supported_by  0.0000   2.0125  object=milk      support=table
# the hand starts to move after half a second
reaching      0.5000   1.2000  hand=right_hand  object=milk                tolerance=20ms because "soft start"
grasping      1.2021   4.3000  hand=right_hand  object=milk    style=wrap  force~12.5N  share~0.25  accepted=2  spread=0.0/12.5ms
contact       2.0000   5.0000  a=milk           b=table                    open_end  tolerance=0ms because "exact"
# the end
)";

Golden Read(const std::string& text) {
  auto result = ReadGolden("x.timeline", text);
  EXPECT_EQ(Format(ErrorsOf(result)), "");
  return result.value_or(Golden{});
}

TEST(Golden, IsReadAsWritten) {
  const Golden golden = Read(kCanonical);
  EXPECT_EQ(golden.scenario, "pick_and_place/milk_carton_wrap");
  EXPECT_EQ(golden.grammar, "pick_and_place");
  EXPECT_EQ(golden.derived.size(), 2u);
  ASSERT_EQ(golden.accepted.size(), 2u);
  EXPECT_EQ(golden.accepted[0], (Acceptance{"2026-01-31", "first golden, \"by eye\""}));
  ASSERT_EQ(golden.events.size(), 4u);
  EXPECT_EQ(golden.events[1].event.Label(), "reaching(right_hand, milk)");
  EXPECT_EQ(golden.events[1].event.interval, (grammar::Interval{240, 576}));
  EXPECT_EQ(golden.events[1].tolerance_ms, 20);
  EXPECT_EQ(golden.events[1].because, "soft start");
  EXPECT_EQ(golden.events[1].comments,
            std::vector<std::string>{"the hand starts to move after half a second"});
  EXPECT_EQ(RoleValue(golden.events[2].event, "style"), "wrap");
  EXPECT_EQ(golden.events[2].event.values,
            (std::vector<grammar::NamedValue>{{"force", 12.5, "N"}, {"share", 0.25, ""}}));
  EXPECT_EQ(golden.events[1].accepted, 1);
  EXPECT_EQ(golden.events[2].accepted, 2);
  EXPECT_EQ(golden.ensemble_plays, 6);
  EXPECT_EQ(golden.unsteady, "the \"last\" touch");
  EXPECT_EQ(golden.events[1].spread, Spread());
  EXPECT_EQ(golden.events[2].spread, (Spread{0, 12.5}));
  EXPECT_TRUE(golden.events[3].event.open_end);
  EXPECT_EQ(golden.events[3].because, "exact");
  EXPECT_EQ(golden.pictures,
            (std::vector<Acceptance>{{"2026-02-02", "the carton is seen in the hand"}}));
  EXPECT_EQ(golden.closing_comments, std::vector<std::string>{"the end"});
}

TEST(Golden, WriterIsCanonicalAndReaderItsInverse) {
  Golden golden = Read(kCanonical);
  for (GoldenEvent& line : golden.events) line.as_written.clear();
  EXPECT_EQ(WriteGolden(golden), kCanonical);
  EXPECT_EQ(Read(WriteGolden(golden)), golden);
}

// What is fixed weighs that much; and a value may be called like a word of the format.
TEST(Golden, AValueMayBeInfiniteAndHaveAnyName) {
  Golden golden = Read(kCanonical);
  golden.events[0].as_written.clear();
  golden.events[0].event.values = {{"weight", HUGE_VAL, "N"}, {"because", -HUGE_VAL, ""}};
  const std::string text = WriteGolden(golden);
  EXPECT_NE(text.find("weight~infN  because~-inf\n"), std::string::npos) << text;
  EXPECT_EQ(Read(text).events[0].event.values, golden.events[0].event.values);
}

TEST(Golden, OrderAndSpacingOfAFileDoNotMatter) {
  const Golden golden = Read(
      "# scenario: s/x\n# grammar: g\n# ticks_per_second: 480\n\n"
      "  contact 1 2 a=cup b=table\n\nsupported_by\t0.5 2 object=cup support=table");
  ASSERT_EQ(golden.events.size(), 2u);
  EXPECT_EQ(golden.events[0].event.event, "supported_by");
  EXPECT_EQ(golden.events[1].event.interval, (grammar::Interval{480, 960}));
}

TEST(Golden, EveryTickOfEveryRateRoundTrips) {
  for (const grammar::Tick rate : {60, 240, 480, 999, 4800, 100'000}) {
    for (const grammar::Tick tick : {0, 1, 2, 7, 479, 4799, 12'345, 17'279'999}) {
      EXPECT_EQ(TickAt(std::stod(SecondsText(tick, rate)), rate), tick) << tick << " at " << rate;
    }
  }
}

struct Mistake {
  const char* name;
  const char* line;  ///< put below a correct header
  const char* complaint;
};

class GoldenMistake : public testing::TestWithParam<Mistake> {};

TEST_P(GoldenMistake, IsFoundWhereItIs) {
  const std::string text = std::string("# scenario: s/x\n# grammar: g\n# ticks_per_second: 480\n") +
                           GetParam().line + "\n";
  const auto result = ReadGolden("x.timeline", text);
  ASSERT_FALSE(result);
  ASSERT_EQ(result.error().size(), 1u) << Format(result.error());
  const auto& diagnostic = result.error()[0];
  const std::string hint = diagnostic.hint.empty() ? "" : " | " + diagnostic.hint;
  EXPECT_EQ(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) +
                ": " + diagnostic.message + hint,
            GetParam().complaint);
  EXPECT_EQ(diagnostic.source_line, GetParam().line);
}

std::string NameOfMistake(const testing::TestParamInfo<Mistake>& row) { return row.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Table, GoldenMistake,
    testing::Values(
        Mistake{"no_name", "=1 2", "4:1: expected an event's name"},
        Mistake{"version", "# version: 2", "4:12: found version 2 of the format, wanted 1"},
        Mistake{"no_begin", "contact a=cup", "4:9: expected begin_s, a time in seconds"},
        Mistake{"no_end", "contact 1.0", "4:12: expected end_s, a time in seconds"},
        Mistake{"negative", "contact -1 2 a=cup", "4:9: expected begin_s, a time in seconds"},
        Mistake{"not_finite", "contact 1 inf a=cup", "4:11: expected end_s, a time in seconds"},
        Mistake{"off_tick", "contact 1.231 2 a=cup",
                "4:9: begin_s is not on a tick of 1/480 s | the nearest tick is at 1.2312"},
        Mistake{"empty_interval", "contact 1 1 a=cup", "4:1: the event must end after it begins"},
        Mistake{"no_roles", "contact 1 2", "4:12: an event needs at least one role=value"},
        Mistake{"no_equals", "contact 1 2 cup",
                "4:16: expected '=' after 'cup' | ROLE=NAME without blanks, or open_end"},
        Mistake{"no_value", "contact 1 2 a= b=cup", "4:15: expected a value for 'a'"},
        Mistake{"no_number", "contact 1 2 a=cup force~much",
                "4:25: expected a number after 'force~', like 12.5N"},
        Mistake{"nan", "contact 1 2 a=cup force~nanN",
                "4:25: expected a number after 'force~', like 12.5N"},
        Mistake{"value_twice", "contact 1 2 a=cup force~1N force~2N", "4:28: second 'force'"},
        Mistake{"accepted_by_nobody", "contact 1 2 a=cup accepted=2",
                "4:28: expected which of the 0 'accepted' lines it is from"},
        Mistake{"spread_of_one", "contact 1 2 a=cup spread=3ms",
                "4:26: a spread is how far begin and end moved, in milliseconds, like 0.0/12.5ms"},
        Mistake{"spread_negative", "contact 1 2 a=cup spread=-1/3ms",
                "4:26: a spread is how far begin and end moved, in milliseconds, like 0.0/12.5ms"},
        Mistake{"role_twice", "contact 1 2 a=cup a=cup", "4:19: second 'a'"},
        Mistake{"tolerance_twice",
                "contact 1 2 a=cup tolerance=20ms because \"x\" tolerance=90ms because \"y\"",
                "4:46: second 'tolerance'"},
        Mistake{"accepted_twice", "contact 1 2 a=cup accepted=1 accepted=1",
                "4:30: second 'accepted'"},
        Mistake{"open_end_twice", "contact 1 2 a=cup open_end open_end", "4:28: second 'open_end'"},
        Mistake{"comment_behind", "contact 1 2 a=cup # why",
                "4:19: comments stand on lines of their own"},
        Mistake{"tolerance_unit", "contact 1 2 a=cup tolerance=20",
                "4:29: a tolerance is whole milliseconds up to 10000, like 20ms"},
        Mistake{"tolerance_unexplained", "contact 1 2 a=cup tolerance=20ms",
                "4:33: a tolerance needs a reason | tolerance=20ms because \"the reason\""},
        Mistake{"open_end_misspelt", "contact 1 2 a=cup open_ned",
                "4:27: expected '=' after 'open_ned' | did you mean 'open_end'?"},
        Mistake{"reason_empty", "contact 1 2 a=cup tolerance=20ms because \"\"",
                "4:42: the reason is empty"},
        Mistake{"reason_unquoted", "contact 1 2 a=cup tolerance=20ms because soft",
                "4:42: expected a reason in double quotes"},
        Mistake{"quote_open", "contact 1 2 a=cup tolerance=20ms because \"so",
                "4:42: the closing quote is missing"},
        Mistake{"reason_alone", "contact 1 2 a=cup because \"soft\"",
                "4:19: 'because' gives the reason of a tolerance, but none stands before it"},
        Mistake{"reason_of_nothing_more",
                "contact 1 2 a=cup tolerance=20ms because \"soft\" because \"hard\"",
                "4:49: 'because' gives the reason of a tolerance, but none stands before it"},
        Mistake{"oracle", "contact 1 2 a=cup oracle=none because \"x\"",
                "4:19: a line no longer says how it differs from the physical oracle | remove "
                "'oracle=' and its reason; the header counts the events that follow from the "
                "definitions"},
        Mistake{"rate_twice", "# ticks_per_second: 240", "4:21: second 'ticks_per_second' line"},
        Mistake{"scenario_twice", "# scenario: s/y", "4:13: second 'scenario' line"},
        Mistake{"bad_date", "# accepted: today \"ok\"",
                "4:13: expected the date of the acceptance, YYYY-MM-DD"},
        Mistake{"accepted_tail", "# accepted: 2026-01-31 \"ok\" yes",
                "4:29: unexpected text at the end of the line"}),
    NameOfMistake);

TEST(Golden, AnEventListedTwiceIsAMistake) {
  const auto result = ReadGolden(
      "x",
      "# scenario: s/x\n# grammar: g\n# ticks_per_second: 480\ncontact 1 2 a=b\ncontact 1 2 a=b\n");
  ASSERT_FALSE(result);
  ASSERT_EQ(result.error().size(), 1u);
  EXPECT_EQ(result.error()[0].place.line, 5);
  EXPECT_EQ(result.error()[0].message, "this event is listed twice");
}

TEST(Golden, HeaderLinesThatAreNeeded) {
  const auto result = ReadGolden("x", "# a comment\n");
  ASSERT_FALSE(result);
  ASSERT_EQ(result.error().size(), 3u);
  EXPECT_EQ(result.error()[0].message, "the line '# scenario: skill/name' is missing");
  EXPECT_EQ(result.error()[1].message, "the line '# grammar: name' is missing");
  EXPECT_EQ(result.error()[2].message, "the line '# ticks_per_second: N' is missing");

  const auto misspelt = ReadGolden("x", "# scenaro: s/x\n#\tgrammar: g\n# ticks_per_second: 480\n");
  ASSERT_FALSE(misspelt);
  ASSERT_EQ(misspelt.error().size(), 2u);
  EXPECT_EQ(Format(misspelt.error()),
            "x:1:3: error: the line '# scenario: skill/name' is missing\n  # scenaro: s/x\n    ^\n"
            "  hint: write '# scenario: ', with these blanks\n"
            "x:2:3: error: the line '# grammar: name' is missing\n  #\tgrammar: g\n   \t^\n"
            "  hint: write '# grammar: ', with these blanks\n");

  const auto early = ReadGolden("x", "contact 1 2 a=b\ncontact 2 3 a=b\n");
  ASSERT_FALSE(early);
  ASSERT_EQ(early.error().size(), 1u);
  EXPECT_EQ(early.error()[0].message, "an event before the line '# ticks_per_second: N'");
}

TEST(Golden, BinaryAndEmptyFilesAreRefused) {
  EXPECT_FALSE(ReadGolden("x", ""));
  EXPECT_FALSE(ReadGolden("x", std::string("\0\1\2", 3)));
}

}  // namespace
}  // namespace prehend::truth
