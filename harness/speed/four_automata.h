// SPDX-License-Identifier: Apache-2.0
// The baseline of the speed figures: the four rules as the automata that a careful programmer would
// write by hand, evaluated for each object in each frame. Tested by
// tests/harness/speed/workload_test.cc
#pragma once

#include "harness/speed/workload.h"

namespace prehend::harness {

/// Plays a log of harness/speed/worlds.h. The first `warm_up` frames do not count.
Watched WatchByHand(const ChangeLog& log, std::size_t warm_up = 0);

}  // namespace prehend::harness
