// SPDX-License-Identifier: Apache-2.0
#include "bench/yardsticks/worlds.h"

#include <random>
#include <vector>

namespace prehend::bench {
namespace {

grammar::EntityTable MakeEntityTable(int objects) {
  grammar::EntityTable entity_table{.ticks_per_second = kWorldRate_hz};
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

// A hand picks up an object, holds it and puts it back: the frame of each step, counted from the
// touch.
struct Visit {
  int grip = 0, lift = 0, lower = 0, release = 0, leave = 0;
};
constexpr int kRiseFrames = 24;
constexpr int kMaxVisitTicks = 400;
constexpr double kRise_m = 0.24;

class Stations {
 public:
  Stations(int objects, double period_s, std::uint64_t seed)
      : objects_(objects),
        period_(static_cast<int>(period_s * static_cast<double>(kWorldRate_hz))),
        random_(seed) {
    log.entity_table = MakeEntityTable(objects);
    visits_.resize(static_cast<std::size_t>(objects));
    // agenda_[frame % period]: which hands act then; a visit is shorter than its period.
    for (int i = 0; i < objects; ++i) {
      starts_.push_back(
          1 + static_cast<int>(random_() % static_cast<unsigned>(period_ - kMaxVisitTicks)));
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
    visit.grip = upto(180);  // sometimes too late
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

}  // namespace

ChangeLog MakeStations(int objects, int frames, double period_s, std::uint64_t seed) {
  Stations stations(objects, period_s, seed);
  stations.Play(frames);
  return std::move(stations.log);
}

ChangeLog LeaveOutEmptyFrames(const ChangeLog& log) {
  ChangeLog rest;
  rest.entity_table = log.entity_table;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const grammar::FrameChanges frame = log[i];
    const bool brings_nothing = frame.entities.empty() && frame.hands.empty() &&
                                frame.touches.empty() && frame.contact_ends.empty();
    if (brings_nothing && i + 1 < log.size()) continue;
    rest.Begin(frame.tick);
    const auto add = [&](const auto& changes) {
      for (const auto& change : changes) rest.Add(change);
    };
    add(frame.entities);
    add(frame.hands);
    add(frame.touches);
    add(frame.contact_ends);
  }
  return rest;
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

}  // namespace prehend::bench
