// SPDX-License-Identifier: Apache-2.0
// FNV-1a, 64 bit, over the bits of poses, velocities and joints: equal hashes mean equal motion.
// Tested by tests/physics/simulation_test.cc
#pragma once

#include <cstdint>
#include <cstring>

#include "physics/snapshot.h"

namespace prehend::physics {

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
  void Add(const HandState& hand) {
    Add(hand.palm);
    Add(hand.joints_rad.data(), static_cast<Eigen::Index>(hand.joints_rad.size()));
  }
  void Add(const Snapshot& snapshot) {
    for (const BodyState& body : snapshot.bodies) Add(body);
    for (const HandState& hand : snapshot.hands) Add(hand);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ULL;
};

}  // namespace prehend::physics
