// SPDX-License-Identifier: Apache-2.0
// One scenario from start to end: physics alone, then with sensing and grammar. Figures to look at
// are ratios within one run: times_real_time, and the watched run against the bare one.
#include <benchmark/benchmark.h>

#include <string>

#include "harness/base/base/project_paths.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::bench {
namespace {

episode::LoadedRun Carton() {
  const std::string root = FindProjectRoot().value_or(".");
  return *episode::LoadRun(
      {.scenario_file = root + "/scenarios/pick_and_place/milk_carton_wrap.yaml"}, root);
}

void CountRealTime(benchmark::State& state, double simulated_s) {
  state.counters["times_real_time"] =
      benchmark::Counter(simulated_s, benchmark::Counter::kIsIterationInvariantRate);
}

void CartonPhysicsAlone(benchmark::State& state) {
  const episode::LoadedRun carton = Carton();
  double simulated_s = 0;
  for (auto _ : state) {
    physics::Simulation simulation(carton.scenario.scene, carton.scenario.script);
    while (simulation.Step()) {
    }
    simulated_s =
        static_cast<double>(simulation.snapshot().tick) / carton.scenario.scene.world.rate_hz;
    benchmark::DoNotOptimize(simulation.state_hash());
  }
  CountRealTime(state, simulated_s);
}
BENCHMARK(CartonPhysicsAlone)->Unit(benchmark::kMillisecond);

void CartonWatched(benchmark::State& state) {
  const episode::LoadedRun carton = Carton();
  double simulated_s = 0;
  for (auto _ : state) {
    const episode::RunResult run =
        episode::RunScenario(carton.scenario, carton.program, {.measure = true});
    simulated_s = static_cast<double>(run.ticks) / carton.scenario.scene.world.rate_hz;
    state.counters["physics_share"] = run.seconds.physics / run.seconds.total;
    state.counters["sensing_share"] = run.seconds.sensing / run.seconds.total;
    state.counters["grammar_share"] = run.seconds.grammar / run.seconds.total;
  }
  CountRealTime(state, simulated_s);
}
BENCHMARK(CartonWatched)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prehend::bench
