// SPDX-License-Identifier: Apache-2.0
// What of a file of poses does not look as its map says: unit, axes, order of quaternions, times,
// lengths that people do not work with. Tested by tests/program/import_test.cc and
// tests/program/import_warnings_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/exchange/import/pose_file.h"
#include "harness/exchange/import/rest_poses.h"

namespace prehend::exchange {

/// Errors at the keys of the map that look wrong, with the numbers that were seen; none of a kind
/// that the map is sure about.
grammar::Diagnostics FindImportWarnings(const PoseFile& poses, const MapFile& map);

/// The middle one, of an even number the upper; 0 of none.
double Median(std::vector<double> values);

/// The usual time between two poses of a body, s.
double UsualStep_s(const PoseBody& body);

struct SmallRange {
  std::string text;
  std::string remedy;  ///< for the map
};
/// The hands go through much of what is tracked, and yet stay within a hand's width.
std::optional<SmallRange> RangeTooSmall(const PoseFile& poses, const ImportMap& map);

/// What a hand cannot move.
DoubtfulThings ThingsTooLarge(const ImportMap& map);

}  // namespace prehend::exchange
