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
#include "harness/command/recorded_episode.h"
#include "harness/figures/figures.h"
#include "harness/golden/golden_files.h"
#include "harness/pictures/pictures.h"
#include "harness/pictures/svg_file.h"
#include "harness/run/load_grammar.h"
#include "harness/run/run_text.h"
#include "harness/sense/sensing.h"

namespace prehend::harness {
namespace {

constexpr std::size_t kKeyFrames = 10;
constexpr int kKeyFrameColumns = 5, kGraspColumns = 4;

struct Kind {
  const char* name;
  const char* scenario;  ///< unless another one is asked for
  bool is_chart;
  const char* help;
};
constexpr Kind kKinds[] = {
    {"keyframes", "pick_and_place/milk_carton_wrap", false,
     "up to ten moments of what hands do, on one sheet"},
    {"phases", "pick_and_place/milk_carton_wrap", true, "all events over time"},
    {"grasps", "*", false, "each style of grasp holding something, with its sensors"},
    {"plate", "bimanual/two_hands_carry_a_plate_of_a_kilogram", true,
     "height of what moves, trigger and force of each hand, over time"},
    {"gaze", "gaze/eyes_lead_the_hand", true, "what a person sees, and how far it is"}};

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

/// Simulated, or read from an episode file.
tl::expected<PlayedRun, ExitCode> PlayOrRead(const std::string& typed, const ParsedOptions& options,
                                             const CommandContext& context) {
  auto played = PlayOrReplay(typed, options, context);
  if (!played) return played;
  if (played->run.recording.empty())
    return tl::unexpected(Complain(context, ExitCode::kFailure, StatusText(played->run)));
  return played;
}

figures::Window WindowOf(const ParsedOptions& options, const RunResult& run) {
  figures::Window window = figures::WholeOf(run);
  window.from_s = options.NumberOr("--from", window.from_s);
  window.to_s = std::min(window.to_s, options.NumberOr("--to", window.to_s));
  return window;
}

PictureFormat SmallFormat(const ParsedOptions& options, int width_px, int height_px) {
  return {.width_px = width_px,
          .height_px = height_px,
          .text_scale = options.NumberOr("--text", 1),
          .print = options.Text("--theme") == "print",
          .strip = false};
}

ExitCode Finish(const PictureResult& drawn, const std::string& file,
                const CommandContext& context) {
  if (!drawn.error.empty())
    return Complain(context, ExitCode::kFailure, "no picture: " + drawn.error);
  context.out << file << "\n";
  return ExitCode::kAgrees;
}

ExitCode DrawKeyFrames(const PlayedRun& played, const ParsedOptions& options,
                       const CommandContext& context) {
  const std::string camera = options.TextOr("--camera", "action");
  if (const auto why = WhyNoCamera(played.loaded.scenario, camera))
    return Complain(context, ExitCode::kBadInput, "--" + *why);
  std::vector<SheetEntry> entries;
  for (const figures::KeyMoment& moment :
       figures::KeyMoments(played.run, WindowOf(options, played.run), kKeyFrames)) {
    entries.push_back({.scenario = &played.loaded.scenario,
                       .run = &played.run,
                       .picture = {},
                       .title = fmt::format("{}, {:.2f} s", moment.caption, moment.time_s)});
    entries.back().picture.at.value = fmt::format("{:.4f}", moment.time_s);
    entries.back().picture.camera.value = camera;
  }
  PictureFormat format = SmallFormat(options, 560, 420);
  format.ghosts = format.paths = false;
  const int columns = std::min(kKeyFrameColumns, static_cast<int>(entries.size()));
  return Finish(DrawSheet(entries, columns, options.Text("--output"), format),
                options.Text("--output"), context);
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
  std::string problem;
  auto selection = SelectScenarios({typed}, {}, context.root, problem);
  if (!selection) {
    Complain(context, ExitCode::kNothing, problem);
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
  std::vector<std::string> styles;
  std::vector<SheetEntry> entries;
  for (const ScenarioFile& file : ScenariosLike(typed, context)) {
    const Result<LoadedRun> read = LoadRun(RequestOf(options, file.path), context.root);
    if (!read) return Complain(context, read.error());
    const std::vector<std::string> used = StylesOf(read->scenario);
    const bool has_new = std::ranges::any_of(
        used, [&](const std::string& style) { return std::ranges::count(styles, style) == 0; });
    if (!has_new) continue;
    auto one = PlayOrRead(file.path, options, context);
    if (!one) return one.error();
    const auto held = figures::LongestGrasp(one->loaded.scenario, one->run);
    if (!held || std::ranges::count(styles, held->style) > 0) continue;
    styles.push_back(held->style);
    played.push_back(std::move(*one));
    PictureYaml picture;
    picture.at.value = fmt::format("{:.4f}", held->time_s);
    picture.camera.value = options.TextOr("--camera", "hand");
    entries.push_back(
        {.picture = std::move(picture),
         .title = fmt::format("{}: {}", held->style, fmt::join(held->sensor_sets, ", "))});
  }
  if (entries.empty())
    return Complain(context, ExitCode::kNothing,
                    "in no scenario of '" + typed + "' a hand holds something in a style");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].scenario = &played[i].loaded.scenario;
    entries[i].run = &played[i].run;
  }
  PictureFormat format = SmallFormat(options, 480, 400);
  format.ghosts = format.paths = false;
  const int columns = std::min(kGraspColumns, static_cast<int>(entries.size()));
  return Finish(DrawSheet(entries, columns, options.Text("--output"), format),
                options.Text("--output"), context);
}

/// The same episode as another grammar, or the golden, segments it; or an exit code.
tl::expected<RunResult, ExitCode> OtherView(const PlayedRun& played, const std::string& view,
                                            const CommandContext& context) {
  RunResult other;
  other.ticks = played.run.ticks;
  const Scenario& scenario = played.loaded.scenario;
  if (view == "golden") {
    const std::string id = ScenarioId(scenario.skill, scenario.name);
    const auto golden = GoldenFiles(context.root).ReadGoldenOf(id);
    if (!golden) return tl::unexpected(Complain(context, golden.error()));
    if (!*golden)
      return tl::unexpected(
          Complain(context, ExitCode::kNothing, "--against: " + id + " has no golden"));
    other.timeline = ToTimeline(**golden);
    other.drawings = played.run.drawings;
    return other;
  }
  if (!played.simulated)
    return tl::unexpected(Complain(context, ExitCode::kBadInput,
                                   "--against: of a recording that was imported, only one grammar "
                                   "can be shown; resegment --grammar shows the other"));
  const grammar::CompileResult compiled = LoadGrammar(context.root, view);
  if (!compiled.program) return tl::unexpected(Complain(context, compiled.diagnostics));
  std::vector<physics::Snapshot> sensed;
  Sensing sensing(scenario.scene, scenario.sensing);
  for (const physics::Snapshot& snapshot : played.run.recording)
    if (sensing.Due(snapshot.tick)) sensed.push_back(snapshot);
  other.timeline = Resegment(scenario, sensed, compiled.program, played.run.ticks + 1);
  other.drawings = EventDrawings(*compiled.program);
  return other;
}

ExitCode DrawChart(const Kind& kind, const PlayedRun& played, const ParsedOptions& options,
                   const CommandContext& context) {
  const Scenario& scenario = played.loaded.scenario;
  const figures::Window window = WindowOf(options, played.run);
  std::optional<figures::Chart> chart;
  const std::string name = kind.name;
  if (name == "phases") chart = figures::PhasesChart(scenario, played.run, window);
  if (options.Has("--against")) {
    const std::string view = options.Text("--against");
    const auto other = OtherView(played, view, context);
    if (!other) return other.error();
    const std::string there = view == "golden" ? view : std::filesystem::path(view).stem().string();
    chart = figures::SideBySide(*chart, scenario.grammar,
                                figures::PhasesChart(scenario, *other, window), there);
  }
  if (name == "plate") chart = figures::SeriesChart(scenario, played.run, window);
  if (name == "gaze") chart = figures::GazeChart(scenario, played.run, window);
  if (!chart)
    return Complain(context, ExitCode::kNothing,
                    scenario.name + " has no person, whose gaze could be shown");
  const std::string file = options.Text("--output");
  const std::string problem =
      WriteDrawing(file, figures::ChartSvg(*chart, {.text_px = 12 * options.NumberOr("--text", 1),
                                                    .transparent = options.Has("--transparent")}));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << file << "\n";
  return ExitCode::kAgrees;
}

/// Why these options do not go together, or "".
std::string WhyNot(const Kind& kind, const ParsedOptions& options) {
  if (options.NumberOr("--from", 0) >= options.NumberOr("--to", 1e9))
    return fmt::format("--from: found {:g} s, wanted less than --to, {:g} s",
                       options.NumberOr("--from", 0), options.NumberOr("--to", 0));
  if (!kind.is_chart && options.Has("--transparent"))
    return "--transparent is for charts: phases, plate, gaze";
  if (std::string_view(kind.name) != "phases" && options.Has("--against"))
    return "--against is for phases";
  for (const char* of_scenes : {"--camera", "--theme"}) {
    if (kind.is_chart && options.Has(of_scenes))
      return fmt::format("{} is for scenes: keyframes, grasps", of_scenes);
  }
  const std::string file = options.Text("--output");
  if (!kind.is_chart && !file.ends_with(".png"))
    return "--output: found '" + file + "', wanted a file NAME.png; scenes are drawn in pixels";
  return kind.is_chart ? WhyNoDrawingFile(file) : "";
}

ExitCode RunFigure(const ParsedOptions& options, const CommandContext& context) {
  const Kind& kind = *KindOf(options.Text("kind"));
  std::string problem = WhyNot(kind, options);
  if (problem.empty()) problem = WhyNotWritable(options.Text("--output"));
  if (!problem.empty()) return Complain(context, ExitCode::kBadInput, problem);
  const std::string typed = options.TextOr("scenario", kind.scenario);
  if (std::string_view(kind.name) == "grasps") return DrawGrasps(typed, options, context);
  const auto played = PlayOrRead(typed, options, context);
  if (!played) return played.error();
  const double from_s = options.NumberOr("--from", 0), end_s = figures::WholeOf(played->run).to_s;
  if (from_s >= end_s)
    return Complain(context, ExitCode::kBadInput,
                    fmt::format("--from: found {:g} s, wanted less than the episode's end, {:g} s",
                                from_s, end_s));
  return kind.is_chart ? DrawChart(kind, *played, options, context)
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
      .options = {{.name = "kind",
                   .help = KindHelp(),
                   .rule = {.range = {}, .problem = KindProblem},
                   .required = true},
                  {.name = "scenario",
                   .help = "a scenario or an episode file (docs/episodes.md); for grasps a glob"},
                  EpisodeOption(),
                  {.name = "--output",
                   .help = "the file: .png; charts also .svg and .pdf",
                   .placeholder = "FILE",
                   .other_name = "-o",
                   .required = true,
                   .is_output = true},
                  {.name = "--against",
                   .help = "of phases: the same episode by another grammar, or the golden, below",
                   .placeholder = "golden|NAME|FILE"},
                  {.name = "--from",
                   .help = "begin of the part that is shown, seconds",
                   .placeholder = "S",
                   .rule = NumbersFrom(0, 1e6)},
                  {.name = "--to",
                   .help = "end of that part",
                   .placeholder = "S",
                   .rule = NumbersFrom(0, 1e6)},
                  {.name = "--camera",
                   .help = "of scenes: from where, as of 'render'",
                   .placeholder = "CAMERA"},
                  {.name = "--text",
                   .help = "scale of all text; default: 1",
                   .placeholder = "SCALE",
                   .rule = NumbersFrom(0.3, 5)},
                  {.name = "--theme",
                   .help = "of scenes: light, or print: on white paper",
                   .placeholder = "THEME",
                   .rule = {.range = "light or print",
                            .problem =
                                [](const std::string& value) {
                                  return value == "light" || value == "print"
                                             ? std::string()
                                             : "expected light or print, found '" + value + "'";
                                }}},
                  {.name = "--transparent", .help = "of charts: no white ground"},
                  GrammarOption(),
                  SettingsOption()},
      .run = RunFigure};
}

}  // namespace prehend::harness
