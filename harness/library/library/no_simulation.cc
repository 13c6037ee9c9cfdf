// SPDX-License-Identifier: Apache-2.0
// The library plays no scenario: it has no physics engine. OpenEpisodes() says so before anything
// comes here. Tested by tests/python/test_events.py
#include "physics/simulation.h"

namespace prehend::physics {

struct Simulation::State {
  Scene scene;
  Snapshot snapshot;
  RunStatus status = {.kind = RunStatus::Kind::kFailed,
                      .tick = 0,
                      .reason = "this library plays no scenario",
                      .advice = "record it with 'prehend run NAME --record x.episodes'"};
  std::vector<ScriptNote> notes;
};

Simulation::Simulation(Scene scene, Script) : state_(std::make_unique<State>()) {
  state_->scene = std::move(scene);
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
bool Simulation::Step() { return false; }
const Scene& Simulation::scene() const { return state_->scene; }
const Snapshot& Simulation::snapshot() const { return state_->snapshot; }
const RunStatus& Simulation::status() const { return state_->status; }
const std::vector<ScriptNote>& Simulation::notes() const { return state_->notes; }
std::uint64_t Simulation::state_hash() const { return 0; }

}  // namespace prehend::physics
