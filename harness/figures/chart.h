// SPDX-License-Identifier: Apache-2.0
// Rows of bars and panels of curves over one time axis, as SVG for papers: on white or without a
// ground, colours that a colour-blind reader can tell apart, doubled by dashes. Tested by
// tests/harness/figures/chart_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/markup.h"

namespace prehend::harness::figures {

struct Bar {
  double begin_s = 0, end_s = 0;
  std::string text;  ///< in the bar if it fits
  std::uint32_t color = 0x888888;
  std::string kind = {};  ///< what the colour means: named below the chart if the text does not fit
};
/// A time that two rows do not agree about.
struct Hatch {
  double begin_s = 0, end_s = 0;
};
struct Row {
  std::string name;
  std::vector<Bar> bars;
  std::vector<Hatch> hatches = {};
};
/// A time that the text speaks of, or a scene beside the chart shows.
struct Mark {
  double time_s = 0;
  std::string letter;
};
struct Curve {
  std::string name;
  /// Time in s, value; times increase. A value that is no number interrupts the curve.
  std::vector<std::pair<double, double>> points;
};
struct Panel {
  std::string name;  ///< "height, m"
  std::vector<Curve> curves;
};
struct Chart {
  std::string title;
  double from_s = 0, to_s = 1;
  std::vector<Row> rows;
  std::vector<Panel> panels;
  std::vector<Mark> marks = {};
};

struct ChartFormat {
  double width_px = 900, text_px = 12;
  bool transparent = false;  ///< no white ground
};

/// What lies outside of the chart's time is left out.
std::string ChartSvg(const Chart& chart, const ChartFormat& format = {});

/// Adds the same to an <svg>, below `top_px`; returns its height.
double AddChart(pugi::xml_node svg, const Chart& chart, const ChartFormat& format, double top_px);

/// An empty <svg> of this size, on white unless it is transparent.
pugi::xml_node AddDrawing(pugi::xml_document& document, const ChartFormat& format,
                          double height_px);

/// Of lines and texts.
inline constexpr const char* kInk = "#222222";

/// As SVG wants numbers.
std::string SvgNumber(double value);

/// Where ticks of an axis stand: at most `most`, at round values.
std::vector<double> RoundTicks(double from, double to, int most);

}  // namespace prehend::harness::figures
