// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "grammar/base/wording.h"
#include "harness/measure/sweep/sweep.h"
#include "harness/show/chart/chart.h"

namespace prehend::measure {
namespace {

/// The points one step away along an axis; fewer at the border.
std::vector<std::size_t> Neighbours(const std::vector<Axis>& axes, std::size_t point,
                                    bool& at_border) {
  std::vector<std::size_t> found;
  at_border = false;
  std::size_t stride = 1;
  for (std::size_t i = axes.size(); i-- > 0;) {
    const std::size_t count = axes[i].values.size(), at = point / stride % count;
    if (at > 0) found.push_back(point - stride);
    if (at + 1 < count) found.push_back(point + stride);
    at_border |= at == 0 || at + 1 == count;
    stride *= count;
  }
  return found;
}

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

/// Of each good point the number of steps to the nearest one that is not, or out of the grid.
std::vector<std::size_t> StepsToWorse(const std::vector<Axis>& axes,
                                      const std::vector<bool>& good) {
  std::vector<std::size_t> steps(good.size(), kUnknown), front;
  for (std::size_t i = 0; i < good.size(); ++i) {
    bool at_border = false;
    const std::vector<std::size_t> near = Neighbours(axes, i, at_border);
    const bool beside =
        at_border || std::ranges::any_of(near, [&](std::size_t n) { return !good[n]; });
    if (!good[i]) steps[i] = 0;
    if (good[i] && beside) {
      steps[i] = 1;
      front.push_back(i);
    }
  }
  while (!front.empty()) {
    std::vector<std::size_t> next;
    for (const std::size_t i : front) {
      bool ignored = false;
      for (const std::size_t n : Neighbours(axes, i, ignored)) {
        if (steps[n] != kUnknown) continue;
        steps[n] = steps[i] + 1;
        next.push_back(n);
      }
    }
    front = std::move(next);
  }
  return steps;
}

std::uint32_t ColorOf(double share) {  // from dark blue over green to yellow
  const auto mix = [&](double low, double middle, double high) {
    return static_cast<std::uint32_t>(share < 0.5 ? low + (middle - low) * 2 * share
                                                  : middle + (high - middle) * (2 * share - 1));
  };
  return mix(68, 33, 253) << 16 | mix(1, 145, 231) << 8 | mix(84, 140, 37);
}

}  // namespace

RobustSettings FindRobustSettings(const std::vector<Axis>& axes,
                                  const std::vector<SweepPoint>& points, double within) {
  RobustSettings robust;
  for (const SweepPoint& point : points) robust.best = std::max(robust.best, point.f1);
  if (robust.best == 0) return robust;
  std::vector<bool> good;
  for (const SweepPoint& point : points) good.push_back(point.f1 >= robust.best - within);
  const std::vector<std::size_t> steps = StepsToWorse(axes, good);
  bool chosen = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!good[i]) continue;
    const auto rank = [&](std::size_t p) { return std::pair(steps[p], points[p].f1); };
    if (!chosen || rank(i) > rank(robust.chosen)) robust.chosen = i;
    chosen = true;
  }
  robust.steps = steps[robust.chosen];
  std::vector<std::size_t> open = {robust.chosen};
  std::vector<bool> seen(points.size(), false);
  seen[robust.chosen] = true;
  while (!open.empty()) {
    const std::size_t point = open.back();
    open.pop_back();
    robust.members.push_back(point);
    bool ignored = false;
    for (const std::size_t n : Neighbours(axes, point, ignored)) {
      if (!good[n] || seen[n]) continue;
      seen[n] = true;
      open.push_back(n);
    }
  }
  std::ranges::sort(robust.members);
  return robust;
}

std::string CsvText(const std::vector<Axis>& axes, const std::vector<SweepPoint>& points) {
  std::string text;
  for (const Axis& axis : axes) text += axis.parameter + ",";
  text += "f1,correct,extra,missed,begin_error_ms,end_error_ms,latency_ms\n";
  for (const SweepPoint& point : points) {
    for (std::size_t i = 0; i < axes.size(); ++i) text += axes[i].ValueText(point.at[i]) + ",";
    text += fmt::format("{:.6f},{},{},{},{:.3f},{:.3f},{:.3f}\n", point.f1, point.correct,
                        point.extra, point.missed, point.begin_ms, point.end_ms, point.latency_ms);
  }
  return text;
}

std::string RobustSettingsText(const std::vector<Axis>& axes, const SweepResult& result,
                               double within) {
  const RobustSettings robust = FindRobustSettings(axes, result.points, within);
  const SweepPoint& chosen = result.points[robust.chosen];
  const std::string measure =
      (result.measure.empty() ? "" : result.measure + "\n") + result.counted;
  const std::string tried =
      fmt::format("{}{}{} on {}", result.grammar, result.grammar.empty() ? "" : ": ",
                  grammar::CountOf(result.points.size(), "setting"),
                  grammar::CountOf(result.episodes, "episode"));
  if (robust.members.empty())
    return fmt::format(
        "{}; every one scores 0: no event is right with any of them, so none is the best\n{}",
        tried, measure);
  std::string text =
      fmt::format("{}; the best F1 is {:.2f} %\n{}", tried, 100 * robust.best, measure);
  text += fmt::format("within {:g} % of it, around the setting named last: {}\n", 100 * within,
                      grammar::CountOf(robust.members.size(), "setting"));
  std::string warnings;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    std::size_t least = chosen.at[i], most = chosen.at[i];
    for (const std::size_t member : robust.members) {
      least = std::min(least, result.points[member].at[i]);
      most = std::max(most, result.points[member].at[i]);
    }
    text += fmt::format("  {}: {} to {}\n", axes[i].parameter, axes[i].ValueText(least),
                        axes[i].ValueText(most));
    const std::size_t last = axes[i].values.size() - 1;
    const bool has_no_effect = least == 0 && most == last;
    if (last == 0 || has_no_effect || (chosen.at[i] != 0 && chosen.at[i] != last)) continue;
    warnings +=
        fmt::format("warning: {} is best at the edge of what was tried, {}; try values beyond it\n",
                    axes[i].parameter, axes[i].ValueText(chosen.at[i]));
  }
  text +=
      fmt::format("farthest from its edge, {} step{}:", robust.steps, robust.steps == 1 ? "" : "s");
  for (std::size_t i = 0; i < axes.size(); ++i)
    text += fmt::format(" {} = {}", axes[i].parameter, axes[i].ValueText(chosen.at[i]));
  return text +
         fmt::format(" (F1 {:.2f} %, begin {:.1f} ms, end {:.1f} ms, latency {:.1f} ms)\n",
                     100 * chosen.f1, chosen.begin_ms, chosen.end_ms, chosen.latency_ms) +
         warnings;
}

std::string HeatMapSvg(const std::vector<Axis>& axes, const std::vector<SweepPoint>& points,
                       const RobustSettings& robust) {
  // The last axis to the right, the one before it downwards.
  const Axis& across = axes.back();
  const Axis* down = axes.size() > 1 ? &axes[axes.size() - 2] : nullptr;
  const std::size_t columns = across.values.size(), rows = down ? down->values.size() : 1;
  double least = 1, most = 0;
  for (const SweepPoint& point : points) {
    least = std::min(least, point.f1);
    most = std::max(most, point.f1);
  }
  show::Chart chart{.title = down ? "F1 in %, " + down->parameter + " downwards" : "F1 in %",
                    .to_s = static_cast<double>(columns),
                    .rows = std::vector<show::Row>(rows),
                    .axis = across.parameter +
                            (robust.members.empty()
                                 ? "; every setting scores 0"
                                 : "; framed: the robust settings; red: farthest from its edge")};
  for (std::size_t column = 0; column < columns; ++column)
    chart.ticks.emplace_back(static_cast<double>(column) + 0.5, across.ValueText(column));
  for (std::size_t row = 0; down && row < rows; ++row) chart.rows[row].name = down->ValueText(row);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SweepPoint& point = points[i];
    bool is_shown = true;
    for (std::size_t k = 0; k + 2 < axes.size(); ++k)
      is_shown &= point.at[k] == points[robust.chosen].at[k];
    if (!is_shown) continue;
    const double x = static_cast<double>(point.at.back());
    const bool member = std::ranges::binary_search(robust.members, i);
    std::vector<show::Bar>& bars = chart.rows[down ? point.at[axes.size() - 2] : 0].bars;
    // The chosen one is drawn last, so that its frame is seen as a whole.
    bars.insert(i == robust.chosen ? bars.end() : bars.begin(),
                {.begin_s = x,
                 .end_s = x + 1,
                 .text = fmt::format("{:.1f}", 100 * point.f1),
                 .color = ColorOf(most > least ? (point.f1 - least) / (most - least) : 1),
                 .frame = !member              ? ""
                          : i == robust.chosen ? "#d00"
                                               : "#000"});
  }
  const double texts_px = 7.2 * static_cast<double>(chart.axis.size());
  return show::ChartSvg(chart,
                        {.width_px = 110 + std::max(texts_px, 56 * static_cast<double>(columns))});
}

}  // namespace prehend::measure
