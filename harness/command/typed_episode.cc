// SPDX-License-Identifier: Apache-2.0
// See harness/command/typed_episode.h. Tested by tests/program/episode_kinds_test.cc
#include "harness/command/typed_episode.h"

#include "harness/episode/open_episode.h"
#include "harness/run/run_text.h"

namespace prehend::harness {

tl::expected<std::vector<EpisodeName>, ExitCode> FindEpisodesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context,
    const std::vector<Need>& needs) {
  auto found = FindEpisodes(options.All(argument), options.Text("--episode"), context.root);
  if (!found) return tl::unexpected(Complain(context, found.error()));
  for (const Need need : needs) {
    if (const std::string lack = Lack(*found, need); !lack.empty())
      return tl::unexpected(Complain(context, ExitCode::kBadInput, lack));
  }
  return std::move(*found);
}

tl::expected<Episode, ExitCode> OpenEpisodeOrComplain(const std::string& typed,
                                                      const ParsedOptions& options,
                                                      const CommandContext& context) {
  const auto name = FindEpisode(typed, options.Text("--episode"), context.root);
  if (!name) return tl::unexpected(Complain(context, name.error()));
  return OpenEpisode(*name, {options.Text("--grammar"), options.All("--set")}, context.root)
      .map_error([&](const grammar::Diagnostics& why) { return Complain(context, why); });
}

tl::expected<PlayedRun, ExitCode> PlayOrComplain(Episode episode, const CommandContext& context) {
  Result<RunResult> run = episode.Run(true);
  if (!run) return tl::unexpected(Complain(context, run.error()));
  if (run->recording.empty())
    return tl::unexpected(Complain(context, ExitCode::kFailure, StatusText(*run)));
  return PlayedRun{std::move(episode.loaded()), std::move(*run), episode.was_simulated()};
}

}  // namespace prehend::harness
