// SPDX-License-Identifier: Apache-2.0
#include "physics/hand/grip.h"

#include <algorithm>
#include <utility>

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
                                         double trigger, const std::vector<double>& joints,
                                         double lets_go_to) {
  const std::vector<double> before = std::exchange(targets_, JointTargets(style, trigger));
  const bool falls = trigger < trigger_, stood = std::exchange(stands_, trigger == trigger_);
  if (!stands_) opens_ = falls;
  trigger_ = trigger;
  if (!opens_ || trigger <= to_) shifts_.clear();
  if (!opens_ || before.size() != targets_.size()) return targets_;
  const auto is_held_back = [&](std::size_t i, double target, double share = 1) {
    return target - joints[i] > share * (model.links[i].slides ? kHeldBack_m : kHeldBack_rad);
  };
  if (shifts_.empty()) to_ = lets_go_to;
  const std::vector<double> open = JointTargets(style, 0), end = JointTargets(style, to_);
  bool stays = false;  // within what it holds
  if (shifts_.empty() && falls && trigger > to_) {
    for (std::size_t i = 0; i < end.size(); ++i) {
      // Behind a target that moved, a joint lags. Behind one that stood, it is held back.
      shifts_.push_back(is_held_back(i, before[i], stood ? 0 : 1) ? joints[i] - before[i] : 0);
      stays |= end[i] > open[i] && is_held_back(i, end[i]);
    }
    if (stays) shifts_.clear();
  }
  for (std::size_t i = 0; i < shifts_.size(); ++i)
    targets_[i] = targets_[i] > end[i] ? std::max(targets_[i] + shifts_[i], end[i])
                                       : targets_[i] + shifts_[i];
  if (!shifts_.empty()) return targets_;
  // A joint presses if it is held back from closing. One that would not open lets nothing go.
  std::vector<bool> presses(targets_.size()), digit_presses(targets_.size());
  std::vector<bool> side_presses(model.sensor_sets.size());
  const auto side_of = [&](std::size_t i) { return std::size_t(model.links[i].sensor_set); };
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    presses[i] = is_held_back(i, targets_[i]);
    if (!presses[i]) continue;
    digit_presses[DigitOf(model, i)] = true;
    if (targets_[i] > open[i]) side_presses[side_of(i)] = true;
  }
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    bool others_press = false;
    for (std::size_t side = 0; side < side_presses.size(); ++side)
      others_press |= side_presses[side] && (falls || side != side_of(i));
    if (others_press && !(falls ? presses[i] : digit_presses[DigitOf(model, i)]))
      targets_[i] = std::max(targets_[i], before[i]);
  }
  return targets_;
}

}  // namespace prehend::physics
