// SPDX-License-Identifier: Apache-2.0
// What of a file of poses does not look as its map says: unit, axes, order of quaternions, times.
// Tested by tests/program/import_test.cc
#pragma once

#include "harness/exchange/import/pose_file.h"

namespace prehend::exchange {

/// Errors at the keys of the map that look wrong, with the numbers that were seen; none of a kind
/// that the map is sure about.
grammar::Diagnostics FindImportWarnings(const PoseFile& poses, const MapFile& map);

/// The middle one, of an even number the upper; 0 of none.
double Median(std::vector<double> values);

/// The usual time between two poses of a body, s.
double UsualStep_s(const PoseBody& body);

}  // namespace prehend::exchange
