// SPDX-License-Identifier: Apache-2.0
// Simulators write the same motion twice: before and after each action, in the world and in the
// frame of one environment. Where a map mixes these, other datasets of the file show it. Tested by
// tests/program/import_hdf5.py
#pragma once

#include "harness/exchange/arrays/read_hdf5_poses.h"

namespace prehend::exchange {

/// A body that is a frame before or after others, one whose place counts from elsewhere, and a
/// clock in the file that has another rate. `poses`: of this group.
grammar::Diagnostics CompareSeries(const Demonstrations& demonstrations, const std::string& group,
                                   const PoseFile& poses, const MapFile& map);

}  // namespace prehend::exchange
