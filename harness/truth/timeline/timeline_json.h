// SPDX-License-Identifier: Apache-2.0
// Events as JSON, as `prehend run --json` prints them.
// Tested by tests/harness/episode/run/run_text_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "grammar/base/timeline.h"

namespace prehend::truth {

/// {"event", "roles": {..}, "attributes": {..}, "begin_tick", "end_tick", "begin_s", "end_s",
/// "decided_tick", "open_end"}; attributes are words (style) or numbers in SI units.
nlohmann::ordered_json EventJson(const grammar::NamedEvent& event, grammar::Tick ticks_per_second);

/// {"ticks_per_second", "events": [..]}
nlohmann::ordered_json TimelineJson(const grammar::Timeline& timeline);

}  // namespace prehend::truth
