// SPDX-License-Identifier: Apache-2.0
// How a hand came to an object: its distance, its region of interest, and the moment since which it
// was coming. Tested by tests/harness/oracle/oracle_test.cc
#pragma once

#include <span>

#include "harness/oracle/recording.h"

namespace prehend::harness::oracle {

struct DistanceAt {
  double t_s = 0;
  double distance_m = 0;
};

/// Where the last uninterrupted approach to the end of `path` begins: an index. Going away by up to
/// `dead_band_m` does not interrupt. After a longer retreat the approach begins at the turning
/// point; if the hand pauses there, when it returns.
int ApproachBegin(std::span<const DistanceAt> path, double dead_band_m,
                  const OracleSettings& settings);

/// Between the surfaces of the hand (palm and links) and of the body, metres; 0 when they touch or
/// overlap.
double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state);

/// Whether the body's oriented bounding box intersects the hand's region of interest.
bool InReachRegion(const physics::HandModel& model, const physics::HandState& hand,
                   const physics::Body& body, const physics::BodyState& state, double radius_m);

/// The frame, in [earliest, touch], at which the hand's reach for the body began that ended with
/// touching it.
int ReachBegin(const Recording& recording, const OracleSettings& settings, int hand, int body,
               int earliest, int touch);

}  // namespace prehend::harness::oracle
