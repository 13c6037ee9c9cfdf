// SPDX-License-Identifier: Apache-2.0
// Things that rest where or as nothing can: on nothing, since the table is not in the map; on a
// plane that is not level; turned otherwise than upright, since trackers give bodies any axes.
// Tested by tests/program/import_rest_poses_test.cc, tests/program/import_up_test.cc and
// tests/program/import_test.cc
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "harness/episode/sense/episode_file.h"
#include "harness/exchange/poses/import_map.h"

namespace prehend::exchange {

/// Calls `look` with frames half a second apart, each with the one before it. A thing rests where
/// it gets less than a centimetre far meanwhile.
void EachLook(const episode::Recording& episode,
              const std::function<void(const episode::EpisodeFrame& before,
                                       const episode::EpisodeFrame& now)>& look);
inline constexpr double kBetweenLooks_s = 0.5;
inline constexpr double kSamePlace_m = 0.01;

struct DoubtfulThings {
  std::set<std::size_t> things;       ///< whose boxes and tilts mean nothing
  std::vector<std::string> warnings;  ///< one for each of them, and one for the hands
};

/// Names what rests neither upright nor, as far as can be told, on its side or on its head, and
/// when it rests.
DoubtfulThings FindNotUpright(const episode::Recording& episode, const ImportMap& map);

/// Says by how much the plane is tilted on which most things rest, how well it is known, and what
/// the map could say; "" where that is less than 5 degrees, where two levels or what the map places
/// explain as much, or too few places tell. Not of `untrue`, whose heights mean nothing.
std::string TiltOfRestPlane(const episode::Recording& episode, const ImportMap& map,
                            const std::set<std::size_t>& untrue);

/// Names the things that rest mostly where nothing is below them and no hand could hold them, at
/// which height, and what the map could say; and each that rests mostly inside what is fixed. Not
/// of `untrue`, whose boxes mean nothing.
std::vector<std::string> RestOddly(const episode::Recording& episode,
                                   const std::set<std::size_t>& untrue);

}  // namespace prehend::exchange
