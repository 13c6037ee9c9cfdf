// SPDX-License-Identifier: Apache-2.0
// Where the joints of a hand go while its trigger rises and falls. A hand that lets go of what
// stands opens from where its joints stopped. Otherwise, as long as one presses still, held back by
// what the hand holds, the others stay where they are, because a post that gave way early would be
// followed by what it holds. When the trigger stops half-way, only the digits on the other side
// (another sensor set) still wait. Tested by tests/physics/hand/grip_test.cc
#pragma once

#include <vector>

#include "physics/scene/hand_model.h"

namespace prehend::physics {

class Grip {
 public:
  /// Of the coming tick, one per joint. `joints`: where they are. `lets_go_to`: to which trigger a
  /// hand opens that lets go of what stands; else 1.
  const std::vector<double>& Targets(const HandModel& model, const GraspStyle& style,
                                     double trigger, const std::vector<double>& joints,
                                     double lets_go_to = 1);

 private:
  std::vector<double> targets_;
  /// Of a hand that lets go: where joints stopped, from their targets.
  std::vector<double> shifts_;
  double trigger_ = 0, to_ = 1;
  bool opens_ = false, stands_ = false;  ///< so the trigger moved last; it did not in this tick
};

}  // namespace prehend::physics
