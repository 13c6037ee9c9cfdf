// SPDX-License-Identifier: Apache-2.0
// How fast a grammar is evaluated on this machine; each figure is the best of several runs. Tested
// by tests/program/command_line_test.cc
#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"

namespace prehend::measure {

// Processor time, not wall time, because other programs may run on this machine.
// Tested by tests/bench/workload_test.cc

class Stopwatch {
 public:
  void Restart() { begin_ = std::clock(); }
  double seconds() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t begin_ = std::clock();
};

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
