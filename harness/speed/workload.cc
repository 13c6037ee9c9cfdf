// SPDX-License-Identifier: Apache-2.0
#include "harness/speed/workload.h"

#include <bit>
#include <cstdlib>
#include <random>
#include <vector>

#include "harness/sense/entity_table.h"
#include "harness/speed/stopwatch.h"

namespace prehend::harness {
namespace {

using grammar::Tick;

constexpr const char* kRules = R"(
grammar four_rules

event grasping(hand: Hand, object: Movable)
  while trigger(hand) >= 0.3 and sensor_sets(hand, object) >= 2

event supported(object: Movable, support: Thing)
  while touching(object, support) and up(object, support) >= 0.5
  lasting 100 ms

event unanswered(hand: Hand, object: Movable)
  from touching(hand, object) begins to grasping(hand, object) begins
  during touching(hand, object)
  lasting 500 ms

event picking_up(hand: Hand, object: Movable)
  from supported(object, any) ends
  to not in_sphere(position(object), position(object)@begin, 9 cm) begins
  during grasping(hand, object)
)";

constexpr double kGripOn = 0.3;
constexpr double kLevel = 0.5;
constexpr double kRegion_m = 0.09;
constexpr Tick kRate_hz = 240;
constexpr Tick kSupportTicks = 24;      // 100 ms
constexpr Tick kUnansweredTicks = 120;  // 500 ms

grammar::EntityTable MakeEntityTable(int objects) {
  grammar::EntityTable entity_table{.ticks_per_second = kRate_hz};
  for (int i = 0; i < objects; ++i)
    entity_table.entities.push_back(
        {.name = "hand" + std::to_string(i), .classes = {"Hand", "Entity"}});
  for (int i = 0; i < objects; ++i) {
    entity_table.entities.push_back(
        {.name = "object" + std::to_string(i), .classes = {"Movable", "Thing", "Entity"}});
  }
  entity_table.entities.push_back({.name = "table", .classes = {"Fixed", "Thing", "Entity"}});
  return entity_table;
}

// A hand that takes an object, holds it up and puts it back: when each step is due, in frames from
// the touch.
struct Visit {
  int grip = 0, lift = 0, lower = 0, release = 0, leave = 0;
};
constexpr int kRiseFrames = 24;
constexpr int kLongestVisit = 400;
constexpr double kRise_m = 0.24;

class Stations {
 public:
  Stations(int objects, double period_s, std::uint64_t seed)
      : objects_(objects),
        period_(static_cast<int>(period_s * static_cast<double>(kRate_hz))),
        random_(seed) {
    log.entity_table = MakeEntityTable(objects);
    visits_.resize(static_cast<std::size_t>(objects));
    // agenda_[frame % period]: who does something then; every visit is over before its period is.
    for (int i = 0; i < objects; ++i) {
      starts_.push_back(
          1 + static_cast<int>(random_() % static_cast<unsigned>(period_ - kLongestVisit)));
    }
    agenda_.resize(static_cast<std::size_t>(period_));
    for (int i = 0; i < objects; ++i) PlanVisit(i);
  }

  void Play(int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      log.Begin(frame);
      if (frame == 0) {
        for (int i = 0; i < objects_; ++i) Settle(i);
      }
      for (const auto [object, step] : agenda_[static_cast<std::size_t>(frame % period_)])
        Act(object, step);
    }
  }

  ChangeLog log;

 private:
  void PlanVisit(int i) {
    Visit& visit = visits_[static_cast<std::size_t>(i)];
    const auto upto = [&](int most) {
      return 1 + static_cast<int>(random_() % static_cast<unsigned>(most));
    };
    visit.grip = upto(180);  // now and then too late
    visit.lift = visit.grip + upto(20);
    visit.lower = visit.lift + kRiseFrames + upto(60);
    visit.release = visit.lower + kRiseFrames + upto(20);
    visit.leave = visit.release + upto(20);
    for (int step = 0; step <= visit.leave; ++step) {
      const bool moves = (step > visit.lift && step <= visit.lift + kRiseFrames) ||
                         (step > visit.lower && step <= visit.lower + kRiseFrames);
      const bool acts = step == 0 || step == visit.grip || step == visit.lift ||
                        step == visit.release || step == visit.leave;
      if (!moves && !acts) continue;
      agenda_[static_cast<std::size_t>((starts_[static_cast<std::size_t>(i)] + step) % period_)]
          .push_back({i, step});
    }
  }

  void Settle(int i) {
    log.Add(grammar::Touch{.a = objects_ + i, .b = 2 * objects_, .up_on_a = 1, .up_on_b = -1});
  }
  void Feel(int i, std::uint32_t sets) {
    log.Add(grammar::Touch{.a = i, .b = objects_ + i, .sensor_sets = sets});
  }
  void Grip(int i, double trigger) {
    log.Add(grammar::HandSample{.entity = i, .trigger = trigger});
  }

  void Act(int i, int step) {
    const Visit& visit = visits_[static_cast<std::size_t>(i)];
    if (step == 0) {
      Feel(i, 1);
    } else if (step == visit.grip) {
      Feel(i, 7);
      Grip(i, 1);
    } else if (step == visit.lift) {
      log.Add(grammar::ContactEnd{objects_ + i, 2 * objects_});
    } else if (step == visit.release) {
      Feel(i, 1);
      Grip(i, 0);
    } else if (step == visit.leave) {
      log.Add(grammar::ContactEnd{i, objects_ + i});
    } else {
      const bool rises = step <= visit.lift + kRiseFrames;
      const int way = rises ? step - visit.lift : visit.lower + kRiseFrames - step;
      grammar::EntityChange change{.entity = objects_ + i};
      change.look.p_WB_m.z() = kRise_m * way / kRiseFrames;
      log.Add(change);
      if (way == 0) Settle(i);
    }
  }

  struct Due {
    int object = 0;
    int step = 0;
  };
  int objects_;
  int period_;
  std::mt19937_64 random_;
  std::vector<Visit> visits_;
  std::vector<int> starts_;
  std::vector<std::vector<Due>> agenda_;
};

enum RuleNumber { kGrasping, kSupported, kUnanswered, kPickingUp };

// The four rules for one object, looked at in each frame.
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
    const bool grasps = touched && trigger >= kGripOn && std::popcount(sets) >= 2;
    const bool grasp_begins = grasps && !grasping;
    if (grasp_begins) grasp_begin = now;
    if (grasping && !grasps) out.Add(kGrasping, hand, object, {grasp_begin, now});
    grasping = grasps;

    const bool stands = on_table && up >= kLevel;
    bool support_ends = false;
    if (stands && !supported) support_begin = now;
    if (supported && !stands && now - support_begin >= kSupportTicks) {
      support_ends = true;
      out.Add(kSupported, kNoEntity, object, {support_begin, now});
    }
    supported = stands;

    if (waiting && (grasp_begins || !touched)) {
      if (now - touch_begin >= kUnansweredTicks)
        out.Add(kUnanswered, hand, object, {touch_begin, now});
      waiting = false;
    } else if (touched && !was_touched && !grasp_begins) {
      waiting = true;
      touch_begin = now;
    }
    was_touched = touched;

    if (lifting) {
      const bool near = (p_m - lift_p_m).norm() <= kRegion_m;
      if ((was_near && !near) || !grasping) {
        out.Add(kPickingUp, hand, object, {lift_begin, now});
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
    if (grasping) out.Add(kGrasping, hand, object, {grasp_begin, end});
    if (supported && end - support_begin >= kSupportTicks)
      out.Add(kSupported, kNoEntity, object, {support_begin, end});
    if (waiting && end - touch_begin >= kUnansweredTicks)
      out.Add(kUnanswered, hand, object, {touch_begin, end});
    if (lifting) out.Add(kPickingUp, hand, object, {lift_begin, end});
  }

  static constexpr int kNoEntity = grammar::kNoEntity;
};

}  // namespace

std::shared_ptr<const grammar::Program> CompileFourRules() {
  return grammar::Compile({"four_rules", kRules}, nullptr).program;
}

ChangeLog MakeStations(int objects, int frames, double period_s, std::uint64_t seed) {
  Stations stations(objects, period_s, seed);
  stations.Play(frames);
  return std::move(stations.log);
}

ChangeLog MakeFlicker(int objects, int frames, int per_frame, Flicker flicker) {
  ChangeLog log;
  log.entity_table = MakeEntityTable(objects);
  int next = 0;
  std::vector<bool> pressed(static_cast<std::size_t>(objects));
  for (int frame = 0; frame < frames; ++frame) {
    log.Begin(frame);
    for (int i = 0; frame == 0 && i < objects; ++i) {
      log.Add(grammar::HandSample{.entity = i, .trigger = flicker == Flicker::kFact ? 0.0 : 1.0});
      log.Add(grammar::Touch{.a = i, .b = objects + i, .sensor_sets = 1});
    }
    for (int k = 0; frame > 0 && k < per_frame; ++k, next = (next + 1) % objects) {
      const auto i = static_cast<std::size_t>(next);
      pressed[i] = !pressed[i];
      const std::uint32_t sets = !pressed[i] ? 1 : flicker == Flicker::kPressure ? 2 : 3;
      log.Add(grammar::Touch{.a = next, .b = objects + next, .sensor_sets = sets});
    }
  }
  return log;
}

void Recognised::Add(int rule, int hand, int object, grammar::Interval interval) {
  ++events;
  std::uint64_t mixed = 0;
  for (const std::int64_t value : {std::int64_t{rule}, std::int64_t{hand}, std::int64_t{object},
                                   interval.begin, interval.end}) {
    mixed = (mixed ^ static_cast<std::uint64_t>(value + 7)) * 0x9E3779B97F4A7C15ULL;
    mixed ^= mixed >> 29;
  }
  hash += mixed;
}

Watched WatchByGrammar(const ChangeLog& log, grammar::Monitor& monitor, std::size_t warm_up) {
  Watched watched;
  Recognised& recognised = watched.recognised;
  Stopwatch watch;
  std::uint64_t events_before = 0;
  std::vector<grammar::Event> events;
  const auto take = [&] {
    for (const grammar::Event& event : events) {
      // Rules are numbered in the order of the text, after `touching`; supported(object, support)
      // has no hand.
      const int rule = event.rule - 1;
      const bool has_hand = rule != kSupported;
      recognised.Add(rule, has_hand ? event.roles[0] : grammar::kNoEntity,
                     event.roles[has_hand ? 1 : 0], event.interval);
    }
    events.clear();
  };
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i == warm_up) {
      events_before = recognised.events;
      watch.Restart();
    }
    monitor.AdvanceBy(log[i], events);
    if (!events.empty()) take();
  }
  watched.seconds = watch.seconds();
  watched.events = recognised.events - events_before;
  monitor.Finish(log.end_tick(), events);
  take();
  return watched;
}

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
