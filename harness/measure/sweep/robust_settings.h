// SPDX-License-Identifier: Apache-2.0
// Where a sweep is good and stays good, as text, CSV and a heat map. Tested by
// tests/harness/measure/sweep/robust_settings_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/measure/sweep/sweep.h"

namespace prehend::measure {

/// The settings whose score is within a distance of the best, and that hang together with the
/// chosen one: of all such settings the one that is farthest from any worse one, and from the
/// border of what was tried; of equals the best, then the first. Without members if no setting has
/// a score above 0.
struct RobustSettings {
  double best = 0;
  std::size_t chosen = 0;            ///< index of a point
  std::size_t steps = 0;             ///< how many steps away the nearest worse one is
  std::vector<std::size_t> members;  ///< indices of points, rising
};
RobustSettings FindRobustSettings(const std::vector<Axis>& axes,
                                  const std::vector<SweepPoint>& points, double within);

std::string CsvText(const std::vector<Axis>& axes, const std::vector<SweepPoint>& points);

/// What it says about the best region, for people.
std::string RobustSettingsText(const std::vector<Axis>& axes, const SweepResult& result,
                               double within);

/// The score over one or two axes as SVG; of more axes the others are as in the chosen setting.
std::string HeatMapSvg(const std::vector<Axis>& axes, const std::vector<SweepPoint>& points,
                       const RobustSettings& robust);

}  // namespace prehend::measure
