// SPDX-License-Identifier: Apache-2.0
// What one physics tick costs with many boxes, awake and asleep: our Simulation (step, contacts,
// snapshot, state hash, checks) beside a bare Bullet loop of the same scene. Look at the ratio.
#include <benchmark/benchmark.h>

#include <memory>

#include "bench/bullet_alone.h"
#include "bench/yardsticks/resting_boxes.h"
#include "physics/simulation.h"

namespace prehend::bench {
namespace {

/// Shorter than the two seconds after which resting boxes fall asleep.
constexpr int kTicksAwake = 480;
/// Given, lest boxes fall asleep anew for each guess at how many are needed.
constexpr int kTicksAsleep = 300;
/// To fall asleep takes 2 s, however few ticks they have; a tick asleep costs the same at any rate.
constexpr int kAsleepRate_hz = 60;
constexpr int kTicksUntilAsleep = static_cast<int>(kUntilAsleep_s * kAsleepRate_hz);

struct Ours {
  explicit Ours(const scenario::Scenario& scenario) : simulation(scenario.scene, scenario.script) {}
  void Step() { simulation.Step(); }
  physics::Simulation simulation;
};

struct Bare {
  explicit Bare(const scenario::Scenario& scenario) : bullet(scenario.scene) {}
  void Step() { bullet.Step(); }
  bench::BulletAlone bullet;
};

/// They fall by a millimetre: boxes that stand still from the beginning are put to sleep at once.
scenario::Scenario BoxesThatLand(int count) {
  scenario::Scenario scenario = BoxesOnAFloor(count);
  for (physics::Body& body : scenario.scene.bodies)
    if (!body.fixed) body.X_WB.p_m.z() += 0.001;
  return scenario;
}

template <class Runner>
void Awake(benchmark::State& state) {
  const scenario::Scenario scenario = BoxesThatLand(static_cast<int>(state.range(0)));
  auto runner = std::make_unique<Runner>(scenario);
  int ticks = 0;
  for (auto _ : state) {
    if (++ticks > kTicksAwake) {
      state.PauseTiming();
      runner = std::make_unique<Runner>(scenario);
      ticks = 1;
      state.ResumeTiming();
    }
    runner->Step();
  }
}

template <class Runner>
void Asleep(benchmark::State& state) {
  Runner runner(BoxesOnAFloor(static_cast<int>(state.range(0)), kAsleepRate_hz));
  for (int i = 0; i < kTicksUntilAsleep; ++i) runner.Step();
  for (auto _ : state) runner.Step();
}

BENCHMARK(Awake<Bare>)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(Awake<Ours>)->Arg(1000)->Unit(benchmark::kMicrosecond);
// Letting 5,000 boxes fall asleep takes some seconds each: ./test leaves that size out.
BENCHMARK(Asleep<Bare>)
    ->Arg(100)
    ->Arg(5000)
    ->Iterations(kTicksAsleep)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Asleep<Ours>)
    ->Arg(100)
    ->Arg(5000)
    ->Iterations(kTicksAsleep)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace prehend::bench
