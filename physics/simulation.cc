// SPDX-License-Identifier: Apache-2.0
// One tick: script, trackers, persons, step, snapshot, hash, checks. Tested by
// tests/physics/simulation_test.cc
#include "physics/simulation.h"

#include <array>

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"
#include "physics/hand/hand_contacts.h"
#include "physics/hand/script_player.h"
#include "physics/motion/stage_clock.h"
#include "physics/motion/tracker.h"
#include "physics/person/person_player.h"
#include "physics/scene/run_limits.h"
#include "physics/scene/state_hash.h"

namespace prehend::physics {
namespace {

/// A longer run is a mistake in the script: half an hour of simulated time takes minutes and fills
/// memory.
constexpr double kMaxRun_s = 1800;

/// An arm that ends farther before its hand is noted.
constexpr double kNotedArm_m = 0.03;

std::unique_ptr<World> MakeWorld(const Scene& scene, const std::vector<int>& styles) {
  switch (scene.world.engine) {
    case Engine::kBox2d:
      return MakeBox2dWorld(scene, styles);
    case Engine::kBullet:
    case Engine::kBulletStock:
      break;
  }
  return MakeBulletWorld(scene, styles);
}

}  // namespace

struct Simulation::State {
  /// When an arm was farthest from the hand that it follows.
  struct ShortArm {
    std::int64_t tick = 0;
    double by_m = 0;
  };

  State(Scene s, Script t)
      : scene(std::move(s)),
        too_long(DurationOf(t) > kMaxRun_s),
        world(MakeWorld(scene, ScriptPlayer::FirstStyles(scene, t))),
        player(scene, std::move(t)) {
    AddTrackers();
    for (std::size_t i = 0; i < scene.persons.size(); ++i)
      persons.emplace_back(scene, player.script(), static_cast<int>(i));
    arms.resize(persons.size());
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
  void AddTrackers();
  std::vector<HandCommand> Tracked(std::vector<HandCommand> commands);
  void MovePersons();
  /// Remembers, and in the end notes, arms that are too short for where their hands go.
  void WatchArms();
  void NoteArms();
  void See();

  const Scene scene;
  const bool too_long;
  std::unique_ptr<World> world;
  ScriptPlayer player;
  std::vector<std::optional<Tracker>> trackers;  ///< per hand
  std::vector<PersonPlayer> persons;
  std::vector<std::array<ShortArm, 2>> arms;  ///< per person: right, left
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

void Simulation::State::WatchArms() {
  for (std::size_t i = 0; i < persons.size(); ++i) {
    for (const bool right : {true, false}) {
      ShortArm& arm = arms[i][right ? 0 : 1];
      const double by_m = persons[i].ArmIsShortBy(right);
      if (by_m > arm.by_m) arm = {snapshot.tick, by_m};
    }
  }
}

void Simulation::State::NoteArms() {
  for (std::size_t i = 0; i < persons.size(); ++i) {
    for (const bool right : {true, false}) {
      const ShortArm& arm = arms[i][right ? 0 : 1];
      const Person& person = scene.persons[i];
      if (arm.by_m > kNotedArm_m)
        player.AddNote({arm.tick, right ? person.right_hand : person.left_hand,
                        "it is out of reach: the arm of " + person.name + " ends " +
                            Millimetres(arm.by_m) +
                            " before it; let her stand nearer, walk, turn or lean"});
    }
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
    const auto hand = static_cast<std::size_t>(player.problem_hand());
    Fail(scene.hands[hand].name, player.problem(), "");
    return false;
  }
  if (!commands) {
    status = {.kind = RunStatus::Kind::kCompleted, .tick = snapshot.tick};
    NoteArms();
    return false;
  }
  MovePersons();
  world->Step(Tracked(*commands));
  world->Describe(snapshot);
  See();
  WatchArms();
  hash.Add(snapshot);
  if (auto problem = CheckSnapshot(scene, snapshot))
    Fail(problem->entity, problem->reason, problem->advice);
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
