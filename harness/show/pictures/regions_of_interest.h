// SPDX-License-Identifier: Apache-2.0
// The regions that the rules of phases ask about, at a moment, and what a hand may be reaching for.
// Tested by tests/harness/show/pictures/regions_of_interest_test.cc
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"
#include "render/picture.h"

namespace prehend::show {

/// Of each phase at the moment of `now`: the regions of its rule in the colour of the phase, and a
/// star above each movable thing that is in a region in front of a hand. `shown` says which events
/// the picture shows.
std::vector<render::Marker> RegionMarkers(
    const scenario::Scenario& scenario, const episode::RunResult& run, const physics::Snapshot& now,
    const std::function<bool(const grammar::NamedEvent&)>& shown);

}  // namespace prehend::show
