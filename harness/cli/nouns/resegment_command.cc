// SPDX-License-Identifier: Apache-2.0
// prehend episode resegment: recorded episodes under another grammar, without physics.
// Tested by tests/program/recording_test.cc and tests/program/episodes_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/resegment_many.h"
#include "harness/episode/run/run_text.h"
#include "harness/exchange/labels/read_truths.h"

namespace prehend::cli {
namespace {

/// "episode 3 of x.episodes"; of what is in no such file its name.
std::string PlaceOf(const episode::EpisodeName& episode) {
  return episode.number ? fmt::format("episode {} of {}", *episode.number, episode.file)
                        : episode.scenario;
}

std::string HeadingOf(const episode::EpisodeName& episode) {
  return PlaceOf(episode) + (episode.number ? ": " + episode.scenario : "") + "\n";
}

/// Results of one episode as `run` prints them, of several one after another; with a comparison
/// only what differs.
void Print(const std::vector<episode::Resegmented>& results, bool compare,
           const CommandContext& context) {
  std::size_t differing = 0;
  for (const episode::Resegmented& result : results) {
    if (!result.problem.empty()) continue;
    const std::string heading = HeadingOf(result.episode);
    if (!compare) {
      if (results.size() > 1) context.out << (&result == &results.front() ? "" : "\n") << heading;
      context.out << episode::RunTable(result.run);
    } else if (!result.differences.empty()) {
      ++differing;
      context.out << heading << result.differences;
    }
  }
  if (compare)
    context.out << fmt::format("{} episode{}, {} with differences\n", results.size(),
                               results.size() == 1 ? "" : "s", differing);
}

void PrintJson(const std::vector<episode::Resegmented>& results, const CommandContext& context) {
  episode::OrderedJson all = episode::OrderedJson::array();
  for (const episode::Resegmented& result : results) {
    if (!result.problem.empty()) continue;
    episode::OrderedJson json = episode::RunJson(result.heading, result.run);
    if (result.episode.number) {
      json["file"] = result.episode.file;
      json["episode"] = *result.episode.number;
    } else if (result.episode.origin == episode::Origin::kRecording) {
      json.erase("state_hash");  // nothing was simulated
    }
    all.push_back(std::move(json));
  }
  if (results.size() == 1 && all.size() == 1) all = episode::OrderedJson(all.front());
  context.out << all.dump(2) << "\n";
}

ExitCode ResegmentEpisodes(const std::vector<episode::EpisodeName>& selected,
                           const ParsedOptions& options, const CommandContext& context) {
  const bool compare = options.Has("--against");
  const std::vector<episode::Resegmented> results =
      episode::ResegmentAll(selected, {.root = context.root,
                                       .choice = {options.Text("--grammar"), options.All("--set")},
                                       .compare = compare,
                                       .jobs = options.IntOr("--jobs", CoreCount())});
  ExitCode worst = ExitCode::kAgrees;
  std::string warned;
  for (const episode::Resegmented& result : results) {
    if (result.warnings != warned) context.err << result.warnings;
    warned = result.warnings;
    if (!result.problem.empty()) {
      context.err << result.problem;
      worst = ExitCode::kBadInput;
    } else if (result.run.status.kind != physics::RunStatus::Kind::kCompleted &&
               worst == ExitCode::kAgrees) {
      context.err << fmt::format("prehend: {} has no good end: {}\n", PlaceOf(result.episode),
                                 episode::StatusText(result.run));
      worst = ExitCode::kFailure;
    }
  }
  if (options.Has("--json"))
    PrintJson(results, context);
  else
    Print(results, compare, context);
  const bool differs = std::ranges::any_of(
      results, [](const episode::Resegmented& result) { return !result.differences.empty(); });
  if (worst == ExitCode::kAgrees &&
      std::ranges::any_of(results, &episode::Resegmented::nothing_left))
    return ExitCode::kNothing;
  return worst == ExitCode::kAgrees && differs ? ExitCode::kDiffers : worst;
}

std::string LabelsProblem(const std::string& file) {
  return exchange::CanWriteLabels(file)
             ? ""
             : "found '" + file + "', wanted a file .csv, .eaf or .TextGrid";
}

/// `-o`: the events of one recording for an annotation program.
ExitCode WriteLabels(const std::vector<episode::EpisodeName>& selected,
                     const ParsedOptions& options, const CommandContext& context) {
  if (selected.size() != 1)
    return Refuse(context, fmt::format("--output writes labels of one recording; {} are selected",
                                       selected.size()));
  Result<episode::Episode> episode = episode::OpenEpisode(
      selected.front(), {options.Text("--grammar"), options.All("--set")}, context.root);
  if (!episode) return Complain(context, episode.error());
  const std::string& file = options.Text("--output");
  const auto labels = exchange::WriteLabels(*episode, options.All("--event"), file, context.today);
  if (!labels) return Complain(context, labels.error());
  context.out << fmt::format("{}: {} labels\n", file, *labels);
  return ExitCode::kAgrees;
}

ExitCode RunResegment(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--output")) {
    for (const char* other : {"--against", "--json", "--jobs"}) {
      if (options.Has(other))
        return Refuse(context,
                      fmt::format("--output writes a file of labels: {} does not apply", other));
    }
  }
  if (options.Has("--event") && !options.Has("--output"))
    return Refuse(context, "--event chooses what --output FILE writes; --output is missing");
  const std::vector<episode::Need> needs =
      options.Has("--against") ? std::vector<episode::Need>{episode::Need::kRecordedEvents}
                               : std::vector<episode::Need>{};
  PREHEND_TRY(const auto selected, FindEpisodesOrComplain("EPISODES", options, context, needs));
  return options.Has("--output") ? WriteLabels(selected, options, context)
                                 : ResegmentEpisodes(selected, options, context);
}

}  // namespace

Command ResegmentCommand() {
  return {
      .name = "episode resegment",
      .summary = "Segment recorded episodes again, with any grammar",
      .examples = {"run milk_carton_wrap --record milk.episodes", "episode resegment milk.episodes",
                   "episode resegment milk.episodes --grammar my/rules.grammar --json",
                   "episode resegment milk.jsonl --set lift_rise=10cm",
                   "episode resegment monday.episodes tuesday.episodes --against recorded",
                   "episode resegment suite.episodes --episode 'slide/*' --set slide_speed=3cm/s"},
      .options = {EpisodesArgument(),
                  EpisodesOption(),
                  Value("--against", "recorded",
                        "print only how the events differ from those that were recognised when "
                        "the episode was recorded",
                        OneOf({"recorded"})),
                  JobsOption(),
                  GrammarOption(),
                  ParametersOption(),
                  {.name = "--output",
                   .help = "write the events of one recording for an annotation program "
                           "(docs/labels.md): ELAN (.eaf), Praat (.TextGrid) or .csv",
                   .placeholder = "FILE",
                   .other_name = "-o",
                   .rule = {.range = {}, .problem = LabelsProblem},
                   .is_output = true},
                  Repeatable(
                      Value("--event", "NAME",
                            "with --output: write this event instead of all; may be repeated")),
                  JsonOption()},
      .run = RunResegment};
}

}  // namespace prehend::cli
