// SPDX-License-Identifier: Apache-2.0
// How fast the monitor is on this machine: each figure is the best of several runs. Where there is
// one, code by hand for the same rules runs beside it, in every frame and on change; the ratios can
// be compared between machines. Tested by tests/harness/speed/workload_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/base/result.h"

namespace prehend::harness {

struct SpeedFigure {
  std::string what;
  std::string unit;        ///< of one operation
  double operations = 0;   ///< in one run
  double seconds = 0;      ///< of one run
  double baseline_s = 0;   ///< of the automata by hand in every frame, same run; 0: there are none
  double on_change_s = 0;  ///< of the automata by hand on change, likewise
  double events = 0;       ///< in one run
  double simulated_s = 0;  ///< of one run; 0: the workload has no real time
  double physics_s = 0;    ///< of the world in one run; 0: there is no world
  double bytes = 0;        ///< of the monitor per object (of a binding: per binding) after the run;
                           ///< 0: not measured
  std::uint64_t hash = 0;  ///< of the recognised events; 0: there are none
  bool agrees = true;      ///< with the automata by hand
};

/// Fails only if `root` lacks the scenario that is played. Takes seconds; with `quick` a fraction
/// of one, for tests.
Result<std::vector<SpeedFigure>> MeasureSpeed(const std::string& root, bool quick);

}  // namespace prehend::harness
