// SPDX-License-Identifier: Apache-2.0
// See physics/base/portable_math.h. Tested by tests/physics/portable_math_test.cc
#include "physics/base/portable_math.h"

#include <sleef.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace prehend::physics {

void SinesAndCosines(const std::array<double, 4>& angles, std::array<double, 4>& sines,
                     std::array<double, 4>& cosines) {
#ifdef __SSE2__
  // For larger angles, what one of a pair is may decide how the other is computed.
  constexpr double kLargest = 10;
  const auto is_small = [](double x) { return x >= -kLargest && x <= kLargest; };
  if (std::ranges::all_of(angles, is_small)) {
    for (std::size_t i = 0; i < 4; i += 2) {
      const __m128d pair = _mm_loadu_pd(&angles[i]);
      _mm_storeu_pd(&sines[i], Sleef_cinz_sind2_u10sse2(pair));
      _mm_storeu_pd(&cosines[i], Sleef_cinz_cosd2_u10sse2(pair));
    }
    return;
  }
#endif
  for (std::size_t i = 0; i < 4; ++i) {
    sines[i] = std::sin(angles[i]);
    cosines[i] = std::cos(angles[i]);
  }
}

}  // namespace prehend::physics
