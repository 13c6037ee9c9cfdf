// SPDX-License-Identifier: Apache-2.0
// A trust-region problem in two dimensions. Method: J. More and D. Sorensen, "Computing a Trust
// Region Step", SIAM J. Sci. Stat. Comput. 4(3), 1983, algorithm 3.2. Only sums, products,
// quotients and roots: the result has the same bits on every processor.
#include "physics/bullet/core/friction_circle.h"

#include <cmath>

namespace prehend::physics {
namespace {

/// Added to the diagonal, relative to it: two rows that push the same way stay solvable.
constexpr btScalar kRegular = 1e-9;
constexpr btScalar kAccuracy = 1e-9;  ///< relative, of the length of the impulse
constexpr int kMostSteps = 30;        ///< Newton's method takes 2 to 5

RowPair SolveTwo(const PairResponse& k, const RowPair& right) {
  const btScalar determinant = k.first * k.second - k.coupling * k.coupling;
  return {(k.second * right.first - k.coupling * right.second) / determinant,
          (k.first * right.second - k.coupling * right.first) / determinant};
}

btScalar Dot(const RowPair& a, const RowPair& b) { return a.first * b.first + a.second * b.second; }

RowPair Apply(const PairResponse& k, const RowPair& x) {
  return {k.first * x.first + k.coupling * x.second, k.coupling * x.first + k.second * x.second};
}

}  // namespace

RowPair FrictionWithin(btScalar limit, const PairResponse& response, const RowPair& wanted) {
  if (limit <= 0) return {};
  if (Dot(wanted, wanted) <= limit * limit) return wanted;
  // (K + slip I) x = K wanted, |x| = limit. 1/|x| is nearly linear in `slip`, and Newton's method
  // on it approaches the solution from below.
  const RowPair right = Apply(response, wanted);
  PairResponse damped = response;
  RowPair x = wanted;
  btScalar length = std::sqrt(Dot(x, x));
  for (int step = 0; step < kMostSteps && length > limit * (1 + kAccuracy); ++step) {
    const btScalar slope = Dot(x, SolveTwo(damped, x));  // of -|x|^2 / 2
    const btScalar more = (length * length / slope) * ((length - limit) / limit);
    damped.first += more;
    damped.second += more;
    x = SolveTwo(damped, right);
    length = std::sqrt(Dot(x, x));
  }
  const btScalar scale = limit / length;
  return {x.first * scale, x.second * scale};
}

RowPair FrictionChange(const RowPair& impulse, btScalar limit, const PairResponse& response,
                       const RowPair& speed_errors) {
  PairResponse k = response;
  k.first *= 1 + kRegular;
  k.second *= 1 + kRegular;
  const btScalar determinant = k.first * k.second - k.coupling * k.coupling;
  if (!(determinant > 0) || !std::isfinite(determinant)) return {};
  const RowPair free = SolveTwo(k, speed_errors);
  const RowPair sum =
      FrictionWithin(limit, k, {impulse.first + free.first, impulse.second + free.second});
  return {sum.first - impulse.first, sum.second - impulse.second};
}

}  // namespace prehend::physics
