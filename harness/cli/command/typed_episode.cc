// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/command/typed_episode.h"

#include "harness/episode/episode/open_episode.h"
#include "harness/episode/run/run_text.h"

namespace prehend::cli {

tl::expected<std::vector<episode::Take>, ExitCode> FindTakesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context) {
  return episode::FindTakes(options.All(argument), options.Text("--episode"), context.root)
      .map_error([&](const episode::NotFound& none) { return Complain(context, none); });
}

tl::expected<std::vector<episode::EpisodeName>, ExitCode> FindEpisodesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context,
    const std::vector<episode::Need>& needs) {
  auto found =
      episode::FindEpisodes(options.All(argument), options.Text("--episode"), context.root);
  if (!found) return tl::unexpected(Complain(context, found.error()));
  for (const episode::Need need : needs) {
    if (const std::string lack = episode::Lack(*found, need); !lack.empty())
      return tl::unexpected(Complain(context, ExitCode::kBadInput, lack));
  }
  return std::move(*found);
}

tl::expected<episode::Episode, ExitCode> OpenEpisodeOrComplain(const std::string& typed,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context) {
  const auto name = episode::FindEpisode(typed, options.Text("--episode"), context.root);
  if (!name) return tl::unexpected(Complain(context, name.error()));
  return episode::OpenEpisode(*name, {options.Text("--grammar"), options.All("--set")},
                              context.root)
      .map_error([&](const grammar::Diagnostics& why) { return Complain(context, why); });
}

tl::expected<suite::PlayedRun, ExitCode> PlayOrComplain(episode::Episode episode,
                                                        const CommandContext& context) {
  Result<episode::RunResult> run = episode.Run(true);
  if (!run) return tl::unexpected(Complain(context, run.error()));
  if (run->recording.empty())
    return tl::unexpected(Complain(context, ExitCode::kFailure, episode::StatusText(*run)));
  return suite::PlayedRun{std::move(episode.loaded()), std::move(*run), episode.was_simulated()};
}

}  // namespace prehend::cli
