// SPDX-License-Identifier: Apache-2.0
// The physical oracle: what truly happened in a recorded run, straight from the definitions in
// docs/events.md. It looks at the complete recording, past and future, and shares nothing with the
// grammar engine, its language or the sensing: goldens and grammars are judged by it, so it has to
// be able to disagree with them. Tested by tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "harness/truth/oracle/recording.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::truth {

/// The events of hands and objects that docs/events.md defines, in its order.
std::span<const std::string_view> OracleEvents();
/// Those of furniture.
std::span<const std::string_view> FurnitureEvents();
/// Whether this is one of either, so that the oracle can judge it. Those of furniture are about a
/// `part`: grammars have a `closing(hand)` of their own.
bool OracleDefines(std::string_view event, std::string_view first_role);
bool OracleDefines(const grammar::NamedEvent& event);

/// The true events of a run, sorted, with one choice of the definitions' numbers. `recording` has
/// the snapshots in the order of their ticks, best of every tick of physics; events begin and end
/// at ticks of snapshots, those that never end, at `end`. `decided` of each is where it ends.
grammar::Timeline TrueTimeline(const physics::Scene& scene,
                               std::span<const physics::Snapshot> recording, grammar::Tick end,
                               const OracleSettings& settings = {});

/// The timelines that the definitions allow: one per DefinitionChoices(), in their order.
std::vector<grammar::Timeline> PossibleTimelines(const physics::Scene& scene,
                                                 std::span<const physics::Snapshot> recording,
                                                 grammar::Tick end);

}  // namespace prehend::truth
