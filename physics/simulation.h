// SPDX-License-Identifier: Apache-2.0
// A Scene and a Script, stepped tick by tick. A run that goes wrong ends as a value, not as an
// exception. Tested by tests/physics/simulation_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "physics/hand/script_player.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

struct RunStatus {
  enum class Kind { kRunning, kCompleted, kFailed };
  Kind kind = Kind::kRunning;
  std::int64_t tick = 0;  ///< at which the run ended
  std::string entity;     ///< the cause; empty unless failed
  std::string reason;     ///< non-finite state, runaway speed, deep penetration, out of the world
  std::string advice;
};

class Simulation {
 public:
  Simulation(Scene scene, Script script);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  /// Advances one tick. False if the run is over: then nothing was stepped, and status() gives the
  /// reason.
  bool Step();

  const Scene& scene() const;
  const Snapshot& snapshot() const;
  const RunStatus& status() const;
  /// Remarks on steps that the hands executed but perhaps not as intended.
  const std::vector<ScriptNote>& notes() const;
  /// FNV-1a over every pose, velocity and joint of every tick so far.
  std::uint64_t state_hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Once per run: indices are those of bodies, hands and links that exist, numbers are finite,
/// quaternions and axes have unit length, and lists have one element for each link or style.
void CheckScene(const Scene& scene);

/// Whether a snapshot has one state for each body, joint, hand and link, and its contacts and gazes
/// are of these. For PREHEND_DCHECK: it costs as much as the contacts are many.
bool IsOf(const Scene& scene, const Snapshot& snapshot);

}  // namespace prehend::physics
