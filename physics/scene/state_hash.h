// SPDX-License-Identifier: Apache-2.0
// FNV-1a over 64-bit words, with a shift so that high bits influence low ones: a hash of the bits
// of poses, velocities and joints. Equal hashes mean equal motion. A sleeping body is skipped: it
// was hashed when it last moved. Tested by tests/physics/simulation_test.cc
#pragma once

#include <bit>
#include <cstdint>

#include "physics/scene/snapshot.h"

namespace prehend::physics {

class StateHash {
 public:
  void Add(const double* values, Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i) Add(std::bit_cast<std::uint64_t>(values[i]));
  }
  void Add(std::uint64_t word) {
    value_ = (value_ ^ word) * 1099511628211ULL;
    value_ ^= value_ >> 32;
  }
  void Add(const BodyState& state) {
    Add(state.X_WB.p_m.data(), 3);
    Add(state.X_WB.q.coeffs().data(), 4);
    Add(state.v_WB_m_per_s.data(), 3);
    Add(state.w_WB_rad_per_s.data(), 3);
  }
  void Add(const HandState& hand) {
    Add(hand.palm);
    Add(hand.joints.data(), static_cast<Eigen::Index>(hand.joints.size()));
  }
  void Add(const Snapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
      if (snapshot.bodies[i].asleep) continue;
      Add(std::uint64_t{i});
      Add(snapshot.bodies[i]);
    }
    for (const Eigen::Vector3d& grain : snapshot.grains) Add(grain.data(), 3);
    for (const JointState& joint : snapshot.joints) Add(&joint.position, 1);
    for (const GazeState& gaze : snapshot.gazes) Add(gaze.toward_W.data(), 3);
    for (const HandState& hand : snapshot.hands) Add(hand);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ULL;
};

}  // namespace prehend::physics
