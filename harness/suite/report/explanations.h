// SPDX-License-Identifier: Apache-2.0
// The part of a scenario's section that says why its events are as they are. Tested by
// tests/harness/suite/report/report_test.cc
#pragma once

#include <pugixml.hpp>

#include "harness/suite/check/explained.h"

namespace prehend::suite {

/// Adds an explanation for each difference, the first one unfolded, with its signals; and as data
/// what turned at each boundary, which the page's script shows at the cursor.
void AddExplanations(pugi::xml_node section, const Explained& explained,
                     grammar::Tick ticks_per_second);

}  // namespace prehend::suite
