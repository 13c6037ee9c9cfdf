// SPDX-License-Identifier: Apache-2.0
// How a point lies to a region of the language. Tested by tests/grammar/values/signals_test.cc
#pragma once

namespace prehend::grammar {

/// How far something is from the centre of a region, and how far it may be. For a sphere, the
/// height does not count.
struct Reach {
  double distance_m = 0;
  double radius_m = 0;
  double height_m = 0;
  double most_height_m = 0;
  bool IsInside() const { return distance_m <= radius_m && height_m <= most_height_m; }
};

}  // namespace prehend::grammar
