// SPDX-License-Identifier: Apache-2.0
// See harness/timeline_svg.h. Colours are those of the pictures (harness/phases.h). Tested by
// tests/harness/report_test.cc
#include "harness/timeline_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/event_text.h"
#include "harness/phases.h"

namespace prehend::harness {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

// Layout in SVG units; the page scales the whole.
constexpr double kLabelWidth = 260;
constexpr double kChartWidth = 720;
constexpr double kMargin = 10;
constexpr double kRowHeight = 26;
constexpr double kBarHeight = 8;
constexpr double kAxisHeight = 22;
constexpr double kNarrowestBar = 1.5;

struct Row {
  std::string label;
  std::vector<const Pairing*> pairings;
};

/// Rows in the order in which they first begin.
std::vector<Row> RowsOf(const Comparison& comparison) {
  std::vector<Row> rows;
  std::map<std::string, std::size_t> row_of;
  for (const Pairing& pairing : comparison.pairings) {
    const std::string label = pairing.event().Label();
    const auto [found, is_new] = row_of.try_emplace(label, rows.size());
    if (is_new) rows.push_back({label, {}});
    rows[found->second].pairings.push_back(&pairing);
  }
  return rows;
}

class Drawing {
 public:
  Drawing(const Comparison& comparison, Tick end)
      : comparison_(comparison), end_(std::max<Tick>(1, end)), rows_(RowsOf(comparison)) {}

  std::string Draw() {
    const double height = kAxisHeight + kRowHeight * static_cast<double>(rows_.size()) + kMargin;
    svg_ = fmt::format("<svg class=\"timeline\" viewBox=\"0 0 {:g} {:g}\" role=\"img\">\n",
                       kLabelWidth + kChartWidth + 2 * kMargin, height);
    DrawAxis(height);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      DrawRow(rows_[i], kAxisHeight + kRowHeight * static_cast<double>(i));
    return svg_ + "</svg>\n";
  }

 private:
  double X(Tick tick) const {
    return kLabelWidth + kChartWidth * static_cast<double>(std::clamp<Tick>(tick, 0, end_)) /
                             static_cast<double>(end_);
  }

  /// A line per second, or per 1, 2, 5, 10, .. seconds so that there are at most 12.
  void DrawAxis(double height) {
    const double end_s =
        static_cast<double>(end_) / static_cast<double>(comparison_.ticks_per_second);
    double step_s = std::pow(10, std::floor(std::log10(std::max(end_s, 1e-3) / 12)));
    for (const double factor : {2.0, 5.0, 10.0}) {
      if (end_s / step_s <= 12) break;
      if (end_s / (step_s * factor) <= 12) {
        step_s *= factor;
        break;
      }
    }
    for (int i = 0; i * step_s <= end_s; ++i) {
      const double x = X(TickAt(i * step_s, comparison_.ticks_per_second));
      svg_ += fmt::format(
          "<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1:g}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>"
          "<text class=\"axis\" x=\"{0:.1f}\" y=\"{3:g}\" text-anchor=\"middle\">{4:g} s</text>\n",
          x, kAxisHeight - 4, height - kMargin, kAxisHeight - 8, i * step_s);
    }
  }

  void DrawRow(const Row& row, double y) {
    const bool agrees = std::all_of(
        row.pairings.begin(), row.pairings.end(),
        [](const Pairing* pairing) { return pairing->agreement == LineVerdict::kMatched; });
    svg_ +=
        fmt::format("<text class=\"{}\" x=\"{:g}\" y=\"{:g}\" text-anchor=\"end\">{}</text>\n",
                    agrees ? "row" : "row differs", kLabelWidth - 8, y + 17, EscapeHtml(row.label));
    for (const Pairing* pairing : row.pairings) {
      if (pairing->expected) DrawBar("golden", *pairing->expected, y + 4, *pairing);
      if (pairing->actual) DrawBar("actual", *pairing->actual, y + 5 + kBarHeight, *pairing);
    }
  }

  void DrawBar(const char* side, const NamedEvent& event, double y, const Pairing& pairing) {
    const double x = X(event.interval.begin);
    const double width = std::max(kNarrowestBar, X(event.interval.end) - x);
    const bool agrees = pairing.agreement == LineVerdict::kMatched;
    svg_ += fmt::format(
        "<rect class=\"{}{}\" x=\"{:.2f}\" y=\"{:g}\" width=\"{:.2f}\" height=\"{:g}\" "
        "fill=\"#{:06x}\"><title>{}</title></rect>\n",
        side, agrees ? "" : " differs", x, y, width, kBarHeight, EventColor(event.event),
        EscapeHtml(fmt::format("{} {}, {}: {}", side, event.Label(),
                               IntervalText(event.interval, comparison_.ticks_per_second),
                               Name(pairing.agreement))));
  }

  const Comparison& comparison_;
  Tick end_;
  std::vector<Row> rows_;
  std::string svg_;
};

}  // namespace

std::string TimelineSvg(const Comparison& comparison, Tick end) {
  return Drawing(comparison, end).Draw();
}

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace prehend::harness
