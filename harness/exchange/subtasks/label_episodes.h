// SPDX-License-Identifier: Apache-2.0
// Labels back: sub-tasks as signals in a copy of the HDF5 file that demonstrations came from, or as
// tables. Tested by tests/program/labels_back.py
#pragma once

#include <string>
#include <vector>

#include "harness/episode/episode/find_episodes.h"
#include "harness/exchange/subtasks/subtasks.h"

namespace prehend::exchange {

struct LabelRequest {
  std::string root;  ///< the project's
  episode::GrammarChoice choice;
  std::string map;
  std::string hdf5;     ///< the copy to write; or
  std::string table;    ///< a file of comma-separated values,
  bool frames = false;  ///< a row per frame, else per sub-task
};

tl::expected<std::vector<Subtasks>, episode::NotFound> LabelEpisodes(
    const std::vector<episode::EpisodeName>& episodes, const LabelRequest& request);

}  // namespace prehend::exchange
