// SPDX-License-Identifier: Apache-2.0
// The content of a picture before any pixel is drawn: placed primitives with colours, in drawing
// order. A value that tests can inspect and that can be compared between runs.
// Tested by tests/render/draw_list_test.cc
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "render/gl/gl_objects.h"
#include "render/picture.h"

namespace prehend::render {

// From metres in the world to pixels: bounds, and the matrices of the camera and the light.
// Tested by tests/render/view_test.cc

/// Axis-aligned box in the world; empty until a finite point is added.
struct Bounds {
  Eigen::Vector3f low_m = Eigen::Vector3f::Constant(1e30f);
  Eigen::Vector3f high_m = Eigen::Vector3f::Constant(-1e30f);

  bool empty() const { return low_m.x() > high_m.x(); }
  void Add(const Eigen::Vector3f& p_W_m);
  void Add(const Bounds& other);
  Eigen::Vector3f center_m() const {
    return empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f((low_m + high_m) / 2);
  }
  float radius_m() const { return empty() ? 0.5f : (high_m - low_m).norm() / 2; }
};

struct View {
  int width_px = 0, height_px = 0;
  Eigen::Vector3f eye_m = Eigen::Vector3f::Zero();
  Eigen::Matrix4f world_to_view = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f view_to_clip = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f world_to_clip() const { return view_to_clip * world_to_view; }
};

/// The camera's view. The field of view spans the part above `reserved_px` pixel rows at the bottom
/// (the strip), so that the camera's target is in the middle of the visible part. An invalid camera
/// is replaced by the default.
View MakeView(const Camera& camera, int width_px, int height_px, int reserved_px,
              const Bounds& bounds);

/// Pixel of a point, y down; nullopt if it is not in front of the camera.
std::optional<Eigen::Vector2f> ToPixel(const View& view, const Eigen::Vector3f& p_W_m);

/// Matrix of a parallel light from `to_light` whose shadow map covers the sphere.
Eigen::Matrix4f WorldToLight(const Eigen::Vector3f& to_light, const Eigen::Vector3f& center_m,
                             float radius_m);

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
  bool shines_through = false;  ///< a marker that is faintly visible through solids
};

/// A named object: "body:milk", "hand:right_hand", "forearm:right_hand", "path:2:reaching",
/// "ghost:0:right_hand", "marker:1:contact", "leg:table", "gaze:0".
struct DrawnObject {
  std::string name;
  Bounds bounds;
  std::optional<Color> color = std::nullopt;  ///< of its first item
  float alpha = 1;
  std::string note = "";  ///< what else an inventory says of it
};

struct DrawList {
  std::vector<DrawnObject> objects;  ///< 0 is the background, 1 the ground; then bodies, hands,
                                     ///< forearms, paths, ghosts, markers, props, gazes
  std::vector<Mesh> meshes;          ///< meshes of paths and hulls
  std::vector<Item> solids;          ///< bodies and hands
  std::vector<Item> paths;           ///< faintly visible through solids
  std::vector<std::vector<Item>> ghosts;                ///< each translucent as a whole
  std::vector<Item> markers;                            ///< translucent
  Bounds bounds;                                        ///< of all objects but the ground
  Eigen::Vector3f to_light = Eigen::Vector3f::UnitZ();  ///< unit

  Theme theme = Theme::kLight;
  Color paper = {1, 1, 1};

  int first_body = 2, first_hand = 2;  ///< first body and first hand in `objects`
};

/// Skips values that are not finite or refer to missing objects; never fails.
DrawList MakeDrawList(const Picture& picture);

/// Adds tubes, beads and arrows of a path. `scale` widens them for distant cameras.
void AddPath(const std::vector<PathInterval>& path, float scale, DrawList* list);

/// One per scene body: whether it is a part of a person, which AddPersons() draws.
std::vector<bool> DrawnAsMannequin(const physics::Scene& scene);

/// Adds persons as artists' mannequins (render/draw_person.cc). The objects of all bodies have been
/// added. Parts that are translucent in the picture are drawn together, after what is solid.
void AddPersons(const Picture& picture, DrawList* list);

/// Adds the item to its list, and to the bounds of its object and of the picture. Ignores an item
/// that is not finite.
void AddItem(const Item& item, std::vector<Item>* items, DrawList* list);

/// The picture's colour of a scene body; without one, wood for fixed bodies, else a palette by
/// index.
Color BodyColor(const Picture& picture, std::size_t body);

inline const Color kSkinColor = {0.878f, 0.675f, 0.525f};

}  // namespace prehend::render
