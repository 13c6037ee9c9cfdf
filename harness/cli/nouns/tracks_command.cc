// SPDX-License-Identifier: Apache-2.0
// prehend grammar tracks: conditions and signals over time, as CSV or JSON.
// Tested by tests/program/explain_command_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/cli/command/command.h"
#include "harness/show/explain/query.h"
#include "harness/show/tracks/tracks.h"

namespace prehend::cli {
namespace {

/// Which of the names the grammar does not know; "" when it knows all.
std::string UnknownTrack(const std::vector<std::string>& only, const grammar::Program& program) {
  const std::vector<std::string> known = show::TrackNames(program);
  for (const std::string& name : only) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = grammar::NearestName(name, known);
    return fmt::format(
        "--only: found '{}', wanted an event, condition or signal of grammar '{}'; {}", name,
        GrammarName(program),
        near.empty() ? fmt::format("known: {}", fmt::join(known, ", "))
                     : fmt::format("did you mean '{}'?", near));
  }
  return "";
}

ExitCode RunTracks(const ParsedOptions& options, const CommandContext& context) {
  std::string output = options.Text("--output");
  if (output == "-") output.clear();
  const bool as_json = options.Has("--json") || output.ends_with(".json");
  if (!output.empty() && !output.ends_with(".json") && !output.ends_with(".csv")) {
    return Refuse(
        context,
        fmt::format("--output: found '{}', wanted a file that ends with .csv or .json", output));
  }
  if (options.Has("--json") && output.ends_with(".csv")) {
    return Refuse(context, "--json contradicts an --output that ends with .csv");
  }
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));
  const std::vector<std::string> only = options.All("--only");
  const std::string unknown = UnknownTrack(only, *episode.program());
  if (!unknown.empty()) return Refuse(context, unknown);

  // Found out before the episode is played.
  std::optional<AtomicFile> file;
  if (!output.empty()) file.emplace(output);
  if (file && !file->problem().empty()) return Refuse(context, "--output: " + file->problem());

  const show::Watched watched = show::Watch(episode);
  if (!watched.problem.empty()) return Refuse(context, watched.problem);
  const show::Tracks tracks = show::CollectTracks(*watched.past, {only.begin(), only.end()});
  if (!tracks.problem.empty()) return Refuse(context, tracks.problem);
  std::ostream& out = file ? file->stream() : context.out;
  if (as_json) {
    show::WriteJson(tracks, episode.loaded().scenario.name, GrammarName(*episode.program()), out);
  } else {
    show::WriteCsv(tracks, out);
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
  return {
      .name = "grammar tracks",
      .summary = "Write conditions and signals over time, for plots",
      .examples = {"grammar tracks milk_carton_wrap -o milk.csv",
                   "grammar tracks milk_carton_wrap --only grasping --only speed_along",
                   "grammar tracks milk.jsonl --grammar my/rules.grammar -o milk.json"},
      .options = {EpisodeArgument(), EpisodeOption(),
                  OutputOption("the file to write, .csv or .json; - or nothing: print CSV"),
                  Repeatable(Value("--only", "NAME",
                                   "an event, condition or signal (speed_along); may be repeated; "
                                   "default: all")),
                  GrammarOption(), SettingsOption(), JsonOption()},
      .run = RunTracks};
}

}  // namespace prehend::cli
