// SPDX-License-Identifier: Apache-2.0
// The monitor alone, on worlds in memory; beside each the same rules by hand, evaluated for each
// object in every frame, and evaluated on change. The label is the hash of what was recognised: the
// three must show the same one. Figures to look at are ratios
// within one run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "bench/yardsticks/four_automata.h"
#include "bench/yardsticks/workload.h"
#include "bench/yardsticks/worlds.h"
#include "harness/base/base/project_paths.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment_recording.h"

namespace prehend::bench {
namespace {

constexpr double kPeriod_s = 60;

int FramesFor(int objects) { return std::max(240, 4'000'000 / objects); }

template <typename Watch>
void Play(benchmark::State& state, const ChangeLog& log, double operations, Watch&& watch) {
  Recognised recognised;
  for (auto _ : state) recognised = watch(log, state);
  state.SetLabel(episode::HashText(recognised.hash));
  using benchmark::Counter;
  const auto rate = [](double count) { return Counter(count, Counter::kIsIterationInvariantRate); };
  state.counters["operations"] = rate(operations);
  state.counters["events"] = rate(static_cast<double>(recognised.events));
}

Recognised ByGrammar(const ChangeLog& log, benchmark::State& state) {
  state.PauseTiming();
  grammar::Monitor monitor(CompileFourRules(), log.entity_table);
  state.ResumeTiming();
  return WatchByGrammar(log, monitor).recognised;
}

template <ByHand kWhen>
Recognised ByAutomata(const ChangeLog& log, benchmark::State&) {
  return WatchByHand(log, kWhen).recognised;
}
constexpr auto ByHandInEveryFrame = ByAutomata<ByHand::kEveryFrame>;
constexpr auto ByHandOnChange = ByAutomata<ByHand::kOnChange>;

/// Numbers of objects.
void Sizes(benchmark::internal::Benchmark* bench) {
  for (const int objects : {1, 1024, 4096, 65'536}) bench->Arg(objects);
  bench->Unit(benchmark::kMillisecond);
}

template <auto kWatch>
void FourRules(benchmark::State& state) {
  const int objects = static_cast<int>(state.range(0));
  const int frames = FramesFor(objects);
  const ChangeLog log = MakeStations(objects, frames, kPeriod_s);
  Play(state, log, static_cast<double>(bench::FourRules::kCount) * objects * frames, kWatch);
}
BENCHMARK(FourRules<ByGrammar>)->Apply(Sizes);
BENCHMARK(FourRules<ByHandInEveryFrame>)->Apply(Sizes);
BENCHMARK(FourRules<ByHandOnChange>)->Apply(Sizes);

// Argument: what a touch changes.
template <auto kWatch>
void Touches(benchmark::State& state) {
  constexpr int kObjects = 64, kFrames = 2000;
  const ChangeLog log =
      MakeFlicker(kObjects, kFrames, kObjects, static_cast<Flicker>(state.range(0)));
  Play(state, log, 1.0 * kObjects * (kFrames - 1), kWatch);
}
BENCHMARK(Touches<ByGrammar>)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(Touches<ByHandInEveryFrame>)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(Touches<ByHandOnChange>)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

// Every object changes a fact every so many frames.
template <auto kWatch>
void Dense(benchmark::State& state) {
  constexpr int kObjects = 1024, kFrames = 1000;
  const ChangeLog log =
      MakeFlicker(kObjects, kFrames, kObjects / static_cast<int>(state.range(0)), Flicker::kFact);
  Play(state, log, static_cast<double>(bench::FourRules::kCount) * kObjects * (kFrames - 1),
       kWatch);
}
BENCHMARK(Dense<ByGrammar>)->Arg(1)->Arg(8)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(Dense<ByHandInEveryFrame>)->Arg(1)->Arg(8)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(Dense<ByHandOnChange>)->Arg(1)->Arg(8)->Arg(64)->Unit(benchmark::kMillisecond);

// All of pick_and_place on a simulated scene, from its recording: sensing and grammar, no physics.
void RecordedCarton(benchmark::State& state) {
  const std::string root = FindProjectRoot().value_or(".");
  const episode::LoadedRun carton = *episode::LoadRun(
      {.scenario_file = root + "/scenarios/pick_and_place/milk_carton_wrap.yaml"}, root);
  const episode::RunResult run =
      episode::RunScenario(carton.scenario, carton.program, {.record = true});
  std::size_t events = 0;
  for (auto _ : state)
    events = episode::Resegment(carton.scenario, run.recording, carton.program, run.ticks + 1)
                 .events.size();
  state.counters["events"] = static_cast<double>(events);
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(run.ticks) / carton.scenario.scene.world.rate_hz,
                         benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(RecordedCarton)->Unit(benchmark::kMillisecond);

void IdleTick(benchmark::State& state) {
  const ChangeLog log = MakeStations(static_cast<int>(state.range(0)), 1, kPeriod_s);
  grammar::Monitor monitor(CompileFourRules(), log.entity_table);
  std::vector<grammar::Event> events;
  monitor.AdvanceBy(log[0], events);
  grammar::Tick tick = 1;
  for (; tick < 100; ++tick)
    monitor.AdvanceBy({.tick = tick}, events);  // what is new comes to rest
  for (auto _ : state) monitor.AdvanceBy({.tick = tick++}, events);
}
BENCHMARK(IdleTick)->Arg(1)->Arg(1024)->Arg(65'536);

void Binding(benchmark::State& state) {
  const ChangeLog log = MakeStations(1024, 1, kPeriod_s);
  const auto program = CompileFourRules();
  int bindings = 0;
  for (auto _ : state) {
    grammar::Monitor monitor(program, log.entity_table);
    std::vector<grammar::Event> events;
    monitor.AdvanceBy(log[0], events);
    bindings = monitor.instances_in_use();
  }
  state.counters["bindings"] =
      benchmark::Counter(bindings, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(Binding)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace prehend::bench
