// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/pid_test.cc
#include "physics/pid.h"

namespace prehend::physics {

Eigen::Vector3d VectorPid::Output(const Eigen::Vector3d& error, const Eigen::Vector3d& rate_error,
                                  double dt_s) {
  const Eigen::Vector3d output =
      gains_.proportional * error + gains_.derivative * rate_error + gains_.integral * integral_;
  const double size = output.norm();
  if (size > gains_.limit) return output * (gains_.limit / size);
  integral_ += error * dt_s;
  const double integral_output = gains_.integral * integral_.norm();
  const double most = gains_.integral_share * gains_.limit;
  if (integral_output > most) integral_ *= most / integral_output;
  return output;
}

}  // namespace prehend::physics
