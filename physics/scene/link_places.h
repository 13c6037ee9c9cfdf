// SPDX-License-Identifier: Apache-2.0
// Where the links of a hand are that has these joints: forward kinematics, link after link. All
// arithmetic is written out, sines and cosines too, so that every processor and every library gives
// the same bits. Episode files do not keep what follows from it (docs/episodes.md): another last
// bit here is another content of the files that people have. Tested by
// tests/physics/scene/link_places_test.cc
#pragma once

#include <vector>

#include "physics/scene/hand_model.h"

namespace prehend::physics {

class LinkPlaces {
 public:
  explicit LinkPlaces(const HandModel& model);

  /// The poses of all links in the world, in the order of the model, from the palm's pose and the
  /// positions of the joints.
  void Place(const Pose& X_WPalm, const std::vector<double>& joints, std::vector<Pose>& X_WL) const;

 private:
  struct Link {
    LinkIndex parent = {};
    bool slides = false;
    Eigen::Quaterniond q_PL;  ///< from the link's frame to its parent's, the joint at zero
    Eigen::Vector3d axis;     ///< of the joint, in the link's frame
    Eigen::Vector3d p_PJ_m;   ///< the joint in the parent's frame
    Eigen::Vector3d p_JL_m;   ///< from the joint to the link's centre, in the link's frame
  };
  std::vector<Link> links_;
};

}  // namespace prehend::physics
