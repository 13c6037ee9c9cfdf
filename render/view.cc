// SPDX-License-Identifier: Apache-2.0
// Camera and light matrices, and the named cameras. Tested by tests/render/view_test.cc
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/draw_list.h"

namespace prehend::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

constexpr float kFilledShare = 0.90f;  // share of the picture filled by the box of a named camera
// Nearer than this only for what is small even there.
constexpr float kMinEyeDistance_m = 0.3f, kSmallShare = 1 / 3.f;

float HalfTangent(float field_of_view_deg) {
  return std::tan(field_of_view_deg * std::numbers::pi_v<float> / 360);
}

// Rows: right, up, towards the eye. In a view straight down, north is up.
Eigen::Matrix3f CameraAxes(const Vector3f& forward) {
  const Vector3f up_hint = std::abs(forward.z()) > 0.999f ? Vector3f::UnitY() : Vector3f::UnitZ();
  Eigen::Matrix3f axes;
  axes.row(0) = forward.cross(up_hint).normalized();
  axes.row(1) = axes.row(0).transpose().cross(forward);
  axes.row(2) = -forward;
  return axes;
}

Matrix4f LookAlong(const Vector3f& eye, const Vector3f& forward) {
  Matrix4f m = Matrix4f::Identity();
  m.topLeftCorner<3, 3>() = CameraAxes(forward);
  m.topRightCorner<3, 1>() = -m.topLeftCorner<3, 3>() * eye;
  return m;
}

bool MakesSense(const Camera& camera) {
  return camera.eye_m.allFinite() && camera.look_at_m.allFinite() &&
         (camera.eye_m - camera.look_at_m).norm() > 1e-4f &&
         camera.vertical_field_of_view_deg > 0.1f && camera.vertical_field_of_view_deg < 170;
}

// Corners of the box in the camera's axes, relative to the camera's target.
std::array<Vector3f, 8> CornersInView(const Eigen::Matrix3f& axes, const Vector3f& look_at,
                                      const Vector3f& low, const Vector3f& high) {
  std::array<Vector3f, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Vector3f p((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                     (i & 4) != 0 ? high.z() : low.z());
    corners[i] = axes * (p - look_at);
  }
  return corners;
}

struct NamedDirection {
  const char* name;
  Vector3f from;  ///< from the box towards the eye
};

const std::vector<NamedDirection>& NamedDirections() {
  static const std::vector<NamedDirection> directions = {
      {"front", {0, -1, 0.42f}},
      {"left", {-1, -0.12f, 0.42f}},
      {"right", {1, -0.12f, 0.42f}},
      {"top", {0, -0.05f, 1}},
      {"three_quarter", {-0.62f, -1, 0.58f}},
      // These frame something else: the hands and what they hold, all that moves, all persons.
      {"hand", {-0.80f, -1, 0.45f}},
      {"action", {-0.62f, -1, 0.50f}},
      {"body", {-0.30f, -1, 0.30f}},
  };
  return directions;
}

}  // namespace

void Bounds::Add(const Vector3f& p_W_m) {
  if (!p_W_m.allFinite()) return;
  low_m = low_m.cwiseMin(p_W_m);
  high_m = high_m.cwiseMax(p_W_m);
}

void Bounds::Add(const Bounds& other) {
  if (other.empty()) return;
  Add(other.low_m);
  Add(other.high_m);
}

View MakeView(const Camera& wanted, int width_px, int height_px, int reserved_px,
              const Bounds& bounds) {
  const Camera camera = MakesSense(wanted) ? wanted : Camera{};
  const float distance = (camera.eye_m - camera.look_at_m).norm();
  const float near = 0.05f * distance;
  const float reach = (camera.eye_m - bounds.center_m()).norm() + bounds.radius_m();
  const float far = std::max(20 * distance, 1.1f * reach);
  const float free_share = static_cast<float>(height_px - reserved_px) / height_px;
  const float zoom = 1 / HalfTangent(camera.vertical_field_of_view_deg);

  View view{.width_px = width_px, .height_px = height_px, .eye_m = camera.eye_m};
  view.world_to_view = LookAlong(camera.eye_m, (camera.look_at_m - camera.eye_m) / distance);
  Matrix4f& m = view.view_to_clip = Matrix4f::Zero();
  m(0, 0) = zoom * free_share * height_px / width_px;
  m(1, 1) = zoom * free_share;
  m(1, 2) = free_share - 1;  // shifts the picture's middle up by half the reserved rows
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2 * far * near / (near - far);
  m(3, 2) = -1;
  return view;
}

std::optional<Eigen::Vector2f> ToPixel(const View& view, const Vector3f& p_W_m) {
  const Eigen::Vector4f clip = view.world_to_clip() * p_W_m.homogeneous();
  if (!clip.allFinite() || clip.w() < 1e-4f) return std::nullopt;
  return Eigen::Vector2f((clip.x() / clip.w() * 0.5f + 0.5f) * view.width_px,
                         (0.5f - clip.y() / clip.w() * 0.5f) * view.height_px);
}

Matrix4f WorldToLight(const Vector3f& to_light, const Vector3f& center_m, float radius_m) {
  Matrix4f ortho = Matrix4f::Identity();
  ortho.diagonal().head<2>().setConstant(1 / radius_m);
  // Objects between the light and the sphere may entity table shadows into it: the depth range
  // starts before them.
  const float near = 0.1f, far = near + 6 * radius_m;
  ortho(2, 2) = -2 / (far - near);
  ortho(2, 3) = -(far + near) / (far - near);
  return ortho * LookAlong(center_m + to_light * (near + 4 * radius_m), -to_light);
}

const std::vector<std::string>& CameraNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const NamedDirection& direction : NamedDirections()) all.push_back(direction.name);
    return all;
  }();
  return names;
}

Camera NamedCamera(const std::string& name, const Vector3f& low_m, const Vector3f& high_m,
                   double aspect) {
  const auto& directions = NamedDirections();
  const auto found = std::find_if(directions.begin(), directions.end(),
                                  [&](const auto& d) { return d.name == name; });
  return CameraFrom((found == directions.end() ? directions.front() : *found).from, low_m, high_m,
                    aspect);
}

Camera CameraFrom(const Vector3f& towards_the_eye, const Vector3f& low_m, const Vector3f& high_m,
                  double aspect) {
  const Vector3f from = towards_the_eye.normalized();
  Camera camera;
  if (!low_m.allFinite() || !high_m.allFinite()) return camera;
  const float tangent_y = kFilledShare * HalfTangent(camera.vertical_field_of_view_deg);
  const Eigen::Array2f tangent(tangent_y * static_cast<float>(std::clamp(aspect, 0.1, 10.0)),
                               tangent_y);
  const Eigen::Matrix3f axes = CameraAxes(-from);
  Vector3f look_at = (low_m + high_m) / 2;
  float distance = 1;
  // In perspective near corners are further out than far ones: move the target to their middle,
  // then repeat.
  for (int round = 0; round < 4; ++round) {
    const std::array<Vector3f, 8> corners = CornersInView(axes, look_at, low_m, high_m);
    float filled = 0;
    for (const Vector3f& q : corners)
      filled = std::max(filled, q.z() + (q.head<2>().array().abs() / tangent).maxCoeff());
    distance = std::max({filled, std::min(kMinEyeDistance_m, filled / kSmallShare), 1e-3f});
    Eigen::Array2f least = Eigen::Array2f::Constant(1e9f), most = -least;
    for (const Vector3f& q : corners) {
      const Eigen::Array2f slope = q.head<2>().array() / (distance - q.z());
      least = least.min(slope);
      most = most.max(slope);
    }
    const Eigen::Vector2f shift = (least + most).matrix() / 2 * distance;
    if (round < 3) look_at += axes.topRows<2>().transpose() * shift;
  }
  camera.look_at_m = look_at;
  camera.eye_m = look_at + distance * from;
  return camera;
}

}  // namespace prehend::render
