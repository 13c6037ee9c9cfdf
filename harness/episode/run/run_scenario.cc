// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/run_scenario.h"

#include <chrono>

#include "grammar/name_events.h"
#include "harness/episode/sense/entity_table.h"
#include "harness/episode/sense/sensing.h"

namespace prehend::episode {

RunResult::RunResult() = default;
RunResult::RunResult(const RunResult& other) = default;
RunResult::RunResult(RunResult&& other) noexcept = default;
RunResult& RunResult::operator=(const RunResult& other) = default;
RunResult& RunResult::operator=(RunResult&& other) noexcept = default;
RunResult::~RunResult() = default;

/// Adds the time since the last lap to one of the counters; costs nothing when not measuring.
class LapClock {
 public:
  explicit LapClock(bool on) : on_(on) {}
  void Lap(double& counter_s) {
    if (!on_) return;
    const auto now = std::chrono::steady_clock::now();
    counter_s += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  /// The time since the last lap belongs to none of the counters.
  void Restart() {
    if (on_) last_ = std::chrono::steady_clock::now();
  }

 private:
  bool on_;
  std::chrono::steady_clock::time_point last_;
};

struct ScenarioRun::State {
  physics::Simulation simulation;
  Sensing sensing;
  std::shared_ptr<const grammar::Program> program;
  const grammar::EntityTable entity_table;
  grammar::Monitor monitor;
  LapClock clock;
  const bool record;
  bool sensed = false;
  std::vector<grammar::Event> events;
  RunResult result;
};

ScenarioRun::ScenarioRun(const scenario::Scenario& scenario,
                         std::shared_ptr<const grammar::Program> program,
                         const RunOptions& options) {
  const grammar::EntityTable entity_table = MakeEntityTable(scenario);
  state_.reset(new State{.simulation = {scenario.scene, scenario.script},
                         .sensing = {scenario.scene, scenario.sensing},
                         .program = program,
                         .entity_table = entity_table,
                         .monitor = {program, entity_table},
                         .clock = LapClock(options.measure),
                         .record = options.record});
}

ScenarioRun::~ScenarioRun() = default;

const physics::Snapshot& ScenarioRun::snapshot() const { return state_->simulation.snapshot(); }
bool ScenarioRun::sensed() const { return state_->sensed; }
grammar::Frame ScenarioRun::frame() { return state_->sensing.Whole(); }

bool ScenarioRun::Step() {
  State& run = *state_;
  RunSeconds& seconds = run.result.seconds;
  run.sensed = false;
  run.clock.Restart();
  if (!run.monitor.error().empty() || !run.simulation.Step()) return false;
  run.clock.Lap(seconds.physics);
  const physics::Snapshot& snapshot = run.simulation.snapshot();
  if (run.record) run.result.recording.push_back(snapshot);
  if (!run.sensing.Due(snapshot.tick)) return true;
  const grammar::FrameChanges changes = run.sensing.SenseChanges(snapshot);
  run.clock.Lap(seconds.sensing);
  run.monitor.AdvanceBy(changes, run.events);
  run.clock.Lap(seconds.grammar);
  run.sensed = true;
  return true;
}

RunResult ScenarioRun::Finish() {
  State& run = *state_;
  RunResult& result = run.result;
  if (!run.monitor.error().empty()) {
    result.status = {physics::RunStatus::Kind::kFailed, 0, "",
                     "the grammar cannot be evaluated on this scene: " + run.monitor.error(),
                     "use fewer entities or rules with narrower role classes"};
    return std::move(result);
  }
  run.clock.Restart();
  result.ticks = run.simulation.snapshot().tick;
  run.monitor.Finish(result.ticks + 1, run.events);
  result.status = run.simulation.status();
  result.notes = run.simulation.notes();
  result.state_hash = run.simulation.state_hash();
  result.timeline = grammar::NameEvents(*run.program, run.entity_table, run.events);
  result.drawings = truth::EventDrawings(*run.program);
  run.clock.Lap(result.seconds.grammar);
  result.seconds.total = result.seconds.physics + result.seconds.sensing + result.seconds.grammar;
  return std::move(result);
}

RunResult RunScenario(const scenario::Scenario& scenario,
                      std::shared_ptr<const grammar::Program> program, const RunOptions& options) {
  ScenarioRun run(scenario, std::move(program), options);
  while (run.Step()) {
  }
  return run.Finish();
}

}  // namespace prehend::episode
