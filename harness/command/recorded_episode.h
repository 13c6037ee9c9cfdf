// SPDX-License-Identifier: Apache-2.0
// An episode of an episode file where a command takes a scenario. Tested by
// tests/program/episodes_test.cc
#pragma once

#include "harness/command/command.h"
#include "harness/episodes/load_episode.h"

namespace prehend::harness {

/// --episode, for commands that take one of a file.
Option EpisodeOption();

/// An episode, with its file open and its scenario loaded.
struct RecordedEpisode {
  episodes::EpisodeFile file;
  episodes::EpisodeRow row;
  LoadedRun loaded;
};

/// The episode that --episode selects, or the only one of the file, with the grammar and parameters
/// of the command line; otherwise, after reporting why there is none, the exit code.
tl::expected<RecordedEpisode, ExitCode> OpenRecordedOrComplain(const std::string& typed,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context);

/// A run with every frame.
struct PlayedRun {
  LoadedRun loaded;
  RunResult run;
  bool simulated = true;  ///< otherwise the frames are those of a stand-in, not to be sensed
};

/// The scenario that was typed, simulated with the grammar and the settings of the command line; or
/// the episode of the file that was typed, read again. Otherwise, after a report, the exit code.
tl::expected<PlayedRun, ExitCode> PlayOrReplay(const std::string& typed,
                                               const ParsedOptions& options,
                                               const CommandContext& context);

/// The episode that was typed for `scenario`, a scenario, an episode file or a
/// recording, with the run options;
/// otherwise, after reporting why there is none, the exit code.
tl::expected<EpisodeSource, ExitCode> OpenEpisodeOrComplain(const ParsedOptions& options,
                                                            const CommandContext& context);

}  // namespace prehend::harness
