// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/base/base/quoting.h"
#include "harness/show/chart/chart.h"
#include "harness/suite/report/report.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
std::string WithRoles(const grammar::NamedEvent& event) {
  std::string roles;
  for (const grammar::Role& role : event.roles)
    if (!truth::IsAttribute(role))
      roles += (roles.empty() ? "" : ", ") + role.name + "=" + role.value;
  return roles.empty() ? event.event : event.event + "(" + roles + ")";
}

namespace {

using grammar::NamedEvent;
using grammar::Tick;
using show::Chart;
using show::Curve;
using show::Row;

constexpr std::uint32_t kStepColor = 0xD5DADF;

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
  /// Of one comparison with a golden, or, if sides are named, of several with the first of them.
  TimelineChart(std::span<const truth::Comparison> comparisons, const Sides& sides,
                const truth::EventDrawings& drawings, bool has_golden)
      : comparisons_(comparisons), sides_(sides), drawings_(drawings), has_golden_(has_golden) {
    for (const truth::Comparison& comparison : comparisons)
      for (const truth::Pairing& pairing : comparison.pairings)
        if (pairing.expected && !Agrees(pairing)) differing_.insert(pairing.golden_line);
  }

  /// Rows of a group after each other; groups, and rows in them, in the order in which they first
  /// begin. A single group needs no heading.
  std::vector<Row> Rows() const {
    std::vector<Row> rows;
    std::map<std::string, std::size_t> row_of, first_of;
    std::vector<std::pair<const truth::Pairing*, int>> pairings;  // with who is compared
    for (std::size_t i = 0; i < comparisons_.size(); ++i)
      for (const truth::Pairing& pairing : comparisons_[i].pairings)
        pairings.emplace_back(&pairing, static_cast<int>(i));
    if (comparisons_.size() > 1)
      std::ranges::stable_sort(pairings, [](const auto& a, const auto& b) {
        return grammar::ComesBefore(a.first->event(), b.first->event());
      });
    for (const auto& [pairing, of] : pairings) {
      for (const auto* event : {&pairing->expected, &pairing->actual}) {
        // Another event of the same time has a row of its own, if people are to choose between
        // them.
        if (!*event || (sides_.empty() && event == &pairing->actual && pairing->expected)) continue;
        const std::string label = (*event)->Label();
        const auto [found, is_new] = row_of.try_emplace(label, rows.size());
        if (is_new) {
          const std::string group = GroupOf(**event, drawings_);
          first_of.try_emplace(group, rows.size());
          rows.push_back({.name = label, .heading = group, .style = "row"});
          rows.back().lanes = sides_.empty() ? 2 : static_cast<int>(sides_.size()) + 1;
          if (!sides_.empty()) rows.back().id = WithRoles(**event);
        }
        Row& row = rows[found->second];
        if (sides_.empty()) {
          Add(*pairing, row);
        } else {
          AddSide(*pairing, of, event == &pairing->expected, row);
        }
      }
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
    std::size_t events = 0;
    std::ptrdiff_t differing = 0;
    for (const truth::Comparison& comparison : comparisons_) {
      events = std::max(events, comparison.pairings.size());
      differing += std::ranges::count_if(
          comparison.pairings, [&](const truth::Pairing& pairing) { return !Agrees(pairing); });
    }
    if (!has_golden_) return fmt::format("timeline: {} events", events);
    return fmt::format("timeline: {} events, {} differ from the {}", events, differing,
                       sides_.empty() ? "golden" : sides_.front());
  }

  double Seconds(Tick tick) const {
    return truth::SecondsOf(tick, comparisons_[0].ticks_per_second);
  }

 private:
  bool Agrees(const truth::Pairing& pairing) const {
    return !has_golden_ || pairing.agreement == truth::LineVerdict::kMatched;
  }

  void AddBar(const std::string& side, const std::string& style, int lane, const NamedEvent& event,
              const truth::Pairing& pairing, bool agrees, Row& row) const {
    row.bars.push_back(
        {.begin_s = Seconds(event.interval.begin),
         .end_s = Seconds(event.interval.end),
         .text = "",
         .color = drawings_.Of(event.event).color,
         .lane = lane,
         .style = style + (agrees ? "" : " differs"),
         .tip = fmt::format("{} {}, {}: {}", side, event.Label(),
                            truth::IntervalText(event.interval, comparisons_[0].ticks_per_second),
                            has_golden_ ? Name(pairing.agreement) : "no golden")});
  }

  void Add(const truth::Pairing& pairing, Row& row) const {
    const bool agrees = Agrees(pairing);
    if (pairing.expected) AddBar("golden", "golden", 0, *pairing.expected, pairing, agrees, row);
    if (pairing.actual) AddBar("actual", "actual", 1, *pairing.actual, pairing, agrees, row);
    AddHatches(pairing, -1, row);
  }

  /// In its lane one side, below all lanes where they differ.
  void AddSide(const truth::Pairing& pairing, int of, bool is_first_side, Row& row) const {
    const int lane = is_first_side ? 0 : of + 1;
    const bool agrees = is_first_side ? !differing_.contains(pairing.golden_line) : Agrees(pairing);
    if (lane > 0 || of == 0)
      AddBar(sides_[static_cast<std::size_t>(lane)], lane == 0 ? "golden" : "actual", lane,
             is_first_side ? *pairing.expected : *pairing.actual, pairing, agrees, row);
    const bool is_pair =
        pairing.expected && pairing.actual && pairing.expected->Label() == pairing.actual->Label();
    const int below = static_cast<int>(sides_.size());
    if (is_pair) {
      if (is_first_side) AddHatches(pairing, below, row);
    } else if (!Agrees(pairing)) {
      const NamedEvent& event = is_first_side ? *pairing.expected : *pairing.actual;
      row.style = "row differs";
      row.hatches.push_back({Seconds(event.interval.begin), Seconds(event.interval.end), below});
    }
  }

  void AddHatches(const truth::Pairing& pairing, int lane, Row& row) const {
    if (Agrees(pairing)) return;
    row.style = "row differs";
    const auto hatch = [&](Tick from, Tick to) {
      if (from != to)
        row.hatches.push_back({Seconds(std::min(from, to)), Seconds(std::max(from, to)), lane});
    };
    if (!pairing.expected || !pairing.actual)
      return hatch(pairing.event().interval.begin, pairing.event().interval.end);
    hatch(pairing.expected->interval.begin, pairing.actual->interval.begin);
    hatch(pairing.expected->interval.end, pairing.actual->interval.end);
  }

  std::span<const truth::Comparison> comparisons_;
  const Sides& sides_;
  const truth::EventDrawings& drawings_;
  bool has_golden_;
  std::set<std::size_t> differing_;  ///< lines of the first side, from anybody
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
  const auto seconds = [&](grammar::Tick tick) { return truth::SecondsOf(tick, ticks_per_second); };
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

std::string TimelineSvg(std::span<const truth::Comparison> comparisons, const Sides& sides,
                        Tick end, const truth::EventDrawings& drawings, bool has_golden,
                        std::span<const show::PlayedStep> steps) {
  const TimelineChart chart(comparisons, sides, drawings, has_golden);
  std::vector<Row> rows;
  for (const show::PlayedStep& step : steps) {
    auto row = std::ranges::find(rows, step.who, &Row::name);
    if (row == rows.end())
      row = rows.insert(row, {.name = step.who, .heading = rows.empty() ? "script" : ""});
    row->bars.push_back({.begin_s = chart.Seconds(step.begin),
                         .end_s = chart.Seconds(step.end),
                         .text = step.what,
                         .color = kStepColor,
                         .style = "step",
                         .tip = step.what});
  }
  std::ranges::move(chart.Rows(), std::back_inserter(rows));
  return show::ChartForPage(
      {.title = "", .to_s = chart.Seconds(std::max<Tick>(1, end)), .rows = std::move(rows)},
      {.width_px = 1000, .page_class = "timeline"}, chart.Label());
}

std::string TimelineSvg(const truth::Comparison& comparison, Tick end,
                        const truth::EventDrawings& drawings, bool has_golden) {
  return TimelineSvg({&comparison, 1}, {}, end, drawings, has_golden, {});
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

void AddHistory(pugi::xml_node body, const std::vector<PastRun>& history) {
  if (history.size() > 1)
    AddElement(body, "script", {{"type", "application/json"}, {"id", "history"}},
               ScriptText(HistoryJson(history)));
}

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
