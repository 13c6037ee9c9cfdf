// SPDX-License-Identifier: Apache-2.0
// prehend tracks: conditions and signals over time, as CSV or JSON.
// Tested by tests/program/explain_command_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "grammar/contents.h"
#include "harness/base/atomic_file.h"
#include "harness/cli/command.h"
#include "harness/explain/replay.h"
#include "harness/explain/tracks.h"

namespace prehend::harness {
namespace {

void Declare(CLI::App& options) {
  options.add_option("scenario", "a name, skill/name or a file; or a recording")
      ->required()
      ->expected(1);
  options.add_option("-o,--output", "the file to write, .csv or .json; - or nothing: print CSV")
      ->type_name("FILE")
      ->expected(1);
  options
      .add_option("--only",
                  "an event, condition or signal (speed_along), may be given again; otherwise all")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  DeclareRunOptions(options);
  DeclareFlag(options, "--json", "print JSON instead of CSV");
}

/// "" or which of the names nobody knows.
std::string WhyNotKnown(const std::vector<std::string>& only, const grammar::Program& program) {
  const std::vector<std::string> known = explain::TrackNames(program);
  for (const std::string& name : only) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = grammar::NearestName(name, known);
    return fmt::format(
        "--only: found '{}', wanted an event, condition or signal of grammar '{}'; {}", name,
        GrammarName(program),
        near.empty() ? fmt::format("there are: {}", fmt::join(known, ", "))
                     : fmt::format("did you mean '{}'?", near));
  }
  return "";
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  std::string output = ValueOf(options, "--output");
  if (output == "-") output.clear();
  const bool as_json = IsGiven(options, "--json") || output.ends_with(".json");
  if (!output.empty() && !output.ends_with(".json") && !output.ends_with(".csv")) {
    return Complain(
        context, ExitCode::kBadInput,
        fmt::format("--output: found '{}', wanted a file that ends with .csv or .json", output));
  }
  if (IsGiven(options, "--json") && output.ends_with(".csv")) {
    return Complain(context, ExitCode::kBadInput,
                    "--json and a file that ends with .csv contradict each other");
  }
  const OpenedEpisode source = OpenEpisodeOrComplain(options, context);
  if (!source.value) return source.exit_code;
  const std::vector<std::string> only = ValuesOf(options, "--only");
  const std::string unknown = WhyNotKnown(only, *source.value->program);
  if (!unknown.empty()) return Complain(context, ExitCode::kBadInput, unknown);

  // What cannot be written is refused before the episode is played.
  std::optional<AtomicFile> file;
  if (!output.empty()) file.emplace(output);
  if (file && !file->problem().empty())
    return Complain(context, ExitCode::kBadInput, "--output: " + file->problem());

  const explain::Watched watched = explain::Watch(*source.value);
  if (!watched.problem.empty()) return Complain(context, ExitCode::kBadInput, watched.problem);
  const explain::Tracks tracks = explain::CollectTracks(*watched.past, {only.begin(), only.end()});
  if (!tracks.problem.empty()) return Complain(context, ExitCode::kBadInput, tracks.problem);
  std::ostream& out = file ? file->stream() : context.out;
  if (as_json) {
    explain::WriteJson(tracks, source.value->name, GrammarName(*source.value->program), out);
  } else {
    explain::WriteCsv(tracks, out);
  }
  if (file) {
    const std::string problem = file->Commit();
    if (!problem.empty()) return Complain(context, ExitCode::kFailure, "--output: " + problem);
    context.out << fmt::format("{}: {} tracks, {} frames\n", output, tracks.tracks.size(),
                               tracks.ticks.size());
  }
  return watched.failure.empty() ? ExitCode::kAgrees
                                 : Complain(context, ExitCode::kFailure, watched.failure);
}

}  // namespace

Command TracksCommand() {
  return {.name = "tracks",
          .summary = "Write conditions and signals over time, for plots",
          .examples =
              "prehend tracks milk_carton_wrap -o milk.csv\n"
              "prehend tracks milk_carton_wrap --only grasping --only speed_along\n"
              "prehend tracks milk.jsonl --grammar my/rules.grammar -o milk.json",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
