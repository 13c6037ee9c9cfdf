// SPDX-License-Identifier: Apache-2.0
// The episode that was typed, of any kind. What is wrong is reported here; the exit code is left.
// Tested by tests/program/episode_kinds_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episode/lacks.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::cli {

/// All that was typed for an argument, with --episode.
tl::expected<std::vector<episode::Take>, ExitCode> FindTakesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context);

/// The same without what is known beside. What lacks one of `needs` is refused.
tl::expected<std::vector<episode::EpisodeName>, ExitCode> FindEpisodesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context,
    const std::vector<episode::Need>& needs = {});

/// A single one, opened with the grammar and the settings of the command line.
tl::expected<episode::Episode, ExitCode> OpenEpisodeOrComplain(const std::string& typed,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context);

tl::expected<suite::PlayedRun, ExitCode> PlayOrComplain(episode::Episode episode,
                                                        const CommandContext& context);

}  // namespace prehend::cli
