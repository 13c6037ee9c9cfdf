// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "grammar/drawing/drawn_episode.h"

namespace prehend::grammar {
namespace {

int Digit(char cell) { return DrawnNumber(cell).value_or(0); }

// A row's value at a time, in the row's own unit, straight between columns.
double Interpolate(const std::string& cells, Tick tick) {
  const double column = static_cast<double>(tick) / kDrawnColumnTicks;
  const auto left = std::min(static_cast<std::size_t>(column), cells.size() - 1);
  const auto right = std::min(left + 1, cells.size() - 1);
  const double share = std::min(column - static_cast<double>(left), 1.0);
  return Digit(cells[left]) + share * (Digit(cells[right]) - Digit(cells[left]));
}

// 1..9 to the left, a..i as far to the right, . not at all.
int Steps(char cell) { return cell >= 'a' ? -(cell - 'a' + 1) : Digit(cell); }

// Two centimetres around the other's origin; each column says by how many sixteenths of a turn it
// goes on.
void Circle(EntitySample& look, const Eigen::Vector3d& centre, const std::string& cells,
            Tick tick) {
  constexpr double kRadius_m = 0.02;
  const auto full = static_cast<std::size_t>(tick / kDrawnColumnTicks);
  double sixteenths = static_cast<double>(tick % kDrawnColumnTicks) / kDrawnColumnTicks *
                      Steps(cells[std::min(full, cells.size() - 1)]);
  for (std::size_t i = 0; i < full; ++i) sixteenths += Steps(cells[std::min(i, cells.size() - 1)]);
  const double rad = sixteenths * std::numbers::pi / 8;
  look.p_WB_m = centre + kRadius_m * Eigen::Vector3d(std::cos(rad), std::sin(rad), 0);
}

void Shake(EntitySample& look, double seconds) {
  constexpr double kAmplitude_m = 0.0002;
  constexpr double kRadPerSecond = 300;
  look.p_WB_m.x() += kAmplitude_m * std::sin(kRadPerSecond * seconds);
  look.v_WB_m_per_s.x() += kAmplitude_m * kRadPerSecond * std::cos(kRadPerSecond * seconds);
}

std::string EventName(const std::string& label) { return label.substr(0, label.find('(')); }

}  // namespace

Frame DrawnFrames::At(Tick tick) {
  looks_.assign(drawn_.entity_table.size(), {});
  touches_.clear();
  hands_.clear();
  collision_spheres_.assign(drawn_.entity_table.size(), {});
  for (std::size_t i = 0; i < drawn_.entity_table.size(); ++i) {
    if (drawn_.entity_table[i].classes.front() == "Hand")
      hands_.push_back({.entity = static_cast<int>(i)});
  }
  for (const bool lost : {false, true}) {  // whatever the other rows say
    for (const DrawnRow& row : drawn_.facts)
      if (row.name.ends_with(" lost") == lost) Apply(row, tick);
  }
  for (HandSample& hand : hands_) {
    collision_spheres_[hand.entity] = {.p_W_m = looks_[hand.entity].p_WB_m, .radius_m = 0};
    hand.collision_spheres = {&collision_spheres_[hand.entity], 1};
  }
  for (Touch& touch : touches_)
    touch.vertical_speed_m_per_s = SpeedAtTheUpper(touch, looks_[touch.a], looks_[touch.b]);
  std::sort(touches_.begin(), touches_.end(), [](const Touch& a, const Touch& b) {
    return std::pair(a.a, a.b) < std::pair(b.a, b.b);
  });
  return {.tick = tick, .entities = looks_, .hands = hands_, .touches = touches_};
}

void DrawnFrames::Apply(const DrawnRow& row, Tick tick) {
  std::istringstream words(row.name);
  std::string who;
  std::string what;
  std::string whom;
  words >> who >> what >> whom;
  const char cell =
      row.cells[std::min(static_cast<std::size_t>(tick / kDrawnColumnTicks), row.cells.size() - 1)];
  if (what == "x" || what == "y" || what == "z") {
    const int axis = what[0] - 'x';
    EntitySample& look = looks_[Id(who)];
    look.p_WB_m[axis] = Interpolate(row.cells, tick) / 100;
    // As a simulator does, the velocity is that of the step that led here.
    look.v_WB_m_per_s[axis] =
        tick == 0 ? 0
                  : (Interpolate(row.cells, tick) - Interpolate(row.cells, tick - 1)) / 100 *
                        kDrawnTicksPerSecond;
  } else if (what == "shakes") {
    if (cell == '#') Shake(looks_[Id(who)], static_cast<double>(tick) / kDrawnTicksPerSecond);
  } else if (what == "lost") {
    if (cell == '#') looks_[Id(who)] = NotTracked();
  } else if (what == "grip") {
    for (HandSample& hand : hands_) {
      if (hand.entity == Id(who)) hand.trigger = cell == '#' ? 1 : Digit(cell) / 10.0;
    }
  } else if (what == "joint") {
    looks_[Id(who)].joint_fraction = Interpolate(row.cells, tick) / 20;
  } else if (what == "percent") {
    looks_[Id(who)].joint_fraction = Interpolate(row.cells, tick) / 100;
  } else if (what == "tilt") {
    const double rad = Interpolate(row.cells, tick) * 5 * std::numbers::pi / 180;
    looks_[Id(who)].q_WB = looks_[Id(who)].q_WB * Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitX());
  } else if (what == "turn") {
    const double rad = Interpolate(row.cells, tick) * 10 * std::numbers::pi / 180;
    looks_[Id(who)].q_WB = Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ()) * looks_[Id(who)].q_WB;
  } else if (what == "circles") {
    Circle(looks_[Id(who)], looks_[Id(whom)].p_WB_m, row.cells, tick);
  } else if (cell != '.') {
    ApplyPair(Id(who), Id(whom), what, cell);
  }
}

void DrawnFrames::ApplyPair(int a, int b, const std::string& what, char cell) {
  const std::vector<std::string>& sets = drawn_.entity_table[a].sensor_sets;
  const auto set = std::find(sets.begin(), sets.end(), what);
  if (what == "looks") {
    looks_[a].gazes_at = b;
  } else if (what == "presses") {
    TouchOf(a, b).normal_force_n = Digit(cell);
  } else if (set != sets.end()) {
    TouchOf(a, b).sensor_sets |= 1U << (set - sets.begin());
  } else {
    AddTouch(a, b, what, cell);
  }
}

// The touch of two, made if there is none.
Touch& DrawnFrames::TouchOf(int a, int b) {
  if (a > b) std::swap(a, b);
  const auto found = std::find_if(touches_.begin(), touches_.end(),
                                  [&](const Touch& t) { return t.a == a && t.b == b; });
  if (found != touches_.end()) return *found;
  touches_.push_back({.a = a, .b = b, .up_on_a = 0, .up_on_b = 0, .normal_force_n = 1});
  return touches_.back();
}

void DrawnFrames::AddTouch(int a, int b, const std::string& how, char cell) {
  Touch& touch = TouchOf(a, b);
  if (how == "on") {
    touch.up_on_a = a < b ? 1 : -1;
    touch.up_on_b = a < b ? -1 : 1;
  } else if (how == "holds") {
    touch.sensor_sets |= static_cast<std::uint32_t>((std::uint64_t{1} << Digit(cell)) - 1);
  }
}

// The mean of the steps of a jittered camera is the usual frame.
Tick DrawnFrames::StepAfter(int frame, int frames_per_second) const {
  static constexpr std::array<Tick, 7> kJitter = {36, 25, 47, 14, 58, 32, 40};
  return drawn_.jittered ? kJitter[static_cast<std::size_t>(frame) % kJitter.size()]
                         : kDrawnTicksPerSecond / frames_per_second;
}

int DrawnFrames::Id(const std::string& name) const {
  return static_cast<int>(std::ranges::find(drawn_.entity_table, name, &EntityInfo::name) -
                          drawn_.entity_table.begin());
}

std::vector<DrawnRow> DrawEvents(const DrawnEpisode& c, const Timeline& timeline,
                                 const std::vector<std::string>& background) {
  std::vector<std::string> wanted;
  for (const DrawnRow& row : c.expected) wanted.push_back(EventName(row.name));
  const auto among = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  std::vector<DrawnRow> rows;
  for (const NamedEvent& event : timeline.events) {
    if (among(background, event.event) && !among(wanted, event.event)) continue;
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const DrawnRow& r) { return r.name == event.Label(); });
    if (row == rows.end()) {
      rows.push_back({event.Label(), std::string(c.facts.front().cells.size(), '.')});
      row = rows.end() - 1;
    }
    const auto column = [](Tick tick) {
      return static_cast<std::size_t>((tick + kDrawnColumnTicks / 2) / kDrawnColumnTicks);
    };
    const std::size_t begin = column(event.interval.begin);
    for (std::size_t i = begin; i < column(event.interval.end) && i < row->cells.size(); ++i) {
      row->cells[i] = i == begin ? '[' : '=';
    }
  }
  return rows;
}

std::string Text(const std::vector<DrawnRow>& rows) {
  std::string text;
  for (const DrawnRow& row : rows) {
    text += row.name + std::string(row.name.size() < 28 ? 28 - row.name.size() : 0, ' ') + "|" +
            row.cells + "|\n";
  }
  return text;
}

}  // namespace prehend::grammar
