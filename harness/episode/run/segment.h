// SPDX-License-Identifier: Apache-2.0
// The loop that segments an episode which was played or recorded before, whatever it came from.
// (ScenarioRun in harness/episode/run/run_scenario.h is the other one: it segments while it
// simulates.) Tested by tests/harness/episode/run/run_scenario_test.cc
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "harness/episode/sense/sensing.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {

/// A frame, or what is new in it.
using FrameNews = std::variant<grammar::Frame, grammar::FrameChanges>;

/// Calls its argument with each frame of an episode, in their order. Returns the first tick after
/// the episode.
using FrameFeed = std::function<grammar::Tick(const std::function<void(const FrameNews&)>&)>;

struct Segmentation {
  grammar::Timeline timeline;
  std::string problem;  ///< empty, or why the grammar cannot be evaluated; then nothing is played
};

/// What the grammar recognises. `decided`, if there is one, gets events as soon as they are.
Segmentation Segment(const std::shared_ptr<const grammar::Program>& program,
                     const grammar::EntityTable& entities, const FrameFeed& play,
                     const std::function<void(const grammar::Timeline&)>& decided = {});

/// What another grammar recognises in the same episode, without simulating it again. `recording`
/// has a snapshot per tick, of which those are sensed that are due.
grammar::Timeline Resegment(const scenario::Scenario& scenario,
                            std::span<const physics::Snapshot> recording,
                            std::shared_ptr<const grammar::Program> program, grammar::Tick end);

}  // namespace prehend::episode
