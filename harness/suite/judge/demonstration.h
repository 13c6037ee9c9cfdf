// SPDX-License-Identifier: Apache-2.0
// What a demonstration of a robot does with things and what goes wrong in it, from its events, its
// poses and its gripper: docs/robot-demonstrations.md, "Why did it fail". Tested by
// tests/program/failed_demonstrations.py
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/truth/timeline/event_drawings.h"

namespace prehend::suite {

/// Something goes wrong, at a moment.
struct Mishap {
  grammar::Tick tick = 0;
  std::string what;      ///< "cube_3 missed, gripper closed on nothing"
  std::string object;    ///< that has to be taken again
  std::string question;  ///< options of `explain`
  bool is_miss = false;
};

/// A thing is grasped and put somewhere.
struct Handling {
  std::string event, hand, object;
  std::string support;  ///< what it rests on afterwards; or ""
  grammar::Tick begin = 0, end = 0;
  bool open_end = false;  ///< it is held to the end of the episode
};

struct Demonstration {
  std::optional<bool> success;  ///< as the file says
  grammar::Tick ticks_per_second = 1, end = 1;
  std::vector<Handling> handled;  ///< by begin; only the last time of several in a row
  std::vector<Mishap> mishaps;    ///< by tick
};

/// Nothing if no gripper ever closes in it. What grasps and supports are say `drawings`.
std::optional<Demonstration> DemonstrationOf(episode::Recording& recording,
                                             const grammar::Timeline& timeline,
                                             const truth::EventDrawings& drawings);

/// Of each that failed, the first thing that went wrong and was not made good; compared with what
/// most of those do that succeeded.
std::vector<std::optional<Mishap>> FirstCauses(const std::vector<const Demonstration*>& all);

}  // namespace prehend::suite
