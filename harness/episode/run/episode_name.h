// SPDX-License-Identifier: Apache-2.0
// Where an episode is, and what it came from. Tested by tests/program/episode_kinds_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace prehend::episode {

enum class Origin {
  kScenario,     ///< to be simulated
  kRecordedRun,  ///< was simulated, and is kept in an episode file
  kRecording     ///< of a tracker or another program: frames as a grammar sees them, no physics
};

struct EpisodeName {
  std::string file;                    ///< a scenario, an episode file, or JSON Lines
  std::optional<std::int64_t> number;  ///< in an episode file
  std::string scenario;                ///< skill/name; of JSON Lines the name of the file
  Origin origin = Origin::kScenario;
  std::string grammar;     ///< that a recording names for itself, or a run was recorded with; or ""
  std::string asked = {};  ///< a grammar that a file of takes names instead of its own

  bool operator==(const EpisodeName&) const = default;
};

}  // namespace prehend::episode
