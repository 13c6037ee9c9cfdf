// SPDX-License-Identifier: Apache-2.0
// What rules that were made at random mean for one episode, for both bindings of p, by
// tests/grammar/reference/reference.h. Tested by tests/grammar/reference/reference_test.cc
#pragma once

#include <array>
#include <vector>

#include "tests/grammar/reference/random_grammar.h"

namespace prehend::grammar::testing {

using MeantIntervals = std::vector<reference::Timed>;

/// By rule, for p1 and p2.
std::vector<std::array<MeantIntervals, 2>> MeaningOf(const std::vector<RandomRule>& rules,
                                                     const RandomEpisode& episode);

}  // namespace prehend::grammar::testing
