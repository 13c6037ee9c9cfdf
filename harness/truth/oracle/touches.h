// SPDX-License-Identifier: Apache-2.0
// Contacts, supports and grasps: what follows from touching alone. Tested by
// tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <map>
#include <span>
#include <vector>

#include "harness/truth/oracle/evidence.h"
#include "harness/truth/oracle/recording.h"
#include "harness/truth/oracle/settings.h"

namespace prehend::truth {

struct Grasp {
  int hand = 0;  ///< index into Scene::hands
  int body = 0;
  Span span;
  int touched_since = 0;  ///< the hand touches it, and has not grasped it in between
  auto operator<=>(const Grasp&) const = default;
};

/// Gaps are bridged as the definitions allow.
struct Touches {
  std::map<Pair, Spans> contacts;  ///< entities a < b
  std::map<Pair, Spans> supports;  ///< (object, support), both bodies, the object movable
  std::vector<Grasp> grasps;       ///< sorted by hand, body, time
};
Touches FindTouches(const Evidence& evidence, const TouchSettings& settings);

// What a hand does with an object during one grasp. Tested by
// tests/harness/truth/oracle/oracle_test.cc

struct Carrying {
  Spans slides, pick_ups, hovers, transports, put_downs;
};

/// `supports`: when the grasped object was supported, by support. Only for movable objects: a wall
/// that is grasped is not carried, however little supports it.
Carrying FindCarrying(const Evidence& evidence, const OracleSettings& settings, const Grasp& grasp,
                      const std::map<int, Spans>& supports);

// How something came to a place: the moment since which it was coming. Tested by
// tests/harness/truth/oracle/oracle_test.cc

struct DistanceAt {
  double t_s = 0;
  double distance_m = 0;
};

/// Where the last uninterrupted approach to the end of `path` begins: an index. Going away by up to
/// `dead_band_m` does not interrupt. After a longer retreat the approach begins at the turning
/// point; if it pauses there, when it returns.
int ApproachBegin(std::span<const DistanceAt> path, double dead_band_m,
                  const OracleSettings& settings);

/// Where the last approach to a landing begins: an index. Distances are medians over a window, so
/// that single errors are no retreat. After a retreat it begins with the movement that leaves the
/// turning point; a pause there does not belong to it.
int LandingApproachBegin(std::span<const DistanceAt> path, const OracleSettings& settings);

/// The frame, in [earliest, touch], at which the hand's reach for the body began that ended with
/// touching it.
int ReachBegin(const Evidence& evidence, const OracleSettings& settings, int hand, int body,
               int earliest, int touch);

}  // namespace prehend::truth
