// SPDX-License-Identifier: Apache-2.0
// Friction of one contact is limited by a circle in the contact plane, not by a square along two
// axes: it opposes sliding in any direction equally. Source of the law: maximum dissipation, D.
// Stewart, "Rigid-Body Dynamics with Friction and Impact", SIAM Review 42(1), 2000, section 2.1.
// Tested by tests/physics/bullet/friction_circle_test.cc
#pragma once

#include <LinearMath/btScalar.h>

namespace prehend::physics {

/// Values of the two friction rows of a contact, along perpendicular directions.
struct RowPair {
  btScalar first = 0, second = 0;
};

/// Change of speed by a unit impulse, along the two directions that do not act on each other.
/// Computed once per tick.
class PrincipalResponse {
 public:
  /// From that along each row by a unit impulse along each row: symmetric, positive definite. Unit:
  /// 1/kg (of rows that act on rotations: 1/(kg m^2)).
  PrincipalResponse(btScalar first, btScalar coupling, btScalar second);

  /// Whether an impulse changes the speed along both directions by a finite amount.
  bool moves() const { return moves_; }
  btScalar first() const { return first_; }
  btScalar second() const { return second_; }
  /// Of the angle by which these directions are turned.
  btScalar cosine() const { return cosine_; }
  btScalar sine() const { return sine_; }
  RowPair ToPrincipal(const RowPair& rows) const {
    return {cosine_ * rows.first - sine_ * rows.second, sine_ * rows.first + cosine_ * rows.second};
  }
  RowPair ToRows(const RowPair& principal) const {
    return {cosine_ * principal.first + sine_ * principal.second,
            cosine_ * principal.second - sine_ * principal.first};
  }

 private:
  btScalar cosine_ = 1, sine_ = 0, first_, second_;
  bool moves_;
};

/// The impulse x with |x| = limit that minimises (x - wanted)' K (x - wanted) / 2, with K =
/// `response`, of a `wanted` beyond the limit, which is positive: it is opposite to the remaining
/// sliding velocity. All are along principal directions. Relative error of |x| at most 1e-9.
RowPair OnTheCircle(btScalar limit, const RowPair& response, const RowPair& wanted,
                    btScalar squared_length);

/// Change of the impulse of a contact's friction rows: afterwards its length is at most `limit`,
/// and it removes as much of `speed_errors` (wanted minus present speed along each row) as that
/// allows. Zero if a row cannot move (its response is not finite or not positive).
RowPair FrictionChange(const RowPair& impulse, btScalar limit, const PrincipalResponse& response,
                       const RowPair& speed_errors);

}  // namespace prehend::physics
