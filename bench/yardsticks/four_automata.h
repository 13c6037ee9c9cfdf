// SPDX-License-Identifier: Apache-2.0
// The yardsticks of the speed figures: the four rules as automata that a careful programmer would
// write by hand, one per object. Tested by tests/bench/workload_test.cc
#pragma once

#include "bench/yardsticks/workload.h"

namespace prehend::bench {

/// Which automata are evaluated in a frame: of all objects, or of those that it says something
/// about.
enum class ByHand { kEveryFrame, kOnChange };

/// Plays a log of bench/yardsticks/worlds.h. The first `warm_up` frames do not count.
Watched WatchByHand(const ChangeLog& log, ByHand by_hand, std::size_t warm_up = 0);

}  // namespace prehend::bench
