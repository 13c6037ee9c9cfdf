// SPDX-License-Identifier: Apache-2.0
#include "harness/run/run_scenario.h"

#include <chrono>

#include "grammar/name_events.h"
#include "harness/run/outcome.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/sensing.h"

namespace prehend::harness {

namespace {

/// Adds the time since the last lap to one of the counters; costs nothing when not measuring.
class LapClock {
 public:
  explicit LapClock(bool on) : on_(on) { Lap(ignored_); }
  void Lap(double& counter_s) {
    if (!on_) return;
    const auto now = std::chrono::steady_clock::now();
    counter_s += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  bool on_;
  double ignored_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

RunResult RunScenario(const Scenario& scenario, std::shared_ptr<const grammar::Program> program,
                      const RunOptions& options) {
  RunResult result;
  physics::Simulation simulation(scenario.scene, scenario.script);
  Sensing sensing(scenario.scene, scenario.sensing);
  const grammar::EntityTable entity_table = MakeEntityTable(scenario);
  grammar::Monitor monitor(program, entity_table);
  if (!monitor.error().empty()) {
    result.status = {physics::RunStatus::Kind::kFailed, 0, "",
                     "the grammar can't watch this scene: " + monitor.error(),
                     "use fewer entities or rules with narrower role classes"};
    return result;
  }
  std::vector<grammar::Event> events;
  std::optional<OutcomeWatch> judge;
  if (options.judge) judge.emplace(scenario.scene, scenario.outcomes);
  LapClock clock(options.measure);

  while (simulation.Step()) {
    clock.Lap(result.seconds.physics);
    const physics::Snapshot& snapshot = simulation.snapshot();
    if (judge) judge->Look(snapshot);
    if (!sensing.Due(snapshot.tick)) continue;
    const grammar::FrameChanges changes = sensing.SenseChanges(snapshot);
    clock.Lap(result.seconds.sensing);
    monitor.AdvanceBy(changes, events);
    clock.Lap(result.seconds.grammar);
    if (options.watch) options.watch(sensing.Whole());
    if (options.record) result.recording.push_back(snapshot);
  }

  result.ticks = simulation.snapshot().tick;
  monitor.Finish(result.ticks + 1, events);
  result.status = simulation.status();
  result.notes = simulation.notes();
  if (judge && result.status.kind == physics::RunStatus::Kind::kCompleted)
    result.outcome = judge->Judge(simulation.snapshot());
  result.state_hash = simulation.state_hash();
  result.timeline = grammar::NameEvents(*program, entity_table, events);
  result.drawings = EventDrawings(*program);
  clock.Lap(result.seconds.grammar);
  result.seconds.total = result.seconds.physics + result.seconds.sensing + result.seconds.grammar;
  return result;
}

grammar::Timeline Resegment(const Scenario& scenario, std::span<const physics::Snapshot> recording,
                            std::shared_ptr<const grammar::Program> program, grammar::Tick end) {
  Sensing sensing(scenario.scene, scenario.sensing);
  const grammar::EntityTable entity_table = MakeEntityTable(scenario);
  grammar::Monitor monitor(program, entity_table);
  std::vector<grammar::Event> events;
  for (const physics::Snapshot& snapshot : recording)
    monitor.AdvanceBy(sensing.SenseChanges(snapshot), events);
  monitor.Finish(end, events);
  return grammar::NameEvents(*program, entity_table, events);
}

}  // namespace prehend::harness
