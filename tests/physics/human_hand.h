// SPDX-License-Identifier: Apache-2.0
// A human right hand for tests.
#pragma once
#include <numbers>
#include "physics/hand_model.h"
namespace prehend::physics {
inline HandModel HumanRight() {
  constexpr double kDeg = std::numbers::pi / 180;
  HandModel m;
  m.name = "human_right";
  m.ahead = Eigen::Vector3d(1, 0, -1).normalized();
  m.sensor_sets = {"fingers", "thumb", "palm"};
  m.palm_sensor_set = 2;
  m.translation = {2500, 120, 2000, 80, 0.6};
  m.rotation = {30, 1.2, 30, 8, 0.6};
  const double y[] = {0.031, 0.0105, -0.0105, -0.031}, scale[] = {1, 1.06, 1, 0.85};
  const char* fingers[] = {"index", "middle", "ring", "little"};
  const Eigen::Vector3d X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);
  for (int f = 0; f < 4; ++f) {
    const double l[] = {0.045 * scale[f], 0.027 * scale[f], 0.022 * scale[f]}, t[] = {0.0075, 0.007, 0.0065},
                 mass[] = {0.020, 0.012, 0.008}, tau[] = {1.2, 0.8, 0.4}, lo[] = {-20, -2, -10}, hi[] = {95, 100, 80};
    const char* parts[] = {"_proximal", "_middle", "_distal"};
    double x = 0.045;
    for (int k = 0; k < 3; ++k) {
      m.links.push_back({std::string(fingers[f]) + parts[k], k ? static_cast<int>(m.links.size()) - 1 : -1, {x, y[f], 0}, X, Y, l[k],
                         0.008, t[k], mass[k], tau[k], lo[k] * kDeg, hi[k] * kDeg, 0});
      x += l[k];
    }
  }
  m.links.push_back({"thumb_trapezium", -1, {-0.030, 0.036, -0.006}, Y, -X, 0.010, 0.009, 0.009, 0.030, 3.0, -20 * kDeg, 125 * kDeg, 1});
  m.links.push_back({"thumb_metacarpal", 12, {-0.030, 0.046, -0.006}, Y, -Z, 0.040, 0.010, 0.009, 0.030, 2.5, -60 * kDeg, 100 * kDeg, 1});
  m.links.push_back({"thumb_proximal", 13, {-0.030, 0.086, -0.006}, Y, -Z, 0.034, 0.009, 0.008, 0.020, 1.5, -10 * kDeg, 70 * kDeg, 1});
  m.links.push_back({"thumb_distal", 14, {-0.030, 0.120, -0.006}, Y, -Z, 0.027, 0.009, 0.0075, 0.012, 0.8, -15 * kDeg, 80 * kDeg, 1});

  using F = std::vector<double>;
  const auto frame = [&](F a, F b, F c, F d, F thumb) {
    F all;
    for (const F& part : {a, b, c, d, thumb}) all.insert(all.end(), part.begin(), part.end());
    for (double& v : all) v *= kDeg;
    return all;
  };
  const auto effort = [&](double finger, double thumb, double cmc) {
    F all(12, finger);
    all.insert(all.end(), {thumb, cmc, thumb, thumb});
    return all;
  };
  const F rest = {5, 10, 5};
  const auto n = -Z;
  {
    GraspStyle s{.name = "wrap", .effort = effort(0.4, 1.6, 1.6), .grip_axis = X, .post_m = {-0.016, 0, 0}};
    const F o = {25, 15, 5}, h = {55, 25, 10}, c = {90, 60, 35};
    s.frames_rad = {frame(o, o, o, o, {108, -35, 0, 0}), frame(h, h, h, h, {108, -8, 5, 5}), frame(c, c, c, c, {108, 4, 12, 10})};
    s.above = GraspApproach{.toward = n, .palm_gap_m = 0.0245, .pads_m = 0.06, .floor_m = 0.122};
    s.side = GraspApproach{.toward = n, .up = Y, .palm_gap_m = 0.0185, .pads_m = 0.045, .floor_m = 0.055};
    m.styles.push_back(s);
  }
  for (const bool tripod : {false, true}) {
    const double opp = tripod ? 101 : 95;
    GraspStyle s{.name = tripod ? "tripod" : "pinch", .effort = effort(tripod ? 0.6 : 1.0, 1.6, 1.6), .grip_axis = X,
                 .post_m = {-0.0136, tripod ? 0.020 : 0.031, 0}, .opening_m = 0.075};
    const F o = {45, 15, 5}, h = {62, 18, 8}, c = {90, 35, 15};
    const auto at = [&](const F& f, F thumb) { return frame(f, tripod ? f : rest, rest, rest, thumb); };
    s.frames_rad = {at(o, {opp, -25, 0, 0}), at(h, {opp, -8, 3, 2}), at(c, {opp, 2, 6, 4})};
    s.above = GraspApproach{.toward = n, .palm_gap_m = 0.02, .pads_m = 0.075, .floor_m = 0.122};
    s.side = GraspApproach{.toward = n, .up = Y, .palm_gap_m = 0.02, .pads_m = 0.075, .floor_m = 0.055};
    m.styles.push_back(s);
  }
  {
    GraspStyle s{.name = "lateral", .effort = effort(1.0, 1.6, 0.5), .grip_axis = Y, .post_m = {0, 0.043, 0}, .opening_m = 0.03};
    const F i = {10, 15, 5}, c = {15, 25, 10};
    s.frames_rad = {frame(i, c, c, c, {0, 45, 20, 0}), frame(i, c, c, c, {0, 65, 20, 0}), frame(i, c, c, c, {0, 95, 22, 0})};
    s.above = GraspApproach{.toward = X, .palm_gap_m = 0.05, .pads_m = 0.072, .floor_m = 0.15};
    m.styles.push_back(s);
  }
  return m;
}
}  // namespace prehend::physics
