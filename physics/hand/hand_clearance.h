// SPDX-License-Identifier: Apache-2.0
// Distance between a hand in a given joint posture and the bodies that may obstruct it; the hand is
// covered by small spheres. Tested by tests/physics/hand/reach_planner_test.cc
#pragma once

#include <string>
#include <vector>

#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class HandClearance {
 public:
  /// `hand` is an index into Scene::hands; the scene must outlive the clearance. The person whose
  /// hand it is does not obstruct it: her arm comes along, and hands pass through persons.
  HandClearance(const Scene& scene, HandIndex hand, const std::vector<double>& joints);

  /// Smallest distance of a hand at X_WH to any body that may obstruct it, metres; negative:
  /// penetration.
  double At(const Pose& X_WH, const Snapshot& now) const;
  /// Distance of a hand at X_WH to one body, metres, at most kFar_m; exact within a few
  /// millimetres.
  double To(BodyIndex body, const Pose& X_WH, const Snapshot& now) const;
  /// Distances are cut off here; larger ones do not matter.
  static constexpr double kFar_m = 0.1;
  /// The smallest distance along a motion, sampled at even time steps.
  double Along(const Segment& segment, const Snapshot& now) const;
  /// The same, and to which body: an none if all are far.
  struct Nearest {
    double distance_m = kFar_m;
    BodyIndex body = {};
  };
  Nearest NearestAlong(const Segment& segment, const Snapshot& now, BodyIndex but = kNone) const;

 private:
  /// The distance to this body, if it is less than `least`.
  double LessTo(BodyIndex body, const Pose& X_WH, const Snapshot& now, double least) const;
  struct Ball {
    Eigen::Vector3d p_H_m;
    double radius_m;
    double reach_m = 0;  ///< from the origin of H to the far side
  };
  const Scene& scene_;
  std::vector<BodyIndex> obstacles_;
  std::vector<Ball> balls_;
  double reach_m_ = 0;  ///< radius of a sphere around H's origin that encloses all
};

// What a hand touches, as the steps of a script look at it. Tested by
// tests/physics/hand/guarded_motion_test.cc

/// Calls `see` with the contacts of a hand, and of the body that it holds if there is one, with
/// another body.
template <typename See>
void ForEachContact(HandIndex hand, BodyIndex held, BodyIndex body, const Snapshot& now,
                    const See& see) {
  const auto is_ours = [&](const ContactSide& side) {
    return side.hand == hand || (held != kNone && side.hand == kNone && side.body == held);
  };
  for (const auto& points : now.AllContacts()) {
    for (const ContactPoint& contact : points) {
      const bool a_is_it = contact.a.hand == kNone && contact.a.body == body;
      const bool b_is_it = contact.b.hand == kNone && contact.b.body == body;
      if ((a_is_it && is_ours(contact.b)) || (b_is_it && is_ours(contact.a))) see(contact);
    }
  }
}

/// A thing that leans by more than 20 degrees is meant to: a hand that keeps it upright does not
/// turn it. The cosine.
inline constexpr double kCosMostLean = 0.94;

/// Number of hands that touch a body.
int HandsOn(BodyIndex body, const Snapshot& now);

bool Touches(HandIndex hand, BodyIndex body, const Snapshot& now);

/// "12 mm".
std::string Millimetres(double length_m);

}  // namespace prehend::physics
