// SPDX-License-Identifier: Apache-2.0
// How fast a grammar is evaluated on this machine; each figure is the best of several runs. Tested
// by tests/program/command_line_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"

namespace prehend::measure {

struct SpeedFigure {
  std::string what;
  std::string unit;        ///< of one operation
  double operations = 0;   ///< in one run
  double seconds = 0;      ///< of one run
  double events = 0;       ///< in one run
  double simulated_s = 0;  ///< of one run
  double physics_s = 0;    ///< of the world in one run; 0: there is no world
};

/// The monitor alone on the frames of an episode; of a scenario also with sensing, beside its
/// physics. With `quick` one run.
std::vector<SpeedFigure> MeasureSpeed(episode::Episode& episode, bool quick);

}  // namespace prehend::measure
