// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "harness/suite/report/report.h"

namespace prehend::suite {
namespace {

DecidingSignal Falling() {
  return {.clause = "height(cup) < 20 mm",
          .how = "fell to 18 mm, below 20 mm",
          .unit = "m",
          .tick = 4,
          .ticks = {0, 2, 4, 6},
          .values = {0.060, 0.040, 0.018, 0.012},
          .limits = {0.02, 0.02, 0.02, 0.02}};
}

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int TimesIn(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(TimelineSvg, DrawsTheGoldenAboveWhatWasRecognised) {
  truth::Golden golden{.scenario = "s/x", .grammar = "g", .ticks_per_second = 100};
  const grammar::NamedEvent event{
      .event = "sliding", .roles = {{"hand", "h"}, {"object", "cup"}}, .interval = {100, 200}};
  golden.events.push_back({.event = event, .tolerance_ms = {}, .because = {}, .comments = {}});
  grammar::NamedEvent late = event;
  late.interval.begin = 150;
  const std::string svg =
      TimelineSvg(truth::Compare(golden, {.ticks_per_second = 100, .events = {late}}, 2), 400, {});
  EXPECT_EQ(TimesIn(svg, "<rect"), 2);
  EXPECT_EQ(TimesIn(svg, "class=\"hatch\""), 1) << "only its begin is another";
  EXPECT_EQ(TimesIn(svg, "class=\"row differs\""), 1);
  EXPECT_NE(svg.find("golden sliding(h, cup), 1.0000..2.0000 s: shifted"), std::string::npos);
  EXPECT_NE(svg.find("actual sliding(h, cup), 1.5000..2.0000 s: shifted"), std::string::npos);
  EXPECT_EQ(TimesIn(svg, "class=\"axis\""), 9) << "every half second of four";
}

TEST(TimelineSvg, RowsAreGroupedByWhoseTheyAre) {
  const auto event = [](const char* name, const char* whose, grammar::Tick begin) {
    return grammar::NamedEvent{
        .event = name, .roles = {{"who", whose}}, .interval = {begin, begin + 10}};
  };
  const grammar::Timeline timeline{
      .ticks_per_second = 100,
      .events = {event("first", "left", 0), event("second", "cup", 5), event("third", "left", 20)}};
  const std::string svg = TimelineSvg(truth::Compare({}, timeline, 2), 400, {}, false);
  const auto at = [&](const char* text) { return svg.find(text); };
  EXPECT_EQ(TimesIn(svg, "class=\"group\""), 2);
  EXPECT_LT(at(">left</text>"), at(">first(left)</text>"));
  EXPECT_LT(at(">first(left)</text>"), at(">third(left)</text>"));
  EXPECT_LT(at(">third(left)</text>"), at(">cup</text>"));
  EXPECT_LT(at(">cup</text>"), at(">second(cup)</text>"));
  EXPECT_EQ(TimesIn(svg, "class=\"hatch\""), 0) << "without a golden nothing differs";
}

TEST(TimelineSvg, SidesHaveLanesAndTheirDifferencesOne) {
  const grammar::NamedEvent event{
      .event = "sliding", .roles = {{"object", "cup"}}, .interval = {100, 200}};
  truth::Golden labels{.scenario = "s/x", .grammar = "g", .ticks_per_second = 100};
  labels.events.push_back({.event = event, .tolerance_ms = {}, .because = {}, .comments = {}});
  grammar::NamedEvent late = event, other = event;
  late.interval.begin = 150;
  other.event = "rolling";
  const auto compared = [&](const grammar::NamedEvent& found) {
    return truth::Compare(labels, {.ticks_per_second = 100, .events = {found}}, 2);
  };
  const std::vector<truth::Comparison> all = {compared(event), compared(late), compared(other)};
  const std::vector<show::PlayedStep> steps = {{"hand", "reach cup", 10, 90}};
  const std::string svg =
      TimelineSvg(all, {"labels", "same", "late", "other"}, 400, {}, true, steps);
  EXPECT_EQ(TimesIn(svg, "data-event=\"sliding(object=cup)\" data-lane=\"0\""), 1) << svg;
  EXPECT_EQ(TimesIn(svg, "data-event=\"sliding(object=cup)\" data-lane=\"1\""), 1);
  EXPECT_EQ(TimesIn(svg, "data-event=\"sliding(object=cup)\" data-lane=\"2\""), 1);
  EXPECT_EQ(TimesIn(svg, "data-event=\"rolling(object=cup)\" data-lane=\"3\""), 1);
  EXPECT_EQ(TimesIn(svg, "class=\"hatch\""), 3) << "its late begin; the label and the other event";
  EXPECT_TRUE(Has(svg, "class=\"actual\"")) << "who agrees does not differ";
  EXPECT_TRUE(Has(svg, "class=\"golden differs\""));
  EXPECT_LT(svg.find(">script</text>"), svg.find(">reach cup</text>"));
  EXPECT_TRUE(Has(svg, "class=\"in_bar\"") && Has(svg, "class=\"step\""));
}

TEST(TimelineSvg, AnEmptyTimelineIsAPictureToo) {
  const std::string svg = TimelineSvg(truth::Comparison{}, 0, {});
  EXPECT_TRUE(svg.starts_with("<svg class=\"timeline\"")) << svg;
  EXPECT_EQ(TimesIn(svg, "</svg>"), 1);
  EXPECT_EQ(TimesIn(svg, "<rect"), 0);
}

TEST(SignalSvg, ShowsValueLimitAndCrossing) {
  const std::string svg = SignalSvg(Falling(), 480);
  for (const char* part :
       {"aria-label=\"height(cup) &lt; 20 mm: fell to 18 mm, below 20 mm\"",
        ">fell to 18 mm, below 20 mm</text>", ">m</text>", ">0.02</text>", ">0.06</text>",
        ">0.002</text>", ">0.012</text>", "class=\"value\"", "class=\"crossing\""})
    EXPECT_TRUE(Has(svg, part)) << part << "\n" << svg;
  const std::size_t end = svg.find("class=\"limit\"", svg.find("<polyline"));
  const std::size_t limit = svg.rfind("<polyline", end);
  const std::string points = svg.substr(limit, end - limit);
  EXPECT_EQ(std::ranges::count(points, ','), 2) << "a straight line has two ends: " << points;
}

TEST(SignalSvg, ShowsWhatItWasWhereTheGoldenHasTheBoundary) {
  EXPECT_FALSE(Has(SignalSvg(Falling(), 480), "golden"));
  DecidingSignal signal = Falling();
  signal.golden_tick = 2;
  const std::string svg = SignalSvg(signal, 480);
  EXPECT_TRUE(Has(svg, "class=\"golden\"")) << svg;
  EXPECT_TRUE(Has(svg, ">golden: 0.04 m</text>")) << svg;
  signal.golden_tick = 100;
  EXPECT_FALSE(Has(SignalSvg(signal, 480), "golden")) << "beyond what is drawn";
}

TEST(SignalSvg, WhatIsNotFiniteIsLeftOut) {
  DecidingSignal signal = Falling();
  signal.values[1] = std::numeric_limits<double>::infinity();
  signal.values[2] = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = SignalSvg(signal, 480);
  EXPECT_FALSE(Has(svg, "nan") || Has(svg, "inf")) << svg;
  signal.values = signal.limits = {7, 7, 7, 7};
  EXPECT_TRUE(Has(SignalSvg(signal, 480), ">7</text>"));
}

}  // namespace
}  // namespace prehend::suite
