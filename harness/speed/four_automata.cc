// SPDX-License-Identifier: Apache-2.0
#include "harness/speed/four_automata.h"

#include <bit>
#include <vector>

#include "harness/speed/stopwatch.h"
#include "harness/speed/worlds.h"

namespace prehend::harness {
namespace {

using grammar::Tick;

constexpr Tick kSupportTicks = FourRules::kSupport_ms * kWorldRate_hz / 1000;
constexpr Tick kUnansweredTicks = FourRules::kUnanswered_ms * kWorldRate_hz / 1000;

// The four rules for one object, evaluated in each frame.
struct Automaton {
  // Facts.
  double trigger = 0;
  std::uint32_t sets = 0;
  bool touched = false;
  bool on_table = false;
  double up = -1;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  // State.
  bool grasping = false, supported = false, waiting = false, lifting = false, was_touched = false,
       was_near = true;
  Tick grasp_begin = 0, support_begin = 0, touch_begin = 0, lift_begin = 0;
  Eigen::Vector3d lift_p_m = Eigen::Vector3d::Zero();

  void Step(int hand, int object, Tick now, Recognised& out) {
    const bool grasps =
        touched && trigger >= FourRules::kGripOn && std::popcount(sets) >= FourRules::kSides;
    const bool grasp_begins = grasps && !grasping;
    if (grasp_begins) grasp_begin = now;
    if (grasping && !grasps) out.Add(FourRules::kGrasping, hand, object, {grasp_begin, now});
    grasping = grasps;

    const bool stands = on_table && up >= FourRules::kLevel;
    bool support_ends = false;
    if (stands && !supported) support_begin = now;
    if (supported && !stands && now - support_begin >= kSupportTicks) {
      support_ends = true;
      out.Add(FourRules::kSupported, kNoEntity, object, {support_begin, now});
    }
    supported = stands;

    if (waiting && (grasp_begins || !touched)) {
      if (now - touch_begin >= kUnansweredTicks)
        out.Add(FourRules::kUnanswered, hand, object, {touch_begin, now});
      waiting = false;
    } else if (touched && !was_touched && !grasp_begins) {
      waiting = true;
      touch_begin = now;
    }
    was_touched = touched;

    if (lifting) {
      const bool near = (p_m - lift_p_m).norm() <= FourRules::kRegion_m;
      if ((was_near && !near) || !grasping) {
        out.Add(FourRules::kPickingUp, hand, object, {lift_begin, now});
        lifting = false;
      }
      was_near = near;
    } else if (support_ends && grasping) {
      lifting = was_near = true;
      lift_begin = now;
      lift_p_m = p_m;
    }
  }

  void Finish(int hand, int object, Tick end, Recognised& out) const {
    if (grasping) out.Add(FourRules::kGrasping, hand, object, {grasp_begin, end});
    if (supported && end - support_begin >= kSupportTicks)
      out.Add(FourRules::kSupported, kNoEntity, object, {support_begin, end});
    if (waiting && end - touch_begin >= kUnansweredTicks)
      out.Add(FourRules::kUnanswered, hand, object, {touch_begin, end});
    if (lifting) out.Add(FourRules::kPickingUp, hand, object, {lift_begin, end});
  }

  static constexpr int kNoEntity = grammar::kNoEntity;
};

}  // namespace

Watched WatchByHand(const ChangeLog& log, std::size_t warm_up) {
  const int objects = static_cast<int>(log.entity_table.entities.size() / 2);
  std::vector<Automaton> automata(static_cast<std::size_t>(objects));
  const auto of = [&](int entity) -> Automaton& {
    return automata[static_cast<std::size_t>(entity)];
  };
  Watched watched;
  Recognised& recognised = watched.recognised;
  Stopwatch watch;
  std::uint64_t events_before = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i == warm_up) {
      events_before = recognised.events;
      watch.Restart();
    }
    const grammar::FrameChanges frame = log[i];
    for (const grammar::EntityChange& change : frame.entities)
      of(change.entity - objects).p_m = change.look.p_WB_m;
    for (const grammar::HandSample& hand : frame.hands) of(hand.entity).trigger = hand.trigger;
    for (const grammar::Touch& touch : frame.touches) {
      if (touch.a >= objects) {
        of(touch.a - objects).on_table = true;
        of(touch.a - objects).up = touch.up_on_a;
      } else {
        of(touch.a).touched = true;
        of(touch.a).sets = touch.sensor_sets;
      }
    }
    for (const grammar::ContactEnd& contact_end : frame.contact_ends) {
      (contact_end.a >= objects ? of(contact_end.a - objects).on_table
                                : of(contact_end.a).touched) = false;
    }
    for (int k = 0; k < objects; ++k) of(k).Step(k, objects + k, frame.tick, recognised);
  }
  watched.seconds = watch.seconds();
  watched.events = recognised.events - events_before;
  for (int k = 0; k < objects; ++k) of(k).Finish(k, objects + k, log.end_tick(), recognised);
  return watched;
}

}  // namespace prehend::harness
