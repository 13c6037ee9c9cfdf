// SPDX-License-Identifier: Apache-2.0
// How fast the monitor is on this machine, each figure as the best of several runs, and where there
// is one, beside the same rules by hand in the same minute: the ratio is what can be compared
// between machines. Tested by tests/harness/speed/workload_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/base/read_result.h"

namespace prehend::harness {

struct SpeedFigure {
  std::string what;
  std::string unit;        ///< of what there are `operations`
  double operations = 0;   ///< in one run
  double seconds = 0;      ///< of one run
  double by_hand_s = 0;    ///< the automata by hand, the same run; 0: there are none
  double events = 0;       ///< in one run
  double simulated_s = 0;  ///< that one run shows; 0: time means nothing here
  double physics_s = 0;    ///< that the world takes for one run; 0: there is no world
  std::uint64_t hash = 0;  ///< of what was recognised; 0: nothing is
  bool agrees = true;      ///< with the automata by hand
};

/// Fails only where `root` lacks the scenario that is watched. Takes seconds; `quick` a fraction of
/// one, for tests.
ReadResult<std::vector<SpeedFigure>> MeasureSpeed(const std::string& root, bool quick);

}  // namespace prehend::harness
