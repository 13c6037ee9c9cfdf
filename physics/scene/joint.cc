// SPDX-License-Identifier: Apache-2.0
// A position is read along or about the joint's axis, as placed. The root of a body is found along
// its fixed joints.
#include "physics/scene/joint.h"

#include <algorithm>

#include "physics/scene/geometry.h"

namespace prehend::physics {

namespace {

/// Index of the body's own joint, or -1.
int JointOf(const Scene& scene, BodyIndex body) {
  const auto it = std::find_if(scene.joints.begin(), scene.joints.end(),
                               [&](const Joint& joint) { return joint.body == body; });
  return it == scene.joints.end() ? -1 : static_cast<int>(it - scene.joints.begin());
}

double Position(const Scene& scene, const Joint& joint, const Pose& X_WBase, const Pose& X_WB) {
  const Pose placed = scene.body(joint.base).X_WB.inverse() * scene.body(joint.body).X_WB;
  const Pose now = X_WBase.inverse() * X_WB;
  const Eigen::Vector3d axis_base = scene.body(joint.base).X_WB.q.conjugate() * joint.axis_W;
  if (joint.kind == JointKind::kSlider) return axis_base.dot(now.p_m - placed.p_m);
  if (joint.kind == JointKind::kHinge)
    return axis_base.dot(RotationVector(now.q * placed.q.conjugate()));
  return 0;
}

/// The frame of a shape's centre of mass; for most shapes it is the shape's own frame.
Pose CentreOf(const Shape& shape, const Pose& X_RS) {
  const auto* hull = std::get_if<Hull>(&shape);
  return hull ? X_RS * hull->X_SC : X_RS;  // the other shapes keep their pose to the last bit
}

}  // namespace

std::vector<std::vector<std::size_t>> RigidGroups(const Scene& scene) {
  const std::size_t count = scene.bodies.size();
  std::vector<std::vector<std::size_t>> groups(count);  // by root, the root itself first
  for (std::size_t i = 0; i < count; ++i) {
    if (!scene.bodies[i].grains) groups[i].push_back(i);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto root = RootOf(scene, BodyIndex(i)).index();
    if (root == i) continue;
    groups[root].push_back(i);
    groups[i].clear();
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

std::vector<RigidMember> MembersOf(const std::vector<const Body*>& bodies) {
  std::vector<RigidMember> members;
  const Pose X_RW = bodies.front()->X_WB.inverse();
  const bool fixed = bodies.front()->fixed;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = *bodies[i];
    double volume = 0;
    for (const PlacedShape& placed : body.shapes) volume += VolumeOf(placed.shape);
    const double density = (fixed ? 1.0 : body.mass_kg) / volume;
    for (const PlacedShape& placed : body.shapes) {
      // The root's own shapes keep their pose to the last bit, too.
      const Pose X_RS = i == 0 ? placed.X_BS : X_RW * body.X_WB * placed.X_BS;
      members.push_back(
          {&placed, i, CentreOf(placed.shape, X_RS), density * VolumeOf(placed.shape)});
    }
  }
  return members;
}

bool IsThing(const Body& body) {
  return !body.kinematic && !body.grains && body.abstract == Abstract::kNot;
}

std::span<const Eigen::Vector3d> GrainsOf(const Scene& scene, BodyIndex body,
                                          const Snapshot& snapshot) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < body.index(); ++i)
    if (const auto& other = scene.bodies[i].grains) first += other->p_WG_m.size();
  const std::vector<Eigen::Vector3d>& placed = scene.body(body).grains->p_WG_m;
  if (first + placed.size() > snapshot.grains.size()) return placed;
  return std::span(snapshot.grains).subspan(first, placed.size());
}

bool MovesFreely(const Scene& scene, BodyIndex body) {
  const Body& moved = scene.body(body);
  return !moved.fixed && IsThing(moved) && JointOf(scene, body) < 0;
}

JointState StateOf(const Scene& scene, const Joint& joint, const Pose& X_WBase, const Pose& X_WB) {
  const double position = Position(scene, joint, X_WBase, X_WB);
  const double range = joint.upper - joint.lower;
  return {position, range > 0 ? std::clamp((position - joint.lower) / range, 0.0, 1.0) : 0};
}

void DescribeJoints(const Scene& scene, Snapshot& snapshot) {
  snapshot.joints.resize(scene.joints.size());
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    snapshot.joints[i] =
        StateOf(scene, joint, snapshot.body(joint.base).X_WB, snapshot.body(joint.body).X_WB);
  }
}

Pose MotionAlong(const Scene& scene, const Joint& joint, const Pose& X_WBase, double change) {
  const Pose since_placed = X_WBase * scene.body(joint.base).X_WB.inverse();
  const Eigen::Vector3d axis_W = since_placed.q * joint.axis_W;
  if (joint.kind == JointKind::kSlider) return {axis_W * change};
  if (joint.kind != JointKind::kHinge) return {};
  const Eigen::Vector3d pivot_W_m = since_placed * joint.pivot_W_m;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(change, axis_W));
  return {pivot_W_m - turn * pivot_W_m, turn};
}

int JointThatMoves(const Scene& scene, BodyIndex body) {
  return JointOf(scene, RootOf(scene, body));
}

bool NeverTouch(const Scene& scene, BodyIndex body, BodyIndex other) {
  const BodyIndex a = RootOf(scene, body), b = RootOf(scene, other);
  return a == b || std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
           const BodyIndex on = RootOf(scene, joint.base), hangs = RootOf(scene, joint.body);
           return (on == a && hangs == b) || (on == b && hangs == a);
         });
}

BodyIndex RootOf(const Scene& scene, BodyIndex body) {
  for (int joint = JointOf(scene, body); joint >= 0; joint = JointOf(scene, body)) {
    const Joint& j = scene.joints[static_cast<std::size_t>(joint)];
    if (j.kind != JointKind::kFixed) break;
    body = j.base;
  }
  return body;
}

}  // namespace prehend::physics
