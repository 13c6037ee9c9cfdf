// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/abstract_entities_test.cc
#include <algorithm>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/limits.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

using physics::Abstract;

constexpr double kMinRegionSize_m = 0.001, kMaxRegionSize_m = 100;

}  // namespace

ValueFormat<RegionYaml> RegionFormat() {
  using R = RegionYaml;
  return StructFormat<R>("a region")
      .Optional("size_m", &R::size_m, Vector<3>(kMinRegionSize_m, kMaxRegionSize_m),
                "Full edge lengths [x, y, z] of a box.")
      .Optional("radius_m", &R::radius_m, Number(kMinRegionSize_m, kMaxRegionSize_m),
                "Radius of a ball.")
      .ExactlyOneOf({"size_m", "radius_m"})
      .format();
}

ValueFormat<GazeTargetYaml> GazeTargetFormat() {
  using G = GazeTargetYaml;
  return StructFormat<G>("a gaze target")
      .Optional("radius_m", &G::radius_m, Number(kMinRegionSize_m, 10),
                "Radius of the ball that is looked at.")
      .format();
}

ValueFormat<CameraYaml> CameraFormat() {
  using C = CameraYaml;
  return StructFormat<C>("a camera")
      .Required("toward_m", &C::toward_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                "The point it looks at, world coordinates.")
      .Optional("view_deg", &C::view_deg, Number(5, 120), "Vertical field of view.")
      .format();
}

ValueFormat<LightYaml> LightFormat() { return StructFormat<LightYaml>("a light").format(); }

void CheckAbstract(const YamlNode& node, const EntityYaml& entity, DiagnosticList& errors) {
  const Abstract abstract = AbstractOf(entity);
  if (abstract == Abstract::kNot) return;
  const std::string noun = NounOf(abstract);
  for (const char* key : {"fixed", "mass_kg", "friction", "rolling_friction", "restitution",
                          "linear_damping_per_s", "angular_damping_per_s", "fixed_to", "slider",
                          "hinge", "ball_joint", "on", "in", "color"}) {
    if (const YamlNode* given = node.Find(key))
      errors.Add(given->key_where,
                 std::string(key) + ": " + noun + " is abstract; this key does not apply to it");
  }
  for (const char* key : {"rpy_deg", "yaw_deg"}) {
    const YamlNode* given = abstract == Abstract::kRegion ? nullptr : node.Find(key);
    if (given)
      errors.Add(given->key_where, std::string(key) + ": " + noun + " has no rotation",
                 abstract == Abstract::kCamera ? "use toward_m" : "");
  }
  if (entity.camera && std::ranges::find(CameraWords(), node.key) != CameraWords().end())
    errors.Add(node.key_where, "'" + node.key + "' is a built-in camera", "choose another name");
  if (entity.camera && entity.at_m.value.size() == 3) {
    const Eigen::Vector3d at_m(entity.at_m.value[0], entity.at_m.value[1], entity.at_m.value[2]);
    if ((entity.camera->toward_m.value - at_m).norm() < kMinRegionSize_m)
      errors.Add(entity.camera->toward_m.where, "toward_m: this is the camera's own position",
                 "give the point that it looks at");
  }
}

}  // namespace prehend::scenario
