// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/touches.h"

#include <bit>
#include <cmath>

namespace prehend::truth {

namespace {

/// From where it is at rest on what bears its weight until they part or that is no longer below: it
/// may tip or roll in between, and a hand may take the weight. What is over in a moment was a blow.
Spans SupportsOf(const std::vector<Bearing>& bearings, const Recording& recording,
                 const TouchSettings& settings) {
  std::vector<bool> borne;
  for (const Bearing& bearing : bearings) {
    const bool bears = bearing.share >= settings.support_share || (!borne.empty() && borne.back());
    borne.push_back(bearing.touching && bearing.up >= settings.support_up && bears);
  }
  Spans spans;
  for (Span span : WhereTrue(borne)) {
    while (!span.empty() && bearings[span.begin].vertical_m_per_s > settings.support_speed_m_per_s)
      ++span.begin;
    if (!span.empty()) spans.push_back(span);
  }
  spans = Bridged(spans, recording.ticks, recording.Ticks(settings.contact_bridge_s));
  std::erase_if(spans, [&](const Span& span) {
    return recording.Lasts_s(span) < settings.support_minimum_s;
  });
  return spans;
}

Spans WhereGripIsCommanded(const Recording& recording, const TouchSettings& settings, int hand) {
  std::vector<bool> commanded;
  for (int frame = 0; frame < recording.size(); ++frame)
    commanded.push_back(recording.hand(hand, frame).trigger >= settings.commanded_trigger);
  return WhereTrue(commanded);
}

/// Whether the grip opens, in the 10 ms around each frame.
std::vector<bool> WhereGripOpens(const Recording& recording, const TouchSettings& settings,
                                 int hand) {
  constexpr double kWindow_s = 0.02;
  std::vector<bool> opens(recording.size());
  for (int frame = 0; frame < recording.size(); ++frame) {
    int before = frame, after = frame;
    while (before > 0 && recording.Seconds(before, frame) < kWindow_s / 2) --before;
    while (after + 1 < recording.size() && recording.Seconds(frame, after) < kWindow_s / 2) ++after;
    const double change =
        recording.hand(hand, after).trigger - recording.hand(hand, before).trigger;
    opens[frame] =
        after > before && change <= -settings.opening_per_s * recording.Seconds(before, after);
  }
  return opens;
}

/// Held with one sensor set that bears force, without slipping out of the hand, as a bar in a hook.
bool HangsOn(const Evidence& evidence, const TouchSettings& settings, Pair pair, int frame) {
  if (evidence.forces_n.at(pair)[frame] < settings.hook_force_n) return false;
  const physics::BodyState& body = evidence.recording.body(pair.second, frame);
  const physics::BodyState& palm = evidence.recording.hand(pair.first, frame).palm;
  const Eigen::Vector3d slip_m_per_s = body.v_WB_m_per_s - VelocityAt(palm, body.X_WB.p_m);
  return slip_m_per_s.norm() <= settings.hook_slip_m_per_s;
}

/// What a hand does with a body that it does not hold alone: its grip is open, or one sensor set
/// touches.
class Helpers {
 public:
  Helpers(const Evidence& evidence, const TouchSettings& settings)
      : evidence_(evidence), settings_(settings) {
    for (const auto& [pair, forces_n] : evidence.forces_n)
      for (int frame = 0; frame < evidence.recording.size(); ++frame)
        presses_[pair].push_back(forces_n[frame] >= settings.press_force_n &&
                                 !HoldsAlone(pair, frame));
  }

  /// Of (hand index, body): by frame.
  const std::vector<bool>& WherePressed(Pair pair) const { return presses_.at(pair); }

  /// Another hand presses on the other side, with a palm that faces this one's. `pair` presses.
  bool IsPressedBetween(Pair pair, int frame) const {
    for (const auto& [other, presses] : presses_) {
      if (other.second != pair.second || other.first == pair.first || !presses[frame]) continue;
      const double cosine = Back(pair.first, frame).dot(Back(other.first, frame));
      if (cosine <= std::cos(settings_.press_facing_rad)) return true;
    }
    return false;
  }

  /// It is held against another thing that the hand presses from the other side: of thumb and
  /// fingers one side touches this one and the other side that one. `pair` presses.
  bool IsSqueezedWithAnother(Pair pair, int frame) const {
    if (!Moves(pair.second)) return false;
    for (const auto& [other, presses] : presses_) {
      if (other.first != pair.first || other.second == pair.second || !presses[frame] ||
          !Moves(other.second) ||
          IsTouchedByFirstSet(pair, frame) == IsTouchedByFirstSet(other, frame))
        continue;
      const auto touching = evidence_.touching.find(std::minmax(pair.second, other.second));
      if (touching != evidence_.touching.end() && touching->second[frame]) return true;
    }
    return false;
  }

 private:
  std::uint32_t Sets(Pair pair, int frame) const { return evidence_.sensor_sets.at(pair)[frame]; }
  /// The fingers of a hand, one jaw of a gripper.
  bool IsTouchedByFirstSet(Pair pair, int frame) const { return (Sets(pair, frame) & 1) != 0; }
  bool Moves(int body) const {
    return physics::MovesFreely(evidence_.recording.scene, physics::BodyIndex(body));
  }
  Eigen::Vector3d Back(int hand, int frame) const {
    return evidence_.recording.hand(hand, frame).palm.X_WB.q * Eigen::Vector3d::UnitZ();
  }
  bool HoldsAlone(Pair pair, int frame) const {
    return std::popcount(Sets(pair, frame)) >= settings_.grasp_sensor_sets &&
           evidence_.recording.hand(pair.first, frame).trigger >= settings_.commanded_trigger;
  }

  const Evidence& evidence_;
  const TouchSettings& settings_;
  std::map<Pair, std::vector<bool>> presses_;
};

void SayHowLongTheyTouched(const Recording& recording, Touches& touches) {
  const Grasp* before = nullptr;
  for (Grasp& grasp : touches.grasps) {
    for (const Span& contact :
         touches.contacts.at({grasp.body, recording.body_count() + grasp.hand}))
      if (contact.Contains(grasp.span.begin)) grasp.touched_since = contact.begin;
    const bool again = before && before->hand == grasp.hand && before->body == grasp.body;
    if (again) grasp.touched_since = std::max(grasp.touched_since, before->span.end);
    before = &grasp;
  }
}

}  // namespace

Touches FindTouches(const Evidence& evidence, const TouchSettings& settings) {
  const Recording& recording = evidence.recording;
  Touches touches;
  for (const auto& [pair, frames] : evidence.touching)
    touches.contacts[pair] =
        Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(settings.contact_bridge_s));
  for (const auto& [pair, bearings] : evidence.bearings)
    touches.supports[pair] = SupportsOf(bearings, recording, settings);
  const Helpers helpers(evidence, settings);
  const auto bridged = [&](const std::vector<bool>& frames) {
    return Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(settings.grasp_bridge_s));
  };
  std::map<int, std::vector<bool>> grip_opens;
  std::map<int, Spans> commanded;
  for (const auto& [pair, sets] : evidence.sensor_sets) {
    const auto& [hand, body] = pair;
    if (!commanded.contains(hand)) {
      commanded[hand] = WhereGripIsCommanded(recording, settings, hand);
      grip_opens[hand] = WhereGripOpens(recording, settings, hand);
    }
    const std::vector<bool>&opens = grip_opens[hand], &presses = helpers.WherePressed(pair);
    // A grasp begins where it is gripped, and lasts while held.
    std::vector<bool> gripped(recording.size()), held = gripped, between = gripped;
    for (int frame = 0; frame < recording.size(); ++frame) {
      if (sets[frame] == 0) continue;
      const bool has_sets = std::popcount(sets[frame]) >= settings.grasp_sensor_sets ||
                            (presses[frame] && helpers.IsSqueezedWithAnother(pair, frame));
      between[frame] = presses[frame] && helpers.IsPressedBetween(pair, frame);
      gripped[frame] = (has_sets && !opens[frame]) || between[frame];
      held[frame] =
          has_sets || between[frame] || (!opens[frame] && HangsOn(evidence, settings, pair, frame));
    }
    const Spans tight = bridged(held);
    // Letting go ends a grasp at once, and none begins before the hand feels the object again.
    for (const Span& squeeze : Union(commanded[hand], bridged(between))) {
      for (Span span : Within(tight, squeeze)) {
        while (!span.empty() && !gripped[span.begin]) ++span.begin;
        if (recording.Lasts_s(span) >= settings.grasp_minimum_s)
          touches.grasps.push_back({hand, body, span, span.begin});
      }
    }
  }
  SayHowLongTheyTouched(recording, touches);
  return touches;
}

}  // namespace prehend::truth
