// SPDX-License-Identifier: Apache-2.0
// A take: an episode, and what is known of it beside its frames: who is in it, where its labels
// are, by which clock. Tested by tests/program/takes_test.cc
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/episode/run/find_scenario.h"

namespace prehend::episode {

struct Take {
  EpisodeName episode;
  std::string labels = {};  ///< a file; "": as the command line says
  /// Column and value: only such rows of `labels` are of this take.
  std::vector<std::pair<std::string, std::string>> rows = {};
  std::optional<double> offset_s = {};  ///< added to times of labels, instead of the map's
  std::string person = {};
  std::string set = {};  ///< "tune", "test", ..
  std::string map = {};  ///< what labels mean; "": as the command line says
};

/// Takes of episodes that no file of takes names.
std::vector<Take> TakesOf(const std::vector<EpisodeName>& episodes);
std::vector<EpisodeName> EpisodesOf(const std::vector<Take>& takes);

/// Whether it is a file of takes: YAML with a line `takes:`.
bool IsTakesFile(const std::string& path);

/// An entry of a file of takes; its paths are as seen from the working folder.
struct TakeEntry {
  std::string recording;
  std::string grammar;
  Take take;  ///< without its episode
};
/// docs/labels.md, "A file of takes".
Result<std::vector<TakeEntry>> ReadTakes(const std::string& path);

/// Seconds since 1970 of "2026-10-25T01:59:57.010", in UTC unless it says which zone.
std::optional<double> SecondsOfDate(std::string_view text);

}  // namespace prehend::episode
