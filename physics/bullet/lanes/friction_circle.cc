// SPDX-License-Identifier: Apache-2.0
// A trust-region problem in two dimensions. Method: J. More and D. Sorensen, "Computing a Trust
// Region Step", SIAM J. Sci. Stat. Comput. 4(3), 1983, algorithm 3.2. Only sums, products,
// quotients and roots: the result has the same bits on every processor.
#include "physics/bullet/lanes/friction_circle.h"

#include <algorithm>
#include <cmath>

namespace prehend::physics {
namespace {

/// Added to the diagonal, relative to it: two rows that push the same way stay solvable.
constexpr btScalar kRegular = 1e-9;
constexpr btScalar kAccuracy = 1e-9;  ///< relative, of the length of the impulse
constexpr int kMostSteps = 30;        ///< Newton's method takes 1 to 4

btScalar SquaredLength(const RowPair& a) { return a.first * a.first + a.second * a.second; }

}  // namespace

PrincipalResponse::PrincipalResponse(btScalar first, btScalar coupling, btScalar second)
    : first_(first), second_(second) {
  if (coupling != 0) {
    // Jacobi's rotation.
    const btScalar half = (second - first) / (2 * coupling);
    const btScalar tangent = (half < 0 ? -1 : 1) / (std::abs(half) + std::sqrt(1 + half * half));
    cosine_ = 1 / std::sqrt(1 + tangent * tangent);
    sine_ = tangent * cosine_;
    first_ -= tangent * coupling;
    second_ += tangent * coupling;
  }
  const btScalar regular = kRegular * (first + second);
  first_ += regular;
  second_ += regular;
  moves_ = first_ > 0 && second_ > 0 && std::isfinite(first_) && std::isfinite(second_);
}

RowPair OnTheCircle(btScalar limit, const RowPair& response, const RowPair& wanted,
                    btScalar squared_length) {
  // (K + slip I) x = K wanted, |x| = limit. 1/|x| is nearly linear in `slip`, and Newton's method
  // on it approaches the solution from below; equal responses are solved by the first guess.
  const RowPair right{response.first * wanted.first, response.second * wanted.second};
  btScalar slip =
      std::min(response.first, response.second) * (std::sqrt(squared_length) / limit - 1);
  RowPair x;
  btScalar length = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    const btScalar first = 1 / (response.first + slip), second = 1 / (response.second + slip);
    x = {right.first * first, right.second * second};
    const btScalar square = SquaredLength(x);
    length = std::sqrt(square);
    if (length <= limit * (1 + kAccuracy)) break;
    const btScalar slope = x.first * x.first * first + x.second * x.second * second;
    slip += square * (length - limit) / (slope * limit);
  }
  const btScalar scale = limit / length;
  return {x.first * scale, x.second * scale};
}

RowPair FrictionChange(const RowPair& impulse, btScalar limit, const PrincipalResponse& response,
                       const RowPair& speed_errors) {
  if (!response.moves()) return {};
  if (limit <= 0) return {-impulse.first, -impulse.second};
  const RowPair errors = response.ToPrincipal(speed_errors);
  RowPair change{errors.first / response.first(), errors.second / response.second()};
  const RowPair before = response.ToPrincipal(impulse);
  const RowPair wanted{before.first + change.first, before.second + change.second};
  const btScalar squared_length = SquaredLength(wanted);
  if (squared_length > limit * limit) {
    const RowPair sum =
        OnTheCircle(limit, {response.first(), response.second()}, wanted, squared_length);
    change = {sum.first - before.first, sum.second - before.second};
  }
  return response.ToRows(change);
}

}  // namespace prehend::physics
