// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/run_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "grammar/contents.h"
#include "grammar/name_events.h"
#include "harness/base/base/number_text.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/episode/sense/sensing.h"

namespace prehend::episode {

std::optional<EventTime> ParseEventTime(const std::string& text) {
  if (const auto time_s = NumberFrom<double>(text)) {
    if (!std::isfinite(*time_s) || *time_s < 0) return std::nullopt;
    return EventTime{.time_s = time_s};
  }
  for (const char* boundary : {".begin", ".end"}) {
    const std::size_t length = std::char_traits<char>::length(boundary);
    if (text.size() <= length || !text.ends_with(boundary)) continue;
    return EventTime{.time_s = std::nullopt,
                     .event = text.substr(0, text.size() - length),
                     .end = boundary == std::string(".end")};
  }
  return std::nullopt;
}

std::optional<EventTimeProblem> WhyNoEventTime(const std::string& text,
                                               const grammar::Program& program) {
  const auto moment = ParseEventTime(text);
  if (!moment) {
    return EventTimeProblem{
        fmt::format("'{}' is not a time", text),
        "write seconds, like 1.25, or the boundary of an event, like reaching.begin"};
  }
  if (moment->time_s) return std::nullopt;
  if (HasEvent(program, moment->event)) return std::nullopt;
  const std::vector<std::string> events = EventNames(program);
  const std::string near = grammar::NearestName(moment->event, events);
  return EventTimeProblem{
      fmt::format("grammar '{}' has no event '{}'", GrammarName(program), moment->event),
      near.empty() ? fmt::format("known: {}", fmt::join(events, ", "))
                   : fmt::format("did you mean '{}'?", near)};
}

FoundTime FindEventTime(const std::string& text, const RunResult& run) {
  const auto moment = ParseEventTime(text);
  if (!moment) return {run.ticks, fmt::format("'{}' is not a time", text)};
  if (moment->time_s) {
    const double ticks_per_s = static_cast<double>(run.timeline.ticks_per_second);
    const double tick = std::round(*moment->time_s * ticks_per_s);
    if (tick <= static_cast<double>(run.ticks)) return {static_cast<grammar::Tick>(tick), ""};
    return {run.ticks, fmt::format("{} s is after the end", text)};
  }
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (event.event == moment->event)
      return {moment->end ? event.interval.end : event.interval.begin, ""};
  }
  return {run.ticks, fmt::format("{} did not happen", text)};
}

const physics::Snapshot& SnapshotAt(const RunResult& run, grammar::Tick tick) {
  const auto at = std::ranges::lower_bound(run.recording, tick, {}, &physics::Snapshot::tick);
  return at == run.recording.end() ? run.recording.back() : *at;
}

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
