// SPDX-License-Identifier: Apache-2.0
// A PID of a vector quantity with limited output; it pulls the palm to the tracked target. The
// integral term is at most a share of the limit and is frozen while the output is saturated
// (anti-windup), so that a hand that was held back does not overshoot when it is released. Tested
// by tests/physics/hand/pid_test.cc
#pragma once

#include "physics/motion/trajectory.h"
#include "physics/scene/hand_model.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class VectorPid {
 public:
  explicit VectorPid(const PidGains& gains) : gains_(gains) {}

  /// Force or torque for this tick. `error` is target minus value, `rate_error` is target rate
  /// minus value rate. `fades`: what balances an error fades away.
  Eigen::Vector3d Output(const Eigen::Vector3d& error, const Eigen::Vector3d& rate_error,
                         double dt_s, bool fades = false);

 private:
  PidGains gains_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
};

struct Wrench {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();
};

/// The two PIDs of a palm. Their output acts at the palm's centre, in world axes.
class PalmPids {
 public:
  explicit PalmPids(const HandModel& model)
      : translation_(model.translation), rotation_(model.rotation) {}

  /// `lets_go`: of a hand that is to stay where it is when its fingers hold it no longer.
  Wrench Output(const BodyState& palm, const TargetState& target, double dt_s,
                bool lets_go = false);

 private:
  VectorPid translation_, rotation_;
};

}  // namespace prehend::physics
