// SPDX-License-Identifier: Apache-2.0
// One tick: script, trackers, persons, step, snapshot, hash, checks. Tested by
// tests/physics/simulation_test.cc
#include "physics/simulation.h"

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"
#include "physics/hand/script_player.h"
#include "physics/motion/stage_clock.h"
#include "physics/motion/tracker.h"
#include "physics/person/person_player.h"
#include "physics/scene/check_scene.h"
#include "physics/scene/mirror_image.h"
#include "physics/scene/run_limits.h"
#include "physics/scene/snapshot.h"
#include "physics/step_watch.h"
#include "physics/world/mirrored_world.h"

namespace prehend::physics {
namespace {

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

}  // namespace prehend::physics
