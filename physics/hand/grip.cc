// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/hand/grip_test.cc
#include "physics/hand/grip.h"

#include <algorithm>

namespace prehend::physics {
namespace {

/// A joint presses if it is held back by more than this.
constexpr double kHeldBack_rad = 0.01, kHeldBack_m = 0.0005;

/// The link with which the digit of a link begins.
std::size_t DigitOf(const HandModel& model, std::size_t link) {
  while (model.links[link].parent != kNone) link = model.links[link].parent.index();
  return link;
}

}  // namespace

const std::vector<double>& Grip::Targets(const HandModel& model, const GraspStyle& style,
                                         double trigger, const std::vector<double>& joints) {
  std::vector<double> before = JointTargets(style, trigger);
  before.swap(targets_);
  const bool falls = trigger < trigger_;
  if (trigger != trigger_) opens_ = falls;
  trigger_ = trigger;
  if (!opens_ || before.size() != targets_.size()) return targets_;
  // A joint presses if it is held back from closing. One that would not open lets nothing go.
  const std::vector<double> open = JointTargets(style, 0);
  std::vector<bool> presses(targets_.size()), digit_presses(targets_.size());
  std::vector<bool> side_presses(model.sensor_sets.size());
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const HandLink& link = model.links[i];
    presses[i] = targets_[i] - joints[i] > (link.slides ? kHeldBack_m : kHeldBack_rad);
    if (!presses[i]) continue;
    digit_presses[DigitOf(model, i)] = true;
    if (targets_[i] > open[i]) side_presses[static_cast<std::size_t>(link.sensor_set)] = true;
  }
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    bool waits = false;
    for (std::size_t side = 0; side < side_presses.size(); ++side)
      waits |= side_presses[side] &&
               (falls || side != static_cast<std::size_t>(model.links[i].sensor_set));
    if (waits && !(falls ? presses[i] : digit_presses[DigitOf(model, i)]))
      targets_[i] = std::max(targets_[i], before[i]);
  }
  return targets_;
}

}  // namespace prehend::physics
