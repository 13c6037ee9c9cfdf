// SPDX-License-Identifier: Apache-2.0
// How long after an event's end it may take until the event is certain, by its rule and the rules this refers to.
// Tested by tests/harness/latency_bound_test.cc
#pragma once

#include <string>

#include "grammar/program.h"

namespace prehend::harness {

/// In ticks. An event that waits for confirmation may wait for as long as the episode.
grammar::Tick LatencyBound(const grammar::Program& program, const std::string& event, grammar::Tick ticks_per_second,
                           grammar::Tick episode);

}  // namespace prehend::harness
