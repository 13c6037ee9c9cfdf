// SPDX-License-Identifier: Apache-2.0
// Labels back: sub-tasks as signals in a copy of the HDF5 file that demonstrations came from, or as
// tables. Where the sub-tasks of a demonstration end, as the `labels:` of its map say
// (docs/robot-demonstrations.md). Tested by tests/program/labels_back.py
#pragma once

#include <string>
#include <vector>

#include "harness/episode/episode/find_episodes.h"
#include "harness/exchange/export/export_episode.h"
#include "harness/exchange/poses/import_map.h"

namespace prehend::exchange {

/// A sub-task in its episode: frames [begin, end), and the first tick of each.
struct Subtask {
  std::string name;  ///< of its label; the last one is the "rest"
  std::string text;  ///< in words; or ""
  std::size_t begin = 0, end = 0;
  grammar::Tick begin_tick = 0, end_tick = 0;
};

struct Subtasks {
  std::string episode;
  std::string source;  ///< the file that it was imported from
  grammar::Tick ticks_per_second = 0;
  std::vector<grammar::Tick> ticks;  ///< of its frames
  std::vector<Subtask> all;          ///< one after another; none if a boundary is missing:
  std::string missing;               ///< which one, and why

  double Seconds(grammar::Tick tick) const { return truth::SecondsOf(tick, ticks_per_second); }
};

/// Names of the map that the grammar, or the map, does not have.
grammar::Diagnostics WrongInLabels(const MapFile& map, const grammar::Program& program);

/// Labels are taken in the order of the map: each boundary lies after the one before it.
Subtasks FindSubtasks(const ImportMap& map, const Motion& motion);

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
