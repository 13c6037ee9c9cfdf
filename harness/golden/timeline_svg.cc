// SPDX-License-Identifier: Apache-2.0
// See harness/golden/timeline_svg.h. Tested by
// tests/harness/report/report_test.cc
#include "harness/golden/timeline_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/base/markup.h"
#include "harness/timeline/event_text.h"

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
constexpr double kGroupHeight = 20;
constexpr double kBarHeight = 8;
constexpr double kAxisHeight = 22;
constexpr double kNarrowestBar = 1.5;

struct Row {
  std::string group;  ///< whose event it is
  std::string label;
  std::vector<const Pairing*> pairings;
};

/// The hand of a phase or grasp, or who has the first role.
std::string GroupOf(const NamedEvent& event, const EventDrawings& drawings) {
  if (event.roles.empty()) return "";
  const EventDrawing& drawing = drawings.Of(event.event);
  const bool has_hand =
      drawing.as == grammar::DrawnAs::kPhase || drawing.as == grammar::DrawnAs::kGrasp;
  return event.roles[has_hand && drawing.hand < event.roles.size() ? drawing.hand : 0].value;
}

/// Rows of a group after each other; groups, and rows in them, in the order in which they first
/// begin.
std::vector<Row> RowsOf(const Comparison& comparison, const EventDrawings& drawings) {
  std::vector<Row> rows;
  std::map<std::string, std::size_t> row_of;
  for (const Pairing& pairing : comparison.pairings) {
    const std::string label = pairing.event().Label();
    const auto [found, is_new] = row_of.try_emplace(label, rows.size());
    if (is_new) rows.push_back({GroupOf(pairing.event(), drawings), label, {}});
    rows[found->second].pairings.push_back(&pairing);
  }
  std::map<std::string, std::size_t> first_of;
  for (std::size_t i = 0; i < rows.size(); ++i) first_of.try_emplace(rows[i].group, i);
  std::ranges::stable_sort(rows, {}, [&](const Row& row) { return first_of.at(row.group); });
  return rows;
}

class Drawing {
 public:
  Drawing(const Comparison& comparison, Tick end, const EventDrawings& drawings, bool has_golden)
      : comparison_(comparison),
        end_(std::max<Tick>(1, end)),
        drawings_(drawings),
        has_golden_(has_golden),
        rows_(RowsOf(comparison, drawings)) {}

  std::string Draw() {
    const double height = kAxisHeight + kRowHeight * static_cast<double>(rows_.size()) +
                          kGroupHeight * Groups() + kMargin;
    svg_ = AddElement(
        document_, "svg",
        {{"class", "timeline"},
         {"viewBox", fmt::format("0 0 {:g} {:g}", kLabelWidth + kChartWidth + 2 * kMargin, height)},
         {"role", "img"},
         {"aria-label", LabelText()},
         {"data-left", fmt::format("{:g}", kLabelWidth)},
         {"data-per-second",
          fmt::format("{:g}", kChartWidth * static_cast<double>(comparison_.ticks_per_second) /
                                  static_cast<double>(end_))}});
    DrawAxis(height);
    double y = kAxisHeight;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (Groups() > 0 && BeginsGroup(i)) {
        AddElement(svg_, "text",
                   {{"class", "group"}, {"x", "4"}, {"y", fmt::format("{:g}", y + 14)}},
                   rows_[i].group);
        y += kGroupHeight;
      }
      DrawRow(rows_[i], y);
      y += kRowHeight;
    }
    return ToText(document_, Layout::kAsItIs);
  }

 private:
  bool BeginsGroup(std::size_t row) const {
    return row == 0 || rows_[row].group != rows_[row - 1].group;
  }
  /// How many headings there are: a single group needs none.
  int Groups() const {
    int groups = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) groups += BeginsGroup(i) ? 1 : 0;
    return groups > 1 ? groups : 0;
  }
  bool Agrees(const Pairing& pairing) const {
    return !has_golden_ || pairing.agreement == LineVerdict::kMatched;
  }

  double X(Tick tick) const {
    return kLabelWidth + kChartWidth * static_cast<double>(std::clamp<Tick>(tick, 0, end_)) /
                             static_cast<double>(end_);
  }

  /// What somebody hears who does not see it.
  std::string LabelText() const {
    const auto differing = std::ranges::count_if(
        comparison_.pairings, [&](const Pairing& pairing) { return !Agrees(pairing); });
    if (!has_golden_) return fmt::format("timeline: {} events", comparison_.pairings.size());
    return fmt::format("timeline: {} events, {} differ from the golden",
                       comparison_.pairings.size(), differing);
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
      const std::string x =
          fmt::format("{:.1f}", X(TickAt(i * step_s, comparison_.ticks_per_second)));
      AddElement(svg_, "line",
                 {{"class", "grid"},
                  {"x1", x},
                  {"y1", fmt::format("{:g}", kAxisHeight - 4)},
                  {"x2", x},
                  {"y2", fmt::format("{:.1f}", height - kMargin)}});
      AddElement(svg_, "text",
                 {{"class", "axis"},
                  {"x", x},
                  {"y", fmt::format("{:g}", kAxisHeight - 8)},
                  {"text-anchor", "middle"}},
                 fmt::format("{:g} s", i * step_s));
    }
  }

  void DrawRow(const Row& row, double y) {
    const bool agrees = std::all_of(row.pairings.begin(), row.pairings.end(),
                                    [&](const Pairing* pairing) { return Agrees(*pairing); });
    AddElement(svg_, "text",
               {{"class", agrees ? "row" : "row differs"},
                {"x", fmt::format("{:g}", kLabelWidth - 8)},
                {"y", fmt::format("{:g}", y + 17)},
                {"text-anchor", "end"}},
               row.label);
    for (const Pairing* pairing : row.pairings) {
      if (pairing->expected) DrawBar("golden", *pairing->expected, y + 4, *pairing);
      if (pairing->actual) DrawBar("actual", *pairing->actual, y + 5 + kBarHeight, *pairing);
      DrawDifference(*pairing, y + 3);
    }
  }

  std::string SecondsText(Tick tick) const {
    return fmt::format(
        "{:.6g}", static_cast<double>(tick) / static_cast<double>(comparison_.ticks_per_second));
  }

  /// Hatches the time in which only one of the two sides has the event.
  void DrawDifference(const Pairing& pairing, double y) {
    if (Agrees(pairing)) return;
    const auto hatch = [&](Tick from, Tick to) {
      if (from == to) return;
      const double x = X(std::min(from, to));
      AddElement(
          svg_, "rect",
          {{"class", "hatch"},
           {"x", fmt::format("{:.2f}", x)},
           {"y", fmt::format("{:g}", y)},
           {"width", fmt::format("{:.2f}", std::max(kNarrowestBar, X(std::max(from, to)) - x))},
           {"height", fmt::format("{:g}", 2 * kBarHeight + 3)}});
    };
    if (!pairing.expected || !pairing.actual)
      return hatch(pairing.event().interval.begin, pairing.event().interval.end);
    hatch(pairing.expected->interval.begin, pairing.actual->interval.begin);
    hatch(pairing.expected->interval.end, pairing.actual->interval.end);
  }

  void DrawBar(const char* side, const NamedEvent& event, double y, const Pairing& pairing) {
    const double x = X(event.interval.begin);
    const double width = std::max(kNarrowestBar, X(event.interval.end) - x);
    const bool agrees = Agrees(pairing);
    const pugi::xml_node bar =
        AddElement(svg_, "rect",
                   {{"class", std::string(side) + (agrees ? "" : " differs")},
                    {"x", fmt::format("{:.2f}", x)},
                    {"y", fmt::format("{:g}", y)},
                    {"width", fmt::format("{:.2f}", width)},
                    {"height", fmt::format("{:g}", kBarHeight)},
                    {"data-begin", SecondsText(event.interval.begin)},
                    {"data-end", SecondsText(event.interval.end)},
                    {"fill", fmt::format("#{:06x}", drawings_.Of(event.event).color)}});
    AddElement(bar, "title", {},
               fmt::format("{} {}, {}: {}", side, event.Label(),
                           IntervalText(event.interval, comparison_.ticks_per_second),
                           has_golden_ ? Name(pairing.agreement) : "no golden"));
  }

  const Comparison& comparison_;
  Tick end_;
  const EventDrawings& drawings_;
  bool has_golden_;
  std::vector<Row> rows_;
  pugi::xml_document document_;
  pugi::xml_node svg_;
};

}  // namespace

std::string TimelineSvg(const Comparison& comparison, grammar::Tick end,
                        const EventDrawings& drawings, bool has_golden) {
  return Drawing(comparison, end, drawings, has_golden).Draw();
}

}  // namespace prehend::harness
