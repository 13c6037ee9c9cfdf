// SPDX-License-Identifier: Apache-2.0
#include "harness/speed/measure.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "harness/run/load_run.h"
#include "harness/run/run_scenario.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/sensing.h"
#include "harness/speed/four_automata.h"
#include "harness/speed/resting_boxes.h"
#include "harness/speed/stopwatch.h"
#include "harness/speed/workload.h"
#include "harness/speed/worlds.h"

namespace prehend::harness {
namespace {

constexpr double kFrameRate_hz = kWorldRate_hz;
constexpr int kRuns = 5;
constexpr std::size_t kKeptSnapshots = 100;  // of 5,000 bodies 0.6 MB each

// That malloc has handed out now, in blocks of its own and from the system.
double BytesInUse() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

class Measuring {
 public:
  explicit Measuring(bool quick) : quick_(quick), program_(CompileFourRules()) {}

  int Frames(int frames) const { return quick_ ? std::max(2, frames / 50) : frames; }

  /// The four rules on a log, by the grammar and by hand in turns. An operation is that of the
  /// unit, in one frame; frames that are left out count.
  SpeedFigure Watch(std::string what, std::string unit, double operations, const ChangeLog& log,
                    int warm_up) const {
    const auto frames = static_cast<double>(log.end_tick() - warm_up);
    SpeedFigure figure{
        .what = std::move(what), .unit = std::move(unit), .operations = operations * frames};
    figure.seconds = figure.baseline_s = figure.on_change_s =
        std::numeric_limits<double>::infinity();
    std::size_t uncounted = 0;
    while (log[uncounted].tick < warm_up) ++uncounted;
    for (int run = 0; run < (quick_ ? 1 : kRuns); ++run) {
      const double bytes_before = BytesInUse();
      grammar::Monitor monitor(program_, log.entity_table);
      const Watched by_grammar = WatchByGrammar(log, monitor, uncounted);
      figure.bytes = (BytesInUse() - bytes_before) /
                     (static_cast<double>(log.entity_table.entities.size()) / 2);
      const Watched by_hand = WatchByHand(log, ByHand::kEveryFrame, uncounted);
      const Watched on_change = WatchByHand(log, ByHand::kOnChange, uncounted);
      figure.seconds = std::min(figure.seconds, by_grammar.seconds);
      figure.baseline_s = std::min(figure.baseline_s, by_hand.seconds);
      figure.on_change_s = std::min(figure.on_change_s, on_change.seconds);
      figure.agrees = figure.agrees && by_grammar.recognised == by_hand.recognised &&
                      by_grammar.recognised == on_change.recognised;
      figure.hash = by_grammar.recognised.hash;
      figure.events = static_cast<double>(by_grammar.events);
    }
    figure.simulated_s = frames / kFrameRate_hz;
    return figure;
  }

  SpeedFigure Stations(int objects, int frames, int warm_up, double period_s) const {
    warm_up = Frames(warm_up);
    return Watch(fmt::format("four rules, {} object{}, each used every {} s", objects,
                             objects == 1 ? "" : "s", period_s),
                 "object-rule-frame", static_cast<double>(FourRules::kCount * objects),
                 MakeStations(objects, Frames(frames) + warm_up, period_s), warm_up);
  }

  SpeedFigure WithoutEmptyFrames() const {
    const int warm_up = Frames(2400);
    return Watch("the same, without the frames that bring nothing", "object-rule-frame",
                 FourRules::kCount,
                 LeaveOutEmptyFrames(MakeStations(1, Frames(1'000'000) + warm_up, 10)), warm_up);
  }

  /// All facts about all objects change, each once in that many frames.
  SpeedFigure Dense(int objects, int every) const {
    return Watch(fmt::format("four rules, {} objects, a fact of each changes every {} frames",
                             objects, every),
                 "object-rule-frame", static_cast<double>(FourRules::kCount * objects),
                 MakeFlicker(objects, Frames(4000), objects / every, Flicker::kFact), 1);
  }

  SpeedFigure Touches(std::string what, std::string unit, Flicker flicker) const {
    constexpr int kObjects = 64, kPerFrame = 64;
    SpeedFigure figure = Watch(std::move(what), std::move(unit), kPerFrame,
                               MakeFlicker(kObjects, Frames(20'000), kPerFrame, flicker), 1);
    figure.simulated_s = figure.bytes = 0;
    return figure;
  }

  SpeedFigure Idle(int objects) const {
    const int frames = Frames(1'000'000);
    const ChangeLog log = MakeStations(objects, 1, 10);
    grammar::Monitor monitor(program_, log.entity_table);
    std::vector<grammar::Event> events;
    monitor.AdvanceBy(log[0], events);
    grammar::Tick tick = 1;
    for (; tick < 1000; ++tick)
      monitor.AdvanceBy({.tick = tick}, events);  // new instances become idle
    const Stopwatch watch;
    for (int i = 0; i < frames; ++i) monitor.AdvanceBy({.tick = tick++}, events);
    return {.what = fmt::format("nothing changes, {} objects stand on a table", objects),
            .unit = "idle tick",
            .operations = static_cast<double>(frames),
            .seconds = watch.seconds(),
            .simulated_s = frames / kFrameRate_hz};
  }

  SpeedFigure Binding() const {
    const ChangeLog log = MakeStations(Frames(16'000), 1, 10);
    SpeedFigure figure{.what = "rules are bound to objects",
                       .unit = "binding",
                       .seconds = std::numeric_limits<double>::infinity()};
    for (int run = 0; run < kRuns; ++run) {
      std::vector<grammar::Event> events;
      const double bytes_before = BytesInUse();
      const Stopwatch watch;
      grammar::Monitor monitor(program_, log.entity_table);
      monitor.AdvanceBy(log[0], events);
      figure.seconds = std::min(figure.seconds, watch.seconds());
      figure.operations = monitor.instances_in_use();
      figure.bytes = (BytesInUse() - bytes_before) / figure.operations;
    }
    return figure;
  }

 private:
  bool quick_;
  std::shared_ptr<const grammar::Program> program_;
};

/// The scenario's world alone, in seconds of processor time.
double TimePhysics(const Scenario& scenario) {
  physics::Simulation simulation(scenario.scene, scenario.script);
  const Stopwatch watch;
  while (simulation.Step()) {
  }
  return watch.seconds();
}

/// Sensing and grammar alone, on recorded snapshots.
double TimeWatching(const Scenario& scenario, std::shared_ptr<const grammar::Program> program,
                    std::span<const physics::Snapshot> recording) {
  Sensing sensing(scenario.scene, scenario.sensing);
  grammar::Monitor monitor(std::move(program), MakeEntityTable(scenario));
  std::vector<grammar::Event> events;
  const Stopwatch watch;
  for (const physics::Snapshot& snapshot : recording) {
    if (sensing.Due(snapshot.tick)) monitor.AdvanceBy(sensing.SenseChanges(snapshot), events);
  }
  return watch.seconds();
}

// One hand takes one carton: the cost of physics, and of sensing and grammar. They are measured
// apart, because reading the clock of the processor is slow.
SpeedFigure WatchCarton(const LoadedRun& carton, bool quick) {
  SpeedFigure figure{.what = "pick_and_place on " + carton.scenario.name + ", sensing included",
                     .unit = "physics tick"};
  const RunResult run = RunScenario(carton.scenario, carton.program, {.record = true});
  figure.operations = static_cast<double>(run.ticks);
  figure.events = static_cast<double>(run.timeline.events.size());
  figure.simulated_s = figure.operations / carton.scenario.scene.world.rate_hz;
  figure.seconds = figure.physics_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < (quick ? 1 : kRuns); ++i) {
    figure.physics_s = std::min(figure.physics_s, TimePhysics(carton.scenario));
    figure.seconds =
        std::min(figure.seconds, TimeWatching(carton.scenario, carton.program, run.recording));
  }
  return figure;
}

// Thousands of boxes at rest: the cost of the world, and of sensing and grammar.
SpeedFigure WatchSleepers(std::shared_ptr<const grammar::Program> program, bool quick) {
  constexpr int kRate_hz = 60;  // falling asleep takes 2 s at any rate
  const int boxes = quick ? 50 : 5000, ticks = quick ? 20 : 400;
  const Scenario scenario = BoxesOnAFloor(boxes, kRate_hz);
  physics::Simulation simulation(scenario.scene, scenario.script);
  Sensing sensing(scenario.scene, scenario.sensing);
  grammar::Monitor monitor(std::move(program), MakeEntityTable(scenario));
  std::vector<grammar::Event> events;
  while (simulation.snapshot().tick < kUntilAsleep_s * kRate_hz && simulation.Step())
    monitor.AdvanceBy(sensing.SenseChanges(simulation.snapshot()), events);

  SpeedFigure figure{
      .what = fmt::format("pick_and_place, {} boxes asleep, sensing included", boxes),
      .unit = "physics tick"};
  figure.operations = ticks;
  figure.simulated_s = figure.operations / kRate_hz;
  std::vector<physics::Snapshot> recording;
  Stopwatch watch;
  for (int i = 0; i < ticks; ++i) {
    simulation.Step();
    if (!sensing.Due(simulation.snapshot().tick) || recording.size() >= kKeptSnapshots) continue;
    figure.physics_s += watch.seconds();  // without the copies
    recording.push_back(simulation.snapshot());
    watch.Restart();
  }
  figure.physics_s += watch.seconds();
  watch.Restart();
  for (const physics::Snapshot& snapshot : recording)
    monitor.AdvanceBy(sensing.SenseChanges(snapshot), events);
  figure.seconds = watch.seconds() * ticks / 2 / static_cast<double>(recording.size());
  return figure;
}

}  // namespace

Result<std::vector<SpeedFigure>> MeasureSpeed(const std::string& root, bool quick) {
  Result<LoadedRun> carton =
      LoadRun({.scenario_file = root + "/scenarios/pick_and_place/milk_carton_wrap.yaml"}, root);
  if (!carton) return tl::unexpected(std::move(carton.error()));
  const Measuring measuring(quick);
  std::vector<SpeedFigure> figures = {
      measuring.Stations(1, 1'000'000, 2400, 10),
      measuring.WithoutEmptyFrames(),
      measuring.Stations(1024, 4800, 2400, 10),
      measuring.Stations(1024, 14'400, 14'400, 60),
      measuring.Stations(4096, 4800, 14'400, 60),
      measuring.Stations(65'536, 480, 100, 60),
      measuring.Dense(1024, 8),
      measuring.Idle(65'536),
      measuring.Touches("a touch changes, no threshold is crossed", "change", Flicker::kPressure),
      measuring.Touches("a touch makes a condition true or false", "fact edge", Flicker::kFact),
      measuring.Touches("a touch begins or ends a grasp", "event boundary", Flicker::kGrasp),
      measuring.Binding(),
      WatchCarton(*carton, quick),
      WatchSleepers(carton->program, quick)};
  return figures;
}

}  // namespace prehend::harness
