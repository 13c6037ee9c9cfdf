// SPDX-License-Identifier: Apache-2.0
// What a hand does with an object during one grasp. Tested by
// tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <map>
#include <vector>

#include "harness/truth/oracle/touches.h"

namespace prehend::truth {

struct Carrying {
  Spans slides, pick_ups, hovers, transports, put_downs;
};

/// `supports`: when the grasped object was supported, by support. Only for movable objects: a wall
/// that is grasped is not carried, however little supports it.
Carrying FindCarrying(const Evidence& evidence, const OracleSettings& settings, const Grasp& grasp,
                      const std::map<int, Spans>& supports);

}  // namespace prehend::truth
