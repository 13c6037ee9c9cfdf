// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/scenario_fields_test.cc and
// tests/harness/scenario/format/abstract_entities_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

constexpr double kMinSize_m =
    0.001;  // below, the collision margins (1 mm) would be larger than the body
constexpr double kMaxSize_m = 100;
constexpr double kMaxPartOffset_m = 10;
constexpr int kMaxBoards = 20;

ValueFormat<double> Length() { return Number(kMinSize_m, kMaxSize_m); }
ValueFormat<Eigen::Vector3d> Size() { return Vector<3>(kMinSize_m, kMaxSize_m); }

/// Cylinders and capsules: the axis is along z.
template <class Round>
ValueFormat<Round> RoundFormat(const std::string& noun, const std::string& length_doc) {
  return StructFormat<Round>(noun)
      .Required("radius_m", &Round::radius_m, Length(), "Radius.")
      .Required("length_m", &Round::length_m, Length(), length_doc)
      .format();
}

/// Reports walls that leave no room inside. `narrow_m`: the smallest outer extent across.
void CheckWall(const YamlNode& node, double wall_m, double narrow_m, DiagnosticList& errors) {
  if (2 * wall_m < narrow_m) return;
  const YamlNode* wall = node.Find("wall_m");
  errors.Add(wall ? wall->where : node.where,
             fmt::format("wall_m: walls of {} leave no room inside", wall_m),
             "walls must be thinner than half of the narrowest side");
}

using physics::Abstract;

constexpr double kMinRegionSize_m = 0.001, kMaxRegionSize_m = 100;

}  // namespace

ValueFormat<physics::Box> BoxFormat() {
  return StructFormat<physics::Box>("a box")
      .Required("size_m", &physics::Box::size_m, Size(), "Full edge lengths [x, y, z].")
      .format();
}

ValueFormat<physics::Sphere> SphereFormat() {
  return StructFormat<physics::Sphere>("a sphere")
      .Required("radius_m", &physics::Sphere::radius_m, Length(), "Radius.")
      .format();
}

ValueFormat<physics::Cylinder> CylinderFormat() {
  return RoundFormat<physics::Cylinder>("a cylinder", "Height, along z.");
}

ValueFormat<physics::Capsule> CapsuleFormat() {
  return RoundFormat<physics::Capsule>("a capsule", "Along z, without the two half spheres.");
}

ValueFormat<physics::Hull> HullFormat() {
  struct Points {
    std::vector<Eigen::Vector3d> points_m;
  };
  const ValueFormat<Points> written =
      StructFormat<Points>("a hull")
          .Required("points_m", &Points::points_m,
                    ListOf(Vector<3>(-kMaxPartOffset_m, kMaxPartOffset_m), physics::kMinHullPoints,
                           physics::kMaxHullPoints),
                    "Its corners [x, y, z] in its own coordinate frame, in any order.")
          .format();
  return ValueFormat<physics::Hull>(
      written.schema(),
      [written](const YamlNode& node, DiagnosticList& errors, physics::Hull& hull) {
        Points points;
        if (!written.Read(node, errors, points)) return false;
        physics::MadeHull made = physics::MakeHull(points.points_m);
        if (made.hull) {
          hull = std::move(*made.hull);
          return true;
        }
        const YamlNode& list = *node.Find("points_m");
        const YamlNode& wrong =
            made.point < 0 ? list : list.children[static_cast<std::size_t>(made.point)];
        errors.Add(wrong.where, "points_m: " + made.problem, made.remedy);
        return false;
      });
}

ValueFormat<physics::Tray> TrayFormat() {
  using T = physics::Tray;
  return StructFormat<T>("a tray")
      .Required("size_m", &T::size_m, Size(), "Outer edge lengths [x, y, z].")
      .Optional("wall_m", &T::wall_m, Length(), "Thickness of floor and walls.")
      .Check([](const YamlNode& node, const T& tray, DiagnosticList& errors) {
        const Eigen::Vector3d& size = tray.size_m;
        CheckWall(node, tray.wall_m, std::min({size.x(), size.y(), 2 * size.z()}), errors);
      })
      .format();
}

ValueFormat<physics::Mug> MugFormat() {
  using M = physics::Mug;
  return StructFormat<M>("a mug")
      .Required("radius_m", &M::radius_m, Length(), "Outer radius, without the handle.")
      .Required("height_m", &M::height_m, Length(), "Height.")
      .Optional("wall_m", &M::wall_m, Length(), "Thickness of floor and wall.")
      .Optional("handle_m", &M::handle_m, Number(0, kMaxSize_m),
                "How far its handle extends to +x; 0: no handle.")
      .Check([](const YamlNode& node, const M& mug, DiagnosticList& errors) {
        CheckWall(node, mug.wall_m, 2 * std::min(mug.radius_m, mug.height_m), errors);
        constexpr double kMinHandle_m = 0.011;  // its bar is 10 mm thick
        if (mug.handle_m > 0 && mug.handle_m < kMinHandle_m) {
          errors.Add(
              node.Find("handle_m")->where,
              fmt::format("handle_m: expected 0, or at least 0.011, found {}", mug.handle_m));
        }
      })
      .format();
}

ValueFormat<physics::Bowl> BowlFormat() {
  using B = physics::Bowl;
  return StructFormat<B>("a bowl")
      .Required("radius_m", &B::radius_m, Length(),
                "Outer radius at the rim; the foot has half of it.")
      .Required("height_m", &B::height_m, Length(), "Height.")
      .Optional("wall_m", &B::wall_m, Length(), "Thickness of floor and wall.")
      .Check([](const YamlNode& node, const B& bowl, DiagnosticList& errors) {
        CheckWall(node, bowl.wall_m, std::min(bowl.radius_m, 2 * bowl.height_m), errors);
      })
      .format();
}

ValueFormat<physics::Shelf> ShelfFormat() {
  using S = physics::Shelf;
  return StructFormat<S>("a shelf")
      .Required("size_m", &S::size_m, Size(), "Outer edge lengths [x, y, z]; it is open to -x.")
      .Optional("boards", &S::boards, Integer<int>(2, kMaxBoards),
                "How many, evenly spaced, including the lowest and the highest.")
      .Optional("wall_m", &S::wall_m, Length(), "Thickness of boards, sides and back.")
      .Optional("back", &S::back, Flag(), "False: open to +x, too.")
      .Check([](const YamlNode& node, const S& shelf, DiagnosticList& errors) {
        const Eigen::Vector3d& size = shelf.size_m;
        CheckWall(node, shelf.wall_m,
                  std::min({2 * size.x(), size.y(), 2 * size.z() / shelf.boards}), errors);
      })
      .format();
}

ValueFormat<GrainsYaml> GrainsFormat() {
  using G = GrainsYaml;
  constexpr int kMaxGrains = 500;
  constexpr double kMinGrainRadius_m = 0.002, kMaxGrainRadius_m = 0.05;
  return StructFormat<G>("grains")
      .Required("count", &G::count, Integer<int>(1, kMaxGrains), "How many.")
      .Required("radius_m", &G::radius_m, Number(kMinGrainRadius_m, kMaxGrainRadius_m),
                "Radius of each.")
      .format();
}

ValueFormat<physics::PlacedShape> PartFormat() {
  using P = PartYaml;
  using physics::Shape;
  return AsAlternative<physics::PlacedShape>(
      StructFormat<P>("a part")
          .Optional("box", &P::shape, AsAlternative<Shape>(BoxFormat()), "Its shape: a box.")
          .Optional("sphere", &P::shape, AsAlternative<Shape>(SphereFormat()),
                    "Its shape: a sphere.")
          .Optional("cylinder", &P::shape, AsAlternative<Shape>(CylinderFormat()),
                    "Its shape: a cylinder, axis along z.")
          .Optional("capsule", &P::shape, AsAlternative<Shape>(CapsuleFormat()),
                    "Its shape: a capsule, axis along z.")
          .Optional("hull", &P::shape, AsAlternative<Shape>(HullFormat()),
                    "Its shape: a solid of flat faces, by its corners.")
          .Optional("at_m", &P::at_m, Vector<3>(-kMaxPartOffset_m, kMaxPartOffset_m),
                    "Its centre in the entity's own coordinate frame, whose origin is at the "
                    "entity's at_m.")
          .Optional(
              "rpy_deg", &P::rpy_deg, Vector<3>(-360, 360),
              "Roll, pitch and yaw in degrees: turns about the entity's x, then y, then z axis.")
          .ExactlyOneOf({"box", "sphere", "cylinder", "capsule", "hull"})
          .format(),
      [](P part) {
        return physics::PlacedShape{std::move(part.shape),
                                    {part.at_m, physics::FromRollPitchYaw(part.rpy_deg)}};
      });
}

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
