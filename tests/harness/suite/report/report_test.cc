// SPDX-License-Identifier: Apache-2.0
// The web page holds what a person needs, and nothing that a scenario's text could break.
#include "harness/suite/report/report.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace prehend::suite {
namespace {

truth::Comparison Compared() {
  const grammar::NamedEvent event{
      .event = "sliding", .roles = {{"hand", "h"}, {"object", "cup"}}, .interval = {100, 200}};
  truth::Golden golden{.scenario = "s/x", .grammar = "g", .ticks_per_second = 100};
  golden.events.push_back({.event = event, .tolerance_ms = {}, .because = {}, .comments = {}});
  return truth::Compare(golden, {.ticks_per_second = 100, .events = {event}}, 2);
}

std::vector<ScenarioVerdict> Verdicts() {
  return {{.scenario = "slide/good",
           .shows = "it <slides>",
           .verdict = Verdict::kPassed,
           .comparison = Compared(),
           .has_golden = true,
           .command = "prehend check slide/good",
           .ticks = 400,
           .pictures = {{.file = "pictures/slide/good.png", .caption = "sliding.begin"}}},
          {.scenario = "slide/bad",
           .verdict = Verdict::kFailed,
           .exit_code = ExitCode::kDiffers,
           .reason = "1 of 9 events differ",
           .details = "shifted sliding(hand, cup)\n",
           .notes = {"note: 1.0 s: h: the cup is <wide>"},
           .command = "prehend check slide/bad"},
          {.scenario = "slide/new",
           .verdict = Verdict::kPending,
           .exit_code = ExitCode::kPending,
           .reason = "no golden yet"}};
}

int CountOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(Report, HasVerdictsTimelinesPicturesDifferencesAndCommands) {
  const std::string html = ReportHtml(Verdicts(), {.command = "prehend check", .date = {}});
  for (const char* part :
       {"1 passed", "1 failed", "1 pending", "href=\"#slide/good\"", "<section id=\"slide/bad\"",
        "picture, not in this page: pictures/slide/good.png (sliding.begin)",
        "golden sliding(h, cup), 1.0000..2.0000 s: matched", "In every row",
        "shifted sliding(hand, cup)", "prehend check slide/bad", "it &lt;slides&gt;",
        "margin: all boundaries match exactly", "no golden yet",
        "note: 1.0 s: h: the cup is &lt;wide&gt;"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html.find("<slides>"), std::string::npos);
  EXPECT_EQ(CountOf(html, "<section"), CountOf(html, "</section>"));
  EXPECT_EQ(html.find("http"), std::string::npos) << "the page must not need the network";
}

TEST(Report, WhatFailedIsFirstAndCausesAreAbove) {
  const std::string html = ReportHtml(Verdicts(), {});
  const auto at = [&](const std::string& part) { return html.find(part); };
  ASSERT_NE(at("<section id=\"slide/good\""), std::string::npos);
  EXPECT_LT(at(">1 cause<"), at("<table"));
  EXPECT_LT(at("<section id=\"slide/bad\""), at("<section id=\"slide/new\""));
  EXPECT_LT(at("<section id=\"slide/new\""), at("<section id=\"slide/good\""));
}

TEST(Report, WhatStandsBetweenBackticksIsCode) {
  std::vector<ScenarioVerdict> verdicts = Verdicts();
  Attribution shifted;
  shifted.event = "sliding";
  shifted.what = "begins later";
  shifted.shift_ms = 20;
  shifted.because = "`reach_radius` 30 cm -> 20 cm";
  verdicts[1].comparison = Compared();
  verdicts[1].comparison->pairings[0].agreement = truth::LineVerdict::kShifted;
  verdicts[1].has_golden = true;
  verdicts[1].attributions = {shifted};
  const std::string html = ReportHtml(verdicts, {});
  const std::string cause = "<strong><code>reach_radius</code> 30 cm \u2192 20 cm</strong>";
  EXPECT_NE(html.find(cause + "<div>1 x sliding begins later, +20.0 ms</div><div class=\"soft\">"
                              "<a href=\"#slide/bad\">slide/bad</a>"),
            std::string::npos)
      << html.substr(html.find("1 cause"), 400);
  EXPECT_NE(html.find("Because of " + cause + ": sliding begins later, +20.0 ms.</p>"),
            std::string::npos);
}

TEST(Report, ReplaysAreInThePageOfABuildThatHasThem) {
  std::vector<ScenarioVerdict> verdicts = Verdicts();
  verdicts[1].replay = "QUFB";
  const std::string html = ReportHtml(verdicts, {});
  const int has = ReplayBundle().empty() ? 0 : 1;
  EXPECT_EQ(CountOf(html, "class=\"replay-data\">QUFB</script>"), has);
  EXPECT_EQ(CountOf(html, "id=\"replay-bundle\""), has);
  EXPECT_EQ(CountOf(html, "3D replay was left out"), 1 - has);
  EXPECT_EQ(WhyNoReplay().empty(), has == 1);
  EXPECT_EQ(CountOf(ReportHtml(Verdicts(), {}), "id=\"replay-bundle\""), 0);
}

TEST(Report, ReplaysThatAreTooLargeAreLeftOut) {
  std::vector<ScenarioVerdict> verdicts = Verdicts();
  for (ScenarioVerdict& verdict : verdicts) verdict.replay.assign(kMostReplayBytes / 2, 'A');
  const std::string html = ReportHtml(verdicts, {});
  const int has = ReplayBundle().empty() ? 0 : 1;
  EXPECT_EQ(CountOf(html, "The 3D replay is not in this page"), has);
  EXPECT_EQ(CountOf(html, "class=\"replay-data\""), 2 * has);
}

TEST(Report, DifferencesAreExplained) {
  std::vector<ScenarioVerdict> verdicts = Verdicts();
  verdicts[1].comparison = Compared();
  verdicts[1].explained.events = {{"sliding(h, cup)", 100, 200, "speed(cup) < 1", "b </script>"}};
  verdicts[1].explained.differences = {{.what = "shifted sliding(h, cup)",
                                        .text = "began at 1 s",
                                        .signals = {{.clause = "speed(cup) > 1",
                                                     .how = "rose",
                                                     .unit = "m/s",
                                                     .tick = 2,
                                                     .ticks = {1, 2},
                                                     .values = {0, 2},
                                                     .limits = {1, 1}}}}};
  const std::string html = ReportHtml(verdicts, {});
  for (const char* part :
       {"<summary>Why: shifted sliding(h, cup)</summary>", "<svg class=\"signal\"",
        "<figcaption>speed(cup) &gt; 1</figcaption>", "began at 1 s</pre>",
        "\"began\":\"speed(cup) \\u003c 1\",\"begin\":1.0,\"end\":2.0",
        "\"ended\":\"b \\u003c/script\\u003e\""})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(Report, ScriptAndStyleAreInThePageAsTheyAre) {
  const std::string html = ReportHtml(Verdicts(), {});
  EXPECT_NE(html.find(std::string(PageScript()) + "</script>"), std::string::npos);
  EXPECT_NE(html.find(std::string(PageStyle()) + "</style>"), std::string::npos);
  EXPECT_EQ(PageScript().find("</"), std::string_view::npos);
  EXPECT_EQ(PageStyle().find("</"), std::string_view::npos);
}

TEST(Report, PicturesAreInThePage) {
  const std::string folder = testing::TempDir() + "report_pictures";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/a.png") << "Mano";
  std::vector<ScenarioVerdict> verdicts = Verdicts();
  verdicts[0].pictures[0].file = "a.png";
  const std::string html = ReportHtml(verdicts, {.command = {}, .date = {}, .folder = folder});
  EXPECT_NE(html.find("src=\"data:image/png;base64,TWFubw==\""), std::string::npos);
}

}  // namespace
}  // namespace prehend::suite
