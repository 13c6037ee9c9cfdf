// SPDX-License-Identifier: Apache-2.0
// Rules rest while their entities are too far apart for them. The opposite of the opposite of a
// condition holds at the same frames and never lets a rule rest so; both must give the same events,
// decided at the same frames, whatever moves, turns, jumps or is lost.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/solid.h"
#include "grammar/monitor.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

constexpr int kEntities = 5;  // one hand, three things, one of them of two parts, and a ball

EntityTable Room() {
  EntityTable room{.ticks_per_second = 1000};
  const std::vector<std::string> thing = {"Movable", "Thing", "Entity"};
  room.entities = {{.name = "hand", .classes = {"Hand", "Entity"}},
                   {.name = "box", .classes = thing},
                   {.name = "rack", .classes = thing},
                   {.name = "can", .classes = thing},
                   {.name = "ball", .classes = thing}};
  for (EntityInfo& entity : room.entities) entity.half_size_m = {0.05, 0.08, 0.1};
  room.entities[1].p_BC_m = {0.02, 0, 0.03};
  room.entities[2].solid = Solid({{.shape = Box{{0.2, 0.02, 0.05}}, .p_BS_m = {0, 0.1, 0}},
                                  {.shape = Box{{0.05, 0.05, 0.01}}, .p_BS_m = {0, -0.1, 0.2}}});
  room.entities[3].solid = Solid({{.shape = Cylinder{.radius_m = 0.04, .half_length_m = 0.1}}});
  room.entities[4].round = true;
  return room;
}

// Things walk about, slowly and fast, tremble, stand still, turn and tip over.
class Walk {
 public:
  explicit Walk(unsigned seed) : random_(seed), looks_(kEntities), speeds_(kEntities, 0.01) {
    for (EntitySample& look : looks_) look.p_WB_m = Step(0.25);
  }

  /// Fingers open and close now and then.
  HandSample Hand() {
    if (random_() % 60 == 0) finger_ = Step(0.1);
    const EntitySample& look = shown_[0];
    spheres_ = {{look.p_WB_m, 0.02}, {look.p_WB_m + look.q_WB * finger_, 0.01}};
    return {.entity = 0, .collision_spheres = spheres_};
  }

  const std::vector<EntitySample>& Next() {
    shown_.clear();
    for (int i = 0; i < kEntities; ++i) {
      if (random_() % 40 == 0) speeds_[i] = kSpeeds[random_() % std::size(kSpeeds)];
      looks_[i].p_WB_m += Step(speeds_[i]);
      looks_[i].p_WB_m = looks_[i].p_WB_m.cwiseMax(-0.25).cwiseMin(0.25);
      const Eigen::Vector3d turn = Step(3 * speeds_[i]);
      looks_[i].q_WB =
          (Eigen::AngleAxisd(turn.norm(), turn.normalized()) * looks_[i].q_WB).normalized();
      if (random_() % 50 == 0) looks_[i].q_WB = Eigen::Quaterniond::Identity();
      lost_[i] = lost_[i] ? random_() % 5 != 0 : random_() % 80 == 0;
      shown_.push_back(lost_[i] ? NotTracked() : looks_[i]);
    }
    return shown_;
  }

 private:
  static constexpr double kSpeeds[] = {1e-6, 0.0005, 0.002, 0.02, 0.1};

  Eigen::Vector3d Step(double most) {
    std::uniform_real_distribution<double> way(-most, most);
    const double x = way(random_), y = way(random_);
    return {x, y, way(random_)};
  }

  std::mt19937 random_;
  std::vector<EntitySample> looks_, shown_;
  std::vector<double> speeds_;
  Eigen::Vector3d finger_ = {0, 0, 0.1};
  std::vector<CollisionSphere> spheres_;
  bool lost_[kEntities] = {};
};

struct Found {
  std::array<int, 4> roles;
  Tick begin, end, decided;
  bool operator==(const Found&) const = default;
};

void ExpectTheSame(const std::string& condition, const std::string& form) {
  const bool is_of_hands = condition.find("gap") != std::string::npos;
  const std::string head = is_of_hands ? "(a: Hand, b: Thing) " : "(a: Entity, b: Thing) ";
  const std::string opposite = "not (not (" + condition + "))";
  const auto put = [&](const std::string& what) {
    std::string text = form;
    return text.replace(text.find('@'), 1, what);
  };
  const auto program = testing::CompileText(
      "grammar t\ncondition fast(a: Entity) while speed(a) > 10 m/s\nevent rests" + head +
      put(condition) + "\nevent awake" + head + put(opposite) + "\n");
  ASSERT_TRUE(program);
  std::size_t events = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const EntityTable room = Room();
    Monitor monitor(program, room);
    Walk walk(seed);
    std::vector<Event> out;
    for (Tick tick = 0; tick < 400; ++tick) {
      std::vector<EntitySample> looks = walk.Next();
      looks[0].v_WB_m_per_s.x() = tick % 17 == 0 ? 20 : 0;
      const HandSample hand = walk.Hand();
      monitor.Advance({.tick = 10 * tick, .entities = looks, .hands = {&hand, 1}}, out);
    }
    monitor.Finish(4000, out);
    ASSERT_EQ(monitor.error(), "");
    std::vector<Found> found[2];
    for (const Event& event : out)
      found[program->rules[event.rule].name == "rests" ? 0 : 1].push_back(
          {event.roles, event.interval.begin, event.interval.end, event.decided});
    EXPECT_TRUE(found[0] == found[1]) << form << " of " << condition << ", seed " << seed;
    events += found[0].size();
  }
  EXPECT_GT(events, 10u) << form << " of " << condition;
}

TEST(FarApart, WhoRestsMissesNothing) {
  for (const std::string condition :
       {"distance(a, b) < 25 cm", "distance(a, b) <= 0.25 m", "in_sphere(b, position(a), 10 cm)",
        "in_sphere(position(a), position(b), 0.3 m)", "inside(a, b)", "inside(b, a)",
        "abs(clearance(a, b)) <= 5 cm", "abs(clearance(b, a)) < 3 cm",
        "distance(a, b) < 30 cm or abs(clearance(a, b)) <= 5 cm",
        "height(a) > -1 m and (inside(a, b) or in_sphere(b, position(a), 10 cm))",
        "speed(b, 60 ms) > 1 cm/s and distance(a, b) < 30 cm", "gap(a, b) <= 4 cm",
        "gap(a, b) < 10 cm and distance(a, b) < 40 cm"}) {
    const bool is_of_entities = condition.find("clearance") == std::string::npos;
    for (const std::string form : {"while @", "while @ bridging 50 ms lasting 20 ms",
                                   "while @ until distance(a, b) > 50 cm"})
      ExpectTheSame(condition, form);
    if (is_of_entities) ExpectTheSame(condition, "until fast(a) begins since @ at most 0.2 s back");
  }
}

}  // namespace
}  // namespace prehend::grammar
