// SPDX-License-Identifier: Apache-2.0
// Episodes as files of other programs: their motion, and beside it their events and the map that
// reads it again. Tested by tests/program/exported.py
#pragma once

#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"

namespace prehend::exchange {

struct ExportRequest {
  std::string root;    ///< the project's
  std::string ending;  ///< of the files: .mcap, .csv, .jsonl or .npz
  std::string output;  ///< a folder, or of one episode a file with this ending
  episode::GrammarChoice choice;
};

struct Exported {
  std::string file;
  std::size_t frames = 0, events = 0;
  std::string warnings;
  std::string failure;  ///< "", or why its simulation ended early
};

/// One after another; what was written before a problem stays.
tl::expected<std::vector<Exported>, episode::NotFound> ExportEpisodes(
    const std::vector<episode::EpisodeName>& episodes, const ExportRequest& request);

}  // namespace prehend::exchange
