// SPDX-License-Identifier: Apache-2.0
// Lengths that people do not work with: hands that hardly move, things larger than a person. Tested
// by tests/program/import_warnings_test.cc
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/exchange/import/pose_file.h"

namespace prehend::exchange {

/// The extent of all poses of some bodies, m, z up or not.
Eigen::AlignedBox3d ExtentOf(const PoseFile& poses, const ImportMap& map, bool of_hands_only);

struct SmallRange {
  std::string text;
  std::string remedy;  ///< for the map
};
/// The hands go through much of what is tracked, and yet stay within a hand's width.
std::optional<SmallRange> RangeTooSmall(const PoseFile& poses, const ImportMap& map);

struct TooLarge {
  std::set<std::size_t> things;       ///< of the map's entities
  std::vector<std::string> warnings;  ///< one for each
};
/// What a hand cannot move.
TooLarge ThingsTooLarge(const ImportMap& map);

}  // namespace prehend::exchange
