// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace prehend {

/// Of an even number of values, the middle between the two in the middle. 0 if there are none.
template <class T>
T Median(std::vector<T> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return std::ssize(values) % 2 == 1
             ? *middle
             : std::midpoint(*std::max_element(values.begin(), middle), *middle);
}

}  // namespace prehend
