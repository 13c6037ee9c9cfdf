// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/speed/measure.h"

#include <algorithm>
#include <limits>

#include "grammar/contents.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/sense/episode_file.h"

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

/// The monitor alone: it watches frames from memory, some at once.
SpeedFigure Watch(episode::Episode& episode, int runs) {
  const grammar::EntityTable entities = episode.entities();
  SpeedFigure figure{
      .what = grammar::GrammarName(*episode.program()) + " on " + episode.name().scenario,
      .unit = "frame",
      .seconds = std::numeric_limits<double>::infinity()};
  for (int i = 0; i < runs; ++i) {
    double operations = 0, seconds = 0;
    const episode::FrameFeed play =
        [&](const std::function<void(const episode::FrameNews&)>& take) {
          std::vector<episode::EpisodeFrame> frames;
          const auto watch = [&] {
            const Stopwatch stopwatch;
            for (episode::EpisodeFrame& frame : frames) take(frame.View());
            seconds += stopwatch.seconds();
            operations += static_cast<double>(frames.size());
            frames.clear();
          };
          const episode::Episode::End end = episode.EachFrame([&](const grammar::Frame& frame) {
            frames.push_back(Copy(frame));
            if (frames.size() == kFramesAtOnce) watch();
          });
          watch();
          figure.simulated_s = truth::SecondsOf(end.tick, entities.ticks_per_second);
          return end.tick;
        };
    figure.events = static_cast<double>(
        episode::Segment(episode.program(), entities, play).timeline.events.size());
    figure.operations = operations;
    figure.seconds = std::min(figure.seconds, seconds);
  }
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
    const Stopwatch watch;
    episode::Resegment(loaded.scenario, run.recording, loaded.program, run.ticks + 1);
    figure.seconds = std::min(figure.seconds, watch.seconds());
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
