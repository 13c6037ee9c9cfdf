// SPDX-License-Identifier: Apache-2.0
// prehend resegment: recorded episodes under another grammar, without physics.
// Tested by tests/program/recording_test.cc and tests/program/episodes_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "grammar/contents.h"
#include "harness/base/atomic_file.h"
#include "harness/command/command.h"
#include "harness/episodes/resegment_many.h"
#include "harness/episodes/schema.h"
#include "harness/labels/read_labels.h"
#include "harness/labels/take.h"
#include "harness/labels/write_labels.h"
#include "harness/run/load_grammar.h"
#include "harness/run/run_text.h"
#include "harness/run/segment_recording.h"

namespace prehend::harness {
namespace {

ExitCode ResegmentLines(const std::string& file, const ParsedOptions& options,
                        const CommandContext& context) {
  const Result<SegmentedRecording> segmented =
      SegmentRecording(RequestOf(options, file), context.root);
  if (!segmented) return Complain(context, segmented.error());
  Warn(context, segmented->warnings);
  context.err << segmented->missing.warnings;
  RunResult run;
  run.status.kind = physics::RunStatus::Kind::kCompleted;
  run.ticks = segmented->end - 1;
  run.is_unfinished = !segmented->says_its_end;
  run.timeline = segmented->timeline;
  const ExitCode exit_code =
      segmented->missing.nothing_left ? ExitCode::kNothing : ExitCode::kAgrees;
  if (!options.Has("--json")) {
    context.out << RunTable(run);
    return exit_code;
  }
  Scenario watched;
  watched.name = segmented->name;
  watched.grammar = GrammarName(*segmented->program);
  OrderedJson json = RunJson(watched, run);
  json.erase("state_hash");  // nothing was simulated
  context.out << json.dump(2) << "\n";
  return exit_code;
}

/// Results of one episode as `run` prints them, of several one after another; with a comparison
/// only what differs.
void Print(const std::vector<episodes::Resegmented>& results, bool compare,
           const CommandContext& context) {
  std::size_t differing = 0;
  for (const episodes::Resegmented& result : results) {
    if (!result.problem.empty()) continue;
    const std::string heading = fmt::format("episode {} of {}: {}\n", result.episode.id,
                                            result.episode.file, result.episode.scenario);
    if (!compare) {
      if (results.size() > 1) context.out << (&result == &results.front() ? "" : "\n") << heading;
      context.out << result.table;
    } else if (!result.differences.empty()) {
      ++differing;
      context.out << heading << result.differences;
    }
  }
  if (compare)
    context.out << fmt::format("{} episode{}, {} with differences\n", results.size(),
                               results.size() == 1 ? "" : "s", differing);
}

void PrintJson(const std::vector<episodes::Resegmented>& results, const CommandContext& context) {
  OrderedJson all = OrderedJson::array();
  for (const episodes::Resegmented& result : results) {
    if (!result.problem.empty()) continue;
    OrderedJson json = OrderedJson::parse(result.json);
    json["file"] = result.episode.file;
    json["episode"] = result.episode.id;
    all.push_back(std::move(json));
  }
  if (results.size() == 1 && all.size() == 1) all = OrderedJson(all.front());
  context.out << all.dump(2) << "\n";
}

ExitCode ResegmentEpisodes(const ParsedOptions& options, const CommandContext& context) {
  const auto selected =
      episodes::SelectEpisodes(options.All("recording"), options.Text("--episode"));
  if (!selected) return Complain(context, selected.error());
  if (selected->empty())
    return Complain(context, ExitCode::kNothing,
                    fmt::format("--episode: no episode matches '{}'", options.Text("--episode")));
  const bool compare = options.Has("--compare");
  const std::vector<episodes::Resegmented> results = episodes::ResegmentAll(
      *selected, {.root = context.root,
                  .choice = {options.Text("--grammar"), options.All("--set")},
                  .compare = compare,
                  .jobs = options.IntOr("--jobs", CoreCount())});
  ExitCode worst = ExitCode::kAgrees;
  std::string warned;
  for (const episodes::Resegmented& result : results) {
    if (result.warnings != warned) context.err << result.warnings;
    warned = result.warnings;
    if (!result.problem.empty()) {
      context.err << result.problem;
      worst = ExitCode::kBadInput;
    } else if (!result.completed && worst == ExitCode::kAgrees) {
      context.err << fmt::format(
          "prehend: episode {} of {} has no good end: {}", result.episode.id, result.episode.file,
          result.table.substr(result.table.rfind('\n', result.table.size() - 2) + 1));
      worst = ExitCode::kFailure;
    }
  }
  if (options.Has("--json"))
    PrintJson(results, context);
  else
    Print(results, compare, context);
  const bool differs = std::ranges::any_of(
      results, [](const episodes::Resegmented& result) { return !result.differences.empty(); });
  return worst == ExitCode::kAgrees && differs ? ExitCode::kDiffers : worst;
}

std::string LabelsProblem(const std::string& file) {
  return labels::IsLabelFile(file) && !file.ends_with(".timeline")
             ? ""
             : "found '" + file + "', wanted a file .csv, .eaf or .TextGrid";
}

/// `--labels`: the events of one recording for an annotation program.
ExitCode WriteLabels(const ParsedOptions& options, const CommandContext& context) {
  const auto takes = labels::TakesOf(options.All("recording"), options.Text("--episode"));
  if (!takes) return Complain(context, takes.error());
  if (takes->size() != 1)
    return Complain(context, takes->empty() ? ExitCode::kNothing : ExitCode::kBadInput,
                    fmt::format("--labels writes one recording; {} are selected", takes->size()));
  Result<labels::Take> take = labels::OpenTake(takes->front(), context.root);
  if (!take) return Complain(context, take.error());
  std::shared_ptr<const grammar::Program> program = take->program;
  if (!program || options.Has("--grammar") || options.Has("--set")) {
    Result<grammar::Overrides> settings = ParameterSettings(options.All("--set"));
    if (!settings) return Complain(context, settings.error());
    const grammar::CompileResult compiled =
        LoadGrammar(context.root, options.TextOr("--grammar", take->grammar), *settings);
    if (!compiled.program) return Complain(context, compiled.diagnostics);
    program = compiled.program;
  }
  const std::vector<std::string> only = options.All("--events");
  const std::vector<std::string> known = EventNames(*program);
  for (const std::string& name : only) {
    if (std::ranges::count(known, name) > 0) continue;
    const std::string near = grammar::NearestName(name, known);
    return Complain(context, ExitCode::kBadInput,
                    fmt::format("--events: grammar '{}' has no event '{}'{}", GrammarName(*program),
                                name, near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  Result<grammar::Timeline> found = take->segment(program);
  if (!found) return Complain(context, found.error());
  std::erase_if(found->events, [&](const grammar::NamedEvent& event) {
    return !only.empty() && std::ranges::count(only, event.event) == 0;
  });
  const std::string& file = options.Text("--labels");
  const std::string problem = WriteTextFile(
      file, labels::LabelsText(file.substr(file.rfind('.')), *found, take->end, context.today));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << fmt::format("{}: {} labels\n", file, found->events.size());
  return ExitCode::kAgrees;
}

ExitCode RunResegment(const ParsedOptions& options, const CommandContext& context) {
  const std::vector<std::string>& files = options.All("recording");
  if (options.Has("--labels")) {
    for (const char* other : {"--compare", "--json", "--jobs"}) {
      if (options.Has(other))
        return Complain(context, ExitCode::kBadInput,
                        fmt::format("--labels writes a file of labels: {} does not apply", other));
    }
    return WriteLabels(options, context);
  }
  if (options.Has("--events"))
    return Complain(context, ExitCode::kBadInput,
                    "--events chooses what --labels FILE writes; --labels is missing");
  const auto lines = std::ranges::find_if_not(files, episodes::IsEpisodeFile);
  if (lines == files.end()) return ResegmentEpisodes(options, context);
  for (const char* of_episodes : {"--episode", "--compare", "--jobs"}) {
    if (options.Has(of_episodes))
      return Complain(context, ExitCode::kBadInput,
                      fmt::format("{} needs episode files; {} is none", of_episodes, *lines));
  }
  if (files.size() > 1)
    return Complain(context, ExitCode::kBadInput,
                    *lines + " is no episode file; other recordings are read one at a time");
  return ResegmentLines(files.front(), options, context);
}

std::string CompareProblem(const std::string& value) {
  return value == "recorded" ? "" : "found '" + value + "', wanted recorded";
}

}  // namespace

Command ResegmentCommand() {
  return {
      .name = "resegment",
      .summary = "Segment recorded episodes again, with any grammar",
      .examples = {"run milk_carton_wrap --record milk.episodes", "resegment milk.episodes",
                   "resegment milk.episodes --grammar my/rules.grammar --json",
                   "resegment milk.jsonl --set lift_rise=10cm",
                   "resegment monday.episodes tuesday.episodes --compare recorded",
                   "resegment suite.episodes --episode 'slide/*' --set slide_speed=3cm/s"},
      .options = {{.name = "recording",
                   .help = "episode files (docs/episodes.md), or one recording as JSON Lines\n"
                           "(docs/recording-format.md)",
                   .required = true,
                   .repeatable = true},
                  {.name = "--episode",
                   .help = "only this one of an episode file: its number, or its scenario\n"
                           "(a name, skill/name or a glob)",
                   .placeholder = "WHICH"},
                  {.name = "--compare",
                   .help = "print only how the events differ from those that were recognised when\n"
                           "the episode was recorded",
                   .placeholder = "recorded",
                   .rule = {.range = {}, .problem = CompareProblem}},
                  {.name = "--jobs",
                   .help = "episodes at a time; default: one per core",
                   .placeholder = "N",
                   .rule = IntegersFrom(1, kMaxJobs)},
                  GrammarOption(),
                  {.name = "--set",
                   .help = "set a parameter of the grammar (reach_radius=25cm); may be repeated",
                   .placeholder = "NAME=VALUE",
                   .repeatable = true},
                  {.name = "--labels",
                   .help = "write the events of one recording for an annotation program\n"
                           "(docs/labels.md): ELAN (.eaf), Praat (.TextGrid) or .csv",
                   .placeholder = "FILE",
                   .rule = {.range = {}, .problem = LabelsProblem},
                   .is_output = true},
                  {.name = "--events",
                   .help = "with --labels: write this event instead of all; may be repeated",
                   .placeholder = "NAME",
                   .repeatable = true},
                  {.name = "--json", .help = "print one JSON object instead of a table"}},
      .run = RunResegment};
}

}  // namespace prehend::harness
