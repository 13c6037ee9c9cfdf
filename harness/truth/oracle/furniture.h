// SPDX-License-Identifier: Apache-2.0
// What hangs on a slider or a hinge: how far it is open, when it opens and closes, and by whom. A
// motion is dated by the position of the joint alone. Tested by
// tests/harness/truth/oracle/oracle_furniture_test.cc
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "harness/truth/oracle/evidence.h"
#include "harness/truth/oracle/recording.h"

namespace prehend::truth {

struct PartMotion {
  bool opens = false;  ///< else it closes
  Span span;
  double way = 0;                        ///< from begin to end, of its range
  std::vector<std::pair<int, Span>> by;  ///< who touches it then: hands and parts of persons
};

struct Part {
  int body = 0;
  std::array<Spans, 4> states;  ///< closed, half closed, half open, open
  std::vector<PartMotion> motions;
};

/// In the order of the scene's joints. `contact_bridge_s`: a gap in a touch that is bridged.
std::vector<Part> FindParts(const Evidence& evidence, const FurnitureSettings& settings,
                            double contact_bridge_s);

}  // namespace prehend::truth
