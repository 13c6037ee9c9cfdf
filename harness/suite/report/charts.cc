// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/base/quoting.h"
#include "harness/show/chart/chart.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

using grammar::NamedEvent;
using grammar::Tick;
using show::Bar;
using show::Chart;
using show::Curve;
using show::Row;

/// The hand of a phase or grasp, or who has the first role.
std::string GroupOf(const NamedEvent& event, const truth::EventDrawings& drawings) {
  if (event.roles.empty()) return "";
  const truth::EventDrawing& drawing = drawings.Of(event.event);
  const bool has_hand =
      drawing.as == grammar::DrawnAs::kPhase || drawing.as == grammar::DrawnAs::kGrasp;
  return event.roles[has_hand && drawing.hand < event.roles.size() ? drawing.hand : 0].value;
}

class TimelineChart {
 public:
  TimelineChart(const truth::Comparison& comparison, const truth::EventDrawings& drawings,
                bool has_golden)
      : comparison_(comparison), drawings_(drawings), has_golden_(has_golden) {}

  /// Rows of a group after each other; groups, and rows in them, in the order in which they first
  /// begin. A single group needs no heading.
  std::vector<Row> Rows() const {
    std::vector<Row> rows;
    std::map<std::string, std::size_t> row_of, first_of;
    for (const truth::Pairing& pairing : comparison_.pairings) {
      const std::string label = pairing.event().Label();
      const auto [found, is_new] = row_of.try_emplace(label, rows.size());
      if (is_new) {
        const std::string group = GroupOf(pairing.event(), drawings_);
        first_of.try_emplace(group, rows.size());
        rows.push_back({.name = label, .heading = group, .style = "row"});
      }
      Add(pairing, rows[found->second]);
    }
    std::ranges::stable_sort(rows, {}, [&](const Row& row) { return first_of.at(row.heading); });
    std::string group = first_of.size() > 1 ? "" : rows.empty() ? "" : rows[0].heading;
    for (Row& row : rows) {
      if (row.heading == group)
        row.heading = "";
      else
        group = row.heading;
    }
    return rows;
  }

  /// What somebody hears who does not see it.
  std::string Label() const {
    const auto differing = std::ranges::count_if(
        comparison_.pairings, [&](const truth::Pairing& pairing) { return !Agrees(pairing); });
    if (!has_golden_) return fmt::format("timeline: {} events", comparison_.pairings.size());
    return fmt::format("timeline: {} events, {} differ from the golden",
                       comparison_.pairings.size(), differing);
  }

  double Seconds(Tick tick) const {
    return static_cast<double>(tick) / static_cast<double>(comparison_.ticks_per_second);
  }

 private:
  bool Agrees(const truth::Pairing& pairing) const {
    return !has_golden_ || pairing.agreement == truth::LineVerdict::kMatched;
  }

  void Add(const truth::Pairing& pairing, Row& row) const {
    const auto add = [&](const char* side, Bar::Part part, const NamedEvent& event) {
      row.bars.push_back(
          {.begin_s = Seconds(event.interval.begin),
           .end_s = Seconds(event.interval.end),
           .text = "",
           .color = drawings_.Of(event.event).color,
           .part = part,
           .style = std::string(side) + (Agrees(pairing) ? "" : " differs"),
           .tip = fmt::format("{} {}, {}: {}", side, event.Label(),
                              truth::IntervalText(event.interval, comparison_.ticks_per_second),
                              has_golden_ ? Name(pairing.agreement) : "no golden")});
    };
    if (pairing.expected) add("golden", Bar::Part::kUpper, *pairing.expected);
    if (pairing.actual) add("actual", Bar::Part::kLower, *pairing.actual);
    if (Agrees(pairing)) return;
    row.style = "row differs";
    const auto hatch = [&](Tick from, Tick to) {
      if (from != to)
        row.hatches.push_back({Seconds(std::min(from, to)), Seconds(std::max(from, to))});
    };
    if (!pairing.expected || !pairing.actual)
      return hatch(pairing.event().interval.begin, pairing.event().interval.end);
    hatch(pairing.expected->interval.begin, pairing.actual->interval.begin);
    hatch(pairing.expected->interval.end, pairing.actual->interval.end);
  }

  const truth::Comparison& comparison_;
  const truth::EventDrawings& drawings_;
  bool has_golden_;
};

Curve CurveOf(const std::string& name, const DecidingSignal& signal,
              const std::vector<double>& values, double per_second) {
  Curve curve{.name = name, .style = name};
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Of what stays the same, the ends.
    const bool is_inner =
        i > 0 && i + 1 < values.size() && values[i - 1] == values[i] && values[i] == values[i + 1];
    if (!is_inner)
      curve.points.emplace_back(static_cast<double>(signal.ticks[i]) / per_second, values[i]);
  }
  return curve;
}

}  // namespace

std::string TimelineSvg(const truth::Comparison& comparison, Tick end,
                        const truth::EventDrawings& drawings, bool has_golden) {
  const TimelineChart chart(comparison, drawings, has_golden);
  return show::ChartForPage(
      {.title = "", .to_s = chart.Seconds(std::max<Tick>(1, end)), .rows = chart.Rows()},
      {.width_px = 1000, .page_class = "timeline"}, chart.Label());
}

std::string SignalSvg(const DecidingSignal& signal, Tick ticks_per_second) {
  const double per_second = static_cast<double>(ticks_per_second);
  const auto seconds = [&](Tick tick) { return static_cast<double>(tick) / per_second; };
  const Tick first = signal.ticks.front(), last = std::max(first + 1, signal.ticks.back());
  Chart chart{.title = signal.how,
              .from_s = seconds(first),
              .to_s = seconds(last),
              .panels = {{signal.unit,
                          {CurveOf("value", signal, signal.values, per_second),
                           CurveOf("limit", signal, signal.limits, per_second)}}},
              .marks = {{seconds(signal.tick), "", "crossing"}}};
  // Where the golden has the boundary, and what the value was then: perhaps an older limit.
  const auto at = std::ranges::lower_bound(signal.ticks, signal.golden_tick);
  if (signal.golden_tick >= first && at != signal.ticks.end()) {
    const double value = signal.values[static_cast<std::size_t>(at - signal.ticks.begin())];
    const std::string text =
        fmt::format("golden: {:.3g}{}{}", value, signal.unit.empty() ? "" : " ", signal.unit);
    chart.marks.push_back({seconds(*at), std::isfinite(value) ? text : "", "golden"});
  }
  return show::ChartForPage(chart, {.width_px = 480, .panel_texts = 6, .page_class = "signal"},
                            signal.clause + ": " + signal.how);
}

namespace {

/// JSON without the characters that HTML would not unescape in a script.
std::string ScriptText(const nlohmann::json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    if (c == '<' || c == '>' || c == '&')
      text += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      text += c;
  }
  return text;
}

nlohmann::json BoundariesJson(const Explained& explained, grammar::Tick ticks_per_second) {
  const auto seconds = [&](grammar::Tick tick) {
    return static_cast<double>(tick) / static_cast<double>(ticks_per_second);
  };
  nlohmann::json list = nlohmann::json::array();
  for (const ExplainedEvent& event : explained.events)
    list.push_back({{"event", event.event},
                    {"begin", seconds(event.begin)},
                    {"end", seconds(event.end)},
                    {"began", event.began},
                    {"ended", event.ended}});
  return list;
}

}  // namespace

void AddExplanations(pugi::xml_node section, const Explained& explained,
                     grammar::Tick ticks_per_second) {
  if (!explained.events.empty()) {
    AddElement(section, "div", {{"class", "turned"}, {"role", "status"}}, "");
    AddElement(section, "script", {{"type", "application/json"}, {"class", "boundaries"}},
               ScriptText(BoundariesJson(explained, ticks_per_second)));
  }
  for (const ExplainedDifference& difference : explained.differences) {
    pugi::xml_node fold = AddElement(section, "details", {{"class", "difference"}});
    if (&difference == &explained.differences.front())
      fold.append_attribute("open").set_value("open");
    AddElement(fold, "summary", {}, "Why: " + difference.what);
    const pugi::xml_node plots = AddElement(fold, "div", {{"class", "signals"}});
    for (const DecidingSignal& signal : difference.signals) {
      const pugi::xml_node figure = AddElement(plots, "figure");
      AddMarkup(figure, SignalSvg(signal, ticks_per_second));
      AddElement(figure, "figcaption", {}, signal.clause);
    }
    if (difference.signals.empty()) fold.remove_child(plots);
    AddElement(fold, "pre", {{"tabindex", "0"}}, difference.text);
  }
}

}  // namespace prehend::suite
