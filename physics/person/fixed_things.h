// SPDX-License-Identifier: Apache-2.0
// Where a person's parts are in fixed things, by geometry alone: an engine does not collide what it
// moves with what it never moves. Tested by tests/physics/person/fixed_things_test.cc
#pragma once

#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// A part of a person that touches a fixed thing.
struct FixedTouch {
  int part = 0;  ///< counted from her head
  BodyIndex thing = {};
  double depth_m = 0;                                 ///< how deep the part is in it
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();    ///< on the part
  Eigen::Vector3d nhat_W = Eigen::Vector3d::UnitZ();  ///< out of the thing
};

class FixedThings {
 public:
  /// `scene` must outlive it.
  explicit FixedThings(const Scene& scene);

  /// What the parts of a person touch at these poses, by part and thing; not what she stands on.
  std::vector<FixedTouch> TouchedBy(const Person& person, const std::vector<Pose>& places) const;

 private:
  struct Thing {
    BodyIndex body = {};
    Eigen::AlignedBox3d bounds_W_m;
  };
  const Scene& scene_;
  std::vector<Thing> things_;
};

/// As contacts without an impulse: what is moved along its path bears no load.
void AddContacts(const Person& person, const std::vector<FixedTouch>& touches, Snapshot& snapshot);

}  // namespace prehend::physics
