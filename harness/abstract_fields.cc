// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/abstract_entities_test.cc
#include "harness/abstract_fields.h"

#include <algorithm>

#include "harness/farthest.h"
#include "harness/record.h"

namespace prehend::harness {
namespace {

using physics::Abstract;

constexpr double kSmallestM = 0.001, kLargestM = 100;
/// A camera or a light is a point; bodies have shapes.
constexpr double kPointM = 0.005;

const char* NounOf(Abstract abstract) {
  switch (abstract) {
    case Abstract::kNot:
      return "";
    case Abstract::kRegion:
      return "a region";
    case Abstract::kGazeTarget:
      return "a gaze target";
    case Abstract::kCamera:
      return "a camera";
    case Abstract::kLight:
      return "a light";
  }
  return "";
}

/// x ahead, z as far up as that allows; a camera that looks straight up or down has its upper side
/// at the world's y.
Eigen::Quaterniond LookingAlong(const Eigen::Vector3d& way) {
  constexpr double kVertical = 1e-6;
  Eigen::Matrix3d R;
  R.col(0) = way.normalized();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(R.col(0));
  R.col(1) =
      left.norm() > kVertical ? left.normalized() : Eigen::Vector3d(-Eigen::Vector3d::UnitX());
  R.col(2) = R.col(0).cross(R.col(1));
  if (left.norm() <= kVertical) {
    R.col(2) = Eigen::Vector3d::UnitY();
    R.col(1) = R.col(2).cross(R.col(0));
  }
  return Eigen::Quaterniond(R);
}

}  // namespace

Format<RegionEntry> RegionFormat() {
  using R = RegionEntry;
  return Record<R>("a region")
      .Optional("size_m", &R::size_m, Vector<3>(kSmallestM, kLargestM),
                "Full edge lengths [x, y, z] of a box.")
      .Optional("radius_m", &R::radius_m, Number(kSmallestM, kLargestM), "Radius of a ball.")
      .ExactlyOneOf({"size_m", "radius_m"})
      .format();
}

Format<GazeTargetEntry> GazeTargetFormat() {
  using G = GazeTargetEntry;
  return Record<G>("a gaze target")
      .Optional("radius_m", &G::radius_m, Number(kSmallestM, 10),
                "Radius of the ball that is looked at.")
      .format();
}

Format<CameraEntry> CameraFormat() {
  using C = CameraEntry;
  return Record<C>("a camera")
      .Required("toward_m", &C::toward_m, Vector<3>(-kFarthestM, kFarthestM),
                "A point in the middle of its picture, in the world.")
      .Optional("view_deg", &C::view_deg, Number(5, 120), "How much it sees, from below to above.")
      .format();
}

Format<LightEntry> LightFormat() { return Record<LightEntry>("a light").format(); }

void CheckAbstract(const YamlNode& node, const EntityEntry& entity, Complaints& complaints) {
  const Abstract abstract = AbstractOf(entity);
  if (abstract == Abstract::kNot) return;
  const std::string noun = NounOf(abstract);
  for (const char* key :
       {"fixed", "mass_kg", "friction", "rolling_friction", "restitution", "linear_damping_per_s",
        "angular_damping_per_s", "fixed_to", "slider", "hinge", "ball_joint", "on", "in"}) {
    if (const YamlNode* given = node.Find(key))
      complaints.Add(given->key_where, std::string(key) + ": " + noun +
                                           " has none; it is no matter, and stays where it is");
  }
  for (const char* key : {"rpy_deg", "yaw_deg"}) {
    const YamlNode* given = abstract == Abstract::kRegion ? nullptr : node.Find(key);
    if (given)
      complaints.Add(given->key_where, std::string(key) + ": " + noun + " is not turned",
                     abstract == Abstract::kCamera ? "it looks toward_m" : "");
  }
  if (entity.camera && std::ranges::find(CameraWords(), node.key) != CameraWords().end())
    complaints.Add(node.key_where, "'" + node.key + "' is a camera that every scenario has",
                   "call it otherwise");
  if (entity.camera && entity.at_m.value.size() == 3) {
    const Eigen::Vector3d at_m(entity.at_m.value[0], entity.at_m.value[1], entity.at_m.value[2]);
    if ((entity.camera->toward_m.value - at_m).norm() < kSmallestM)
      complaints.Add(entity.camera->toward_m.where, "toward_m: the camera stands there",
                     "a point that it looks at");
  }
}

void MakeAbstract(const EntityEntry& entity, physics::Body& body) {
  body.abstract = AbstractOf(entity);
  body.fixed = true;
  physics::Shape shape = physics::Sphere{kPointM};
  if (entity.region && entity.region->size_m) shape = physics::Box{*entity.region->size_m};
  if (entity.region && entity.region->radius_m) shape = physics::Sphere{*entity.region->radius_m};
  if (entity.gaze_target) shape = physics::Sphere{entity.gaze_target->radius_m};
  if (entity.camera && entity.at_m.value.size() == 3) {
    const Eigen::Vector3d at_m(entity.at_m.value[0], entity.at_m.value[1], entity.at_m.value[2]);
    body.view_deg = entity.camera->view_deg;
    body.X_WB.q = LookingAlong(entity.camera->toward_m.value - at_m);
  }
  body.shapes = {{shape, {}}};
}

std::string WhyNoThing(const physics::Body& body) {
  return body.grains ? "grains" : NounOf(body.abstract);
}

}  // namespace prehend::harness
