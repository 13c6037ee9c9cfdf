// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command/other_view.h. Tested by tests/program/render_test.cc
#include "harness/cli/command/other_view.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment.h"
#include "harness/suite/judge/compare_engines.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::cli {
namespace {

truth::Golden GoldenOf(const grammar::Timeline& timeline) {
  truth::Golden golden{.ticks_per_second = timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : timeline.events)
    golden.events.push_back({.event = event});
  return golden;
}

tl::expected<OtherView, ExitCode> GoldenView(const PlayedRun& played,
                                             const CommandContext& context) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  const std::string id = episode::ScenarioId(scenario.skill, scenario.name);
  const auto golden = truth::GoldenFiles(context.root).ReadGoldenOf(id);
  if (!golden) return tl::unexpected(Complain(context, golden.error()));
  if (!*golden)
    return tl::unexpected(
        Complain(context, ExitCode::kNothing, "--against: " + id + " has no golden"));
  OtherView view{.name = "golden", .run = {}, .comparison = {}};
  view.run.timeline = truth::ToTimeline(**golden);
  view.run.drawings = played.run.drawings;
  view.comparison =
      truth::Compare(**golden, played.run.timeline, scenario::DefaultTolerance(scenario));
  return view;
}

tl::expected<OtherView, ExitCode> GrammarView(const PlayedRun& played, const std::string& grammar,
                                              const CommandContext& context) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  if (!played.simulated)
    return tl::unexpected(Complain(context, ExitCode::kBadInput,
                                   "--against: of a recording that was imported, only one grammar "
                                   "can be shown; episode resegment --grammar shows the other"));
  const grammar::CompileResult compiled = episode::LoadGrammar(context.root, grammar);
  if (!compiled.program) return tl::unexpected(Complain(context, compiled.diagnostics));
  OtherView view{
      .name = std::filesystem::path(grammar).stem().string(), .run = {}, .comparison = {}};
  view.run.timeline =
      episode::Resegment(scenario, played.run.recording, compiled.program, played.run.ticks + 1);
  view.run.drawings = truth::EventDrawings(*compiled.program);
  view.comparison = truth::Compare(GoldenOf(view.run.timeline), played.run.timeline,
                                   scenario::DefaultTolerance(scenario));
  return view;
}

tl::expected<OtherView, ExitCode> EngineView(const PlayedRun& played, const std::string& engine,
                                             const CommandContext& context) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  const auto refuse = [&](ExitCode code, const std::string& why) {
    return tl::unexpected(Complain(context, code, "--against: " + why));
  };
  const std::string own = suite::NameOf(scenario.scene.world.engine);
  if (engine == own)
    return refuse(ExitCode::kBadInput,
                  fmt::format("{} is played in {} already, wanted {}", scenario.name, own,
                              own == "box2d" ? "bullet" : "box2d"));
  if (!scenario.scene.world.planar || !played.simulated)
    return refuse(ExitCode::kBadInput,
                  scenario.name + " is not planar; only planar scenarios run in both engines");
  scenario::Scenario in_other = scenario;
  in_other.scene.world.engine =
      engine == "box2d" ? physics::Engine::kBox2d : physics::Engine::kBullet;
  OtherView view{.name = engine,
                 .run = episode::RunScenario(in_other, played.loaded.program, {.record = true}),
                 .comparison = {}};
  if (view.run.status.kind != physics::RunStatus::Kind::kCompleted)
    return refuse(ExitCode::kFailure, "in " + engine + ": " + episode::StatusText(view.run));
  const auto tolerance = std::llround(suite::kEngineTolerance_s *
                                      static_cast<double>(played.run.timeline.ticks_per_second));
  view.comparison = truth::Compare(GoldenOf(view.run.timeline), played.run.timeline, tolerance);
  return view;
}

}  // namespace

tl::expected<OtherView, ExitCode> OtherViewOrComplain(const PlayedRun& played,
                                                      const std::string& view,
                                                      const CommandContext& context) {
  if (view == "golden") return GoldenView(played, context);
  if (view == "box2d" || view == "bullet") return EngineView(played, view, context);
  return GrammarView(played, view, context);
}

}  // namespace prehend::cli
