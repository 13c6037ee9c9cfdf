// SPDX-License-Identifier: Apache-2.0
// Rows of bars and panels of curves over one axis, as SVG. For papers: on white or without a
// ground, colours that a colour-blind reader can tell apart, doubled by dashes. For web pages: with
// classes, which the page's style sheet gives colours. Tested by
// tests/harness/show/chart/chart_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/base/quoting.h"

namespace prehend::show {

struct Bar {
  double begin_s = 0, end_s = 0;
  std::string text;  ///< in the bar if it fits
  std::uint32_t color = 0x888888;
  std::string kind = {};  ///< what the colour means: named below the chart if the text does not fit
  int lane = 0;           ///< from above, of those of its row
  std::string frame = {};  ///< its colour, if it is to be seen
  std::string style = {};  ///< classes in a page
  std::string tip = {};    ///< what a page says where the pointer rests
};
/// A time that two rows, or the lanes of one, do not agree about.
struct Hatch {
  double begin_s = 0, end_s = 0;
  int lane = -1;  ///< -1: over the whole row
};
struct Row {
  std::string name;
  std::vector<Bar> bars;
  std::vector<Hatch> hatches = {};
  std::string heading = {};  ///< above the row
  std::string style = {};    ///< classes of its name in a page
  std::string id = {};       ///< of its bars in a page, for the script
  int lanes = 1;
};
/// A time that the text speaks of, or a scene beside the chart shows.
struct Mark {
  double time_s = 0;
  std::string letter;
  std::string style = {};  ///< classes in a page
};
struct Curve {
  std::string name;
  /// Time in s, value; times increase. A value that is no number interrupts the curve.
  std::vector<std::pair<double, double>> points;
  std::string style = {};  ///< classes in a page
};
struct Panel {
  std::string name;  ///< "height, m"
  std::vector<Curve> curves;
};
/// A place on the axis and what is written there.
using AxisTick = std::pair<double, std::string>;
struct Chart {
  std::string title;
  double from_s = 0, to_s = 1;
  std::vector<Row> rows;
  std::vector<Panel> panels;
  std::vector<Mark> marks = {};
  std::string axis = "time, s";
  std::vector<AxisTick> ticks = {};  ///< of an axis that is not time
};

struct ChartFormat {
  double width_px = 900, text_px = 12;
  bool transparent = false;     ///< no white ground
  double panel_texts = 9;       ///< height of a panel, in heights of the text
  std::string page_class = {};  ///< not empty: for a web page, of this class
};

/// What lies outside of the chart's time is left out.
std::string ChartSvg(const Chart& chart, const ChartFormat& format = {});

/// The same as an element of a web page; `label` is what somebody hears who does not see it. Its
/// data-left, data-end and data-per-second say where times are.
std::string ChartForPage(const Chart& chart, const ChartFormat& format, const std::string& label);

/// Adds the same to an <svg>, below `top_px`; returns its height.
double AddChart(pugi::xml_node svg, const Chart& chart, const ChartFormat& format, double top_px);

/// An empty <svg> of this size, on white unless it is transparent.
pugi::xml_node AddDrawing(pugi::xml_document& document, const ChartFormat& format,
                          double height_px);

/// Of lines and texts.
inline constexpr const char* kInk = "#222222";

/// Broken where it says, and where a line would have more letters than `most`: at a blank, else
/// inside a name.
std::vector<std::string> BrokenLines(const std::string& text, std::size_t most);

/// As SVG wants numbers.
std::string SvgNumber(double value);

/// Where ticks of an axis stand: at most `most`, at round values.
std::vector<double> RoundTicks(double from, double to, int most);

}  // namespace prehend::show
