// SPDX-License-Identifier: Apache-2.0
// Things that rest on nothing: the table is not in the map, or at another height. Tested by
// tests/program/import_test.cc
#pragma once

#include <set>
#include <string>

#include "harness/episode/sense/episode_file.h"

namespace prehend::exchange {

/// Names the things that rest mostly where nothing is below them, at which height, and what the map
/// could say; "" if there are none. Not of `untrue`, whose boxes mean nothing.
std::string RestOnNothing(const episode::Recording& episode, const std::set<std::size_t>& untrue);

}  // namespace prehend::exchange
