// SPDX-License-Identifier: Apache-2.0
// Timelines with all their fields, for harness/base/process/worker_pool.h. What people's programs
// read is in harness/truth/timeline/event_text.h. Tested by tests/harness/base/process/wire_test.cc
#pragma once

#include <nlohmann/json.hpp>

#include "grammar/base/timeline.h"

namespace prehend::grammar {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Interval, begin, end)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Role, name, value)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NamedValue, name, value, unit)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NamedEvent, event, roles, interval, decided, open_end, values)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Timeline, ticks_per_second, events)

}  // namespace prehend::grammar
