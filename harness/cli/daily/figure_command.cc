// SPDX-License-Identifier: Apache-2.0
// prehend figure: the paper's figures from runs of one's own. Tested by
// tests/program/figure_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "grammar/watch_drawing.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/cli/command/picture_options.h"
#include "harness/episode/run/load_run.h"
#include "harness/show/figures/figures.h"
#include "harness/show/figures/scene_tiles.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/check/run_suite.h"

namespace prehend::cli {
namespace {

constexpr std::size_t kKeyFrames = 10;
constexpr int kMostScenes = 10;
constexpr double kSheetWidth_px = 1100;
constexpr double kBeside = 0.7;  ///< width of a chart beside another one
constexpr double kNarrow = 30;   ///< in heights of the text: nothing has room beside this
constexpr const char* kTwist = "bimanual/plate_of_a_kilogram_twists_out_of_one_hand";

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
     "height and tilt of what moves, trigger and force of each hand, over time; alone, beside it "
     "bimanual/plate_of_a_kilogram_twists_out_of_one_hand"},
    {"gaze", "gaze/eyes_lead_the_hand", 3, "what a person sees, for how long, and how far it is"}};

const Kind& KindOf(const std::string& name) {
  return *std::ranges::find(kKinds, name, [](const Kind& one) { return one.name; });
}

std::vector<std::string> KindNames() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::string KindHelp() {
  std::string help;
  for (const Kind& kind : kKinds)
    help += fmt::format("{}{}: {}; default: {}", help.empty() ? "" : "\n", kind.name, kind.help,
                        kind.scenario);
  return help;
}

/// Of any kind of episode.
tl::expected<suite::PlayedRun, ExitCode> PlayTyped(const std::string& typed,
                                                   const ParsedOptions& options,
                                                   const CommandContext& context) {
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(typed, options, context));
  return PlayOrComplain(std::move(episode), context);
}

ExitCode WriteOut(const std::string& svg, const ParsedOptions& options,
                  const CommandContext& context) {
  const std::string file = options.Text("--output");
  const std::string problem = show::WriteDrawing(file, svg, PixelsOf(options));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << file << "\n";
  return ExitCode::kAgrees;
}

ExitCode WriteSheet(const show::Sheet& sheet, const show::SceneFormat& format,
                    const show::ScenePainter& painter, const ParsedOptions& options,
                    const CommandContext& context) {
  if (!painter.error().empty())
    return Complain(context, ExitCode::kFailure, "no picture: " + painter.error());
  return WriteOut(SheetSvg(sheet, format.chart), options, context);
}

/// The key frames of the paper, of its ten cases.
struct PaperFrame {
  const char* scenario;
  const char* at;
  double later_s, track_s;
  bool keeps_track;
  const char* caption;
};
constexpr const char* kCandidates = "reach/two_candidates_one_grasped";
constexpr const char* kReturn = "reach/reach_begins_at_the_return_after_a_retreat";
constexpr const char* kSlide = "pick_up/slide_then_pick_up";
constexpr const char* kCut = "put_down/moving_away_cuts_the_put_down_short";
constexpr double kAlmost_s = -0.01;  ///< the phase that ends goes on
constexpr PaperFrame kPaper[] = {
    {kCandidates, "reaching.begin", 0.2, 1, false,
     "reaching: a thing in its region is a candidate, with a star"},
    {kReturn, "reaching.end", kAlmost_s, 2.4, true,
     "reaching begins anew after a retreat, whose way is grey"},
    {kSlide, "fixation.end", kAlmost_s, 1, false, "fixation: touched, not yet held"},
    {kSlide, "sliding.end", kAlmost_s, 1, false, "sliding along the support"},
    {kSlide, "picking_up.begin", 0.05, 1, false, "picking up begins off the support"},
    {kSlide, "picking_up.end", kAlmost_s, 1, false, "picking up ends at the edge of its region"},
    {kCandidates, "transporting.end", -0.5, 1.2, false, "transporting, from region to region"},
    {kCandidates, "putting_down.begin", 0.03, 1, false, "putting down: near the landing place"},
    {kCandidates, "putting_down.end", kAlmost_s, 1.4, true,
     "putting down ends; its begin is found in the track, which is pale green"},
    {kCut, "putting_down.end", kAlmost_s, 2.2, true,
     "putting down after moving away, which cuts it short"}};

/// Each scenario is played once.
ExitCode DrawPaperFrames(const ParsedOptions& options, const CommandContext& context) {
  const show::SceneFormat format = SceneFormatOf(options, "hand", kSheetWidth_px);
  show::ScenePainter painter;
  show::TileRow row{.columns = 5};
  std::map<std::string, suite::PlayedRun> runs;
  for (const PaperFrame& frame : kPaper) {
    if (!runs.contains(frame.scenario)) {
      auto played = PlayTyped(frame.scenario, options, context);
      if (!played) return played.error();
      runs.emplace(frame.scenario, std::move(*played));
    }
    const suite::PlayedRun& played = runs.at(frame.scenario);
    auto moments = show::NamedMoments({frame.at}, *played.loaded.program, played.run);
    if (!moments)
      return Complain(context, ExitCode::kNothing,
                      fmt::format("{}: {}", frame.scenario, moments.error()));
    show::KeyMoment& moment = moments->front();
    moment.time_s += frame.later_s;
    moment.caption = frame.caption;
    moment.involved = {"milk", "juice"};
    moment.track_s = frame.track_s;
    moment.keeps_track = frame.keeps_track;
    AddKeyFrames(played.loaded.scenario, played.run, *moments, format, painter, row);
  }
  return WriteSheet({.rows = {std::move(row)}}, format, painter, options, context);
}

ExitCode DrawKeyFrames(const suite::PlayedRun& played, const ParsedOptions& options,
                       const CommandContext& context) {
  const show::SceneFormat format = SceneFormatOf(options, "hand", kSheetWidth_px);
  show::ScenePainter painter;
  const show::Sheet sheet = show::KeyFrameSheet(
      played.loaded.scenario, played.run,
      show::KeyMoments(played.run, WindowOf(options, played.run), kKeyFrames), format, painter);
  return WriteSheet(sheet, format, painter, options, context);
}

/// One scenario per style: the first in which a hand holds something so.
ExitCode DrawGrasps(const std::string& typed, const ParsedOptions& options,
                    const CommandContext& context) {
  const auto selection = suite::SelectScenarios({typed}, {}, context.root);
  if (!selection) return Complain(context, selection.error().exit_code, selection.error().why);
  std::vector<episode::RunRequest> scenarios;
  for (const episode::ScenarioFile& file : selection->scenarios)
    scenarios.push_back(RequestOf(options, file.path));
  const auto grasps = show::FindGrasps(std::move(scenarios), context.root);
  if (!grasps) return Complain(context, grasps.error());
  if (grasps->empty())
    return Complain(context, ExitCode::kNothing,
                    "in no scenario of '" + typed + "' a hand holds something in a style");
  const show::SceneFormat format = SceneFormatOf(options, "hand", kSheetWidth_px);
  show::ScenePainter painter;
  const show::Sheet sheet = show::GraspSheet(show::ScenesOf(*grasps), format, painter);
  return WriteSheet(sheet, format, painter, options, context);
}

/// Of the chart's scenes: those that are asked for, else those that tell most.
tl::expected<std::vector<show::KeyMoment>, ExitCode> MomentsOf(const Kind& kind,
                                                               const show::Chart& chart,
                                                               const suite::PlayedRun& played,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context) {
  const episode::RunResult& run = played.run;
  const show::Window window = WindowOf(options, run);
  if (options.Has("--at")) {
    auto moments =
        show::NamedMoments(SplitAt(options.Text("--at"), ','), *played.loaded.program, run);
    if (!moments) return tl::unexpected(Refuse(context, "--at: " + moments.error()));
    if (moments->size() > kMostScenes)
      return tl::unexpected(Refuse(context, fmt::format("--at: found {} moments, wanted at most {}",
                                                        moments->size(), kMostScenes)));
    return std::move(*moments);
  }
  const auto count = static_cast<std::size_t>(options.IntOr("--scenes", kind.scenes));
  const std::string name = kind.name;
  if (name == "gaze") return LongestLooks(played.loaded.scenario, run, window, count);
  if (name == "plate") return SeriesMoments(chart, count);
  return show::EventMoments(run, window, count);
}

/// The chart with its scenes as SVG. `share`: how many such drawings share the width.
tl::expected<std::string, ExitCode> ChartOf(const Kind& kind, const suite::PlayedRun& played,
                                            const ParsedOptions& options,
                                            const CommandContext& context, int share,
                                            show::ChartFormat& drawn) {
  const scenario::Scenario& scenario = played.loaded.scenario;
  const show::Window window = WindowOf(options, played.run);
  std::optional<show::Chart> chart;
  const std::string name = kind.name;
  if (name == "phases") chart = show::PhasesChart(scenario, played.run, window);
  if (options.Has("--against")) {
    const auto other = suite::ViewOf(played, options.Text("--against"), context.root);
    if (!other) return tl::unexpected(Complain(context, other.error()));
    chart = show::ComparisonChart(scenario, {.name = other->name, .events = &other->run},
                                  {.name = scenario.grammar, .events = &played.run},
                                  other->comparison, window);
  }
  if (name == "plate") chart = show::SeriesChart(scenario, played.run, window);
  if (name == "gaze") chart = show::GazeChart(scenario, played.run, window);
  if (!chart)
    return tl::unexpected(Complain(context, ExitCode::kNothing,
                                   scenario.name + " has no person, whose gaze could be shown"));
  PREHEND_TRY(const auto moments, MomentsOf(kind, *chart, played, options, context));
  show::SceneFormat format = SceneFormatOf(options, name == "gaze" ? "body" : "action", 900);
  if (share > 1) format.chart.width_px *= options.Has("--width") ? 1.0 / share : kBeside;
  drawn = format.chart;
  format.picture.ghosts = false;
  format.picture.paths = name == "phases";
  format.picture.labels = false;
  if (moments.empty() && options.IntOr("--scenes", kind.scenes) > 0)
    context.err
        << "prehend: note: there are no scenes, as nothing that a scene could show begins or "
           "ends here; --at names moments\n";
  if (!moments.empty() && !show::CanDrawPictures())
    context.err << "prehend: warning: this build draws no scenes; the chart is alone\n";
  if (moments.empty() || !show::CanDrawPictures())
    return SheetSvg({.chart = std::move(chart)}, format.chart);
  show::ScenePainter painter;
  const show::Sheet sheet =
      WithScenes(std::move(*chart), scenario, played.run, moments, format, painter);
  if (!painter.error().empty())
    return tl::unexpected(Complain(context, ExitCode::kFailure, "no picture: " + painter.error()));
  return SheetSvg(sheet, format.chart);
}

/// Of one scenario, or of several beside each other.
ExitCode DrawCharts(const Kind& kind, const std::vector<std::string>& scenarios,
                    const ParsedOptions& options, const CommandContext& context) {
  std::vector<std::string> svgs;
  show::ChartFormat format = SceneFormatOf(options, "", 900).chart;
  const bool beside =
      format.width_px / static_cast<double>(scenarios.size()) >= kNarrow * format.text_px;
  const std::size_t columns = beside || !options.Has("--width") ? scenarios.size() : 1;
  for (const std::string& typed : scenarios) {
    const auto played = PlayTyped(typed, options, context);
    if (!played) return played.error();
    if (const std::string why = WhyNotShown(options, played->loaded.scenario, played->run);
        !why.empty())
      return Refuse(context, why);
    const auto svg = ChartOf(kind, *played, options, context, static_cast<int>(columns), format);
    if (!svg) return svg.error();
    svgs.push_back(*svg);
  }
  return WriteOut(svgs.size() == 1 ? svgs[0] : BesideEachOther(svgs, format, columns), options,
                  context);
}

/// A file of drawn episodes, of which `--episode` names one by its number or title.
ExitCode DrawDrawing(const std::string& path, const ParsedOptions& options,
                     const CommandContext& context) {
  if (!options.Has("--grammar"))
    return Refuse(context, path + ": a drawing needs a grammar: --grammar my.grammar");
  const Result<std::string> text = ReadTextFile(path);
  if (!text) return Complain(context, text.error());
  Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  const grammar::CompileResult compiled =
      episode::LoadGrammar(context.root, options.Text("--grammar"), *settings);
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  grammar::Diagnostics wrong;
  const std::vector<grammar::DrawnEpisode> all =
      grammar::ReadDrawings({ReadableName(path), *text}, wrong);
  if (!wrong.empty()) return Complain(context, wrong);
  const std::string which = options.TextOr("--episode", "1");
  std::size_t at = 0;
  while (at < all.size() && std::to_string(at + 1) != which && all[at].title != which) ++at;
  if (at == all.size())
    return Complain(context, ExitCode::kNothing,
                    fmt::format("--episode: '{}' is none of the {} drawings of {}", which,
                                all.size(), ReadableName(path)));
  const grammar::WatchedDrawing watched = WatchDrawing(compiled.program, all[at]);
  if (!watched.error.empty()) return Complain(context, ExitCode::kFailure, watched.error);
  const show::SceneFormat format = SceneFormatOf(options, "action", 900);
  show::Sheet sheet{.chart = show::DrawingChart(*compiled.program, all[at], watched.timeline)};
  return WriteSheet(sheet, format, {}, options, context);
}

/// Why these options do not go together, or "".
std::string WhyNot(const Kind& kind, const ParsedOptions& options) {
  if (std::string_view(kind.name) != "phases" && options.Has("--against"))
    return "--against is for phases";
  for (const char* of_charts : {"--scenes", "--at"})
    if (!kind.HasChart() && options.Has(of_charts))
      return fmt::format("{} is for charts: phases, plate, gaze", of_charts);
  if (options.Has("--sheet") &&
      (std::string_view(kind.name) != "keyframes" || options.Has("EPISODE")))
    return "--sheet paper is for keyframes, without a scenario: it has four of its own";
  for (const char* of_one : {"--from", "--to", "--hand", "--of", "--episode"})
    if (options.Has("--sheet") && options.Has(of_one))
      return fmt::format("{} does not go with --sheet paper", of_one);
  if (options.Has("--scenes") && options.Has("--at")) return "--scenes and --at exclude each other";
  return show::WhyNoDrawingFile(options.Text("--output"));
}

ExitCode RunFigure(const ParsedOptions& options, const CommandContext& context) {
  const Kind& kind = KindOf(options.Text("kind"));
  std::string problem = WhyNot(kind, options);
  if (problem.empty()) problem = WhyNotWritable(options.Text("--output"));
  if (!problem.empty()) return Refuse(context, problem);
  const std::string typed = options.TextOr("EPISODE", kind.scenario);
  if (std::string_view(kind.name) == "phases" && typed.ends_with(".txt"))
    return DrawDrawing(typed, options, context);
  if (std::string_view(kind.name) == "grasps") return DrawGrasps(typed, options, context);
  if (options.Has("--sheet")) return DrawPaperFrames(options, context);
  const bool is_pair = std::string_view(kind.name) == "plate" && !options.Has("EPISODE");
  if (is_pair) return DrawCharts(kind, {kTwist, typed}, options, context);
  if (kind.HasChart()) return DrawCharts(kind, {typed}, options, context);
  PREHEND_TRY(const auto played, PlayTyped(typed, options, context));
  problem = WhyNotShown(options, played.loaded.scenario, played.run);
  if (!problem.empty()) return Refuse(context, problem);
  return DrawKeyFrames(played, options, context);
}

}  // namespace

Command FigureCommand() {
  return {
      .name = "figure",
      .summary = "Draw a figure for a paper from a run: key frames, phases, grasps, gaze",
      .examples = {"figure keyframes -o keyframes.png",
                   "figure keyframes --sheet paper --width 180mm -o paper.pdf",
                   "figure phases slide/hop_divides_a_slide -o phases.pdf",
                   "figure phases milk_carton_wrap --against original_2020 -o two.pdf",
                   "figure plate --from 1 --to 4 -o plate.svg --look transparent",
                   "figure gaze suite.episodes --episode gaze/eyes_lead_the_hand -o gaze.png"},
      .options = Joined(
          {Required(Argument("kind", KindHelp(), OneOf(KindNames()))),
           Argument("EPISODE",
                    "a scenario, an episode file or a recording; for grasps a glob of scenarios; "
                    "for phases also drawings (.txt), with --grammar"),
           EpisodeOption(), Required(OutputOption("the file: .svg, .pdf or .png")),
           Value("--against", "golden|GRAMMAR|ENGINE",
                 "of phases: the same episode by another grammar, or the golden, beside it"),
           Value("--sheet", "paper",
                 "of keyframes: the ten cases of the paper's figure, from four scenarios",
                 OneOf({"paper"})),
           Value("--scenes", "N",
                 "how many scenes are above a chart, 0 to 10; default: phases 5, others 3",
                 IntegersFrom(0, kMostScenes)),
           Value("--at", "TIME,..",
                 "when these are: EVENT.begin, EVENT.end or seconds, with commas between them")},
          Joined(Joined(LookOptions(), PartOptions()),
                 {WidthOption(), GrammarOption(), SettingsOption()})),
      .run = RunFigure};
}

}  // namespace prehend::cli
