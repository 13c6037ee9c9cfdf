// SPDX-License-Identifier: Apache-2.0
// Entities must be in the entity table, ticks must rise, and each touch names its entities in
// order.
#include "grammar/engine/frame_checks.h"

#include <algorithm>
#include <span>

namespace prehend::grammar {
namespace {

bool IsEntity(int entity, int entities) { return entity >= 0 && entity < entities; }

std::string_view WhyNoTouches(std::span<const Touch> touches, int entities) {
  const auto is_bad = [&](const Touch& touch) {
    return touch.a < 0 || touch.a >= touch.b || touch.b >= entities;
  };
  return std::ranges::any_of(touches, is_bad) ? "a frame has a touch of entities that are not in "
                                                "the entity table, or not in its order"
                                              : std::string_view();
}

}  // namespace

std::string_view WhyNoTick(Tick tick, const History& history) {
  if (tick > kLatestTick || tick < -kLatestTick) return "a frame's tick is too large";
  if (history.now() >= 0 && tick <= history.At(history.now()).tick)
    return "the frames are not in order of time";
  return {};
}

std::string_view WhyNotWatchable(const Frame& frame, int entities) {
  if (static_cast<int>(frame.entities.size()) != entities)
    return "a frame has another number of entities than the entity table";
  int last_hand = kNoEntity;
  for (const HandSample& hand : frame.hands) {
    if (!IsEntity(hand.entity, entities))
      return "a frame has a hand that is not in the entity table";
    if (hand.entity <= last_hand)
      return "a frame has a hand twice, or its hands are not in the order of the entity table";
    last_hand = hand.entity;
  }
  return WhyNoTouches(frame.touches, entities);
}

std::string_view WhyNotWatchable(const FrameChanges& changes, int entities) {
  for (const EntityChange& change : changes.entities) {
    if (!IsEntity(change.entity, entities))
      return "a frame has an entity that is not in the entity table";
  }
  for (const HandSample& hand : changes.hands) {
    if (!IsEntity(hand.entity, entities))
      return "a frame has a hand that is not in the entity table";
  }
  for (const ContactEnd& contact_end : changes.contact_ends) {
    if (!IsEntity(contact_end.a, entities) || !IsEntity(contact_end.b, entities))
      return "a frame has a contact end of an entity that is not in the entity table";
  }
  return WhyNoTouches(changes.touches, entities);
}

}  // namespace prehend::grammar
