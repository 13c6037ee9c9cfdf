// SPDX-License-Identifier: Apache-2.0
// prehend grammar sweep and margins: a grammar's parameters on recorded episodes. Tested by
// tests/program/sweep_test.cc
#include <fmt/format.h>

#include <optional>

#include "harness/base/base/atomic_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/measure/sweep/sweep.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::cli {
namespace {

constexpr double kDefaultWithin_percent = 0.5;

std::string AxisProblem(const std::string& text) {
  std::string problem;
  (void)measure::ParseAxis(text, problem);
  return problem;
}

constexpr double kDefaultMargin_percent = 1;

/// What both commands have in common. Nothing, after a complaint.
std::optional<measure::SweepRequest> RequestFrom(const ParsedOptions& options,
                                                 const CommandContext& context) {
  measure::SweepRequest request{
      .root = context.root, .grammar = options.Text("--grammar"), .settings = options.All("--set")};
  if (const std::string why = measure::SetTruth(options.All("--truth"), request); !why.empty()) {
    Refuse(context, why);
    return std::nullopt;
  }
  request.label_map = options.Text("--map");
  request.collar_s = options.NumberOr("--collar-ms", kDefaultCollar_ms) / 1000;
  // People agree to a few tenths of a second; goldens are exact.
  request.by_overlap = request.truth == measure::Truth::kLabels && !options.Has("--collar-ms");
  request.skip_bad_labels = options.Has("--skip-bad-labels");
  request.jobs = options.IntOr("--jobs", CoreCount());
  return request;
}

/// The takes to be tried, or the exit code after a complaint: without those of the set `test`, and
/// all of the same grammar where none was named. If they have labels, these are the truth.
tl::expected<std::vector<episode::Take>, ExitCode> TakesFrom(const ParsedOptions& options,
                                                             measure::SweepRequest& request,
                                                             const CommandContext& context) {
  auto takes = FindTakesOrComplain("EPISODES", options, context);
  if (!takes) return takes;
  for (const std::string& output : options.All("--output")) {
    const std::string why = WhyNotWritable(output);
    if (!why.empty()) return tl::unexpected(Refuse(context, "--output: " + why));
  }
  const auto of_test = std::erase_if(*takes, [](const auto& take) { return take.set == "test"; });
  if (takes->empty())
    return tl::unexpected(
        Refuse(context, "all takes are of the set 'test', which nothing is tuned on"));
  if (of_test > 0)
    context.err << fmt::format("prehend: left out: {} take{} of the set test\n", of_test,
                               of_test == 1 ? "" : "s");
  if (!options.Has("--truth") && !takes->front().labels.empty()) {
    request.truth = measure::Truth::kLabels;
    request.by_overlap = !options.Has("--collar-ms");
  }
  for (const char* of_labels : {"--map", "--skip-bad-labels"}) {
    if (request.truth == measure::Truth::kLabels || !options.Has(of_labels)) continue;
    return tl::unexpected(
        Refuse(context, fmt::format("{} needs labels: --truth FILE or FOLDER", of_labels)));
  }
  if (request.grammar.empty()) {
    const auto why = episode::WhyNotOneGrammar(EpisodesOf(*takes), context.root);
    if (!why.empty()) return tl::unexpected(Complain(context, why));
  }
  return takes;
}

/// Nothing if there is something to print. Labels that do not fit are bad input; of other truths
/// what has none is left out.
std::optional<ExitCode> ComplainOf(const measure::SweepResult& result,
                                   const measure::SweepRequest& request,
                                   const CommandContext& context) {
  if (result.IsRefused(request))
    return Refuse(context, (result.unread.empty() ? result.left_out : result.unread).front());
  context.err << result.label_warning;
  for (const std::string& line : result.left_out)
    context.err << "prehend: left out: " << line << "\n";
  if (result.episodes == 0) return Refuse(context, "no episode has events to compare with");
  return std::nullopt;
}

template <typename Measure>
auto WithProgress(measure::SweepRequest& request, std::size_t episodes,
                  const CommandContext& context, const Measure& measure) {
  measure::SweepProgress progress(episodes, context.progress, context.err);
  request.progress = [&](std::size_t done, std::size_t all) { progress.Tell(done, all); };
  return measure();
}

ExitCode RunMargins(const ParsedOptions& options, const CommandContext& context) {
  auto request = RequestFrom(options, context);
  if (!request) return ExitCode::kBadInput;
  PREHEND_TRY(const auto takes, TakesFrom(options, *request, context));
  const std::string output = options.Text("--output");
  if (show::WhyNoDrawingFile(output).empty())
    return Refuse(context, fmt::format("--output: found '{}', wanted a file of CSV", output));
  const double within = options.NumberOr("--within", kDefaultMargin_percent) / 100;
  std::string problem;
  // After each parameter, so that it is there if somebody ends it.
  const auto write = [&](const measure::Margins& margins) {
    if (options.Has("--output") && !margins.sweep.IsRefused(*request))
      problem = WriteTextFile(output, MarginsCsv(margins));
  };
  const auto margins = WithProgress(*request, takes.size(), context, [&] {
    return measure::FindMargins(takes, *request, within, options.All("--over"), write);
  });
  if (!margins) return Complain(context, margins.error());
  if (const auto refused = ComplainOf(margins->sweep, *request, context)) return *refused;
  context.out << measure::MarginsText(*margins, within);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

ExitCode RunSweep(const ParsedOptions& options, const CommandContext& context) {
  auto request = RequestFrom(options, context);
  if (!request) return ExitCode::kBadInput;
  if (const std::string why = measure::SetAxes(options.All("--over"), *request); !why.empty())
    return Refuse(context, why);
  PREHEND_TRY(const auto takes, TakesFrom(options, *request, context));
  const auto result = WithProgress(*request, takes.size(), context,
                                   [&] { return measure::Sweep(takes, *request); });
  if (!result) return Complain(context, result.error());
  if (const auto problem = ComplainOf(*result, *request, context)) return *problem;

  const double within = options.NumberOr("--within", kDefaultWithin_percent) / 100;
  const std::string csv = measure::CsvText(request->axes, result->points);
  std::string problem;
  bool is_printed = true;
  for (const std::string& file : options.All("--output")) {
    const bool is_map = show::WhyNoDrawingFile(file).empty();
    is_printed = is_printed && is_map;
    if (!problem.empty()) continue;
    problem = is_map ? show::WriteDrawing(
                           file, measure::HeatMapSvg(request->axes, result->points,
                                                     measure::FindRobustSettings(
                                                         request->axes, result->points, within)))
                     : WriteTextFile(file, csv);
  }
  if (is_printed) context.out << csv;
  context.out << measure::RobustSettingsText(request->axes, *result, within);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

/// What both commands take, and what is theirs alone.
std::vector<Option> SweepOptions(const std::vector<Option>& own) {
  std::vector<Option> options = {EpisodesArgument(), GrammarOption(), ParametersOption(),
                                 EpisodesOption(), JobsOption()};
  options = Joined(
      options,
      TruthOptions("what the events are compared with: golden (default), oracle, recorded (the "
                   "events of the recording), or labels by people: one file for each recording "
                   "(.csv, .eaf, .TextGrid, .timeline) or a folder (docs/labels.md)",
                   "golden|oracle|recorded|FILE|FOLDER"));
  return Joined(options, own);
}

Option WithinOption(const std::string& help) {
  return Value("--within", "PERCENT", help, NumbersFrom(0, 100));
}

}  // namespace

Command MarginsCommand() {
  return {
      .name = "grammar margins",
      .summary = "How far each parameter of a grammar may be from its value",
      .examples = {"grammar margins suite.episodes --truth oracle --grammar my/rules.grammar",
                   "grammar margins take1.jsonl take2.jsonl --truth labels --map labels.yaml -o "
                   "margins.csv"},
      .options = SweepOptions(
          {Repeatable(
               Value("--over", "NAME", "try this parameter instead of all; may be repeated")),
           WithinOption("how many percent of F1 a score may be below the best; default: 1"),
           OutputOption(
               "also write a CSV file, again after each parameter (of scenarios, after sixteen)")}),
      .run = RunMargins};
}

Command SweepCommand() {
  Option output = OutputOption(
      "the CSV file; default: print it. NAME.svg, NAME.png or NAME.pdf: a heat map of one or two "
      "parameters; may be repeated");
  output.repeatable = true;
  return {
      .name = "grammar sweep",
      .summary = "Try a grammar's parameters on recorded episodes",
      .examples =
          {"grammar sweep all.episodes --grammar pick_and_place --over reach_radius=10cm..50cm:9",
           "grammar sweep all.episodes --grammar pick_and_place --over lift_rise=2cm..8cm:7 -o "
           "a.png",
           "grammar sweep *.episodes --over reach_radius=10cm..50cm:9 --over lift_rise=2cm..8cm:7"},
      .options = SweepOptions(
          {Repeatable(Value(
               "--over", "NAME=FROM..TO:COUNT",
               "try so many values of this parameter, evenly spaced; repeated: all combinations",
               {.range = {}, .problem = AxisProblem})),
           WithinOption(
               "the robust settings: their F1 is within so many percent of the best; default: 0.5"),
           std::move(output)}),
      .run = RunSweep};
}

}  // namespace prehend::cli
