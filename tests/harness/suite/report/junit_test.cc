// SPDX-License-Identifier: Apache-2.0
// The XML in full, as the schema of JUnit files wants it.
#include <gtest/gtest.h>

#include "harness/suite/report/report.h"

namespace prehend::suite {
namespace {

/// A golden that expects a slide from 0.1 to 0.2 s, and what was recognised instead.
truth::Comparison Compared(const std::string& event, grammar::Interval interval,
                           bool open_end = false) {
  const grammar::NamedEvent expected{
      .event = "sliding", .roles = {{"hand", "hand"}, {"object", "cup"}}, .interval = {100, 200}};
  grammar::NamedEvent actual = expected;
  actual.event = event;
  actual.interval = interval;
  actual.open_end = open_end;
  truth::Golden golden{.scenario = "slide/x", .grammar = "g", .ticks_per_second = 1000};
  golden.events.push_back({.event = expected, .tolerance_ms = {}, .because = {}, .comments = {}});
  return truth::Compare(golden, {.ticks_per_second = 1000, .events = {actual}}, 10);
}

TEST(Junit, HasEveryKindOfOutcome) {
  std::vector<ScenarioVerdict> verdicts(4);
  verdicts[0] = {.scenario = "slide/good", .shows = {}, .verdict = Verdict::kPassed};
  verdicts[0].has_golden = true;
  verdicts[0].comparison = Compared("sliding", {100, 204});
  verdicts[0].seconds = 0.25;
  verdicts[1] = {.scenario = "slide/bad",
                 .file = "scenarios/slide/bad.yaml",
                 .shows = {},
                 .verdict = Verdict::kFailed};
  verdicts[1].exit_code = ExitCode::kDiffers;
  verdicts[1].reason = "\"1\" < 2 & 3\x1b\xff";
  verdicts[1].details = "shifted a -> b\n";
  verdicts[1].command = "prehend check slide/bad";
  verdicts[1].seconds = 1;
  verdicts[1].claims = {{.claim = "no sliding",
                         .place = "scenarios/slide/bad.yaml:31",
                         .says = truth::kContradicted,
                         .found = "found 1",
                         .times = {}}};
  verdicts[2] = {.scenario = "alone", .shows = {}, .verdict = Verdict::kFailed};
  verdicts[2].exit_code = ExitCode::kFailure;
  verdicts[2].reason = "its process ended";
  verdicts[2].command = "prehend check alone";
  verdicts[3] = {.scenario = "slide/old", .shows = {}, .verdict = Verdict::kUnchanged};
  EXPECT_EQ(JunitXml(verdicts), R"(<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="prehend" tests="4" failures="1" errors="1" time="1.250">
  <testsuite name="prehend check" tests="4" failures="1" errors="1" skipped="1" time="1.250">
    <testcase classname="slide" name="good" file="" line="1" time="0.250">
      <system-out>margin: 6.0 of 10.0 ms left at end of sliding(hand, cup)</system-out>
    </testcase>
    <testcase classname="slide" name="bad" file="scenarios/slide/bad.yaml" line="31" time="1.000">
      <failure type="failed" message="&quot;1&quot; &lt; 2 &amp; 3��; first: shifted a -> b">shifted a -&gt; b
again: prehend check slide/bad
</failure>
    </testcase>
    <testcase classname="scenarios" name="alone" file="" line="1" time="0.000">
      <error type="failed" message="its process ended">again: prehend check alone
</error>
    </testcase>
    <testcase classname="slide" name="old" file="" line="1" time="0.000">
      <skipped message="nothing changed since it passed" />
    </testcase>
  </testsuite>
</testsuites>
)");
}

TEST(Junit, TheMessageTellsTheFirstDivergence) {
  ScenarioVerdict verdict{.scenario = "slide/bad", .shows = {}, .verdict = Verdict::kFailed};
  verdict.reason = "2 of 3 events differ from the golden";
  verdict.details = "shifted ..";
  verdict.has_golden = true;
  verdict.comparison = Compared("sliding", {120, 200}, true);
  EXPECT_NE(
      JunitXml({verdict}).find(
          "message=\"2 of 3 events differ from the golden; first: changed sliding(hand, cup): "
          "expected 0.1000..0.2000 s, recognised 0.1200..0.2000 s, begin +20.0 ms, end +0.0 "
          "ms, end: of its own -> of the episode\""),
      std::string::npos)
      << JunitXml({verdict});
  verdict.comparison = Compared("sliding", {1300, 1400});
  EXPECT_NE(
      JunitXml({verdict}).find(
          "first: missing sliding(hand, cup): expected 0.1000..0.2000 s, recognised nothing\""),
      std::string::npos)
      << JunitXml({verdict});
}

TEST(Junit, TheMessageOfAContradictedClaimIsSaidOnce) {
  ScenarioVerdict verdict{.scenario = "slide/bad", .shows = {}, .verdict = Verdict::kFailed};
  verdict.reason = "expects: 'no sliding' (x.yaml:4): found 1";
  verdict.details = verdict.reason + "\n  sliding(hand, cup) 0.1000..0.2000 s\n";
  EXPECT_NE(JunitXml({verdict}).find("message=\"expects: 'no sliding' (x.yaml:4): found 1\""),
            std::string::npos)
      << JunitXml({verdict});
}

}  // namespace
}  // namespace prehend::suite
