// SPDX-License-Identifier: Apache-2.0
// One tick: script, trackers, persons, step, snapshot, hash, checks. Tested by
// tests/physics/simulation_test.cc, tests/physics/scene/check_scene_test.cc
#include "physics/simulation.h"

#include <algorithm>
#include <cmath>

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"
#include "physics/hand/script_player.h"
#include "physics/motion/stage_clock.h"
#include "physics/motion/tracker.h"
#include "physics/person/person_player.h"
#include "physics/scene/run_limits.h"
#include "physics/scene/snapshot.h"
#include "physics/step_watch.h"
#include "physics/world/mirrored_world.h"

namespace prehend::physics {
namespace {

constexpr double kUnit = 1e-6;  ///< how far a length may be from 1

bool IsUnit(const Eigen::Vector3d& v) { return std::abs(v.norm() - 1) < kUnit; }
bool IsPose(const Pose& X) {
  return X.p_m.allFinite() && std::abs(X.q.norm() - 1) < kUnit;  // false of what is not finite
}

template <typename Thing>
bool IsNoneOrBelow(Index<Thing> index, std::size_t size) {
  return index == kNone || index.IsBelow(size);
}

void CheckBody(const Body& body) {
  PREHEND_CHECK(IsPose(body.X_WB) && std::isfinite(body.mass_kg) && body.mass_kg >= 0);
  for (const PlacedShape& placed : body.shapes) PREHEND_CHECK(IsPose(placed.X_BS));
  PREHEND_CHECK(!body.grains || !body.grains->p_WG_m.empty());
}

void CheckJoint(const Joint& joint, std::size_t bodies) {
  PREHEND_CHECK(joint.body.IsBelow(bodies) && joint.base.IsBelow(bodies));
  PREHEND_CHECK(joint.body != joint.base);
  PREHEND_CHECK(joint.pivot_W_m.allFinite() && IsUnit(joint.axis_W));
  PREHEND_CHECK(joint.lower <= 0 && joint.upper >= 0);
}

void CheckModel(const HandModel& model) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const HandLink& link = model.links[i];
    PREHEND_CHECK(IsNoneOrBelow(link.parent, i));  // a parent comes before its links
    PREHEND_CHECK(IsUnit(link.direction) && IsUnit(link.joint_axis));
    PREHEND_CHECK(link.pivot_m.allFinite() && link.lower <= link.upper);
  }
  for (const GraspStyle& style : model.styles) {
    PREHEND_CHECK(style.frames.size() >= 2 && style.effort.size() == model.links.size());
    for (const auto& frame : style.frames) PREHEND_CHECK(frame.size() == model.links.size());
  }
}

bool IsSideOf(const Scene& scene, const ContactSide& side) {
  if (side.hand == kNone) return side.body.IsBelow(scene.bodies.size()) && side.link == kNone;
  return side.body == kNone && side.hand.IsBelow(scene.hands.size()) &&
         IsNoneOrBelow(side.link, scene.hand(side.hand).model.links.size());
}

/// A longer run is a mistake in the script: half an hour of simulated time takes minutes and fills
/// memory.
constexpr double kMaxRun_s = 1800;

std::unique_ptr<World> MakeWorld(const Scene& scene, const Script& script) {
  CheckScene(scene);
  const std::vector<int> styles = ScriptPlayer::FirstStyles(scene, script);
  switch (scene.world.engine) {
    case Engine::kBox2d:
      return MakeBox2dWorld(scene, styles);
    case Engine::kBullet:
      if (scene.world.planar || !LeftHandLeads(scene, script)) break;
      return MirrorImageOf(MakeBulletWorld(InMirror(scene), styles));
    case Engine::kBulletStock:
      break;
  }
  return MakeBulletWorld(scene, styles);
}

}  // namespace

struct Simulation::State {
  State(Scene s, Script t)
      : scene(std::move(s)),
        too_long(DurationOf(t) > kMaxRun_s),
        world(MakeWorld(scene, t)),
        player(scene, std::move(t)),
        watch(scene, player.script()),
        limits(scene) {
    AddTrackers();
    for (std::size_t i = 0; i < scene.persons.size(); ++i)
      persons.emplace_back(scene, player.script(), static_cast<int>(i));
    world->Describe(snapshot);
    See();
    if (too_long)
      Fail("", "the script is longer than half an hour",
           "split it, or shorten over_s and settle_s");
  }

  void Fail(std::string entity, std::string reason, std::string advice) {
    status = {RunStatus::Kind::kFailed, snapshot.tick, std::move(entity), std::move(reason),
              std::move(advice)};
  }
  bool Step();
  /// At the end: what the engine got wrong.
  void AddLimits() {
    for (ScriptNote& note : limits.Notes()) player.AddNote(std::move(note));
  }
  void AddTrackers();
  std::vector<HandCommand> Tracked(std::vector<HandCommand> commands);
  void MovePersons();
  void See();

  const Scene scene;
  const bool too_long;
  std::unique_ptr<World> world;
  ScriptPlayer player;
  std::vector<std::optional<Tracker>> trackers;  ///< per hand
  std::vector<PersonPlayer> persons;
  StepWatch watch;
  LimitWatch limits;
  Snapshot snapshot;
  RunStatus status;
  StateHash hash;
};

void Simulation::State::AddTrackers() {
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    const Hand& hand = scene.hands[i];
    std::optional<Tracker>& tracker = trackers.emplace_back();
    if (!hand.tracking) continue;
    // Every hand has its own seed, chosen so that the next scenario seed does not give one hand the
    // noise that another hand has now.
    const std::uint64_t seed = Random(scene.world.seed ^ Random(i).Next()).Next();
    tracker.emplace(*hand.tracking, scene.world.rate_hz, seed, TargetState{.X_WH = hand.X_WH});
  }
}

std::vector<HandCommand> Simulation::State::Tracked(std::vector<HandCommand> commands) {
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (trackers[i]) commands[i].target = trackers[i]->Follow(commands[i].target);
  }
  return commands;
}

void Simulation::State::MovePersons() {
  for (PersonPlayer& person : persons) {
    for (const BegunSteps& begun : player.begun())
      person.Begin(begun.stage, begun.steps, begun.person_steps, snapshot);
    person.Advance(snapshot, *world);
  }
}

void Simulation::State::See() {
  snapshot.gazes.clear();
  for (const PersonPlayer& person : persons) snapshot.gazes.push_back(person.See(*world));
}

bool Simulation::State::Step() {
  if (status.kind != RunStatus::Kind::kRunning) return false;
  const std::vector<HandCommand>* commands = player.Advance(snapshot);
  if (!player.problem().empty()) {
    const HandIndex hand = player.problem_hand();
    Fail(hand == kNone ? "" : scene.hand(hand).name, player.problem(), "");
    return false;
  }
  if (!commands) {
    status = {.kind = RunStatus::Kind::kCompleted, .tick = snapshot.tick};
    for (ScriptNote& note : watch.Notes()) player.AddNote(std::move(note));
    AddLimits();
    return false;
  }
  watch.Begin(player.begun(), snapshot);
  MovePersons();
  world->Step(Tracked(*commands));
  world->Describe(snapshot);
  for (std::size_t i = 0; i < persons.size(); ++i)
    AddContacts(scene.persons[i], persons[i].touches(), snapshot);
  See();
  watch.See(snapshot, persons);
  limits.See(snapshot);
  PREHEND_DCHECK(IsOf(scene, snapshot));
  hash.Add(snapshot);
  if (auto problem = CheckSnapshot(scene, snapshot)) {
    Fail(problem->entity, problem->reason, problem->advice);
    AddLimits();
  }
  return true;
}

Simulation::Simulation(Scene scene, Script script)
    : state_(std::make_unique<State>(std::move(scene), std::move(script))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

bool Simulation::Step() { return state_->Step(); }
const Scene& Simulation::scene() const { return state_->scene; }
const Snapshot& Simulation::snapshot() const { return state_->snapshot; }
const RunStatus& Simulation::status() const { return state_->status; }
const std::vector<ScriptNote>& Simulation::notes() const { return state_->player.notes(); }
std::uint64_t Simulation::state_hash() const { return state_->hash.value(); }

void CheckScene(const Scene& scene) {
  PREHEND_CHECK(scene.world.rate_hz > 0);
  for (const Body& body : scene.bodies) CheckBody(body);
  for (const Joint& joint : scene.joints) CheckJoint(joint, scene.bodies.size());
  for (const Hand& hand : scene.hands) {
    PREHEND_CHECK(IsPose(hand.X_WH));
    CheckModel(hand.model);
  }
  for (const Person& person : scene.persons) {
    PREHEND_CHECK(person.head.IsBelow(scene.bodies.size()) && IsPose(person.X_WS));
    PREHEND_CHECK(IsNoneOrBelow(person.right_hand, scene.hands.size()));
    PREHEND_CHECK(IsNoneOrBelow(person.left_hand, scene.hands.size()));
  }
}

bool IsOf(const Scene& scene, const Snapshot& snapshot) {
  for (const auto& contacts : snapshot.AllContacts())
    for (const ContactPoint& contact : contacts)
      if (!IsSideOf(scene, contact.a) || !IsSideOf(scene, contact.b)) return false;
  for (const GazeState& gaze : snapshot.gazes)
    if (!IsNoneOrBelow(gaze.body, scene.bodies.size()) ||
        !IsNoneOrBelow(gaze.hand, scene.hands.size()))
      return false;
  const auto fits = [](const Hand& hand, const HandState& now) {
    return now.joints.size() == hand.model.links.size() && now.X_WL.size() == now.joints.size();
  };
  return snapshot.bodies.size() == scene.bodies.size() &&
         snapshot.joints.size() == scene.joints.size() &&
         snapshot.gazes.size() == scene.persons.size() &&
         std::ranges::equal(scene.hands, snapshot.hands, fits);
}

}  // namespace prehend::physics
