// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include "grammar/base/diagnostic.h"
#include "grammar/base/quantity.h"
#include "grammar/describe.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/run/load_run.h"
#include "harness/measure/sweep/sweep.h"
#include "harness/show/chart/chart.h"
#include "harness/truth/timeline/event_text.h"

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

/// The same along each axis alone, the least of these first: larger towards the middle.
std::vector<std::size_t> StepsAlongAxes(const std::vector<Axis>& axes,
                                        const std::vector<bool>& good, std::size_t point) {
  std::vector<std::size_t> steps;
  std::size_t stride = 1;
  for (std::size_t i = axes.size(); i-- > 0;) {
    const std::size_t count = axes[i].values.size(), at = point / stride % count;
    std::size_t down = 1, up = 1;
    while (down <= at && good[point - down * stride]) ++down;
    while (at + up < count && good[point + up * stride]) ++up;
    steps.push_back(std::min(down, up));
    stride *= count;
  }
  std::ranges::sort(steps);
  return steps;
}

std::uint32_t ColorOf(double share) {  // from dark blue over green to yellow
  const auto mix = [&](double low, double middle, double high) {
    return static_cast<std::uint32_t>(share < 0.5 ? low + (middle - low) * 2 * share
                                                  : middle + (high - middle) * (2 * share - 1));
  };
  return mix(68, 33, 253) << 16 | mix(1, 145, 231) << 8 | mix(84, 140, 37);
}

constexpr std::array kFactors = {0.125, 0.177, 0.25, 0.354, 0.5, 0.707, 0.841, 1.0,
                                 1.19,  1.414, 2.0,  2.83,  4.0, 5.66,  8.0};

constexpr std::size_t kAxesOfScenarios = 16;  ///< at once

using CompileWith = std::function<grammar::CompileResult(const grammar::Overrides&)>;

/// The values that the grammar accepts; `own` becomes the index of the parameter's own one.
Axis AxisOf(const grammar::ProgramParam& param, const grammar::Overrides& fixed,
            const CompileWith& compile, std::size_t& own) {
  Axis axis{.parameter = param.name};
  const std::string text = grammar::QuantityText(param.value);
  if (const std::size_t blank = text.find(' '); blank != std::string::npos)
    axis.unit = text.substr(blank + 1);
  for (const double factor : kFactors) {
    const double value = param.value.value * factor;
    axis.values.push_back(factor == 1.0 ? value : std::stod(fmt::format("{:.3g}", value)));
    grammar::Overrides overrides = fixed;
    overrides[param.name] = axis.ValueText(axis.values.size() - 1);
    const bool is_own = factor == 1.0;
    if (is_own)
      own = axis.values.size() - 1;
    else if (!compile(overrides).program)
      axis.values.pop_back();
  }
  return axis;
}

Margin MarginOf(const Axis& axis, std::span<const SweepPoint> points, std::size_t own,
                double within) {
  auto best = std::ranges::max_element(points, {}, &SweepPoint::f1);
  if (points[own].f1 == best->f1) best = points.begin() + static_cast<std::ptrdiff_t>(own);
  Margin margin{.parameter = axis.parameter,
                .value = axis.ValueText(own),
                .f1 = points[own].f1,
                .best = best->f1,
                .best_at = axis.ValueText(static_cast<std::size_t>(best - points.begin()))};
  // What one recording gains another one may lose.
  margin.has_effect = std::ranges::any_of(
      points, [&](const SweepPoint& point) { return point.of_each != points[own].of_each; });
  const auto is_good = [&](std::size_t i) { return points[i].f1 >= best->f1 - within; };
  if (!is_good(own)) return margin;
  std::size_t from = own, to = own;
  while (from > 0 && is_good(from - 1)) --from;
  while (to + 1 < points.size() && is_good(to + 1)) ++to;
  margin.from = axis.ValueText(from);
  margin.to = axis.ValueText(to);
  margin.open_below = from == 0;
  margin.open_above = to + 1 == points.size();
  margin.near_edge = (from == own && own > 0) || (to == own && own + 1 < points.size());
  return margin;
}

/// A parameter with the values that are tried.
struct TriedAxis {
  Axis axis;
  std::size_t own = 0;  ///< index of its own value
};

std::optional<grammar::Diagnostics> UnknownAmong(const std::vector<std::string>& names,
                                                 const std::vector<grammar::ProgramParam>& params) {
  std::vector<std::string> known;
  for (const grammar::ProgramParam& param : params) known.push_back(param.name);
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) > 0) continue;
    return grammar::Diagnostics{{.file = "--over",
                                 .message = fmt::format("the grammar has no parameter '{}'", name),
                                 .hint = grammar::DidYouMean(name, known)}};
  }
  return std::nullopt;
}

/// Narrow ranges first; of all, what is not in its range.
double Width(const Margin& margin) {
  if (margin.from.empty()) return 0;
  const double from = std::stod(margin.from), to = std::stod(margin.to);
  return 1 + (margin.open_below ? 8 : 0) + (margin.open_above ? 8 : 0) + to / from;
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
    const auto rank = [&](std::size_t p) {
      return std::tuple(steps[p], StepsAlongAxes(axes, good, p), points[p].f1);
    };
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
    text += fmt::format("{:.6f},{},{},{}", point.f1, point.correct, point.extra, point.missed);
    for (const double ms : {point.begin_ms, point.end_ms, point.latency_ms})
      text += "," + (std::isnan(ms) ? "-" : fmt::format("{:.3f}", ms));
    text += "\n";
  }
  return text;
}

std::string RobustSettingsText(const std::vector<Axis>& axes, const SweepResult& result,
                               double within) {
  const RobustSettings robust = FindRobustSettings(axes, result.points, within);
  const SweepPoint& chosen = result.points[robust.chosen];
  const auto ms_text = [](double ms, bool has_sign) {
    return std::isnan(ms) ? "-"
                          : fmt::format(fmt::runtime(has_sign ? "{:+.1f} ms" : "{:.1f} ms"), ms);
  };
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
         fmt::format(" (F1 {:.2f} %, begin {}, end {}, latency {})\n", 100 * chosen.f1,
                     ms_text(chosen.begin_ms, true), ms_text(chosen.end_ms, true),
                     ms_text(chosen.latency_ms, false)) +
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

Result<Margins> FindMargins(const std::vector<episode::Take>& takes, SweepRequest request,
                            double within, const std::vector<std::string>& only,
                            const std::function<void(const Margins&)>& so_far) {
  PREHEND_TRY(const grammar::Overrides fixed, episode::ParameterSettings(request.settings));
  episode::EpisodeOpener opener(request.root);
  const CompileWith compile = [&](const grammar::Overrides& overrides) {
    return opener.Compile(takes.front().episode, request.grammar, overrides);
  };
  const grammar::CompileResult compiled = compile(fixed);
  if (!compiled.program) return tl::unexpected(compiled.diagnostics);
  const std::vector<grammar::ProgramParam> params = grammar::Describe(*compiled.program).params;
  if (auto unknown = UnknownAmong(only, params)) return tl::unexpected(std::move(*unknown));
  Margins all;
  std::vector<TriedAxis> tried;
  std::size_t settings = 0, before = 0;
  for (const grammar::ProgramParam& param : params) {
    if (!only.empty() && std::ranges::count(only, param.name) == 0) continue;
    if (param.value.value == 0) {
      all.without.push_back(param.name);
      continue;
    }
    tried.emplace_back();
    tried.back().axis = AxisOf(param, fixed, compile, tried.back().own);
    settings += tried.back().axis.values.size();
  }
  // What is told is about all of them.
  const auto progress = request.progress;
  if (progress) {
    request.progress = [&](std::size_t done, std::size_t) {
      progress(before * takes.size() + done, settings * takes.size());
    };
  }
  // A scenario is played for each call. Of what is only read, each parameter is told as it comes.
  const bool plays = std::ranges::any_of(takes, [](const episode::Take& take) {
    return take.episode.origin == episode::Origin::kScenario;
  });
  const std::size_t at_once = plays ? kAxesOfScenarios : 1;
  request.one_at_a_time = true;
  for (std::size_t first = 0; first < tried.size(); first += at_once) {
    const auto some = std::span(tried).subspan(first, std::min(at_once, tried.size() - first));
    request.axes.clear();
    for (const TriedAxis& one : some) request.axes.push_back(one.axis);
    PREHEND_TRY(SweepResult swept, Sweep(takes, request));
    std::span<const SweepPoint> points = swept.points;
    before += points.size();
    for (const TriedAxis& one : some) {
      const std::size_t own_points = one.axis.values.size();
      all.margins.push_back(MarginOf(one.axis, points.first(own_points), one.own, within));
      points = points.subspan(own_points);
    }
    std::ranges::stable_sort(all.margins, {}, Width);
    all.sweep = std::move(swept);
    if (all.sweep.episodes == 0) break;
    if (so_far) so_far(all);
  }
  return all;
}

std::string MarginsText(const Margins& margins, double within) {
  std::vector<std::vector<std::string>> rows = {
      {"parameter", "value", "F1", "stays from", "to", "best", "at", ""}};
  std::vector<std::string> idle;
  for (const Margin& margin : margins.margins) {
    if (!margin.has_effect) {
      idle.push_back(margin.parameter);
      continue;
    }
    rows.push_back({margin.parameter, margin.value, fmt::format("{:.1f}", 100 * margin.f1),
                    margin.from.empty() ? "-" : (margin.open_below ? "<= " : "") + margin.from,
                    margin.to.empty() ? "-" : (margin.open_above ? ">= " : "") + margin.to,
                    fmt::format("{:.1f}", 100 * margin.best), margin.best_at,
                    margin.from.empty() ? "warning: not among the best"
                    : margin.near_edge  ? "warning: at an edge"
                                        : ""});
  }
  std::string text = fmt::format("{}, {}\n", margins.sweep.grammar,
                                 grammar::CountOf(margins.sweep.episodes, "recording"));
  text += truth::AlignColumns(rows);
  text += fmt::format(
      "each parameter from an eighth to eight times its value, the others as they are;\n"
      "a score stays if it is within {:g} percent of the best of its row\n{}\n",
      100 * within, margins.sweep.measure);
  text += margins.sweep.counted;
  if (std::ranges::all_of(margins.margins, [](const Margin& margin) { return margin.best == 0; }))
    return text + "every score is 0: no event is right with any value of any parameter\n";
  if (!idle.empty())
    text += fmt::format("without any effect on the scores: {}\n", fmt::join(idle, ", "));
  if (!margins.without.empty())
    text += fmt::format("not tried, because they are 0: {}\n", fmt::join(margins.without, ", "));
  return text;
}

std::string MarginsCsv(const Margins& margins) {
  std::string text = "parameter,value,f1,from,to,open_below,open_above,best,best_at,near_edge\n";
  for (const Margin& m : margins.margins)
    text += fmt::format("{},{},{:.6g},{},{},{:d},{:d},{:.6g},{},{:d}\n", m.parameter, m.value, m.f1,
                        m.from, m.to, m.open_below, m.open_above, m.best, m.best_at, m.near_edge);
  return text;
}

}  // namespace prehend::measure
