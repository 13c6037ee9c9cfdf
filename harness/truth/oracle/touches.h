// SPDX-License-Identifier: Apache-2.0
// Contacts, supports and grasps: what follows from touching alone. Tested by
// tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <map>
#include <vector>

#include "harness/truth/oracle/evidence.h"
#include "harness/truth/oracle/settings.h"
#include "harness/truth/oracle/spans.h"

namespace prehend::truth {

struct Grasp {
  int hand = 0;  ///< index into Scene::hands
  int body = 0;
  Span span;
  int touched_since = 0;  ///< the hand touches it, and has not grasped it in between
};

/// Gaps are bridged as the definitions allow.
struct Touches {
  std::map<Pair, Spans> contacts;  ///< entities a < b
  std::map<Pair, Spans> supports;  ///< (object, support), both bodies, the object movable
  std::vector<Grasp> grasps;       ///< sorted by hand, body, time
};
Touches FindTouches(const Evidence& evidence, const OracleSettings& settings);

}  // namespace prehend::truth
