// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <ranges>
#include <string_view>
#include <tuple>

#include "harness/show/pictures/pictures.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {
namespace {

using grammar::DrawnAs;
using grammar::NamedEvent;

constexpr double kForceWindow_s = 0.05;  ///< forces are means over so long
constexpr double kMoves_m = 0.01;        ///< what rises or sinks less has no curve
constexpr double kTilts_deg = 5;         ///< likewise what leans over less
constexpr double kApart_s = 0.1;         ///< scenes of moments that are nearer look the same

/// The roles but that of the hand: "milk".
std::string OthersOf(const episode::RunResult& run, const NamedEvent& event) {
  const truth::EventDrawing& drawing = run.drawings.Of(event.event);
  std::string others;
  for (std::size_t i = 0; i < event.roles.size(); ++i) {
    if (i == drawing.hand || truth::IsAttribute(event.roles[i])) continue;
    others += (others.empty() ? "" : ", ") + event.roles[i].value;
  }
  return others;
}

Bar BarOf(const episode::RunResult& run, const NamedEvent& event, std::string text) {
  return {.begin_s = SecondsOf(run, event.interval.begin),
          .end_s = SecondsOf(run, event.interval.end),
          .text = std::move(text),
          .color = run.drawings.Of(event.event).color,
          .kind = event.event,
          .tip = event.Label()};
}

/// The phases of each hand, in the order of the hands.
std::vector<Row> PhaseRows(const scenario::Scenario& scenario, const episode::RunResult& run,
                           const Window& window) {
  std::vector<Row> rows;
  for (const physics::Hand& hand : scenario.scene.hands) {
    Row row{.name = hand.name};
    for (const NamedEvent& event : run.timeline.events) {
      if (run.drawings.Of(event.event).as == DrawnAs::kPhase && HandOf(run, event) == hand.name &&
          window.Shows(scenario, event))
        row.bars.push_back(BarOf(run, event, event.event));
    }
    if (!row.bars.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

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

Chart PhasesChart(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const Window& window) {
  Chart chart{.title = scenario.name + ", " + scenario.grammar,
              .from_s = window.from_s,
              .to_s = window.to_s,
              .rows = PhaseRows(scenario, run, window)};
  std::vector<Row> others;
  std::map<std::string, std::string> base;  // of a row's name: without its number
  for (const NamedEvent& event : run.timeline.events) {
    const truth::EventDrawing& drawing = run.drawings.Of(event.event);
    if (drawing.as == DrawnAs::kPhase || drawing.as == DrawnAs::kNothing) continue;
    const bool is_in = SecondsOf(run, event.interval.end) > window.from_s &&
                       SecondsOf(run, event.interval.begin) < window.to_s;
    if (!is_in || !window.Shows(scenario, event)) continue;
    const bool of_hand = drawing.as == DrawnAs::kGrasp, is_on = drawing.as == DrawnAs::kSupport;
    const std::string name = of_hand ? HandOf(run, event) + ": " + event.event
                             : is_on ? event.roles[drawing.first].value + " on"
                                     : event.event;
    auto row = std::ranges::find(others, name, &Row::name);
    // Events of one row that overlap need rows of their own.
    int copy = 1;
    while (row != others.end() &&
           row->bars.back().end_s > SecondsOf(run, event.interval.begin) + 1e-9) {
      row = std::ranges::find(others, fmt::format("{} {}", name, ++copy), &Row::name);
    }
    if (row == others.end()) {
      others.push_back({copy == 1 ? name : fmt::format("{} {}", name, copy), {}});
      row = others.end() - 1;
      base[row->name] = name;
    }
    row->bars.push_back(BarOf(run, event,
                              of_hand ? OthersOf(run, event)
                              : is_on ? event.roles[drawing.last].value
                                      : event.Label()));
    if (!of_hand && !is_on) {
      std::string& text = row->bars.back().text;  // "contact(milk, table)" -> "milk, table"
      const std::size_t open = text.find('(');
      if (open != std::string::npos) text = text.substr(open + 1, text.size() - open - 2);
    }
  }
  // Rows of hands, then as they change; what stays is last. Numbered rows stay together.
  std::map<std::string, double> change_s;
  for (const Row& row : others) {
    const double first_s = FirstChange_s(row.bars, window.from_s, window.to_s);
    const auto known = change_s.try_emplace(base[row.name], first_s).first;
    known->second =
        row.name.find(": ") != std::string::npos ? -1 : std::min(known->second, first_s);
  }
  std::ranges::stable_sort(others, {}, [&](const Row& row) { return change_s[base[row.name]]; });
  chart.rows.insert(chart.rows.end(), others.begin(), others.end());
  return chart;
}

Chart SideBySide(Chart chart, const std::string& here, const Chart& other,
                 const std::string& there) {
  std::vector<Row> rows;
  std::vector<bool> taken(other.rows.size(), false);
  const auto add = [&](const Row& row, const std::string& whose) {
    rows.push_back({fmt::format("{} ({})", row.name, whose), row.bars, row.hatches});
  };
  for (const Row& row : chart.rows) {
    add(row, here);
    for (std::size_t i = 0; i < other.rows.size(); ++i) {
      if (other.rows[i].name != row.name) continue;
      add(other.rows[i], there);
      taken[i] = true;
    }
  }
  for (std::size_t i = 0; i < other.rows.size(); ++i) {
    if (!taken[i]) add(other.rows[i], there);
  }
  chart.rows = std::move(rows);
  return chart;
}

Chart SeriesChart(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const Window& window) {
  Chart chart{.title = scenario.name + ", " + scenario.grammar,
              .from_s = window.from_s,
              .to_s = window.to_s,
              .rows = PhaseRows(scenario, run, window)};
  const physics::Scene& scene = scenario.scene;
  Panel heights{"height, m", {}}, tilts{"tilt, degrees", {}}, triggers{"trigger", {}},
      forces{"force of touch, N", {}};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const physics::Body& body = scene.bodies[i];
    if (body.fixed || body.kinematic || body.grains) continue;
    Curve curve{body.name, {}}, tilt{body.name, {}};
    double least = 1e9, most = -1e9;
    for (const physics::Snapshot& snapshot : run.recording) {
      const double height_m = snapshot.bodies[i].X_WB.p_m.z();
      curve.points.emplace_back(SecondsOf(run, snapshot.tick), height_m);
      const double up = (snapshot.bodies[i].X_WB.q * Eigen::Vector3d::UnitZ()).z();
      tilt.points.emplace_back(curve.points.back().first,
                               std::acos(std::clamp(up, -1.0, 1.0)) * 180 / std::numbers::pi);
      least = std::min(least, height_m);
      most = std::max(most, height_m);
    }
    if (most - least < kMoves_m) continue;
    heights.curves.push_back(std::move(curve));
    const auto lean = std::ranges::max_element(tilt.points, {}, &std::pair<double, double>::second);
    if (lean != tilt.points.end() && lean->second >= kTilts_deg)
      tilts.curves.push_back(std::move(tilt));
  }
  const double rate_hz = scene.world.rate_hz, share = 1 / (kForceWindow_s * rate_hz);
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    Curve trigger{scene.hands[h].name, {}}, force{scene.hands[h].name, {}};
    double mean_n = 0;
    for (const physics::Snapshot& snapshot : run.recording) {
      const double time_s = SecondsOf(run, snapshot.tick);
      trigger.points.emplace_back(time_s, snapshot.hands[h].trigger);
      double impulse_n_s = 0;
      for (const auto& part : snapshot.AllContacts()) {
        for (const physics::ContactPoint& point : part) {
          const physics::HandIndex index(h);
          if (point.a.hand == index || point.b.hand == index)
            impulse_n_s += point.normal_impulse_n_s;
        }
      }
      mean_n += std::min(share, 1.0) * (impulse_n_s * rate_hz - mean_n);
      force.points.emplace_back(time_s, mean_n);
    }
    triggers.curves.push_back(std::move(trigger));
    forces.curves.push_back(std::move(force));
  }
  for (Panel* panel : {&heights, &tilts, &triggers, &forces})
    if (!panel->curves.empty()) chart.panels.push_back(std::move(*panel));
  return chart;
}

std::vector<KeyMoment> SeriesMoments(const Chart& chart, std::size_t count) {
  std::vector<KeyMoment> moments;
  // In the order of what tells most: on its way over, level, over; most pressed, up.
  const std::tuple<const char*, double, double> wanted[] = {{"tilt", 0.5, kTilts_deg},
                                                            {"tilt", 0.05, kTilts_deg},
                                                            {"tilt", 0.95, kTilts_deg},
                                                            {"force", 1, 1.0},
                                                            {"height", 1, kMoves_m}};
  for (const auto& [name, share, least] : wanted) {
    KeyMoment first{.time_s = chart.to_s + 1};
    double greatest = -1e9;
    for (const Panel& panel : chart.panels) {
      if (!panel.name.starts_with(name)) continue;
      const std::size_t comma = panel.name.find(", ");
      for (const Curve& curve : panel.curves) {
        double low = 1e9, high = -1e9;
        auto in = std::views::filter(curve.points, [&](const auto& point) {
          return point.first >= chart.from_s && point.first <= chart.to_s;
        });
        for (const auto& [time_s, value] : in)
          low = std::min(low, value), high = std::max(high, value);
        for (const auto& [time_s, value] : in) {
          if (high - low < least || value < (share < 1 ? low + share * (high - low) : high))
            continue;
          if (share < 1 ? time_s < first.time_s : value > greatest) {
            greatest = value;
            first = {.time_s = time_s,
                     .caption = fmt::format("{} of {}: {:.3g} {}", panel.name.substr(0, comma),
                                            curve.name, value, panel.name.substr(comma + 2))};
          }
          break;
        }
      }
    }
    const auto is_near = [&](const KeyMoment& other) {
      return std::abs(other.time_s - first.time_s) < kApart_s;
    };
    if (!first.caption.empty() && moments.size() < count && std::ranges::none_of(moments, is_near))
      moments.push_back(first);
  }
  std::ranges::sort(moments, {}, &KeyMoment::time_s);
  return moments;
}

std::optional<Chart> GazeChart(const scenario::Scenario& scenario, const episode::RunResult& run,
                               const Window& window) {
  const physics::Scene& scene = scenario.scene;
  if (scene.persons.empty()) return std::nullopt;
  Chart chart{.title = scenario.name + ", " + scenario.grammar,
              .from_s = window.from_s,
              .to_s = window.to_s,
              .rows = PhaseRows(scenario, run, window)};
  for (const NamedEvent& event : run.timeline.events) {
    if (run.drawings.Of(event.event).as != DrawnAs::kGrasp) continue;
    const std::string name = HandOf(run, event) + ": " + event.event;
    auto row = std::ranges::find(chart.rows, name, &Row::name);
    if (row == chart.rows.end()) row = chart.rows.insert(chart.rows.end(), {name, {}});
    row->bars.push_back(BarOf(run, event, OthersOf(run, event)));
  }
  // Rows in the order of the names; what a person looks at.
  std::map<std::string, Row> rows;
  for (const Look& look : Looks(scenario, run, window)) {
    const std::string name = look.person + " sees " + look.seen;
    Row& row = rows.try_emplace(name, Row{name, {}}).first->second;
    row.bars.push_back({.begin_s = look.begin_s,
                        .end_s = look.end_s,
                        .text = fmt::format("{:.2f} s", look.Dwell_s()),
                        .color = 0x0072B2});
  }
  for (auto& [name, row] : rows) chart.rows.push_back(std::move(row));
  Panel distances{"distance to what is seen, m", {}};
  for (std::size_t p = 0; p < scene.persons.size(); ++p) {
    Curve distance{scene.persons[p].name, {}};
    for (const physics::Snapshot& snapshot : run.recording) {
      const physics::GazeState& gaze = snapshot.gazes[p];
      const bool sees = gaze.body != physics::kNone || gaze.hand != physics::kNone;
      distance.points.emplace_back(
          SecondsOf(run, snapshot.tick),
          sees ? gaze.distance_m : std::numeric_limits<double>::quiet_NaN());
    }
    distances.curves.push_back(std::move(distance));
  }
  chart.panels.push_back(std::move(distances));
  return chart;
}

Chart DrawingChart(const grammar::Program& program, const grammar::DrawnEpisode& drawn,
                   const grammar::Timeline& timeline) {
  const auto seconds = [&](grammar::Tick tick) {
    return truth::SecondsOf(tick, timeline.ticks_per_second);
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
