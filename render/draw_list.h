// SPDX-License-Identifier: Apache-2.0
// What a picture is made of before a pixel is drawn: placed primitives with colours, in the order
// of drawing. A value that can be looked at in tests and compared between runs.
// Tested by tests/render/draw_list_test.cc
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "render/mesh.h"
#include "render/picture.h"
#include "render/view.h"

namespace prehend::render {

enum class Primitive { kBox, kBall, kCylinder, kCone, kMesh };
enum class Finish {
  kSolid = 0,
  kGround = 1,
  kRegion = 2,
  kFlat = 3
};  ///< numbers of the surface shader

struct Item {
  Primitive primitive = Primitive::kBox;
  int mesh = -1;  ///< index into DrawList::meshes
  Eigen::Affine3f X_WI = Eigen::Affine3f::Identity();
  Eigen::Vector3f half_size_m = Eigen::Vector3f::Zero();
  float rounding_m = 0;
  Color color = {0.5f, 0.5f, 0.5f};
  float alpha = 1;
  float gloss = 0.25f;
  int object = 0;
};

/// Something with a name: "body:milk", "hand:right_hand", "forearm:right_hand", "path:2:reaching",
/// "ghost:0:right_hand", "marker:1:contact".
struct DrawnObject {
  std::string name;
  Bounds bounds;
};

struct DrawList {
  std::vector<DrawnObject> objects;  ///< 0 is the background, 1 the ground; then bodies, hands,
                                     ///< forearms, paths, ghosts, markers
  std::vector<Mesh> meshes;          ///< of paths and of hulls
  std::vector<Item> solids;          ///< bodies and hands
  std::vector<Item> paths;           ///< seen through solids, faintly
  std::vector<std::vector<Item>> ghosts;                ///< each one translucent as a whole
  std::vector<Item> markers;                            ///< translucent
  Bounds bounds;                                        ///< of everything but the ground
  Eigen::Vector3f to_light = Eigen::Vector3f::UnitZ();  ///< unit

  int first_body = 2, first_hand = 2;  ///< where bodies and hands start in `objects`
};

/// Skips what is not finite or refers to things the scene does not have; never fails.
DrawList MakeDrawList(const Picture& picture);

/// Adds tubes, beads and arrows. `scale` widens them for pictures from far away.
void AddPath(const std::vector<PathStretch>& path, float scale, DrawList* list);

/// Adds the item to its list and to the bounds of its object and of the picture, unless it is not
/// finite.
void AddItem(const Item& item, std::vector<Item>* items, DrawList* list);

/// The picture's colour of a body of its scene; where it gives none, wood for fixed bodies, else a
/// palette by index.
Color BodyColor(const Picture& picture, std::size_t body);

inline const Color kSkinColor = {0.878f, 0.675f, 0.525f};

}  // namespace prehend::render
