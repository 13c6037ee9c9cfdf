// SPDX-License-Identifier: Apache-2.0
// The PID of a vector quantity with a limited output: pulls the palm to the tracked target.
// The integral's part is at most a share of the limit and frozen while the output is saturated, so
// that a hand that was held back does not shoot off when it comes free. Tested by
// tests/physics/pid_test.cc
#pragma once

#include "physics/hand_model.h"

namespace prehend::physics {

class VectorPid {
 public:
  explicit VectorPid(const PidGains& gains) : gains_(gains) {}

  /// Force or torque for this tick. `error`: target minus value; `rate_error`: target's rate minus
  /// the value's.
  Eigen::Vector3d Output(const Eigen::Vector3d& error, const Eigen::Vector3d& rate_error,
                         double dt_s);

 private:
  PidGains gains_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
};

}  // namespace prehend::physics
