// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/mirror_image.h"

#include <algorithm>
#include <utility>

namespace prehend::physics {
namespace {

void Mirror(Hull& hull) {
  for (Eigen::Vector3d& corner_m : hull.corners_m) corner_m = InMirror(corner_m);
  for (Hull::Face& face : hull.faces) {
    std::ranges::reverse(face.corners);  // counter-clockwise again
    face.nhat_S = InMirror(face.nhat_S);
  }
  hull.X_SC = InMirror(hull.X_SC);
}

}  // namespace

PlacedShape InMirror(PlacedShape placed) {
  placed.X_BS = InMirror(placed.X_BS);
  if (auto* const hull = std::get_if<Hull>(&placed.shape)) Mirror(*hull);
  return placed;
}

Body InMirror(Body body) {
  body.X_WB = InMirror(body.X_WB);
  if (body.grains)
    for (Eigen::Vector3d& p_WG_m : body.grains->p_WG_m) p_WG_m = InMirror(p_WG_m);
  for (PlacedShape& placed : body.shapes) placed = InMirror(std::move(placed));
  return body;
}

Joint InMirror(Joint joint) {
  joint.pivot_W_m = InMirror(joint.pivot_W_m);
  joint.axis_W =
      joint.kind == JointKind::kHinge ? AxisInMirror(joint.axis_W) : InMirror(joint.axis_W);
  return joint;
}

Hand InMirror(Hand hand) {
  hand.X_WH = InMirror(hand.X_WH);
  hand.model = Mirrored(std::move(hand.model));
  return hand;
}

Scene InMirror(Scene scene) {
  for (Body& body : scene.bodies) body = InMirror(std::move(body));
  for (Joint& joint : scene.joints) joint = InMirror(std::move(joint));
  for (Hand& hand : scene.hands) hand = InMirror(std::move(hand));
  return scene;
}

}  // namespace prehend::physics
