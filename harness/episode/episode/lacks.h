// SPDX-License-Identifier: Apache-2.0
// What an episode does not have that a command needs. Tested by
// tests/program/episode_kinds_test.cc
#pragma once

#include <span>
#include <string>

#include "harness/episode/run/episode_name.h"

namespace prehend::episode {

/// Facts that not every kind of episode has.
enum class Need {
  kScenario,        ///< something that can be simulated
  kGroundTruth,     ///< what physically happened
  kRecordedEvents,  ///< what was recognised when it was recorded
  kEpisodeFile,     ///< to be kept in an episode file
  kGolden           ///< a place for a golden of its own
};

/// "", or a sentence: which fact is missing, and what to do.
std::string Lacks(const EpisodeName& episode, Need need);
/// Of the first of these that lacks it.
std::string Lack(std::span<const EpisodeName> episodes, Need need);

}  // namespace prehend::episode
