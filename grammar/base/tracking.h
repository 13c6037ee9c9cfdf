// SPDX-License-Identifier: Apache-2.0
// Not tracked is a value: a look of which nobody knows where its entity is. No condition that reads
// such a look holds, and neither does its opposite (docs/recording-format.md). Tested by
// tests/grammar/engine/tracking_test.cc
#pragma once

#include <cmath>
#include <limits>

#include "grammar/base/frame.h"

namespace prehend::grammar {

inline bool IsTracked(const EntitySample& look) { return !std::isnan(look.p_WB_m.x()); }

/// All that is measured of it is no number.
inline EntitySample NotTracked() {
  constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  EntitySample look;
  look.p_WB_m.setConstant(kNotKnown);
  look.q_WB.coeffs().setConstant(kNotKnown);
  look.v_WB_m_per_s.setConstant(kNotKnown);
  look.w_WB_rad_per_s.setConstant(kNotKnown);
  look.joint_position = look.joint_fraction = kNotKnown;
  return look;
}

}  // namespace prehend::grammar
