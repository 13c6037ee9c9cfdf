// SPDX-License-Identifier: Apache-2.0
// Hollow everyday objects, built from convex parts. Each has its frame at the centre of its
// bounding box (without a mug's handle), z up. Tested by tests/physics/scene/compounds_test.cc
#pragma once

#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// A flat box without a lid.
struct Tray {
  Eigen::Vector3d size_m = {0.4, 0.3, 0.04};  ///< outer edge lengths
  double wall_m = 0.01;
};
/// A round cup with a handle on the side of +x.
struct Mug {
  double radius_m = 0.04;  ///< outer, without the handle
  double height_m = 0.1;
  double wall_m = 0.005;
  double handle_m = 0.03;  ///< how far the handle stands out; 0: no handle
};
/// A round dish with sides that lean outwards.
struct Bowl {
  double radius_m = 0.08;  ///< outer, at the rim; the foot has half of it
  double height_m = 0.06;
  double wall_m = 0.006;
};
/// Boards between two sides, open towards -x. Two boards and a back make a cupboard or a chest.
struct Shelf {
  Eigen::Vector3d size_m = {0.3, 0.6, 0.8};  ///< outer edge lengths
  int boards = 2;                            ///< the lowest and the highest included
  double wall_m = 0.015;
  bool back = true;
};

std::vector<PlacedShape> ShapesOf(const Tray& tray);
std::vector<PlacedShape> ShapesOf(const Mug& mug);
std::vector<PlacedShape> ShapesOf(const Bowl& bowl);
std::vector<PlacedShape> ShapesOf(const Shelf& shelf);

}  // namespace prehend::physics
