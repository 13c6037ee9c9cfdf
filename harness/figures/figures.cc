// SPDX-License-Identifier: Apache-2.0
// See harness/figures/figures.h. Tested by tests/harness/figures/figures_test.cc
#include "harness/figures/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "harness/timeline/event_text.h"
#include "physics/scene/geometry.h"

namespace prehend::harness::figures {
namespace {

using grammar::DrawnAs;
using grammar::NamedEvent;

constexpr double kForceWindow_s = 0.05;  ///< forces are means over so long
constexpr double kMoves_m = 0.01;        ///< what rises or sinks less has no curve

double Seconds(const RunResult& run, grammar::Tick tick) {
  return static_cast<double>(tick) / static_cast<double>(run.timeline.ticks_per_second);
}

std::string HandOf(const RunResult& run, const NamedEvent& event) {
  const EventDrawing& drawing = run.drawings.Of(event.event);
  return drawing.hand < event.roles.size() ? event.roles[drawing.hand].value : std::string();
}

/// The roles but that of the hand: "milk".
std::string OthersOf(const RunResult& run, const NamedEvent& event) {
  const EventDrawing& drawing = run.drawings.Of(event.event);
  std::string others;
  for (std::size_t i = 0; i < event.roles.size(); ++i) {
    if (i == drawing.hand || IsAttribute(event.roles[i])) continue;
    others += (others.empty() ? "" : ", ") + event.roles[i].value;
  }
  return others;
}

Bar BarOf(const RunResult& run, const NamedEvent& event, std::string text) {
  return {.begin_s = Seconds(run, event.interval.begin),
          .end_s = Seconds(run, event.interval.end),
          .text = std::move(text),
          .color = run.drawings.Of(event.event).color,
          .kind = event.event};
}

/// The phases of each hand, in the order of the hands.
std::vector<Row> PhaseRows(const Scenario& scenario, const RunResult& run) {
  std::vector<Row> rows;
  for (const physics::Hand& hand : scenario.scene.hands) {
    Row row{.name = hand.name, .bars = {}};
    for (const NamedEvent& event : run.timeline.events) {
      if (run.drawings.Of(event.event).as == DrawnAs::kPhase && HandOf(run, event) == hand.name)
        row.bars.push_back(BarOf(run, event, event.event));
    }
    if (!row.bars.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Window WholeOf(const RunResult& run) { return {0, Seconds(run, run.ticks)}; }

std::vector<KeyMoment> KeyMoments(const RunResult& run, const Window& window, std::size_t most) {
  struct Phase {
    double begin_s, end_s;
    std::string name;
  };
  std::vector<Phase> phases;
  for (const NamedEvent& event : run.timeline.events) {
    const Phase phase{Seconds(run, event.interval.begin), Seconds(run, event.interval.end),
                      event.event};
    const bool is_phase = run.drawings.Of(event.event).as == DrawnAs::kPhase;
    if (is_phase && phase.begin_s >= window.from_s && phase.begin_s <= window.to_s)
      phases.push_back(phase);
  }
  std::map<double, std::string> moments;
  const auto add = [&](double time_s, const std::string& caption) {
    if (moments.size() < most && time_s <= window.to_s) moments.try_emplace(time_s, caption);
  };
  add(window.from_s, "begin");
  add(window.to_s, "end");
  for (const Phase& phase : phases) add(phase.begin_s, phase.name + " begins");
  if (!phases.empty()) {
    const Phase& last = *std::ranges::max_element(phases, {}, &Phase::end_s);
    add(last.end_s, last.name + " ends");
  }
  std::ranges::sort(phases, std::greater<>(),
                    [](const Phase& phase) { return phase.end_s - phase.begin_s; });
  for (const Phase& phase : phases) add((phase.begin_s + phase.end_s) / 2, phase.name);
  std::vector<KeyMoment> found;
  for (const auto& [time_s, caption] : moments) found.push_back({time_s, caption});
  return found;
}

Chart PhasesChart(const Scenario& scenario, const RunResult& run, const Window& window) {
  Chart chart{.title = scenario.name + ", " + scenario.grammar,
              .from_s = window.from_s,
              .to_s = window.to_s,
              .rows = PhaseRows(scenario, run),
              .panels = {}};
  std::vector<Row> others;
  for (const NamedEvent& event : run.timeline.events) {
    const EventDrawing& drawing = run.drawings.Of(event.event);
    if (drawing.as == DrawnAs::kPhase || drawing.as == DrawnAs::kNothing) continue;
    const bool of_hand = drawing.as == DrawnAs::kGrasp;
    const std::string name = of_hand ? HandOf(run, event) + ": " + event.event : event.event;
    auto row = std::ranges::find(others, name, &Row::name);
    // Events of one row that overlap need rows of their own.
    int copy = 1;
    while (row != others.end() &&
           row->bars.back().end_s > Seconds(run, event.interval.begin) + 1e-9) {
      row = std::ranges::find(others, fmt::format("{} {}", name, ++copy), &Row::name);
    }
    if (row == others.end()) {
      others.push_back({copy == 1 ? name : fmt::format("{} {}", name, copy), {}});
      row = others.end() - 1;
    }
    row->bars.push_back(BarOf(run, event, of_hand ? OthersOf(run, event) : event.Label()));
    if (!of_hand) {
      std::string& text = row->bars.back().text;  // "contact(milk, table)" -> "milk, table"
      const std::size_t open = text.find('(');
      if (open != std::string::npos) text = text.substr(open + 1, text.size() - open - 2);
    }
  }
  std::ranges::stable_sort(others, {}, &Row::name);
  chart.rows.insert(chart.rows.end(), others.begin(), others.end());
  return chart;
}

Chart SideBySide(Chart chart, const std::string& here, const Chart& other,
                 const std::string& there) {
  std::vector<Row> rows;
  std::vector<bool> taken(other.rows.size(), false);
  const auto add = [&](const Row& row, const std::string& whose) {
    rows.push_back({fmt::format("{} ({})", row.name, whose), row.bars});
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

Chart SeriesChart(const Scenario& scenario, const RunResult& run, const Window& window) {
  Chart chart{.title = scenario.name + ", " + scenario.grammar,
              .from_s = window.from_s,
              .to_s = window.to_s,
              .rows = PhaseRows(scenario, run),
              .panels = {}};
  const physics::Scene& scene = scenario.scene;
  Panel heights{"height, m", {}}, triggers{"trigger", {}}, forces{"force of touch, N", {}};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const physics::Body& body = scene.bodies[i];
    if (body.fixed || body.kinematic || body.grains) continue;
    Curve curve{body.name, {}};
    double least = 1e9, most = -1e9;
    for (const physics::Snapshot& snapshot : run.recording) {
      const double height_m = snapshot.bodies[i].X_WB.p_m.z();
      curve.points.emplace_back(Seconds(run, snapshot.tick), height_m);
      least = std::min(least, height_m);
      most = std::max(most, height_m);
    }
    if (most - least >= kMoves_m) heights.curves.push_back(std::move(curve));
  }
  const double rate_hz = scene.world.rate_hz, share = 1 / (kForceWindow_s * rate_hz);
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    Curve trigger{scene.hands[h].name, {}}, force{scene.hands[h].name, {}};
    double mean_n = 0;
    for (const physics::Snapshot& snapshot : run.recording) {
      const double time_s = Seconds(run, snapshot.tick);
      trigger.points.emplace_back(time_s, snapshot.hands[h].trigger);
      double impulse_n_s = 0;
      for (const auto& part : snapshot.AllContacts()) {
        for (const physics::ContactPoint& point : part) {
          const auto index = static_cast<int>(h);
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
  for (Panel* panel : {&heights, &triggers, &forces})
    if (!panel->curves.empty()) chart.panels.push_back(std::move(*panel));
  return chart;
}

std::optional<Chart> GazeChart(const Scenario& scenario, const RunResult& run,
                               const Window& window) {
  const physics::Scene& scene = scenario.scene;
  if (scene.persons.empty()) return std::nullopt;
  Chart chart{.title = scenario.name + ", " + scenario.grammar,
              .from_s = window.from_s,
              .to_s = window.to_s,
              .rows = PhaseRows(scenario, run),
              .panels = {}};
  for (const NamedEvent& event : run.timeline.events) {
    if (run.drawings.Of(event.event).as != DrawnAs::kGrasp) continue;
    const std::string name = HandOf(run, event) + ": " + event.event;
    auto row = std::ranges::find(chart.rows, name, &Row::name);
    if (row == chart.rows.end()) row = chart.rows.insert(chart.rows.end(), {name, {}});
    row->bars.push_back(BarOf(run, event, OthersOf(run, event)));
  }
  Panel distances{"distance to what is seen, m", {}};
  for (std::size_t p = 0; p < scene.persons.size(); ++p) {
    std::map<std::string, Row> seen;
    std::string last;
    Curve distance{scene.persons[p].name, {}};
    for (const physics::Snapshot& snapshot : run.recording) {
      const physics::GazeState& gaze = snapshot.gazes[p];
      const double time_s = Seconds(run, snapshot.tick);
      const std::string name =
          gaze.body >= 0   ? scene.bodies[static_cast<std::size_t>(gaze.body)].name
          : gaze.hand >= 0 ? scene.hands[static_cast<std::size_t>(gaze.hand)].name
                           : std::string();
      if (!name.empty()) {
        Row& row = seen[name];
        row.name = scene.persons[p].name + " sees " + name;
        if (name != last || row.bars.empty())
          row.bars.push_back({.begin_s = time_s, .end_s = time_s, .text = {}, .color = 0x0072B2});
        row.bars.back().end_s = time_s;
        distance.points.emplace_back(time_s, gaze.distance_m);
      } else if (!last.empty()) {
        distance.points.emplace_back(time_s, std::numeric_limits<double>::quiet_NaN());
      }
      last = name;
    }
    for (auto& [name, row] : seen) {
      for (Bar& bar : row.bars) bar.text = fmt::format("{:.2f} s", bar.end_s - bar.begin_s);
      chart.rows.push_back(std::move(row));
    }
    distances.curves.push_back(std::move(distance));
  }
  chart.panels.push_back(std::move(distances));
  return chart;
}

std::optional<HeldMoment> LongestGrasp(const Scenario& scenario, const RunResult& run) {
  const NamedEvent* longest = nullptr;
  for (const NamedEvent& event : run.timeline.events) {
    if (run.drawings.Of(event.event).as != DrawnAs::kGrasp || RoleValue(event, "style").empty())
      continue;
    if (!longest ||
        event.interval.end - event.interval.begin > longest->interval.end - longest->interval.begin)
      longest = &event;
  }
  if (!longest) return std::nullopt;
  const grammar::Tick middle = (longest->interval.begin + longest->interval.end) / 2;
  HeldMoment moment{
      .time_s = Seconds(run, middle), .style = RoleValue(*longest, "style"), .sensor_sets = {}};
  const physics::Scene& scene = scenario.scene;
  const auto hand = std::ranges::find(scene.hands, HandOf(run, *longest), &physics::Hand::name);
  const auto snapshot = std::ranges::find_if(
      run.recording, [&](const physics::Snapshot& one) { return one.tick >= middle; });
  if (hand == scene.hands.end() || snapshot == run.recording.end()) return moment;
  // Only of what is held: a finger may touch the table, too.
  const std::size_t role = run.drawings.Of(longest->event).first;
  const int held =
      role < longest->roles.size() ? physics::FindBody(scene, longest->roles[role].value) : -1;
  std::set<int> sets;
  const auto index = static_cast<int>(hand - scene.hands.begin());
  for (const physics::ContactPoint& point : snapshot->contacts) {
    for (const physics::ContactSide& side : {point.a, point.b}) {
      const bool touches_held = point.a.body == held || point.b.body == held;
      if (side.hand != index || !touches_held) continue;
      sets.insert(side.link < 0
                      ? hand->model.palm_sensor_set
                      : hand->model.links[static_cast<std::size_t>(side.link)].sensor_set);
    }
  }
  for (const int set : sets) {
    if (set >= 0 && set < static_cast<int>(hand->model.sensor_sets.size()))
      moment.sensor_sets.push_back(hand->model.sensor_sets[static_cast<std::size_t>(set)]);
  }
  return moment;
}

}  // namespace prehend::harness::figures
