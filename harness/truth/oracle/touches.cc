// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/touches.h"

namespace prehend::truth {

namespace {

/// From where it is at rest on what bears its weight until they part or that is no longer below: it
/// may tip or roll in between, and a hand may take the weight. What is over in a moment was a blow.
Spans SupportsOf(const std::vector<Bearing>& bearings, const Recording& recording,
                 const OracleSettings& settings) {
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

Spans WhereGripIsCommanded(const Recording& recording, const OracleSettings& settings, int hand) {
  std::vector<bool> commanded;
  for (int frame = 0; frame < recording.size(); ++frame)
    commanded.push_back(recording.hand(hand, frame).trigger >= settings.commanded_trigger);
  return WhereTrue(commanded);
}

/// Whether the grip opens, in the 10 ms around each frame.
std::vector<bool> WhereGripOpens(const Recording& recording, const OracleSettings& settings,
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
bool HangsOn(const Evidence& evidence, const OracleSettings& settings, Pair pair, int frame) {
  if (evidence.forces_n.at(pair)[frame] < settings.hook_force_n) return false;
  const physics::BodyState& body = evidence.recording.body(pair.second, frame);
  const physics::BodyState& palm = evidence.recording.hand(pair.first, frame).palm;
  const Eigen::Vector3d slip_m_per_s = body.v_WB_m_per_s - VelocityAt(palm, body.X_WB.p_m);
  return slip_m_per_s.norm() <= settings.hook_slip_m_per_s;
}

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

Touches FindTouches(const Evidence& evidence, const OracleSettings& settings) {
  const Recording& recording = evidence.recording;
  Touches touches;
  for (const auto& [pair, frames] : evidence.touching)
    touches.contacts[pair] =
        Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(settings.contact_bridge_s));
  for (const auto& [pair, bearings] : evidence.bearings)
    touches.supports[pair] = SupportsOf(bearings, recording, settings);
  for (const auto& [pair, sets] : evidence.sensor_sets) {
    const auto& [hand, body] = pair;
    const std::vector<bool> opens = WhereGripOpens(recording, settings, hand);
    std::vector<bool> gripped, held;  // a grasp begins where it is gripped, and lasts while held
    for (int frame = 0; frame < recording.size(); ++frame) {
      const bool has_sets = sets[frame] >= settings.grasp_sensor_sets;
      gripped.push_back(has_sets && !opens[frame]);
      held.push_back(has_sets || (sets[frame] > 0 && !opens[frame] &&
                                  HangsOn(evidence, settings, pair, frame)));
    }
    const Spans tight =
        Bridged(WhereTrue(held), recording.ticks, recording.Ticks(settings.grasp_bridge_s));
    // Letting go ends a grasp at once, and none begins before the hand feels the object again.
    for (const Span& squeeze : WhereGripIsCommanded(recording, settings, hand)) {
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
