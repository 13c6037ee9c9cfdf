// SPDX-License-Identifier: Apache-2.0
#include "bench/yardsticks/four_automata.h"

#include <bit>
#include <vector>

#include "bench/yardsticks/worlds.h"
#include "harness/measure/speed/measure.h"

namespace prehend::bench {
namespace {

using grammar::Tick;

constexpr Tick kSupportTicks = FourRules::kSupport_ms * kWorldRate_hz / 1000;
constexpr Tick kUnansweredTicks = FourRules::kUnanswered_ms * kWorldRate_hz / 1000;

// The four rules for one object. To evaluate it again in a frame that says nothing about the object
// changes nothing.
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

class Automata {
 public:
  explicit Automata(int objects)
      : objects_(objects), automata_(static_cast<std::size_t>(objects)) {}

  /// What a frame says; calls changed(object) for each that it says something about, perhaps again.
  template <typename Changed>
  void Take(const grammar::FrameChanges& frame, const Changed& changed) {
    const auto of = [&](int object) -> Automaton& {
      changed(object);
      return automata_[static_cast<std::size_t>(object)];
    };
    for (const grammar::EntityChange& change : frame.entities)
      of(change.entity - objects_).p_m = change.look.p_WB_m;
    for (const grammar::HandSample& hand : frame.hands) of(hand.entity).trigger = hand.trigger;
    for (const grammar::Touch& touch : frame.touches) {
      if (touch.a >= objects_) {
        Automaton& automaton = of(touch.a - objects_);
        automaton.on_table = true;
        automaton.up = touch.up_on_a;
      } else {
        Automaton& automaton = of(touch.a);
        automaton.touched = true;
        automaton.sets = touch.sensor_sets;
      }
    }
    for (const grammar::ContactEnd& contact_end : frame.contact_ends) {
      if (contact_end.a >= objects_) {
        of(contact_end.a - objects_).on_table = false;
      } else {
        of(contact_end.a).touched = false;
      }
    }
  }
  void Step(int object, Tick now, Recognised& out) {
    automata_[static_cast<std::size_t>(object)].Step(object, objects_ + object, now, out);
  }
  void Finish(Tick end, Recognised& out) const {
    for (int k = 0; k < objects_; ++k)
      automata_[static_cast<std::size_t>(k)].Finish(k, objects_ + k, end, out);
  }

 private:
  int objects_ = 0;
  std::vector<Automaton> automata_;
};

}  // namespace

Watched WatchByHand(const ChangeLog& log, ByHand by_hand, std::size_t warm_up) {
  const int objects = static_cast<int>(log.entity_table.entities.size() / 2);
  Automata automata(objects);
  std::vector<int> changed;
  Watched watched;
  Recognised& recognised = watched.recognised;
  measure::Stopwatch watch;
  std::uint64_t events_before = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i == warm_up) {
      events_before = recognised.events;
      watch.Restart();
    }
    const grammar::FrameChanges frame = log[i];
    if (by_hand == ByHand::kEveryFrame) {
      automata.Take(frame, [](int) {});
      for (int k = 0; k < objects; ++k) automata.Step(k, frame.tick, recognised);
    } else {
      changed.clear();
      automata.Take(frame, [&](int object) { changed.push_back(object); });
      for (const int k : changed) automata.Step(k, frame.tick, recognised);
    }
  }
  watched.seconds = watch.seconds();
  watched.events = recognised.events - events_before;
  automata.Finish(log.end_tick(), recognised);
  return watched;
}

}  // namespace prehend::bench
