// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "harness/show/figures/figures.h"
#include "harness/truth/timeline/event_drawings.h"

namespace prehend::show {
namespace {

constexpr double kColumn_s =
    static_cast<double>(grammar::kDrawnColumnTicks) / grammar::kDrawnTicksPerSecond;
constexpr std::uint32_t kFactColor = 0xb8bfc9;

/// What a fact measures, and how much of it one step of its row is.
struct Scale {
  std::string_view fact, panel;
  double step = 1;
};
constexpr std::array<Scale, 8> kScales = {{{"x", "cm"},
                                           {"y", "cm"},
                                           {"z", "cm"},
                                           {"tilt", "tilt, deg", 5},
                                           {"turn", "turn, deg", 10},
                                           {"joint", "open, %", 5},
                                           {"percent", "open, %"},
                                           {"grip", "grip", 0.1}}};

/// Null of what only holds or not.
const Scale* ScaleOf(const std::string& name) {
  const auto found = std::ranges::find(kScales, name.substr(name.rfind(' ') + 1), &Scale::fact);
  return found == kScales.end() ? nullptr : &*found;
}

Curve CurveOf(const grammar::DrawnRow& row, double step) {
  Curve curve{.name = row.name, .points = {}};
  for (std::size_t i = 0; i < row.cells.size(); ++i)
    curve.points.emplace_back(
        kColumn_s * static_cast<double>(i),
        step * (row.cells[i] == '#' ? 10 : grammar::DrawnNumber(row.cells[i]).value_or(0)));
  return curve;
}

Row BarsOf(const grammar::DrawnRow& row) {
  Row bars{.name = row.name, .bars = {}};
  for (std::size_t i = 0; i < row.cells.size();) {
    const std::size_t end =
        std::min(row.cells.find_first_not_of(row.cells[i], i), row.cells.size());
    if (row.cells[i] != '.')
      bars.bars.push_back({.begin_s = kColumn_s * static_cast<double>(i),
                           .end_s = kColumn_s * static_cast<double>(end),
                           .text = row.cells[i] == '#' ? "" : std::string(1, row.cells[i]),
                           .color = kFactColor});
    i = end;
  }
  return bars;
}

}  // namespace

Chart DrawingChart(const grammar::Program& program, const grammar::DrawnEpisode& drawn,
                   const grammar::Timeline& timeline) {
  const auto seconds = [&](grammar::Tick tick) {
    return static_cast<double>(tick) / static_cast<double>(timeline.ticks_per_second);
  };
  Chart chart{
      .title = drawn.title, .from_s = 0, .to_s = seconds(drawn.end()), .rows = {}, .panels = {}};
  for (const grammar::DrawnRow& fact : drawn.facts) {
    const Scale* scale = ScaleOf(fact.name);
    if (scale == nullptr) {
      chart.rows.push_back(BarsOf(fact));
      continue;
    }
    auto found = std::ranges::find(chart.panels, scale->panel, &Panel::name);
    if (found == chart.panels.end())
      found = chart.panels.insert(found, {.name = std::string(scale->panel), .curves = {}});
    found->curves.push_back(CurveOf(fact, scale->step));
  }
  const truth::EventDrawings drawings(program);
  for (const grammar::DrawnRow& wanted : drawn.expected) {
    Row row{.name = wanted.name, .bars = {}};
    for (const grammar::NamedEvent& event : timeline.events) {
      if (event.Label() != wanted.name) continue;
      row.bars.push_back({.begin_s = seconds(event.interval.begin),
                          .end_s = seconds(event.interval.end),
                          .text = event.event,
                          .color = drawings.Of(event.event).color,
                          .kind = event.event});
    }
    chart.rows.push_back(std::move(row));
  }
  return chart;
}

}  // namespace prehend::show
