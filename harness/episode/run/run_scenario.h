// SPDX-License-Identifier: Apache-2.0
// One scenario, simulated and segmented: the main loop. The result is a value.
// Tested by tests/harness/episode/run/run_scenario_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/compile/compile.h"
#include "grammar/monitor.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/truth/timeline/event_text.h"
#include "physics/simulation.h"

namespace prehend::episode {

struct RunOptions {
  bool record = false;   ///< keep a snapshot per tick of physics (pictures, oracle)
  bool measure = false;  ///< time physics, sensing and grammar separately
};

/// Where the time of a run went; all zero unless measured.
struct RunSeconds {
  double physics = 0, sensing = 0, grammar = 0, total = 0;
};

struct RunResult {
  // Compiled once, not wherever one is made or destroyed.
  RunResult();
  RunResult(const RunResult& other);
  RunResult(RunResult&& other) noexcept;
  RunResult& operator=(const RunResult& other);
  RunResult& operator=(RunResult&& other) noexcept;
  ~RunResult();

  physics::RunStatus status;
  grammar::Tick ticks = 0;     ///< the last one: as many updates of the physics
  bool is_recording = false;   ///< nothing was played: it lasts until its end, a tick more
  bool is_unfinished = false;  ///< nobody says that it ended here: a recording without 'end_tick'
  std::uint64_t state_hash = 0;
  grammar::Timeline timeline;                ///< what was recognised up to the end of the run
  truth::EventDrawings drawings;             ///< how the grammar wants its events drawn
  std::vector<physics::Snapshot> recording;  ///< empty unless asked for
  std::vector<physics::ScriptNote> notes;
  std::string outcome;  ///< of the scenario's outcomes; empty unless judged
                        ///< (harness/episode/run/run_trials.h)
  RunSeconds seconds;
};

/// A scenario while it is played. The caller has the loop and may look at each tick:
///
///   ScenarioRun run(scenario, program);
///   while (run.Step()) Look(run.snapshot());
///   const RunResult result = run.Finish();
class ScenarioRun {
 public:
  /// The scenario outlives the run.
  ScenarioRun(const scenario::Scenario& scenario, std::shared_ptr<const grammar::Program> program,
              const RunOptions& options = {});
  ~ScenarioRun();

  /// Plays one tick of physics, and senses and segments it if a frame is due. False when the run is
  /// over, or when the grammar cannot be applied to this scene.
  bool Step();

  /// The world after the last tick.
  const physics::Snapshot& snapshot() const;
  /// Whether the last tick was sensed, and what the grammar saw then.
  bool sensed() const;
  grammar::Frame frame();

  /// To be called once, after the last Step().
  RunResult Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Plays a scenario to its end.
RunResult RunScenario(const scenario::Scenario& scenario,
                      std::shared_ptr<const grammar::Program> program,
                      const RunOptions& options = {});

// A time of an episode as people write it: "reaching.begin", "grasping.end", or in seconds "1.25".
// Tested by tests/harness/episode/run/event_time_test.cc

/// Either seconds or a boundary of an event.
struct EventTime {
  std::optional<double> time_s;
  std::string event;
  bool end = false;  ///< the end of the event, otherwise its begin
};

/// No value if the text is neither seconds nor EVENT.begin nor EVENT.end.
std::optional<EventTime> ParseEventTime(const std::string& text);

/// Why an episode with this grammar cannot have such a time; no value if it can.
struct EventTimeProblem {
  std::string message;
  std::string hint;
};
std::optional<EventTimeProblem> WhyNoEventTime(const std::string& text,
                                               const grammar::Program& program);

/// The tick that the text names; the first such event counts. If it did not happen, or is after the
/// episode, the tick is the end of the run, and `missed` gives the reason.
struct FoundTime {
  grammar::Tick tick = 0;
  std::string missed;
};
FoundTime FindEventTime(const std::string& text, const RunResult& run);

/// First recorded snapshot at or after a tick, else the last one. Something was recorded.
const physics::Snapshot& SnapshotAt(const RunResult& run, grammar::Tick tick);

}  // namespace prehend::episode
