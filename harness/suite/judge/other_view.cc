// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/other_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"

namespace prehend::suite {
namespace {

using Viewed = tl::expected<OtherView, episode::NotFound>;

auto Refused(ExitCode code, const std::string& why) {
  return tl::unexpected(episode::NotFound{.exit_code = code, .message = why});
}
auto Refused(grammar::Diagnostics errors) {
  return tl::unexpected(episode::NotFound{.diagnostics = std::move(errors)});
}

Viewed GoldenView(const PlayedRun& played, const std::string& root) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  const std::string id = episode::ScenarioId(scenario.skill, scenario.name);
  const auto golden = truth::GoldenFiles(root).ReadGoldenOf(id);
  if (!golden) return Refused(golden.error());
  if (!*golden) return Refused(ExitCode::kNothing, "--against: " + id + " has no golden");
  OtherView view{.name = "golden",
                 .comparison = truth::Compare(**golden, played.run.timeline,
                                              scenario::DefaultTolerance(scenario))};
  view.run.timeline = truth::ToTimeline(**golden);
  view.run.drawings = played.run.drawings;
  return view;
}

Viewed GrammarView(const PlayedRun& played, const std::string& grammar, const std::string& root) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  if (!played.simulated)
    return Refused(ExitCode::kBadInput,
                   "--against: of a recording that was imported, only one grammar can be shown; "
                   "episode resegment --grammar shows the other");
  const grammar::CompileResult compiled = episode::LoadGrammar(root, grammar);
  if (!compiled.program) return Refused(compiled.diagnostics);
  OtherView view{.name = std::filesystem::path(grammar).stem().string()};
  view.run.timeline =
      episode::Resegment(scenario, played.run.recording, compiled.program, played.run.ticks + 1);
  view.run.drawings = truth::EventDrawings(*compiled.program);
  view.comparison = truth::Compare(GoldenOf(view.run.timeline), played.run.timeline,
                                   scenario::DefaultTolerance(scenario));
  return view;
}

Viewed EngineView(const PlayedRun& played, const std::string& engine) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  const std::string own = NameOf(scenario.scene.world.engine);
  if (engine == own)
    return Refused(ExitCode::kBadInput,
                   fmt::format("--against: {} is played in {} already, wanted {}", scenario.name,
                               own, own == "box2d" ? "bullet" : "box2d"));
  if (!scenario.scene.world.planar || !played.simulated)
    return Refused(ExitCode::kBadInput,
                   "--against: " + scenario.name +
                       " is not planar; only planar scenarios run in both engines");
  OtherView view{.name = engine,
                 .run = RunInOtherEngine(scenario, played.loaded.program, {.record = true})};
  if (view.run.status.kind != physics::RunStatus::Kind::kCompleted)
    return Refused(ExitCode::kFailure,
                   "--against: in " + engine + ": " + episode::StatusText(view.run));
  view.comparison = truth::Compare(GoldenOf(view.run.timeline), played.run.timeline,
                                   EngineTolerance(played.run.timeline));
  return view;
}

Viewed HeardView(const PlayedRun& played, const Heard& heard) {
  if (!heard.failure.empty())
    return Refused(ExitCode::kBadInput, "--against: the recogniser failed: " + heard.failure);
  grammar::Timeline covered = played.run.timeline;
  std::erase_if(covered.events, [&](auto& event) { return !heard.MayFind(event); });
  OtherView view{.name = "recogniser",
                 .comparison = truth::Compare(GoldenOf(heard.timeline), covered,
                                              scenario::DefaultTolerance(played.loaded.scenario))};
  view.run.timeline = heard.timeline;
  view.run.drawings = played.run.drawings;
  return view;
}

}  // namespace

bool Heard::MayFind(grammar::NamedEvent& event) const {
  std::erase_if(event.roles, [](const grammar::Role& role) { return role.name == "style"; });
  event.open_end = false;
  return covers.empty() || std::ranges::count(covers, event.event) > 0;
}

Viewed ViewOf(const PlayedRun& played, const std::string& view, const std::string& root,
              const Heard* heard) {
  if (heard) return HeardView(played, *heard);
  if (view == "golden") return GoldenView(played, root);
  if (view == "box2d" || view == "bullet") return EngineView(played, view);
  return GrammarView(played, view, root);
}

tl::expected<NamedSheet, episode::NotFound> SheetAgainst(
    const PlayedRun& played, const std::string& view, const show::Window& window,
    const show::SceneFormat& format, const std::string& root, const Heard* heard) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  show::ScenePainter painter;
  NamedSheet made{.name = view};
  if (view == "pictures") {
    const std::string id = episode::ScenarioId(scenario.skill, scenario.name);
    made.sheet = show::GoldenPicturesSheet(id, scenario, played.run,
                                           truth::GoldenFiles(root).PicturesOf(id), painter);
    if (made.sheet.rows.empty())
      return Refused(ExitCode::kNothing, "--against: " + id + " has no golden pictures; " +
                                             AcceptPicturesCommand(id) + " keeps those of now");
  } else {
    PREHEND_TRY(const auto other, ViewOf(played, view, root, heard));
    const bool in_other_engine = !other.run.recording.empty();
    const show::Side first{.name = made.name = other.name,
                           .events = &other.run,
                           .scenes = in_other_engine ? &other.run : &played.run},
        second{.name = in_other_engine ? NameOf(scenario.scene.world.engine) : scenario.grammar,
               .events = &played.run,
               .scenes = &played.run};
    made.sheet =
        show::ComparisonSheet(scenario, first, second, other.comparison, window, format, painter);
  }
  if (!painter.error().empty())
    return Refused(ExitCode::kFailure, "no picture: " + painter.error());
  return made;
}

}  // namespace prehend::suite
