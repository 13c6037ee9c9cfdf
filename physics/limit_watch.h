// SPDX-License-Identifier: Apache-2.0
// Looks for what an engine gets wrong, whichever it is: bodies that come out on the other side of
// another one, and bodies that sink into another one. It changes nothing. Tested by
// tests/physics/limit_watch_test.cc
#pragma once

#include <map>
#include <string>
#include <vector>

#include "physics/hand/script_player.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class LimitWatch {
 public:
  /// `scene` must outlive it.
  explicit LimitWatch(const Scene& scene);

  /// After each tick.
  void See(const Snapshot& now);
  /// What there is to say in the end, by time.
  std::vector<ScriptNote> Notes() const;

 private:
  /// The first time that a pair is through, and the deepest overlap of a pair.
  struct Through {
    std::int64_t tick = 0;
    double way_m = 0;
  };
  struct Overlap {
    std::int64_t begin_tick = 0, last_tick = -2;  ///< of the present overlap
    std::int64_t noted_tick = -1;                 ///< when it had lasted long enough
    double deepest_m = 0;
    double mass_ratio = 1;  ///< then
  };
  using BodyPair = std::pair<BodyIndex, BodyIndex>;
  using SidePair = std::pair<ContactSide, ContactSide>;  ///< whole hands

  void SeeWays(const Snapshot& now);
  /// Of a body that moves far in this tick.
  void SeeWay(BodyIndex body, const Snapshot& now);
  /// Whether the centre of a body goes through another one.
  void SeeWay(BodyIndex body, BodyIndex other, const Snapshot& now);
  void SeeOverlaps(const Snapshot& now);
  /// The centre of a body may be on its way into another one.
  void SeeEntry(BodyIndex body, BodyIndex other);
  bool MayCollide(BodyIndex a, BodyIndex b) const;

  const Scene& scene_;
  std::vector<double> half_m_;  ///< by body, half of its smallest extent
  double thinnest_m_ = 0;       ///< the least of them
  std::vector<Pose> before_;    ///< by body, its pose a tick ago
  /// Bodies that may be on their way through another one, and where their centre was, in that one's
  /// frame, when it was last seen outside.
  std::map<BodyPair, Eigen::Vector3d> entered_;
  std::map<BodyPair, Through> through_;
  std::map<SidePair, Overlap> overlaps_;
};

}  // namespace prehend::physics
