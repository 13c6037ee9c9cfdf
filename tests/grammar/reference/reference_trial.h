// SPDX-License-Identifier: Apache-2.0
// The engine against the reference on random grammars and random episodes: alone and beside another
// monitor, in whole frames and in changes. Tested by tests/grammar/reference/reference_test.cc
#pragma once

#include <cstdint>
#include <string>

#include "tests/grammar/reference/random_grammar.h"

namespace prehend::grammar::testing {

struct TrialResult {
  std::int64_t ticks = 0;  ///< frames that were shown to monitors
  int grammars = 0;
  int episodes = 0, lost = 0;  ///< those in which poses are lost are counted in both
  int refused = 0;             ///< random grammars with conditions that are never or always true
  int mismatches = 0;
  std::string first;  ///< what the first mismatch was

  /// "1000000 ticks, 320 grammars, 6400 episodes (3200 with lost poses), 0 mismatches"
  std::string Text() const;
};

/// Random episodes for random grammars until so many ticks are seen.
TrialResult TryRandomGrammars(std::uint64_t seed, std::int64_t ticks);
/// All episodes of so many frames in which p1, q and r are touched or not and heights follow p1,
/// for that many grammars.
TrialResult TryAllEpisodes(std::uint64_t seed, int grammars, int frames);

}  // namespace prehend::grammar::testing
