// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/touches.h"

namespace prehend::truth {

namespace {

/// From where it is at rest on what bears it until that does no more: it may tip or roll in
/// between. What is over in a moment was a blow.
Spans SupportsOf(const std::vector<Bearing>& bearings, const Recording& recording,
                 const OracleSettings& settings) {
  std::vector<bool> borne;
  for (const Bearing& bearing : bearings)
    borne.push_back(bearing.touching && bearing.up >= settings.support_up &&
                    bearing.share >= settings.support_share);
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
    std::vector<bool> gripped;
    for (const std::uint8_t count : sets) gripped.push_back(count >= settings.grasp_sensor_sets);
    const Spans tight =
        Bridged(WhereTrue(gripped), recording.ticks, recording.Ticks(settings.grasp_bridge_s));
    // Letting go ends a grasp at once, and none begins before the hand feels the object again.
    for (const Span& squeeze : WhereGripIsCommanded(recording, settings, hand)) {
      for (Span span : Within(tight, squeeze)) {
        while (!span.empty() && !gripped[span.begin]) ++span.begin;
        if (!span.empty()) touches.grasps.push_back({hand, body, span, span.begin});
      }
    }
  }
  SayHowLongTheyTouched(recording, touches);
  return touches;
}

}  // namespace prehend::truth
