// SPDX-License-Identifier: Apache-2.0
// The yardstick of the speed figures: the four rules as the automata that a careful programmer
// would write by hand, looking at each object in each frame. Tested by
// tests/harness/speed/workload_test.cc
#pragma once

#include "harness/speed/workload.h"

namespace prehend::harness {

/// Plays a log of worlds.h. The first frames are `warm_up`.
Watched WatchByHand(const ChangeLog& log, std::size_t warm_up = 0);

}  // namespace prehend::harness
