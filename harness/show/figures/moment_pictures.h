// SPDX-License-Identifier: Apache-2.0
// Pictures of moments in recorded episodes: the world at a time, and the paths of a hand and of a
// thing over a while. Tested by tests/program/query_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/episode/episodes/query_events.h"

namespace prehend::show {

/// More than these are not drawn.
inline constexpr std::size_t kMostMoments = 100;

struct Moment {
  std::string file;
  std::int64_t episode = 0;
  std::string scenario, name;       ///< of these the picture's name is made
  double at_s = 0;                  ///< the world at this time
  double from_s = 0, to_s = 0;      ///< paths between these times
  std::vector<std::string> of;      ///< of the first hand and the first thing among these
  std::vector<std::string> marked;  ///< things that get a marker
};

/// The moment of an answer: when its event begins.
Moment MomentOf(const episode::EventAnswer& answer);

struct MomentPictures {
  std::vector<std::string> files;  ///< one per moment; empty: not drawn
  std::string error;               ///< empty, or why (some) could not be drawn
};

/// Draws each moment as FOLDER/NUMBER-SCENARIO-NAME.png; makes the folder. `root`: the project's.
/// Moments of one episode should follow each other, so that it is replayed once.
MomentPictures DrawMoments(const std::vector<Moment>& moments, const std::string& folder,
                           const std::string& root);

}  // namespace prehend::show
