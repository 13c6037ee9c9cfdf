// SPDX-License-Identifier: Apache-2.0
// From a monitor's events to a timeline: numbers become names.
// Tested by tests/grammar/base/timeline_test.cc
#pragma once

#include <vector>

#include "grammar/base/event.h"
#include "grammar/base/timeline.h"

namespace prehend::grammar {

struct Program;  // grammar/program/program.h

/// Gives monitor events their names and sorts them into the canonical order.
Timeline NameEvents(const Program& program, const EntityTable& entity_table,
                    const std::vector<Event>& events);

}  // namespace prehend::grammar
