// SPDX-License-Identifier: Apache-2.0
#include "harness/speed/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <utility>

#include "harness/prepare_run.h"
#include "harness/run_scenario.h"
#include "harness/speed/four_rules.h"

namespace prehend::harness {
namespace {

constexpr double kFrameRate_hz = 240;
constexpr int kRuns = 5;

// Of the processor, not of the wall: others may use this machine, too.
template <typename Work>
double Seconds(Work&& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

class Measuring {
 public:
  explicit Measuring(bool quick) : quick_(quick), program_(CompileFourRules()) {}

  int Frames(int frames) const { return quick_ ? std::max(2, frames / 50) : frames; }

  /// The four rules on a log, in turns by grammar and by hand.
  SpeedFigure Watch(std::string what, std::string unit, double operations, const ChangeLog& log) const {
    SpeedFigure figure{.what = std::move(what), .unit = std::move(unit), .operations = operations};
    figure.seconds = figure.by_hand_s = std::numeric_limits<double>::infinity();
    for (int run = 0; run < (quick_ ? 1 : kRuns); ++run) {
      grammar::Monitor monitor(program_, log.cast);
      Recognised by_grammar, by_hand;
      figure.seconds = std::min(figure.seconds, Seconds([&] { by_grammar = WatchByGrammar(log, monitor); }));
      figure.by_hand_s = std::min(figure.by_hand_s, Seconds([&] { by_hand = WatchByHand(log); }));
      figure.agrees = figure.agrees && by_grammar == by_hand;
      figure.hash = by_grammar.hash;
      figure.events = static_cast<double>(by_grammar.events);
    }
    return figure;
  }

  SpeedFigure Stations(int objects, int frames, double period_s) const {
    frames = Frames(frames);
    SpeedFigure figure =
        Watch(fmt::format("four rules, {} object{}, each used every {} s", objects, objects == 1 ? "" : "s", period_s),
              "object-rule-frame", 1.0 * kFourRules * objects * frames, MakeStations(objects, frames, period_s));
    figure.simulated_s = frames / kFrameRate_hz;
    return figure;
  }

  SpeedFigure Flicker(bool grasps) const {
    constexpr int kObjects = 64, kPerFrame = 64;
    const int frames = Frames(20'000);
    return Watch(grasps ? "a touch that begins or ends a grasp" : "a touch that changes nothing",
                 grasps ? "event boundary" : "fact edge", 1.0 * kPerFrame * (frames - 1),
                 MakeFlicker(kObjects, frames, kPerFrame, grasps));
  }

  SpeedFigure Idle(int objects) const {
    const int frames = Frames(1'000'000);
    const ChangeLog log = MakeStations(objects, 1, 10);
    grammar::Monitor monitor(program_, log.cast);
    std::vector<grammar::Event> events;
    monitor.AdvanceBy(log[0], events);
    grammar::Tick tick = 1;
    for (; tick < 1000; ++tick) monitor.AdvanceBy({.tick = tick}, events);  // what is new comes to rest
    const double seconds = Seconds([&] {
      for (int i = 0; i < frames; ++i) monitor.AdvanceBy({.tick = tick++}, events);
    });
    return {.what = fmt::format("nothing happens, {} objects stand on a table", objects),
            .unit = "idle tick",
            .operations = static_cast<double>(frames),
            .seconds = seconds,
            .simulated_s = frames / kFrameRate_hz};
  }

  SpeedFigure Binding() const {
    const ChangeLog log = MakeStations(Frames(16'000), 1, 10);
    double best = std::numeric_limits<double>::infinity();
    double bindings = 0;
    for (int run = 0; run < kRuns; ++run) {
      std::vector<grammar::Event> events;
      best = std::min(best, Seconds([&] {
                        grammar::Monitor monitor(program_, log.cast);
                        monitor.AdvanceBy(log[0], events);
                        bindings = monitor.lanes_in_use();
                      }));
    }
    return {.what = "rules are bound to objects", .unit = "binding", .operations = bindings, .seconds = best};
  }

 private:
  bool quick_;
  std::shared_ptr<const grammar::Program> program_;
};

// One hand takes one carton: what physics costs, and what watching adds to it.
SpeedFigure WatchCarton(const PreparedRun& carton, bool quick) {
  SpeedFigure figure{.what = "pick_and_place on " + carton.scenario.name + ", sensing included", .unit = "physics tick"};
  figure.seconds = figure.physics_s = std::numeric_limits<double>::infinity();
  for (int run = 0; run < (quick ? 1 : 3); ++run) {
    const RunResult result = RunScenario(carton.scenario, carton.program, {.measure = true});
    figure.seconds = std::min(figure.seconds, result.seconds.sensing + result.seconds.grammar);
    figure.physics_s = std::min(figure.physics_s, result.seconds.physics);
    figure.operations = static_cast<double>(result.ticks);
    figure.events = static_cast<double>(result.timeline.events.size());
    figure.simulated_s = figure.operations / carton.scenario.world.rate_hz;
  }
  return figure;
}

}  // namespace

ReadResult<std::vector<SpeedFigure>> MeasureSpeed(const std::string& root, bool quick) {
  ReadResult<PreparedRun> carton =
      PrepareRun({.scenario_file = root + "/scenarios/pick_and_place/milk_carton_wrap.yaml"}, root);
  if (!carton.value) return {.value = std::nullopt, .diagnostics = std::move(carton.diagnostics)};
  const Measuring measuring(quick);
  std::vector<SpeedFigure> figures = {measuring.Stations(1, 1'000'000, 10), measuring.Stations(1024, 4800, 10),
                                      measuring.Stations(1024, 4800, 60),   measuring.Stations(4096, 2400, 60),
                                      measuring.Stations(65'536, 480, 60),  measuring.Idle(65'536),
                                      measuring.Flicker(false),             measuring.Flicker(true),
                                      measuring.Binding(),                  WatchCarton(*carton.value, quick)};
  return {.value = std::move(figures), .diagnostics = {}};
}

}  // namespace prehend::harness
