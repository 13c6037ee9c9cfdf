// SPDX-License-Identifier: Apache-2.0
// prehend figure: the paper's figures from runs of one's own. Tested by
// tests/program/figure_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "harness/base/atomic_file.h"
#include "harness/check/select_scenarios.h"
#include "harness/command/command.h"
#include "harness/command/other_view.h"
#include "harness/command/picture_options.h"
#include "harness/command/typed_episode.h"
#include "harness/figures/comparison_sheet.h"
#include "harness/pictures/svg_file.h"
#include "harness/run/event_time.h"
#include "harness/run/run_text.h"

namespace prehend::harness {
namespace {

constexpr std::size_t kKeyFrames = 10;
constexpr int kMostScenes = 10;
constexpr double kSheetWidth_px = 1100;

struct Kind {
  const char* name;
  const char* scenario;  ///< unless another one is asked for
  int scenes;            ///< above a chart, unless asked otherwise; -1: it has no chart
  const char* help;

  bool HasChart() const { return scenes >= 0; }
};
constexpr Kind kKinds[] = {
    {"keyframes", "pick_and_place/milk_carton_wrap", -1,
     "up to ten moments of what hands do, on one sheet"},
    {"phases", "pick_and_place/milk_carton_wrap", 5, "all events over time, with scenes"},
    {"grasps", "*", -1, "each style of grasp holding something, with its sensors"},
    {"plate", "bimanual/two_hands_carry_a_plate_of_a_kilogram", 3,
     "height of what moves, trigger and force of each hand, over time"},
    {"gaze", "gaze/eyes_lead_the_hand", 3, "what a person sees, for how long, and how far it is"}};

const Kind* KindOf(const std::string& name) {
  const auto kind = std::ranges::find(kKinds, name, [](const Kind& one) { return one.name; });
  return kind == std::end(kKinds) ? nullptr : kind;
}

std::string KindProblem(const std::string& name) {
  if (KindOf(name)) return "";
  return "found '" + name + "', wanted keyframes, phases, grasps, plate or gaze";
}

std::string KindHelp() {
  std::string help;
  for (const Kind& kind : kKinds)
    help += fmt::format("{}{}: {}; default: {}", help.empty() ? "" : "\n", kind.name, kind.help,
                        kind.scenario);
  return help;
}

/// Of any kind of episode.
tl::expected<PlayedRun, ExitCode> PlayTyped(const std::string& typed, const ParsedOptions& options,
                                            const CommandContext& context) {
  auto episode = OpenEpisodeOrComplain(typed, options, context);
  if (!episode) return tl::unexpected(episode.error());
  return PlayOrComplain(std::move(*episode), context);
}

ExitCode WriteSheet(const figures::Sheet& sheet, const figures::SceneFormat& format,
                    const ScenePainter& painter, const ParsedOptions& options,
                    const CommandContext& context) {
  if (!painter.error().empty())
    return Complain(context, ExitCode::kFailure, "no picture: " + painter.error());
  const std::string file = options.Text("--output");
  const std::string problem = WriteDrawing(file, SheetSvg(sheet, format.chart));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << file << "\n";
  return ExitCode::kAgrees;
}

ExitCode DrawKeyFrames(const PlayedRun& played, const ParsedOptions& options,
                       const CommandContext& context) {
  const figures::SceneFormat format = SceneFormatOf(options, "hand", kSheetWidth_px);
  ScenePainter painter;
  const figures::Sheet sheet = figures::KeyFrameSheet(
      played.loaded.scenario, played.run,
      figures::KeyMoments(played.run, WindowOf(options, played.run), kKeyFrames), format, painter);
  return WriteSheet(sheet, format, painter, options, context);
}

/// The styles in which the scenario's hands reach.
std::vector<std::string> StylesOf(const Scenario& scenario) {
  std::vector<std::string> styles;
  for (const physics::ScriptStage& stage : scenario.script.stages) {
    for (const physics::Step& step : stage.steps)
      if (const auto* reach = std::get_if<physics::ReachStep>(&step.action))
        styles.push_back(reach->style);
  }
  return styles;
}

/// Short ones first, which show little else.
std::vector<ScenarioFile> ScenariosLike(const std::string& typed, const CommandContext& context) {
  auto selection = SelectScenarios({typed}, {}, context.root);
  if (!selection) {
    Complain(context, selection.error().exit_code, selection.error().why);
    return {};
  }
  std::ranges::stable_sort(selection->scenarios, {}, [](const ScenarioFile& file) {
    std::error_code error;
    return std::filesystem::file_size(file.path, error);
  });
  return std::move(selection->scenarios);
}

/// One scenario per style: the first in which a hand holds something so.
ExitCode DrawGrasps(const std::string& typed, const ParsedOptions& options,
                    const CommandContext& context) {
  std::vector<PlayedRun> played;
  std::vector<figures::HeldScene> scenes;
  const auto is_known = [&](const std::string& style) {
    return std::ranges::any_of(
        scenes, [&](const figures::HeldScene& scene) { return scene.held.style == style; });
  };
  for (const ScenarioFile& file : ScenariosLike(typed, context)) {
    const Result<LoadedRun> read = LoadRun(RequestOf(options, file.path), context.root);
    if (!read) return Complain(context, read.error());
    if (std::ranges::all_of(StylesOf(read->scenario), is_known)) continue;
    auto one = PlayTyped(file.path, options, context);
    if (!one) return one.error();
    auto held = figures::LongestGrasp(one->loaded.scenario, one->run);
    if (!held || is_known(held->style)) continue;
    played.push_back(std::move(*one));
    scenes.push_back({.held = std::move(*held)});
  }
  if (scenes.empty())
    return Complain(context, ExitCode::kNothing,
                    "in no scenario of '" + typed + "' a hand holds something in a style");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    scenes[i].scenario = &played[i].loaded.scenario;
    scenes[i].run = &played[i].run;
  }
  const figures::SceneFormat format = SceneFormatOf(options, "hand", kSheetWidth_px);
  ScenePainter painter;
  const figures::Sheet sheet = figures::GraspSheet(scenes, format, painter);
  return WriteSheet(sheet, format, painter, options, context);
}

/// Of the chart's scenes: those that are asked for, else those that tell most.
tl::expected<std::vector<figures::KeyMoment>, ExitCode> MomentsOf(const Kind& kind,
                                                                  const PlayedRun& played,
                                                                  const ParsedOptions& options,
                                                                  const CommandContext& context) {
  const RunResult& run = played.run;
  const figures::Window window = WindowOf(options, run);
  std::vector<figures::KeyMoment> moments;
  if (options.Has("--at")) {
    for (const std::string& at : WordsOf(options.Text("--at"))) {
      if (const auto problem = WhyNoEventTime(at, *played.loaded.program))
        return tl::unexpected(Complain(context, ExitCode::kBadInput,
                                       "--at: " + problem->message + "; " + problem->hint));
      const FoundTime found = FindEventTime(at, run);
      if (!found.missed.empty())
        return tl::unexpected(Complain(context, ExitCode::kBadInput, "--at: " + found.missed));
      moments.push_back({.time_s = figures::SecondsOf(run, found.tick), .caption = at});
    }
    if (moments.size() > kMostScenes)
      return tl::unexpected(Complain(
          context, ExitCode::kBadInput,
          fmt::format("--at: found {} moments, wanted at most {}", moments.size(), kMostScenes)));
    return moments;
  }
  const auto count = static_cast<std::size_t>(options.IntOr("--scenes", kind.scenes));
  const std::string name = kind.name;
  if (name == "gaze") return LongestLooks(played.loaded.scenario, run, window, count);
  if (name == "phases") {
    // Begin and end of the episode are on the chart anyway.
    for (std::size_t most = count; moments.size() < count && most <= count + 2; ++most) {
      moments = figures::KeyMoments(run, window, most);
      std::erase_if(moments, [](const figures::KeyMoment& moment) {
        return moment.caption == "begin" || moment.caption == "end";
      });
    }
    return moments;
  }
  for (const double time_s : figures::SpreadMoments(run, window, count))
    moments.push_back({.time_s = time_s, .caption = ""});
  return moments;
}

ExitCode DrawChart(const Kind& kind, const PlayedRun& played, const ParsedOptions& options,
                   const CommandContext& context) {
  const Scenario& scenario = played.loaded.scenario;
  const figures::Window window = WindowOf(options, played.run);
  std::optional<figures::Chart> chart;
  const std::string name = kind.name;
  if (name == "phases") chart = figures::PhasesChart(scenario, played.run, window);
  if (options.Has("--against")) {
    const auto other = OtherViewOrComplain(played, options.Text("--against"), context);
    if (!other) return other.error();
    chart = figures::ComparisonChart(scenario, {.name = other->name, .events = &other->run},
                                     {.name = scenario.grammar, .events = &played.run},
                                     other->comparison, window);
  }
  if (name == "plate") chart = figures::SeriesChart(scenario, played.run, window);
  if (name == "gaze") chart = figures::GazeChart(scenario, played.run, window);
  if (!chart)
    return Complain(context, ExitCode::kNothing,
                    scenario.name + " has no person, whose gaze could be shown");
  const auto moments = MomentsOf(kind, played, options, context);
  if (!moments) return moments.error();
  figures::SceneFormat format = SceneFormatOf(options, name == "gaze" ? "body" : "action", 900);
  format.picture.ghosts = false;
  format.picture.paths = name == "phases";
  format.picture.labels = false;
  if (!moments->empty() && !CanDrawPictures())
    context.err << "prehend: warning: this build draws no scenes; the chart is alone\n";
  if (moments->empty() || !CanDrawPictures())
    return WriteSheet({.chart = std::move(chart)}, format, {}, options, context);
  ScenePainter painter;
  const figures::Sheet sheet =
      WithScenes(std::move(*chart), scenario, played.run, *moments, format, painter);
  return WriteSheet(sheet, format, painter, options, context);
}

/// Why these options do not go together, or "".
std::string WhyNot(const Kind& kind, const ParsedOptions& options) {
  if (std::string_view(kind.name) != "phases" && options.Has("--against"))
    return "--against is for phases";
  for (const char* of_charts : {"--scenes", "--at"}) {
    if (!kind.HasChart() && options.Has(of_charts))
      return fmt::format("{} is for charts: phases, plate, gaze", of_charts);
  }
  if (options.Has("--scenes") && options.Has("--at")) return "--scenes and --at exclude each other";
  return WhyNoDrawingFile(options.Text("--output"));
}

ExitCode RunFigure(const ParsedOptions& options, const CommandContext& context) {
  const Kind& kind = *KindOf(options.Text("kind"));
  std::string problem = WhyNot(kind, options);
  if (problem.empty()) problem = WhyNotWritable(options.Text("--output"));
  if (!problem.empty()) return Complain(context, ExitCode::kBadInput, problem);
  const std::string typed = options.TextOr("scenario", kind.scenario);
  if (std::string_view(kind.name) == "grasps") return DrawGrasps(typed, options, context);
  const auto played = PlayTyped(typed, options, context);
  if (!played) return played.error();
  problem = WhyNotShown(options, played->loaded.scenario, played->run);
  if (!problem.empty()) return Complain(context, ExitCode::kBadInput, problem);
  return kind.HasChart() ? DrawChart(kind, *played, options, context)
                         : DrawKeyFrames(*played, options, context);
}

}  // namespace

Command FigureCommand() {
  return {
      .name = "figure",
      .summary = "Draw a figure for a paper from a run: key frames, phases, grasps, gaze",
      .examples = {"figure keyframes -o keyframes.png",
                   "figure phases slide/hop_divides_a_slide -o phases.pdf",
                   "figure phases milk_carton_wrap --against original_2020 -o two.pdf",
                   "figure plate --from 1 --to 4 -o plate.svg --transparent",
                   "figure gaze suite.episodes --episode gaze/eyes_lead_the_hand -o gaze.png"},
      .options = Joined(
          {{.name = "kind",
            .help = KindHelp(),
            .rule = {.range = {}, .problem = KindProblem},
            .required = true},
           {.name = "scenario",
            .help = "a scenario or an episode file (docs/episodes.md); for grasps a glob"},
           EpisodeOption(),
           Required(OutputOption("the file: .svg, .pdf or .png")),
           {.name = "--against",
            .help = "of phases: the same episode by another grammar, or the golden, beside it",
            .placeholder = kViewForm},
           {.name = "--scenes",
            .help = "how many scenes are above a chart, 0 to 10; default: phases 5, others 3",
            .placeholder = "N",
            .rule = IntegersFrom(0, kMostScenes)},
           {.name = "--at",
            .help = "when these are: EVENT.begin, EVENT.end or seconds, with commas between them",
            .placeholder = "TIME,.."}},
          Joined(Joined(LookOptions(), PartOptions()), {GrammarOption(), SettingsOption()})),
      .run = RunFigure};
}

}  // namespace prehend::harness
