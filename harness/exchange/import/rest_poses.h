// SPDX-License-Identifier: Apache-2.0
// Things that rest turned otherwise than upright: trackers give bodies any axes, and the map does
// not say when they stand. Tested by tests/program/import_rest_poses_test.cc
#pragma once

#include <set>
#include <string>
#include <vector>

#include "harness/episode/sense/episode_file.h"
#include "harness/exchange/import/import_map.h"

namespace prehend::exchange {

struct NotUpright {
  std::set<std::size_t> things;       ///< whose boxes and tilts mean nothing
  std::vector<std::string> warnings;  ///< one for each of them, and one for the hands
};

/// Names what rests neither upright nor, as far as can be told, on its side or on its head, and
/// when it rests.
NotUpright FindNotUpright(const episode::Recording& episode, const ImportMap& map);

}  // namespace prehend::exchange
