// SPDX-License-Identifier: Apache-2.0
// prehend sweep: a grammar's parameters on recorded episodes. Tested by
// tests/program/sweep_test.cc
#include <fmt/format.h>

#include "harness/base/atomic_file.h"
#include "harness/base/default_grammar.h"
#include "harness/command/command.h"
#include "harness/pictures/svg_file.h"
#include "harness/sweep/plateau.h"
#include "harness/sweep/sweep.h"

namespace prehend::harness {
namespace {

constexpr double kDefaultWithin_percent = 0.5;
constexpr double kDefaultSweepCollar_ms = 50;

std::string AxisProblem(const std::string& text) {
  std::string problem;
  (void)sweep::ParseAxis(text, problem);
  return problem;
}

std::string TruthProblem(const std::string& text) {
  return text == "golden" || text == "oracle" || text == "recorded"
             ? ""
             : "found '" + text + "', wanted golden, oracle or recorded";
}

ExitCode RunSweep(const ParsedOptions& options, const CommandContext& context) {
  sweep::SweepRequest request{.root = context.root,
                              .grammar = options.TextOr("--grammar", kDefaultGrammar),
                              .settings = options.All("--set"),
                              .axes = {}};
  std::size_t settings = 1;
  for (const std::string& text : options.All("--over")) {
    std::string problem;
    request.axes.push_back(*sweep::ParseAxis(text, problem));
    settings *= request.axes.back().values.size();
    for (std::size_t i = 0; i + 1 < request.axes.size(); ++i) {
      if (request.axes[i].parameter == request.axes.back().parameter)
        return Complain(context, ExitCode::kBadInput,
                        "--over: " + request.axes[i].parameter + " is given twice");
    }
    if (settings > sweep::kMostSettings)
      return Complain(context, ExitCode::kBadInput,
                      fmt::format("--over: more than {} settings", sweep::kMostSettings));
  }
  if (request.axes.empty())
    return Complain(context, ExitCode::kBadInput,
                    "--over is missing: which parameter? --over reach_radius=10cm..50cm:9");
  const std::string truth = options.TextOr("--truth", "golden");
  request.truth = truth == "oracle"     ? sweep::Truth::kOracle
                  : truth == "recorded" ? sweep::Truth::kRecorded
                                        : sweep::Truth::kGolden;
  request.collar_s = options.NumberOr("--collar-ms", kDefaultSweepCollar_ms) / 1000;
  request.jobs = options.IntOr("--jobs", CoreCount());
  for (const char* output : {"--output", "--picture"}) {
    const std::string why = options.Has(output) ? WhyNotWritable(options.Text(output)) : "";
    if (!why.empty())
      return Complain(context, ExitCode::kBadInput, std::string(output) + ": " + why);
  }
  const auto episodes = episodes::SelectEpisodes(options.All("files"), options.Text("--episode"));
  if (!episodes) return Complain(context, episodes.error());
  if (episodes->empty())
    return Complain(context, ExitCode::kNothing,
                    fmt::format("--episode: no episode matches '{}'", options.Text("--episode")));
  const Result<sweep::SweepResult> result = sweep::Sweep(*episodes, request);
  if (!result) return Complain(context, result.error());
  for (const std::string& line : result->left_out)
    context.err << "prehend: left out: " << line << "\n";
  if (result->episodes == 0)
    return Complain(context, ExitCode::kNothing, "no episode has events to compare with");

  const double within = options.NumberOr("--within", kDefaultWithin_percent) / 100;
  const std::string csv = sweep::CsvText(request.axes, result->points);
  std::string problem;
  if (options.Has("--output")) problem = WriteTextFile(options.Text("--output"), csv);
  if (problem.empty() && options.Has("--picture"))
    problem =
        WriteDrawing(options.Text("--picture"),
                     sweep::HeatMapSvg(request.axes, result->points,
                                       sweep::FindPlateau(request.axes, result->points, within)));
  if (!options.Has("--output")) context.out << csv;
  context.out << sweep::PlateauText(request.axes, *result, within);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace

Command SweepCommand() {
  return {
      .name = "sweep",
      .summary = "Try a grammar's parameters on recorded episodes",
      .examples = {"sweep suite.episodes --over reach_radius=10cm..50cm:9 -o sweep.csv",
                   "sweep suite.episodes --over reach_radius=10cm..50cm:9 --over "
                   "lift_rise=2cm..8cm:7 --truth oracle --picture sweep.png",
                   "sweep *.episodes --grammar my/rules.grammar --over still_for=50ms..200ms:4 "
                   "--truth recorded"},
      .options = {{.name = "files",
                   .help = "files from 'run --record' or 'check --record' (docs/episodes.md)",
                   .required = true,
                   .repeatable = true},
                  {.name = "--over",
                   .help = "try so many values of this parameter, evenly spaced; repeated: all\n"
                           "combinations",
                   .placeholder = "NAME=FROM..TO:COUNT",
                   .rule = {.range = {}, .problem = AxisProblem},
                   .repeatable = true},
                  GrammarOption(),
                  {.name = "--set",
                   .help = "set another parameter of the grammar; may be repeated",
                   .placeholder = "NAME=VALUE",
                   .repeatable = true},
                  {.name = "--truth",
                   .help = "what the events are compared with: golden (default), oracle, or\n"
                           "recorded, the events of the recording",
                   .placeholder = "golden|oracle|recorded",
                   .rule = {.range = {}, .problem = TruthProblem}},
                  {.name = "--collar-ms",
                   .help = "an event is right if both boundaries are so near; default: 50",
                   .placeholder = "MS",
                   .rule = NumbersFrom(0, 1e6)},
                  {.name = "--within",
                   .help = "the plateau: settings whose F1 is within so many percent of the "
                           "best;\ndefault: 0.5",
                   .placeholder = "PERCENT",
                   .rule = NumbersFrom(0, 100)},
                  {.name = "--episode",
                   .help = "only these episodes: a number, or a scenario (a name, skill/name "
                           "or a glob)",
                   .placeholder = "WHICH"},
                  {.name = "--output",
                   .help = "the CSV file; default: print it",
                   .placeholder = "FILE",
                   .other_name = "-o",
                   .is_output = true},
                  {.name = "--picture",
                   .help = "a heat map of one or two parameters: NAME.svg, NAME.png or NAME.pdf",
                   .placeholder = "FILE",
                   .rule = {.range = {}, .problem = WhyNoDrawingFile},
                   .is_output = true},
                  {.name = "--jobs",
                   .help = "episodes at a time; default: one per core",
                   .placeholder = "N",
                   .rule = IntegersFrom(1, kMaxJobs)}},
      .run = RunSweep};
}

}  // namespace prehend::harness
