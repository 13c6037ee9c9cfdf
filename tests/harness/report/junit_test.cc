// SPDX-License-Identifier: Apache-2.0
// The XML in full, as the schema of JUnit files wants it.
#include "harness/report/junit.h"

#include <gtest/gtest.h>

namespace prehend::harness {
namespace {

TEST(Junit, HasEveryKindOfOutcome) {
  std::vector<ScenarioVerdict> verdicts(4);
  verdicts[0] = {.scenario = "slide/good", .shows = {}, .verdict = Verdict::kPassed};
  verdicts[0].headroom = "headroom: 1 of 2 ms";
  verdicts[0].seconds = 0.25;
  verdicts[1] = {.scenario = "slide/bad", .shows = {}, .verdict = Verdict::kFailed};
  verdicts[1].exit_code = ExitCode::kDiffers;
  verdicts[1].reason = "\"1\" < 2 & 3\x1b\xff";
  verdicts[1].details = "shifted a -> b\n";
  verdicts[1].command = "prehend check slide/bad";
  verdicts[1].seconds = 1;
  verdicts[2] = {.scenario = "alone", .shows = {}, .verdict = Verdict::kFailed};
  verdicts[2].exit_code = ExitCode::kFailure;
  verdicts[2].reason = "its process ended";
  verdicts[2].command = "prehend check alone";
  verdicts[3] = {.scenario = "slide/old", .shows = {}, .verdict = Verdict::kUnchanged};
  EXPECT_EQ(JunitXml(verdicts), R"(<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="prehend" tests="4" failures="1" errors="1" time="1.250">
  <testsuite name="prehend check" tests="4" failures="1" errors="1" skipped="1" time="1.250">
    <testcase classname="slide" name="good" time="0.250">
      <system-out>headroom: 1 of 2 ms</system-out>
    </testcase>
    <testcase classname="slide" name="bad" time="1.000">
      <failure type="failed" message="&quot;1&quot; &lt; 2 &amp; 3��; first: shifted a -> b">shifted a -&gt; b
again: prehend check slide/bad
</failure>
    </testcase>
    <testcase classname="scenarios" name="alone" time="0.000">
      <error type="failed" message="its process ended">again: prehend check alone
</error>
    </testcase>
    <testcase classname="slide" name="old" time="0.000">
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
  const nlohmann::ordered_json side = {
      {"roles", {{"object", "cup"}, {"support", "table"}}}, {"begin_s", 0.5}, {"end_s", 1}};
  verdict.differences = {{{"kind", "changed"},
                          {"event", "supported_by"},
                          {"expected", side},
                          {"recognised", side},
                          {"begin_ms", 12.5},
                          {"end_ms", 0},
                          {"changes", {"end: of its own -> of the episode"}}},
                         {{"kind", "extra"}}};
  EXPECT_NE(JunitXml({verdict}).find(
                "message=\"2 of 3 events differ from the golden; first: changed supported_by(cup, "
                "table): expected 0.5000..1.0000 s, recognised 0.5000..1.0000 s, begin +12.5 ms, "
                "end +0.0 ms, end: of its own -> of the episode\""),
            std::string::npos)
      << JunitXml({verdict});
  verdict.differences = {{{"kind", "extra"},
                          {"event", "supported_by"},
                          {"expected", nullptr},
                          {"recognised", side},
                          {"begin_ms", nullptr},
                          {"end_ms", nullptr},
                          {"changes", nlohmann::ordered_json::array()}}};
  EXPECT_NE(
      JunitXml({verdict}).find(
          "first: extra supported_by(cup, table): expected nothing, recognised 0.5000..1.0000 s\""),
      std::string::npos)
      << JunitXml({verdict});
}

}  // namespace
}  // namespace prehend::harness
