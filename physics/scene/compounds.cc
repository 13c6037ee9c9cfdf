// SPDX-License-Identifier: Apache-2.0
// Round walls are rings of boxes (staves).
#include "physics/scene/compounds.h"

#include <cmath>
#include <numbers>

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

/// Staves of a round wall: with 16 the inner surface differs from a circle by a hundredth of the
/// radius.
constexpr int kStaves = 16;
/// A handle is a bar this thick.
constexpr double kHandleBar_m = 0.01;
/// A bowl's foot, as a share of its rim.
constexpr double kFootShare = 0.5;

PlacedShape BoxAt(const Vector3d& size_m, const Vector3d& at_m) { return {Box{size_m}, {at_m}}; }

/// A closed ring of boards around z. Half-way up their centre lines are at radius_m; they lean
/// outwards by lean_rad; length_m is measured along a board.
void AddRing(double radius_m, double length_m, double wall_m, double lean_rad, double z_m,
             std::vector<PlacedShape>& shapes) {
  const double rise = length_m / 2 * std::sin(lean_rad);
  // Wide enough to leave no gap at the upper edge, where the ring is widest.
  const double width_m = 2 * (radius_m + rise + wall_m / 2) * std::tan(std::numbers::pi / kStaves);
  for (int i = 0; i < kStaves; ++i) {
    const Eigen::Quaterniond yaw(
        Eigen::AngleAxisd(2 * std::numbers::pi * i / kStaves, Vector3d::UnitZ()));
    const Eigen::Quaterniond lean(Eigen::AngleAxisd(lean_rad, Vector3d::UnitY()));
    shapes.push_back({Box{{wall_m, width_m, length_m}},
                      {yaw * Vector3d(radius_m, 0, 0) + Vector3d(0, 0, z_m), yaw * lean}});
  }
}

}  // namespace

std::vector<PlacedShape> ShapesOf(const Tray& tray) {
  const Vector3d& size = tray.size_m;
  const double wall = tray.wall_m, height = size.z() - wall;
  const double z = wall / 2;
  return {BoxAt({size.x(), size.y(), wall}, {0, 0, (wall - size.z()) / 2}),
          BoxAt({wall, size.y(), height}, {(size.x() - wall) / 2, 0, z}),
          BoxAt({wall, size.y(), height}, {(wall - size.x()) / 2, 0, z}),
          BoxAt({size.x() - 2 * wall, wall, height}, {0, (size.y() - wall) / 2, z}),
          BoxAt({size.x() - 2 * wall, wall, height}, {0, (wall - size.y()) / 2, z})};
}

std::vector<PlacedShape> ShapesOf(const Mug& mug) {
  std::vector<PlacedShape> shapes = {
      {Cylinder{mug.radius_m, mug.wall_m}, {{0, 0, (mug.wall_m - mug.height_m) / 2}}}};
  AddRing(mug.radius_m - mug.wall_m / 2, mug.height_m - mug.wall_m, mug.wall_m, 0, mug.wall_m / 2,
          shapes);
  if (mug.handle_m <= 0) return shapes;
  const double reach = mug.height_m / 4;
  const double grip_x = mug.radius_m + mug.handle_m - kHandleBar_m / 2;
  const double arm_m = mug.handle_m - kHandleBar_m;
  shapes.push_back(BoxAt({kHandleBar_m, kHandleBar_m, 2 * reach + kHandleBar_m}, {grip_x, 0, 0}));
  for (const double z : {-reach, reach}) {
    shapes.push_back(BoxAt({arm_m, kHandleBar_m, kHandleBar_m}, {mug.radius_m + arm_m / 2, 0, z}));
  }
  return shapes;
}

std::vector<PlacedShape> ShapesOf(const Bowl& bowl) {
  const double foot_m = kFootShare * bowl.radius_m;
  const double out_m = bowl.radius_m - foot_m - bowl.wall_m / 2, up_m = bowl.height_m - bowl.wall_m;
  const double lean_rad = std::atan2(out_m, up_m);
  std::vector<PlacedShape> shapes = {
      {Cylinder{foot_m, bowl.wall_m}, {{0, 0, (bowl.wall_m - bowl.height_m) / 2}}}};
  AddRing(foot_m + out_m / 2, std::hypot(out_m, up_m), bowl.wall_m, lean_rad, 0, shapes);
  return shapes;
}

std::vector<PlacedShape> ShapesOf(const Shelf& shelf) {
  const Vector3d& size = shelf.size_m;
  const double wall = shelf.wall_m, side_y = (size.y() - wall) / 2;
  const double depth = shelf.back ? size.x() - wall : size.x();
  const double x = (depth - size.x()) / 2;
  std::vector<PlacedShape> shapes = {BoxAt({size.x(), wall, size.z()}, {0, -side_y, 0}),
                                     BoxAt({size.x(), wall, size.z()}, {0, side_y, 0})};
  if (shelf.back)
    shapes.push_back(BoxAt({wall, size.y() - 2 * wall, size.z()}, {(size.x() - wall) / 2, 0, 0}));
  for (int i = 0; i < shelf.boards; ++i) {
    const double z = (size.z() - wall) * (static_cast<double>(i) / (shelf.boards - 1) - 0.5);
    shapes.push_back(BoxAt({depth, size.y() - 2 * wall, wall}, {x, 0, z}));
  }
  return shapes;
}

}  // namespace prehend::physics
