// SPDX-License-Identifier: Apache-2.0
// One scenario, simulated and watched: the main loop. The result is a value.
// Tested by tests/harness/run/one_hash_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "harness/scenario/scenario.h"
#include "harness/timeline/event_drawings.h"
#include "physics/simulation.h"

namespace prehend::harness {

struct RunOptions {
  bool record = false;  ///< keep a snapshot per sensed frame (pictures, oracle)
  std::function<void(const grammar::Frame&)> watch;  ///< shown every sensed frame; may be empty
  bool judge = false;                                ///< by the scenario's outcomes
  bool measure = false;                              ///< clock physics, sensing and grammar apart
};

/// Where the time of a run went; all zero unless measured.
struct RunSeconds {
  double physics = 0, sensing = 0, grammar = 0, total = 0;
};

struct RunResult {
  physics::RunStatus status;
  grammar::Tick ticks = 0;
  std::uint64_t state_hash = 0;
  grammar::Timeline timeline;                ///< what was recognised up to where the run ended
  EventDrawings drawings;                    ///< how the grammar wants its events drawn
  std::vector<physics::Snapshot> recording;  ///< empty unless asked for
  std::vector<physics::ScriptNote> notes;
  std::string outcome;  ///< empty unless judged
  RunSeconds seconds;
};

RunResult RunScenario(const Scenario& scenario, std::shared_ptr<const grammar::Program> program,
                      const RunOptions& options = {});

/// What another grammar makes of the same episode, without simulating it again. `recording` has the
/// sensed snapshots.
grammar::Timeline Resegment(const Scenario& scenario, std::span<const physics::Snapshot> recording,
                            std::shared_ptr<const grammar::Program> program, grammar::Tick end);

}  // namespace prehend::harness
