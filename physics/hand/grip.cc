// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/hand/grip_test.cc
#include "physics/hand/grip.h"

#include <algorithm>

namespace prehend::physics {
namespace {

/// A joint presses if it is held back by more than this.
constexpr double kHeldBack_rad = 0.01, kHeldBack_m = 0.0005;

}  // namespace

const std::vector<double>& Grip::Targets(const HandModel& model, const GraspStyle& style,
                                         double trigger, const std::vector<double>& joints,
                                         double lets_go_to) {
  std::vector<double> before = JointTargets(style, trigger);
  before.swap(targets_);
  const bool falls = trigger < trigger_;
  if (trigger != trigger_) opens_ = falls;
  trigger_ = trigger;
  if (!opens_ || trigger <= to_) shifts_.clear();
  if (!opens_ || before.size() != targets_.size()) return targets_;
  const auto is_held_back = [&](std::size_t i, double target) {
    return target - joints[i] > (model.links[i].slides ? kHeldBack_m : kHeldBack_rad);
  };
  if (shifts_.empty()) to_ = lets_go_to;
  const std::vector<double> open = JointTargets(style, 0), end = JointTargets(style, to_);
  bool waits = false;  // One that would not open lets nothing go.
  if (shifts_.empty() && falls && trigger > to_) {
    for (std::size_t i = 0; i < end.size(); ++i) {
      shifts_.push_back(is_held_back(i, before[i]) ? joints[i] - before[i] : 0);
      waits |= end[i] > open[i] && is_held_back(i, end[i]);
    }
    if (waits) shifts_.clear();
  }
  for (std::size_t i = 0; i < shifts_.size(); ++i)
    targets_[i] = targets_[i] > end[i] ? std::max(targets_[i] + shifts_[i], end[i])
                                       : targets_[i] + shifts_[i];
  if (!shifts_.empty()) return targets_;
  for (std::size_t i = 0; i < targets_.size(); ++i)
    waits |= targets_[i] > open[i] && is_held_back(i, targets_[i]);
  for (std::size_t i = 0; i < targets_.size(); ++i)
    if (falls && waits && !is_held_back(i, targets_[i])) targets_[i] = std::max(targets_[i], before[i]);
  return targets_;
}

}  // namespace prehend::physics
