// SPDX-License-Identifier: Apache-2.0
// prehend sweep and margins: a grammar's parameters on recorded episodes. Tested by
// tests/program/sweep_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>

#include "harness/base/atomic_file.h"
#include "harness/command/command.h"
#include "harness/command/typed_episode.h"
#include "harness/labels/label_files.h"
#include "harness/labels/read_labels.h"
#include "harness/pictures/svg_file.h"
#include "harness/sweep/margins.h"
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

constexpr double kDefaultMargin_percent = 1;

/// What both commands have in common. Nothing, after a complaint.
std::optional<sweep::SweepRequest> RequestFrom(const ParsedOptions& options,
                                               const std::vector<const char*>& outputs,
                                               const CommandContext& context) {
  sweep::SweepRequest request{.root = context.root,
                              .grammar = options.Text("--grammar"),
                              .settings = options.All("--set"),
                              .axes = {}};
  std::vector<std::string> truths = options.All("--truth");
  if (truths.empty()) truths = {"golden"};
  request.truth = truths.front() == "oracle"     ? sweep::Truth::kOracle
                  : truths.front() == "recorded" ? sweep::Truth::kRecorded
                  : truths.front() == "golden"   ? sweep::Truth::kGolden
                                                 : sweep::Truth::kLabels;
  std::error_code error;
  for (const std::string& truth : truths) {
    const bool is_word = truth == "golden" || truth == "oracle" || truth == "recorded";
    const bool is_known =
        is_word ? truths.size() == 1
                : labels::IsLabelFile(truth) || std::filesystem::is_directory(truth, error);
    if (is_known) continue;
    Complain(context, ExitCode::kBadInput,
             fmt::format("--truth: found '{}', wanted golden, oracle or recorded, or files of "
                         "labels or a folder of them",
                         truth));
    return std::nullopt;
  }
  if (request.truth == sweep::Truth::kLabels) request.label_files = truths;
  request.label_map = options.Text("--map");
  for (const char* of_labels : {"--map", "--skip-bad-labels"}) {
    if (request.truth == sweep::Truth::kLabels || !options.Has(of_labels)) continue;
    Complain(context, ExitCode::kBadInput,
             fmt::format("{} needs labels: --truth FILE or FOLDER", of_labels));
    return std::nullopt;
  }
  request.collar_s = options.NumberOr("--collar-ms", kDefaultSweepCollar_ms) / 1000;
  // People agree to a few tenths of a second; goldens are exact.
  request.by_overlap = request.truth == sweep::Truth::kLabels && !options.Has("--collar-ms");
  request.skip_bad_labels = options.Has("--skip-bad-labels");
  request.jobs = options.IntOr("--jobs", CoreCount());
  for (const char* output : outputs) {
    const std::string why = options.Has(output) ? WhyNotWritable(options.Text(output)) : "";
    if (why.empty()) continue;
    Complain(context, ExitCode::kBadInput, std::string(output) + ": " + why);
    return std::nullopt;
  }
  return request;
}

/// The recordings, or the exit code after a complaint. Where no grammar was named, `request` gets
/// theirs.
tl::expected<std::vector<EpisodeName>, ExitCode> EpisodesFrom(const ParsedOptions& options,
                                                              sweep::SweepRequest& request,
                                                              const CommandContext& context) {
  auto episodes = FindEpisodesOrComplain("files", options, context);
  if (!episodes) return episodes;
  if (request.grammar.empty()) {
    Result<std::string> own = labels::OwnGrammar(*episodes);
    if (!own) return tl::unexpected(Complain(context, own.error()));
    request.grammar = std::move(*own);
  }
  return *episodes;
}

/// Labels do not fit, or something cannot be read.
bool IsRefused(const sweep::SweepResult& result, const sweep::SweepRequest& request) {
  return !result.unread.empty() ||
         (request.truth == sweep::Truth::kLabels && !result.left_out.empty());
}

/// Nothing if there is something to print. Labels that do not fit are bad input; of other truths
/// what has none is left out.
std::optional<ExitCode> ComplainOf(const sweep::SweepResult& result,
                                   const sweep::SweepRequest& request,
                                   const CommandContext& context) {
  if (IsRefused(result, request))
    return Complain(context, ExitCode::kBadInput,
                    (result.unread.empty() ? result.left_out : result.unread).front());
  context.err << result.label_warning;
  for (const std::string& line : result.left_out)
    context.err << "prehend: left out: " << line << "\n";
  if (result.episodes == 0)
    return Complain(context, ExitCode::kNothing, "no episode has events to compare with");
  return std::nullopt;
}

/// "40 seconds", "12 minutes", "3.5 hours"
std::string TimeText(double seconds) {
  constexpr double kMinute_s = 60, kHour_s = 3600;
  if (seconds < 1.5 * kMinute_s) return fmt::format("{:.0f} seconds", std::ceil(seconds));
  if (seconds < 1.5 * kHour_s) return fmt::format("{:.0f} minutes", seconds / kMinute_s);
  return fmt::format("{:.1f} hours", seconds / kHour_s);
}

/// Says once, after the first settings, how long all will take, unless that is soon; to a person
/// also how far it is.
class Progress {
 public:
  Progress(std::size_t episodes, const CommandContext& context)
      : episodes_(episodes), context_(context) {}
  ~Progress() {
    if (said_ && context_.progress) context_.err << "\r\033[K" << std::flush;
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Tell(std::size_t done, std::size_t all) {
    constexpr double kSoon_s = 2, kMeasured_s = 1;
    const Clock::time_point now = Clock::now();
    if (done > 0 && !first_) first_ = {now, done};
    if (!first_ || done == first_->done) return;
    // The first ones came with what happens once: grammars are compiled, recordings read.
    const double measured_s = Seconds(now - first_->at);
    const double more_s =
        measured_s * static_cast<double>(all - done) / static_cast<double>(done - first_->done);
    const double passed_s = Seconds(now - start_);
    if (!said_ && (measured_s < kMeasured_s || passed_s + more_s < kSoon_s)) return;
    if (!said_) {
      const std::size_t settings = all / episodes_;
      context_.err << fmt::format("prehend: {} setting{} on {} recording{}, about {}\n", settings,
                                  settings == 1 ? "" : "s", episodes_, episodes_ == 1 ? "" : "s",
                                  TimeText(passed_s + more_s))
                   << std::flush;
    }
    said_ = true;
    if (context_.progress)
      context_.err << fmt::format("\r\033[K{} %, about {} more", 100 * done / all, TimeText(more_s))
                   << std::flush;
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Counted {
    Clock::time_point at;
    std::size_t done = 0;
  };
  static double Seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  }

  const std::size_t episodes_;
  const CommandContext& context_;
  const Clock::time_point start_ = Clock::now();
  std::optional<Counted> first_;
  bool said_ = false;
};

template <typename Measure>
auto WithProgress(sweep::SweepRequest& request, std::size_t episodes, const CommandContext& context,
                  const Measure& measure) {
  Progress progress(episodes, context);
  request.progress = [&](std::size_t done, std::size_t all) { progress.Tell(done, all); };
  return measure();
}

ExitCode RunMargins(const ParsedOptions& options, const CommandContext& context) {
  auto request = RequestFrom(options, {"--output"}, context);
  if (!request) return ExitCode::kBadInput;
  const auto episodes = EpisodesFrom(options, *request, context);
  if (!episodes) return episodes.error();
  const double within = options.NumberOr("--within", kDefaultMargin_percent) / 100;
  std::string problem;
  // After each parameter, so that it is there if somebody ends it.
  const auto write = [&](const sweep::Margins& margins) {
    if (options.Has("--output") && !IsRefused(margins.sweep, *request))
      problem = WriteTextFile(options.Text("--output"), MarginsCsv(margins));
  };
  const auto margins = WithProgress(*request, episodes->size(), context, [&] {
    return sweep::FindMargins(*episodes, *request, within, options.All("--only"), write);
  });
  if (!margins) return Complain(context, margins.error());
  if (const auto refused = ComplainOf(margins->sweep, *request, context)) return *refused;
  context.out << MarginsText(*margins, within);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

ExitCode RunSweep(const ParsedOptions& options, const CommandContext& context) {
  auto request = RequestFrom(options, {"--output", "--picture"}, context);
  if (!request) return ExitCode::kBadInput;
  std::size_t settings = 1;
  for (const std::string& text : options.All("--over")) {
    std::string problem;
    request->axes.push_back(*sweep::ParseAxis(text, problem));
    settings *= request->axes.back().values.size();
    for (std::size_t i = 0; i + 1 < request->axes.size(); ++i) {
      if (request->axes[i].parameter == request->axes.back().parameter)
        return Complain(context, ExitCode::kBadInput,
                        "--over: " + request->axes[i].parameter + " is given twice");
    }
    if (settings > sweep::kMostSettings)
      return Complain(context, ExitCode::kBadInput,
                      fmt::format("--over: more than {} settings", sweep::kMostSettings));
  }
  if (request->axes.empty())
    return Complain(context, ExitCode::kBadInput,
                    "--over is missing: which parameter? --over reach_radius=10cm..50cm:9");
  const auto episodes = EpisodesFrom(options, *request, context);
  if (!episodes) return episodes.error();
  const auto result = WithProgress(*request, episodes->size(), context,
                                   [&] { return sweep::Sweep(*episodes, *request); });
  if (!result) return Complain(context, result.error());
  if (const auto problem = ComplainOf(*result, *request, context)) return *problem;

  const double within = options.NumberOr("--within", kDefaultWithin_percent) / 100;
  const std::string csv = sweep::CsvText(request->axes, result->points);
  std::string problem;
  if (options.Has("--output")) problem = WriteTextFile(options.Text("--output"), csv);
  if (problem.empty() && options.Has("--picture"))
    problem =
        WriteDrawing(options.Text("--picture"),
                     sweep::HeatMapSvg(request->axes, result->points,
                                       sweep::FindPlateau(request->axes, result->points, within)));
  if (!options.Has("--output")) context.out << csv;
  context.out << sweep::PlateauText(request->axes, *result, within);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

Option TruthOption() {
  return {.name = "--truth",
          .help =
              "what the events are compared with: golden (default), oracle, recorded (the\n"
              "events of the recording), or labels by people: one file for each recording\n"
              "(.csv, .eaf, .TextGrid, .timeline) or a folder (docs/labels.md)",
          .placeholder = "golden|oracle|recorded|FILE|FOLDER",
          .repeatable = true};
}
Option MapOption() {
  return {.name = "--map", .help = "what labels mean: a YAML file", .placeholder = "FILE"};
}
Option SkipOption() {
  return {.name = "--skip-bad-labels",
          .help = "leave out labels that end before they begin, and count them"};
}
Option CollarOption() {
  return {.name = "--collar-ms",
          .help =
              "an event is right if both boundaries are so near; default: 50, and with labels\n"
              "by people what has half of the union with its label in common (F1@50)",
          .placeholder = "MS",
          .rule = NumbersFrom(0, 1e6)};
}
Option JobsOption() {
  return {.name = "--jobs",
          .help = "episodes at a time; default: one per core",
          .placeholder = "N",
          .rule = IntegersFrom(1, kMaxJobs)};
}

}  // namespace

Command MarginsCommand() {
  return {.name = "margins",
          .summary = "How far each parameter of a grammar may be from its value",
          .examples = {"margins suite.episodes --truth oracle --grammar my/rules.grammar",
                       "margins take1.jsonl take2.jsonl --truth labels --map labels.yaml --grammar "
                       "pick_and_place_from_motion -o margins.csv"},
          .options = {{.name = "files",
                       .help = "episode files, or with labels also recordings as JSON Lines",
                       .required = true,
                       .repeatable = true},
                      GrammarOption(),
                      {.name = "--set",
                       .help = "set a parameter of the grammar; may be repeated",
                       .placeholder = "NAME=VALUE",
                       .repeatable = true},
                      {.name = "--only",
                       .help = "this parameter instead of all; may be repeated",
                       .placeholder = "NAME",
                       .repeatable = true},
                      TruthOption(),
                      MapOption(),
                      SkipOption(),
                      CollarOption(),
                      {.name = "--within",
                       .help = "how many percent of F1 a score may be below the best; default: 1",
                       .placeholder = "PERCENT",
                       .rule = NumbersFrom(0, 100)},
                      EpisodeOption(),
                      {.name = "--output",
                       .help = "also write a CSV file, again after each parameter",
                       .placeholder = "FILE",
                       .other_name = "-o",
                       .is_output = true},
                      JobsOption()},
          .run = RunMargins};
}

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
                  TruthOption(),
                  MapOption(),
                  SkipOption(),
                  CollarOption(),
                  {.name = "--within",
                   .help = "the plateau: settings whose F1 is within so many percent of the "
                           "best;\ndefault: 0.5",
                   .placeholder = "PERCENT",
                   .rule = NumbersFrom(0, 100)},
                  EpisodeOption(),
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
                  JobsOption()},
      .run = RunSweep};
}

}  // namespace prehend::harness
