// SPDX-License-Identifier: Apache-2.0
// See harness/figures/chart.h. Tested by tests/harness/figures/chart_test.cc
#include "harness/figures/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace prehend::harness::figures {
namespace {

/// Okabe and Ito's palette without yellow, which is pale on white ("Color Universal Design", 2008).
constexpr std::array<const char*, 6> kColors = {"#0072B2", "#D55E00", "#009E73",
                                                "#CC79A7", "#56B4E9", "#000000"};
constexpr std::array<const char*, 4> kDashes = {"none", "6 3", "2 3", "8 3 2 3"};
constexpr double kFoot = 5.6;              ///< height of times and legend, in heights of the text
constexpr std::size_t kMostPoints = 1500;  ///< of a curve; more cannot be seen

std::string Number(double value) { return SvgNumber(value); }

/// Whether dark text can be read on it: its luminance (ITU-R BT.709).
bool IsLight(std::uint32_t color) {
  const double red = color >> 16 & 255, green = color >> 8 & 255, blue = color & 255;
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 140;
}

class Drawing {
 public:
  Drawing(const Chart& chart, const ChartFormat& format) : chart_(chart), format_(format) {
    const double letter_px = 0.6 * format.text_px;
    std::size_t longest = 0;
    for (const Row& row : chart.rows) longest = std::max(longest, row.name.size());
    left_ = 20 + std::max(50.0, letter_px * static_cast<double>(longest));
    right_ = format.width_px - 14;
  }

  double Height() const {
    const double panels = static_cast<double>(chart_.panels.size());
    return Top() + RowPx() * static_cast<double>(chart_.rows.size()) +
           (GapPx() + PanelPx()) * panels + kFoot * format_.text_px;
  }

  void AddTo(pugi::xml_node svg) {
    svg_ = svg;
    if (!chart_.title.empty()) Text(left_, 1.4 * format_.text_px, chart_.title, "start", "bold");
    double y = Top();
    DrawTimes(y, Height() - kFoot * format_.text_px);
    DrawMarks(Height() - kFoot * format_.text_px);
    for (const Row& row : chart_.rows) {
      DrawRow(row, y, RowPx());
      y += RowPx();
    }
    for (const Panel& panel : chart_.panels) {
      y += GapPx();
      DrawPanel(panel, y, PanelPx());
      y += PanelPx();
    }
    DrawLegend(Height() - 0.8 * format_.text_px);
  }

 private:
  double RowPx() const { return 1.9 * format_.text_px; }
  double PanelPx() const { return 9 * format_.text_px; }
  double GapPx() const { return 1.6 * format_.text_px; }
  double Top() const {
    return (chart_.title.empty() ? 8 : 2.4 * format_.text_px) +
           (chart_.marks.empty() ? 0 : 1.3 * format_.text_px);
  }

  double X(double time_s) const {
    const double share = (time_s - chart_.from_s) / (chart_.to_s - chart_.from_s);
    return left_ + std::clamp(share, 0.0, 1.0) * (right_ - left_);
  }

  void Text(double x, double y, const std::string& text, const char* anchor,
            const char* weight = "normal", const char* color = kInk) {
    AddElement(svg_, "text",
               {{"x", Number(x)},
                {"y", Number(y)},
                {"text-anchor", anchor},
                {"font-weight", weight},
                {"fill", color}},
               text);
  }
  void Line(double x1, double y1, double x2, double y2, const char* color) {
    AddElement(svg_, "line",
               {{"x1", Number(x1)},
                {"y1", Number(y1)},
                {"x2", Number(x2)},
                {"y2", Number(y2)},
                {"stroke", color},
                {"stroke-width", "1"}});
  }

  void DrawRow(const Row& row, double y, double height) {
    Text(left_ - 8, y + 0.5 * height + 0.35 * format_.text_px, row.name, "end");
    for (const Bar& bar : row.bars) {
      if (bar.end_s <= chart_.from_s || bar.begin_s >= chart_.to_s) continue;
      const double x = X(bar.begin_s), width = std::max(1.5, X(bar.end_s) - x);
      AddElement(svg_, "rect",
                 {{"x", Number(x)},
                  {"y", Number(y + 2)},
                  {"width", Number(width)},
                  {"height", Number(height - 4)},
                  {"fill", fmt::format("#{:06X}", bar.color)},
                  {"stroke", "#FFFFFF"}});
      if (0.62 * format_.text_px * static_cast<double>(bar.text.size()) < width - 6)
        Text(x + width / 2, y + 0.5 * height + 0.35 * format_.text_px, bar.text, "middle", "normal",
             IsLight(bar.color) ? "#000000" : "#FFFFFF");
      else if (!bar.kind.empty())
        unnamed_[bar.kind] = bar.color;
    }
    for (const Hatch& hatch : row.hatches) DrawHatch(hatch, y, height);
  }

  /// Slanted lines in a frame: readable in print and on any colour.
  void DrawHatch(const Hatch& hatch, double y, double height) {
    if (hatch.end_s <= chart_.from_s || hatch.begin_s >= chart_.to_s) return;
    const double step_px = 5, x = X(hatch.begin_s), top = y + 2, tall = height - 4,
                 width = std::max(3.0, X(hatch.end_s) - x);
    std::string path =
        fmt::format("M{:.2f},{:.2f}h{:.2f}v{:.2f}h{:.2f}z", x, top, width, tall, -width);
    // Each line leaves the frame where it meets its right or upper side.
    for (double from = x - tall + step_px; from < x + width; from += step_px) {
      const double first = std::max(from, x), last = std::min(from + tall, x + width);
      path += fmt::format("M{:.2f},{:.2f}L{:.2f},{:.2f}", first, top + tall - (first - from), last,
                          top + tall - (last - from));
    }
    AddElement(svg_, "path",
               {{"d", path}, {"fill", "none"}, {"stroke", kInk}, {"stroke-width", "1"}});
  }

  /// A dashed line behind everything, with its letter above. Letters at one place are one text.
  void DrawMarks(double bottom) {
    const double top = Top();
    double right_end = 0;
    for (const Mark& mark : chart_.marks) {
      if (mark.time_s < chart_.from_s || mark.time_s > chart_.to_s) continue;
      const double x = X(mark.time_s);
      AddElement(svg_, "line",
                 {{"x1", Number(x)},
                  {"y1", Number(top - 2)},
                  {"x2", Number(x)},
                  {"y2", Number(bottom)},
                  {"stroke", kInk},
                  {"stroke-width", "1"},
                  {"stroke-dasharray", "4 3"}});
      const double letter_px = 0.75 * format_.text_px * static_cast<double>(mark.letter.size());
      const double letter_x = std::max(x, right_end + letter_px / 2);
      Text(letter_x, top - 0.35 * format_.text_px, mark.letter, "middle", "bold");
      right_end = letter_x + letter_px / 2 + 1;
    }
  }

  void DrawPanel(const Panel& panel, double top, double height) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Curve& curve : panel.curves) {
      for (const auto& [time_s, value] : curve.points) {
        if (time_s < chart_.from_s || time_s > chart_.to_s || !std::isfinite(value)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
    if (!(least <= most)) least = 0, most = 1;
    if (most - least < 1e-9) most = least + 1;
    const double room = 0.06 * (most - least);
    least -= room;
    most += room;
    const auto y_of = [&](double value) {
      return top + height - (value - least) / (most - least) * height;
    };
    for (const double tick : RoundTicks(least, most, 4)) {
      Line(left_, y_of(tick), right_, y_of(tick), "#DDDDDD");
      Text(left_ - 8, y_of(tick) + 0.35 * format_.text_px, Number(tick), "end");
    }
    Line(left_, top, left_, top + height, kInk);
    double legend = right_;
    for (std::size_t i = 0; i < panel.curves.size(); ++i) {
      const Curve& curve = panel.curves[i];
      const char* color = kColors[i % kColors.size()];
      const char* dash = kDashes[i % kDashes.size()];
      DrawCurve(curve, y_of, color, dash);
      const double name_px = 0.6 * format_.text_px * static_cast<double>(curve.name.size());
      legend -= name_px + 34;
      if (panel.curves.size() > 1 || !curve.name.empty()) {
        AddElement(svg_, "line",
                   {{"x1", Number(legend)},
                    {"y1", Number(top - 0.4 * format_.text_px)},
                    {"x2", Number(legend + 22)},
                    {"y2", Number(top - 0.4 * format_.text_px)},
                    {"stroke", color},
                    {"stroke-width", "2"},
                    {"stroke-dasharray", dash}});
        Text(legend + 26, top - 0.1 * format_.text_px, curve.name, "start");
      }
    }
    Text(left_, top - 0.1 * format_.text_px, panel.name, "start", "bold");
  }

  template <typename YOf>
  void DrawCurve(const Curve& curve, const YOf& y_of, const char* color, const char* dash) {
    const std::size_t step = curve.points.size() / kMostPoints + 1;
    std::string points;
    for (std::size_t i = 0; i < curve.points.size(); i += step) {
      const auto& [time_s, value] = curve.points[i];
      if (!std::isfinite(value)) DrawLine(points, color, dash);
      if (time_s < chart_.from_s || time_s > chart_.to_s || !std::isfinite(value)) continue;
      points += fmt::format("{:.2f},{:.2f} ", X(time_s), y_of(value));
    }
    DrawLine(points, color, dash);
  }

  /// Through these points, which are empty afterwards.
  void DrawLine(std::string& points, const char* color, const char* dash) {
    if (points.empty()) return;
    points.pop_back();
    AddElement(svg_, "polyline",
               {{"points", points},
                {"fill", "none"},
                {"stroke", color},
                {"stroke-width", "1.6"},
                {"stroke-dasharray", dash}});
    points.clear();
  }

  /// What the colours mean whose bars are too short for their texts.
  void DrawLegend(double y) {
    double x = left_;
    for (const auto& [kind, color] : unnamed_) {
      AddElement(svg_, "rect",
                 {{"x", Number(x)},
                  {"y", Number(y - 0.8 * format_.text_px)},
                  {"width", Number(format_.text_px)},
                  {"height", Number(0.9 * format_.text_px)},
                  {"fill", fmt::format("#{:06X}", color)}});
      Text(x + 1.4 * format_.text_px, y, kind, "start");
      x += 3 * format_.text_px + 0.62 * format_.text_px * static_cast<double>(kind.size());
    }
  }

  void DrawTimes(double top, double bottom) {
    Line(left_, bottom, right_, bottom, kInk);
    for (const double tick : RoundTicks(chart_.from_s, chart_.to_s, 10)) {
      Line(X(tick), top, X(tick), bottom, "#EEEEEE");
      Line(X(tick), bottom, X(tick), bottom + 4, kInk);
      Text(X(tick), bottom + 4 + 1.1 * format_.text_px, Number(tick), "middle");
    }
    Text((left_ + right_) / 2, bottom + 8 + 2.3 * format_.text_px, "time, s", "middle");
  }

  const Chart& chart_;
  const ChartFormat& format_;
  double left_ = 0, right_ = 0;
  pugi::xml_node svg_;
  std::map<std::string, std::uint32_t> unnamed_;
};

}  // namespace

std::vector<double> RoundTicks(double from, double to, int most) {
  const double raw = (to - from) / most, power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (auto i = static_cast<long>(std::ceil(from / step - 1e-9));
       static_cast<double>(i) * step <= to + 1e-9 * step; ++i)
    ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

std::string SvgNumber(double value) { return fmt::format("{:.6g}", value); }

pugi::xml_node AddDrawing(pugi::xml_document& document, const ChartFormat& format,
                          double height_px) {
  const pugi::xml_node svg =
      AddElement(document, "svg",
                 {{"xmlns", "http://www.w3.org/2000/svg"},
                  {"xmlns:xlink", "http://www.w3.org/1999/xlink"},
                  {"width", SvgNumber(format.width_px)},
                  {"height", SvgNumber(height_px)},
                  {"viewBox", "0 0 " + SvgNumber(format.width_px) + " " + SvgNumber(height_px)},
                  {"font-family", "DejaVu Sans, Arial, sans-serif"},
                  {"font-size", SvgNumber(format.text_px)}});
  if (!format.transparent)
    AddElement(svg, "rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "#FFFFFF"}});
  return svg;
}

double AddChart(pugi::xml_node svg, const Chart& chart, const ChartFormat& format, double top_px) {
  Drawing drawing(chart, format);
  drawing.AddTo(AddElement(svg, "g", {{"transform", "translate(0 " + SvgNumber(top_px) + ")"}}));
  return drawing.Height();
}

std::string ChartSvg(const Chart& chart, const ChartFormat& format) {
  pugi::xml_document document;
  Drawing drawing(chart, format);
  drawing.AddTo(AddDrawing(document, format, drawing.Height()));
  return ToText(document, Layout::kIndented);
}

}  // namespace prehend::harness::figures
