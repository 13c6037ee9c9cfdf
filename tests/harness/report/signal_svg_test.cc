// SPDX-License-Identifier: Apache-2.0
#include "harness/report/signal_svg.h"

#include <gtest/gtest.h>

#include <limits>

namespace prehend::harness {
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

TEST(SignalSvg, ShowsValueLimitAndCrossing) {
  const std::string svg = SignalSvg(Falling(), 480);
  for (const char* part :
       {"aria-label=\"height(cup) &lt; 20 mm: fell to 18 mm, below 20 mm\"",
        ">fell to 18 mm, below 20 mm</text>", ">0.02 m</text>", ">0.06 m</text>", ">0.000 s</text>",
        ">0.013 s</text>", "<polyline class=\"value\"", "<circle class=\"crossing\" cx=\"337.3\""})
    EXPECT_TRUE(Has(svg, part)) << part << "\n" << svg;
  EXPECT_FALSE(Has(svg, ">0.012 m</text>")) << "it would lie over that of the limit";
  const std::size_t limit = svg.find("class=\"limit\"");
  const std::string points = svg.substr(limit, svg.find("/>", limit) - limit);
  EXPECT_EQ(std::ranges::count(points, ','), 2) << "a straight line has two ends: " << points;
}

TEST(SignalSvg, ShowsWhatItWasWhereTheGoldenHasTheBoundary) {
  EXPECT_FALSE(Has(SignalSvg(Falling(), 480), "golden"));
  DecidingSignal signal = Falling();
  signal.golden_tick = 2;
  const std::string svg = SignalSvg(signal, 480);
  EXPECT_TRUE(Has(svg, "<line class=\"golden\"")) << svg;
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
  EXPECT_TRUE(Has(SignalSvg(signal, 480), ">7 m</text>"));
}

}  // namespace
}  // namespace prehend::harness
