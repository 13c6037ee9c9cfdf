// SPDX-License-Identifier: Apache-2.0
// A motion of a whole body, through figures at given times. Tested by
// tests/physics/figure_test.cc
#pragma once

#include <vector>

#include "physics/figure.h"
#include "physics/trajectory.h"

namespace prehend::physics {

/// A motion through figures, passed without stopping: the hips on the monotone cubic of
/// WaypointTrajectory(), the ways turning evenly between neighbours.
class FigureTrack {
 public:
  /// Starts with `from` unless the first figure is at time 0. At least one figure.
  FigureTrack(const Figure& from, std::vector<TimedFigure> figures);
  /// Before the first: as it starts. After the last: as it ends.
  Figure At(double t_s) const;

 private:
  std::vector<TimedFigure> figures_;
  Trajectory hips_;
};

}  // namespace prehend::physics
