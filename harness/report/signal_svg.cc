// SPDX-License-Identifier: Apache-2.0
#include "harness/report/signal_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/markup.h"

namespace prehend::harness {
namespace {

// Layout in SVG units; the page scales the whole.
constexpr double kWidth = 480, kHeight = 130;
constexpr double kLeft = 76, kRight = 12, kTop = 24, kBottom = 24;

class Plot {
 public:
  Plot(const DecidingSignal& signal, grammar::Tick ticks_per_second)
      : signal_(signal), per_second_(static_cast<double>(ticks_per_second)) {
    for (const auto* values : {&signal.values, &signal.limits}) {
      for (const double value : *values) {
        if (!std::isfinite(value)) continue;
        least_ = std::min(least_, value);
        most_ = std::max(most_, value);
      }
    }
    if (least_ > most_) least_ = most_ = 0;
    room_ = std::max(0.08 * (most_ - least_), 1e-9);
  }

  std::string Draw() {
    svg_ = AddElement(document_, "svg",
                      {{"class", "signal"},
                       {"viewBox", fmt::format("0 0 {:g} {:g}", kWidth, kHeight)},
                       {"role", "img"},
                       {"aria-label", signal_.clause + ": " + signal_.how}});
    AddLabel("title", kLeft, 14, "start", signal_.how);
    std::vector<double> labelled;
    for (const double value : {LimitAtIt(), least_, most_}) {
      const auto near = [&](double other) { return std::abs(Y(value) - Y(other)) < 14; };
      if (!std::isfinite(value) || std::ranges::any_of(labelled, near)) continue;
      labelled.push_back(value);
      AddLabel("axis", kLeft - 6, Y(value) + 4, "end",
               fmt::format("{:.3g}{}{}", value, signal_.unit.empty() ? "" : " ", signal_.unit));
    }
    AddLabel("axis", X(signal_.ticks.front()), kHeight - 8, "start",
             Seconds(signal_.ticks.front()));
    AddLabel("axis", X(signal_.ticks.back()), kHeight - 8, "end", Seconds(signal_.ticks.back()));
    AddLine("grid", signal_.tick, least_, most_);
    AddGolden();
    AddCurve("limit", signal_.limits);
    AddCurve("value", signal_.values);
    const auto at = std::ranges::find(signal_.ticks, signal_.tick);
    if (at != signal_.ticks.end()) {
      const double value = signal_.values[static_cast<std::size_t>(at - signal_.ticks.begin())];
      if (std::isfinite(value))
        AddElement(svg_, "circle",
                   {{"class", "crossing"},
                    {"cx", fmt::format("{:.1f}", X(signal_.tick))},
                    {"cy", fmt::format("{:.1f}", Y(value))},
                    {"r", "4"}});
    }
    return ToText(document_, Layout::kAsItIs);
  }

 private:
  double X(grammar::Tick tick) const {
    const double all = static_cast<double>(signal_.ticks.back() - signal_.ticks.front());
    const double share = all > 0 ? static_cast<double>(tick - signal_.ticks.front()) / all : 0.5;
    return kLeft + share * (kWidth - kLeft - kRight);
  }
  double Y(double value) const {
    const double share = (value - least_ + room_) / (most_ - least_ + 2 * room_);
    return kHeight - kBottom - share * (kHeight - kTop - kBottom);
  }
  double LimitAtIt() const {
    const auto at = std::ranges::find(signal_.ticks, signal_.tick);
    return at == signal_.ticks.end()
               ? signal_.limits.front()
               : signal_.limits[static_cast<std::size_t>(at - signal_.ticks.begin())];
  }
  std::string Seconds(grammar::Tick tick) const {
    return fmt::format("{:.3f} s", static_cast<double>(tick) / per_second_);
  }

  /// Where the golden has the boundary, and what the value was then: perhaps an older limit.
  void AddGolden() {
    const auto at = std::ranges::lower_bound(signal_.ticks, signal_.golden_tick);
    if (signal_.golden_tick < signal_.ticks.front() || at == signal_.ticks.end()) return;
    const double value = signal_.values[static_cast<std::size_t>(at - signal_.ticks.begin())];
    AddLine("golden", *at, least_, most_);
    if (!std::isfinite(value)) return;
    const double x = std::clamp(X(*at), kLeft + 120, kWidth - 130);
    AddLabel(
        "axis", x, kHeight - 8, "middle",
        fmt::format("golden: {:.3g}{}{}", value, signal_.unit.empty() ? "" : " ", signal_.unit));
  }

  void AddLabel(const char* style, double x, double y, const char* anchor,
                const std::string& text) {
    AddElement(svg_, "text",
               {{"class", style},
                {"x", fmt::format("{:.1f}", x)},
                {"y", fmt::format("{:.1f}", y)},
                {"text-anchor", anchor}},
               text);
  }
  void AddLine(const char* style, grammar::Tick tick, double from, double to) {
    const std::string x = fmt::format("{:.1f}", X(tick));
    AddElement(svg_, "line",
               {{"class", style},
                {"x1", x},
                {"y1", fmt::format("{:.1f}", Y(from))},
                {"x2", x},
                {"y2", fmt::format("{:.1f}", Y(to))}});
  }
  void AddCurve(const char* style, const std::vector<double>& values) {
    std::string points;
    for (std::size_t i = 0; i < values.size(); ++i) {
      // Of what stays the same, the ends.
      const bool is_inner = i > 0 && i + 1 < values.size() && values[i - 1] == values[i] &&
                            values[i] == values[i + 1];
      if (std::isfinite(values[i]) && !is_inner)
        points += fmt::format("{:.1f},{:.1f} ", X(signal_.ticks[i]), Y(values[i]));
    }
    AddElement(svg_, "polyline", {{"class", style}, {"points", points}});
  }

  const DecidingSignal& signal_;
  double per_second_;
  double least_ = 1e300, most_ = -1e300, room_ = 0;
  pugi::xml_document document_;
  pugi::xml_node svg_;
};

}  // namespace

std::string SignalSvg(const DecidingSignal& signal, grammar::Tick ticks_per_second) {
  return Plot(signal, ticks_per_second).Draw();
}

}  // namespace prehend::harness
