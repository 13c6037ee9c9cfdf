// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/speed/measure.h"

#include <algorithm>
#include <limits>
#include <span>

#include "grammar/contents.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/sense/entity_table.h"
#include "harness/episode/sense/sensing.h"
#include "harness/measure/speed/stopwatch.h"

namespace prehend::measure {
namespace {

constexpr int kRuns = 5;
constexpr std::size_t kFramesAtOnce = 1000;

episode::EpisodeFrame Copy(const grammar::Frame& frame) {
  episode::EpisodeFrame copy{.tick = frame.tick,
                             .entities = {frame.entities.begin(), frame.entities.end()},
                             .hands = {frame.hands.begin(), frame.hands.end()},
                             .touches = {frame.touches.begin(), frame.touches.end()}};
  for (const grammar::HandSample& hand : frame.hands)
    copy.collision_spheres.emplace_back(hand.collision_spheres.begin(),
                                        hand.collision_spheres.end());
  return copy;
}

/// The monitor alone: several of them watch the same frames from memory, some at once.
SpeedFigure Watch(episode::Episode& episode, int runs) {
  struct Run {
    grammar::Monitor monitor;
    std::vector<grammar::Event> events;
    double seconds = 0;
  };
  std::vector<Run> all;
  const grammar::EntityTable entities = episode.entities();
  for (int i = 0; i < runs; ++i)
    all.push_back({.monitor = grammar::Monitor(episode.program(), entities), .events = {}});
  std::vector<episode::EpisodeFrame> frames;
  SpeedFigure figure{
      .what = grammar::GrammarName(*episode.program()) + " on " + episode.name().scenario,
      .unit = "frame"};
  const auto watch = [&] {
    for (Run& run : all) {
      const Stopwatch stopwatch;
      for (episode::EpisodeFrame& frame : frames) run.monitor.Advance(frame.View(), run.events);
      run.seconds += stopwatch.seconds();
    }
    figure.operations += static_cast<double>(frames.size());
    frames.clear();
  };
  const episode::Episode::End end = episode.EachFrame([&](const grammar::Frame& frame) {
    frames.push_back(Copy(frame));
    if (frames.size() == kFramesAtOnce) watch();
  });
  watch();
  for (Run& run : all) run.monitor.Finish(end.tick, run.events);
  figure.seconds = std::ranges::min_element(all, {}, &Run::seconds)->seconds;
  figure.events = static_cast<double>(all.front().events.size());
  figure.simulated_s =
      static_cast<double>(end.tick) / static_cast<double>(entities.ticks_per_second);
  return figure;
}

/// The scenario's world alone, in seconds of processor time.
double TimePhysics(const scenario::Scenario& scenario) {
  physics::Simulation simulation(scenario.scene, scenario.script);
  const Stopwatch watch;
  while (simulation.Step()) {
  }
  return watch.seconds();
}

/// Sensing and grammar alone, on recorded snapshots.
double TimeWatching(const scenario::Scenario& scenario,
                    std::shared_ptr<const grammar::Program> program,
                    std::span<const physics::Snapshot> recording) {
  episode::Sensing sensing(scenario.scene, scenario.sensing);
  grammar::Monitor monitor(std::move(program), episode::MakeEntityTable(scenario));
  std::vector<grammar::Event> events;
  const Stopwatch watch;
  for (const physics::Snapshot& snapshot : recording) {
    if (sensing.Due(snapshot.tick)) monitor.AdvanceBy(sensing.SenseChanges(snapshot), events);
  }
  return watch.seconds();
}

/// The cost of physics, and of sensing and grammar. They are measured apart, because reading the
/// clock of the processor is slow.
SpeedFigure BesidePhysics(const episode::LoadedRun& loaded, int runs) {
  SpeedFigure figure{.what = "the same, sensing included", .unit = "physics tick"};
  const episode::RunResult run =
      episode::RunScenario(loaded.scenario, loaded.program, {.record = true});
  figure.operations = static_cast<double>(run.ticks);
  figure.events = static_cast<double>(run.timeline.events.size());
  figure.simulated_s = figure.operations / loaded.scenario.scene.world.rate_hz;
  figure.seconds = figure.physics_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    figure.physics_s = std::min(figure.physics_s, TimePhysics(loaded.scenario));
    figure.seconds =
        std::min(figure.seconds, TimeWatching(loaded.scenario, loaded.program, run.recording));
  }
  return figure;
}

}  // namespace

std::vector<SpeedFigure> MeasureSpeed(episode::Episode& episode, bool quick) {
  const int runs = quick ? 1 : kRuns;
  std::vector<SpeedFigure> figures = {Watch(episode, runs)};
  if (episode.name().origin == episode::Origin::kScenario)
    figures.push_back(BesidePhysics(episode.loaded(), runs));
  return figures;
}

}  // namespace prehend::measure
