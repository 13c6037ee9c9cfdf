// SPDX-License-Identifier: Apache-2.0
// The output is clamped by its norm. Tested by tests/physics/hand/pid_test.cc
#include "physics/hand/pid.h"

namespace prehend::physics {

/// An output that fades does so with this time constant.
constexpr double kFades_s = 0.05;

Eigen::Vector3d VectorPid::Output(const Eigen::Vector3d& error, const Eigen::Vector3d& rate_error,
                                  double dt_s, bool fades) {
  const Eigen::Vector3d output =
      gains_.proportional * error + gains_.derivative * rate_error + gains_.integral * integral_;
  const double size = output.norm();
  if (size > gains_.limit) return output * (gains_.limit / size);
  integral_ += error * dt_s;
  if (fades && gains_.integral > 0)
    integral_ -= (gains_.proportional / gains_.integral * error + integral_) * (dt_s / kFades_s);
  const double integral_output = gains_.integral * integral_.norm();
  const double most = gains_.integral_share * gains_.limit;
  if (integral_output > most) integral_ *= most / integral_output;
  return output;
}

Wrench PalmPids::Output(const BodyState& palm, const TargetState& target, double dt_s,
                        bool lets_go) {
  const Pose& X_WH = palm.X_WB;
  return {translation_.Output(target.X_WH.p_m - X_WH.p_m, target.v_m_per_s - palm.v_WB_m_per_s,
                              dt_s, lets_go),
          rotation_.Output(RotationVector(target.X_WH.q * X_WH.q.conjugate()),
                           target.w_rad_per_s - palm.w_WB_rad_per_s, dt_s, lets_go)};
}

}  // namespace prehend::physics
