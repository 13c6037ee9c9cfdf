// SPDX-License-Identifier: Apache-2.0
// Relations between several intervals that must hold at once, and whether they can: path
// consistency over Allen's thirteen relations, after his paper of 1983. What it refuses can never
// be; a network that it accepts may still, in rare cases, be impossible. Tested by
// tests/grammar/analysis/allen_network_test.cc
#pragma once

#include <vector>

#include "grammar/base/allen.h"

namespace prehend::grammar {

inline constexpr AllenSet kAnyRelation = (1U << kAllenNames.size()) - 1;

/// How b may lie to a if a lies to b in one of these ways.
AllenSet Inverse(AllenSet relations);

/// How a may lie to c if a lies to b, and b to c, in one of these ways.
AllenSet Composed(AllenSet a_to_b, AllenSet b_to_c);

class AllenNetwork {
 public:
  /// So many intervals, about which nothing is known but that each equals itself.
  explicit AllenNetwork(int intervals);

  /// `left` lies to `right` in one of these ways, too. False: together with what was said before,
  /// that cannot be.
  bool Constrain(int left, int right, AllenSet relations);

 private:
  AllenSet& At(int left, int right) { return relations_[left * size_ + right]; }
  bool Narrow(int left, int right, AllenSet relations);

  int size_;
  std::vector<AllenSet> relations_;
};

}  // namespace prehend::grammar
