// SPDX-License-Identifier: Apache-2.0
// How something came to a place: the moment since which it was coming. Tested by
// tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <span>

#include "harness/truth/oracle/evidence.h"
#include "harness/truth/oracle/settings.h"

namespace prehend::truth {

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
