// SPDX-License-Identifier: Apache-2.0
// A story for tests of imports: a hand reaches a cup at 1 s, lifts it at 1.3 s, carries it from 2
// to 3 s, and has put it down at 3.5 s; of poses only, in metres, z up.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace prehend::house {

struct Row {
  double t_s, x, y, z;
};

/// Between points in time, straight lines.
inline double Along(const std::vector<std::pair<double, double>>& points, double t) {
  if (t <= points.front().first) return points.front().second;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto [t0, v0] = points[i - 1];
    const auto [t1, v1] = points[i];
    if (t < t1) return v0 + (v1 - v0) * (t - t0) / (t1 - t0);
  }
  return points.back().second;
}

inline Row CupAt(double t) {
  return {t, Along({{2, 0}, {3, 0.4}}, t), 0,
          0.77 + Along({{1.3, 0}, {2, 0.215}, {3, 0.215}, {3.5, 0}}, t)};
}
inline Row HandAt(double t) {
  const Row cup = CupAt(t);
  const double away = Along({{0.2, 0.4}, {1, 0}, {3.7, 0}, {4.3, 0.4}}, t);
  return {t, cup.x - 0.08 - away, 0, cup.z + away / 2};
}

inline constexpr const char* kCupMap = R"(import: 1
episode: a_cup_is_carried
unit: m
axes: z_up
quaternion_order: wxyz
time_unit: s
columns:
  time: t
  body: name
  position: ['x', 'y', 'z']
  quaternion: [qw, qx, qy, qz]
entities:
  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}
  cup: {from: Mug, class: Cup, size_m: [0.08, 0.08, 0.1]}
  hand: {from: Glove, hand: true, size_m: [0, 0, 0]}
)";

inline std::string AsWritten(const char* name, Row row) {
  char text[200];
  std::snprintf(text, sizeof text, "%.4f,%s,%.5f,%.5f,%.5f,1,0,0,0\n", row.t_s, name, row.x, row.y,
                row.z);
  return text;
}

}  // namespace prehend::house
