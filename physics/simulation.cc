// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/simulation_test.cc
#include "physics/simulation.h"

#include <cstring>

#include "physics/bullet_world.h"
#include "physics/run_checks.h"
#include "physics/script_player.h"

namespace prehend::physics {
namespace {

/// Longer runs are a mistake in a script: half an hour of simulated time takes minutes and fills
/// memory.
constexpr double kLongestRun_s = 1800;

/// FNV-1a, 64 bit.
class StateHash {
 public:
  void Add(const double* values, Eigen::Index count) {
    unsigned char bytes[sizeof(double)];
    for (Eigen::Index i = 0; i < count; ++i) {
      std::memcpy(bytes, values + i, sizeof(double));
      for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 1099511628211ULL;
    }
  }
  void Add(const BodyState& state) {
    Add(state.X_WB.p_m.data(), 3);
    Add(state.X_WB.q.coeffs().data(), 4);
    Add(state.v_WB_m_per_s.data(), 3);
    Add(state.w_WB_rad_per_s.data(), 3);
  }
  void Add(const Snapshot& snapshot) {
    for (const BodyState& body : snapshot.bodies) Add(body);
    for (const JointState& joint : snapshot.joints) Add(&joint.position, 1);
    for (const HandState& hand : snapshot.hands) {
      Add(hand.palm);
      Add(hand.joints_rad.data(), static_cast<Eigen::Index>(hand.joints_rad.size()));
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ULL;
};

}  // namespace

struct Simulation::State {
  State(Scene s, Script t)
      : scene(std::move(s)),
        too_long(DurationOf(t) > kLongestRun_s),
        world(MakeBulletWorld(scene, ScriptPlayer::FirstStyles(scene, t))),
        player(scene, std::move(t)) {
    world->Describe(snapshot);
    if (too_long)
      Fail("", "the script is longer than half an hour",
           "split it, or shorten over_s and settle_s");
  }

  void Fail(std::string entity, std::string reason, std::string advice) {
    status = {RunStatus::Kind::kFailed, snapshot.tick, std::move(entity), std::move(reason),
              std::move(advice)};
  }
  bool Step();

  const Scene scene;
  const bool too_long;
  std::unique_ptr<World> world;
  ScriptPlayer player;
  Snapshot snapshot;
  RunStatus status;
  StateHash hash;
};

bool Simulation::State::Step() {
  if (status.kind != RunStatus::Kind::kRunning) return false;
  const std::vector<HandCommand>* commands = player.Advance(snapshot);
  if (!player.problem().empty()) {
    const auto hand = static_cast<std::size_t>(player.problem_hand());
    Fail(scene.hands[hand].name, player.problem(),
         "name an entity of the scenario and a style of the hand file");
    return false;
  }
  if (!commands) {
    status = {.kind = RunStatus::Kind::kCompleted, .tick = snapshot.tick};
    return false;
  }
  world->Step(*commands);
  world->Describe(snapshot);
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
std::uint64_t Simulation::state_hash() const { return state_->hash.value(); }

}  // namespace prehend::physics
