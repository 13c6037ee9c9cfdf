// SPDX-License-Identifier: Apache-2.0
// Contacts, supports and grasps: what follows from touching alone. Tested by
// tests/harness/oracle/oracle_test.cc
#pragma once

#include <map>
#include <vector>

#include "harness/oracle/evidence.h"
#include "harness/oracle/settings.h"
#include "harness/oracle/spans.h"

namespace prehend::harness::oracle {

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

}  // namespace prehend::harness::oracle
