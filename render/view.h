// SPDX-License-Identifier: Apache-2.0
// From metres in the world to pixels: bounds, and the matrices of the camera and the light.
// Tested by tests/render/view_test.cc
#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/picture.h"

namespace prehend::render {

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

}  // namespace prehend::render
