// SPDX-License-Identifier: Apache-2.0
// The poses of an entity over time, as an import goes on with them: metres, z up; and what a
// tracker got wrong for a few frames. Tested by tests/program/import_test.cc and
// tests/program/import_outliers_test.cc
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

/// An entity over time.
struct Track {
  PoseSeries poses;
  bool lost_before = false, lost_after = false;  ///< before its first and after its last pose
  bool stands = false;                           ///< PoseBody::stands
  std::size_t next = 0;  ///< the first one that is later than the present time

  PoseSample At(double t_s) {
    while (next < poses.size() && poses[next].t_s <= t_s)
      if (++next % 4096 == 0) LetGo(poses);
    if (next == 0) return poses.front();
    const PoseSample& before = poses[next - 1];
    if (next == poses.size() || poses[next].after_loss) return before;
    const PoseSample& after = poses[next];
    const double part = (t_s - before.t_s) / (after.t_s - before.t_s);
    if (part <= 0) return before;
    return {.t_s = t_s,
            .p = before.p + part * (after.p - before.p),
            .q = before.q.slerp(part, after.q)};
  }
};

/// Whether nobody knows where it was at the time of the last At().
bool IsLost(const Track& track, double t_s);

/// The mean of the poses at most `half_s` before or after each; less at both ends, so that it is
/// not drawn to one side.
PoseSeries Smoothed(const PoseSeries& poses, double half_s);

/// How far it goes along an axis, but for errors of some frames.
double WayOf(const PoseSeries& poses);

/// The standard deviation of its position on each axis, as far as it is noise. A smooth path bends
/// from frame to frame, but a polynomial through six neighbours follows it; what repeats faster
/// than every four frames is off both.
double Trembling_m(const PoseSeries& poses);

/// The poses from `begin` up to `end` are off the way between the ones around them.
struct Outlier {
  std::size_t begin = 0, end = 0;
  double off_m = 0, off_deg = 0;
};

/// A step from one pose to the next that no hand makes.
struct Jump {
  std::size_t at = 0;  ///< the pose after it
  double way_m = 0, turn_deg = 0;
};

struct JumpsOfTrack {
  std::vector<Outlier> outliers;
  std::vector<Jump> jumps;  ///< what does not come back
};

JumpsOfTrack FindJumps(const PoseSeries& poses);

/// From `begin` to `end`, s, each of two tracks is where the other one was.
struct Exchange {
  std::size_t a = 0, b = 0;  ///< tracks
  double begin_s = 0, end_s = 0;
};

/// `found`: by track. What an exchange explains is taken out of the jumps; outliers stay.
std::vector<Exchange> FindExchanges(const std::vector<const PoseSeries*>& tracks,
                                    std::vector<JumpsOfTrack>& found);

}  // namespace prehend::exchange
