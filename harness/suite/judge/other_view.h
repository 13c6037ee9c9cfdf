// SPDX-License-Identifier: Apache-2.0
// What somebody else says happened in a run: its golden, another grammar, another physics engine;
// and a sheet of both. Tested by tests/program/render_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/show/figures/figures.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {

/// What somebody else than the grammar says of an episode (docs/recognisers.md).
struct Heard {
  grammar::Timeline timeline;
  std::string failure;              ///< a rule that it broke: its events are not all
  std::string notes;                ///< what it said beside: lines, or ""
  std::vector<std::string> covers;  ///< the events that it may find; none: whatever there is

  /// Whether it may find such an event, which loses what nobody heard says: its attributes, and
  /// whether the episode ended it.
  bool MayFind(grammar::NamedEvent& event) const;
};
/// Programs of others belong to another wing, so who hears them is a value.
using Listen = std::function<Result<Heard>(episode::Episode&)>;

// A planar scenario in the other engine: what is recognised does not depend on the engine that
// computed the physics. Tested by tests/harness/suite/judge/compare_engines_test.cc

/// Said of a scenario that differs between them.
inline constexpr const char* kUntilEnginesAgree =
    "it cannot be accepted until both engines agree: change the scenario, or fix what differs";

/// As the scenario format calls it.
const char* NameOf(physics::Engine engine);

struct EngineComparison {
  physics::Engine other = physics::Engine::kBullet;
  episode::RunResult run;  ///< in the other engine
  truth::Comparison
      comparison;  ///< of the other engine's timeline with the one given; empty if it failed
};

/// In the engine that it does not name.
episode::RunResult RunInOtherEngine(scenario::Scenario scenario,
                                    std::shared_ptr<const grammar::Program> program,
                                    const episode::RunOptions& options = {});
/// Boundaries may differ by this much between engines, which place contacts and distribute friction
/// differently.
grammar::Tick EngineTolerance(const grammar::Timeline& timeline);
/// With nothing that people wrote.
truth::Golden GoldenOf(const grammar::Timeline& timeline);

/// Plays the scenario in the other engine. Empty when it is not planar.
std::optional<EngineComparison> CompareEngines(const scenario::Scenario& scenario,
                                               std::shared_ptr<const grammar::Program> program,
                                               const grammar::Timeline& timeline);

/// Whether the other engine's run completed with the same events.
bool Agrees(const EngineComparison& compared);

/// In which events the other engine differs and how far, or why its run failed; "" when they agree.
/// `explain` is the command that asks about the scenario's events.
std::string EngineDifferenceText(const scenario::Scenario& scenario,
                                 const EngineComparison& compared, const std::string& explain);

/// A run with every frame.
struct PlayedRun {
  episode::LoadedRun loaded;
  episode::RunResult run;
  bool simulated = true;  ///< otherwise its scene is a placeholder: its frames are not to be sensed
};

struct OtherView {
  std::string name;              ///< "golden", "original_2020", "box2d"
  episode::RunResult run;        ///< its timeline; another engine's also has the recording
  truth::Comparison comparison;  ///< `expected` is the other view, `actual` the run that was played
};

/// `view` is "golden", the name of an engine, or a grammar: its name or its file; or the command
/// that said what is heard. `root`: the project's.
tl::expected<OtherView, episode::NotFound> ViewOf(const PlayedRun& played, const std::string& view,
                                                  const std::string& root,
                                                  const Heard* heard = nullptr);

/// Both over time, and the scenes where they differ. `view` may also be "pictures": golden
/// pictures, those of now, and what differs. The name is that of the view.
struct NamedSheet {
  std::string name;
  show::Sheet sheet;
};
tl::expected<NamedSheet, episode::NotFound> SheetAgainst(
    const PlayedRun& played, const std::string& view, const show::Window& window,
    const show::SceneFormat& format, const std::string& root, const Heard* heard = nullptr);

}  // namespace prehend::suite
