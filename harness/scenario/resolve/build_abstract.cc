// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/abstract_entities_test.cc
#include "harness/scenario/resolve/build_abstract.h"

namespace prehend::scenario {
namespace {

/// A camera or a light is a point; bodies have shapes.
constexpr double kPointRadius_m = 0.005;

/// An orientation with x along `way` and z as close to up as possible. A camera that looks straight
/// up or down has its top towards the world's y.
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

void MakeAbstract(const EntityYaml& entity, physics::Body& body) {
  body.abstract = AbstractOf(entity);
  body.fixed = true;
  physics::Shape shape = physics::Sphere{kPointRadius_m};
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

}  // namespace prehend::scenario
