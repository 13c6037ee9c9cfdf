// SPDX-License-Identifier: Apache-2.0
// Solids of revolution from a profile and a list of meridians, and tubes by parallel transport.
// Tested by tests/render/gl/mesh_test.cc
#include "render/gl/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/base/check.h"

namespace prehend::render {
namespace {

using Eigen::Vector3f;
constexpr float kPi = std::numbers::pi_v<float>;

// One ring of a solid of revolution; rings are listed from top to bottom.
struct ProfilePoint {
  float direction_radial, direction_z;
  float corner_radial, corner_z;
};

// One direction around z; a box has several meridians at the same angle with different corners.
struct Meridian {
  float cosine, sine;
  float corner_x, corner_y;
};

Mesh Revolve(const std::vector<ProfilePoint>& profile, const std::vector<Meridian>& meridians) {
  Mesh mesh;
  for (const ProfilePoint& p : profile) {
    for (const Meridian& m : meridians) {
      mesh.vertices.push_back(
          {{p.corner_radial * m.corner_x, p.corner_radial * m.corner_y, p.corner_z},
           {p.direction_radial * m.cosine, p.direction_radial * m.sine, p.direction_z}});
    }
  }
  const auto around = static_cast<std::uint32_t>(meridians.size());
  for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (std::uint32_t i = 0; i + 1 < around; ++i) {
      const std::uint32_t upper = ring * around + i, lower = upper + around;
      mesh.triangles.insert(mesh.triangles.end(),
                            {upper, lower, upper + 1, upper + 1, lower, lower + 1});
    }
  }
  return mesh;
}

// Flat top, a quarter arc, the side, a quarter arc, flat bottom.
std::vector<ProfilePoint> RoundedProfile(int segments) {
  std::vector<ProfilePoint> profile = {{0, 1, 0, 1}};
  for (const float side : {1.0f, -1.0f}) {
    for (int i = 0; i <= segments; ++i) {
      const float angle = kPi / 2 * (static_cast<float>(i) / segments + (side > 0 ? 0 : 1));
      profile.push_back({std::sin(angle), std::cos(angle), 1, side});
    }
  }
  profile.push_back({0, -1, 0, -1});
  return profile;
}

// Direction between the first two points that differ.
Vector3f FirstDirection(const std::vector<Vector3f>& points) {
  for (const Vector3f& p : points) {
    const Vector3f chord = p - points.front();
    if (chord.norm() > 1e-9f) return chord.normalized();
  }
  return Vector3f::UnitX();
}

std::vector<Meridian> CircleMeridians(int segments) {
  std::vector<Meridian> meridians;
  for (int i = 0; i <= 4 * segments; ++i) {
    const float angle = kPi / 2 * static_cast<float>(i % (4 * segments)) / segments;
    const float c = std::cos(angle), s = std::sin(angle);
    meridians.push_back({c, s, c, s});
  }
  return meridians;
}

}  // namespace

Mesh RoundedBoxMesh(int segments) {
  std::vector<Meridian> meridians;
  constexpr float kCornerX[] = {1, -1, -1, 1}, kCornerY[] = {1, 1, -1, -1};
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    for (int i = 0; i <= segments; ++i) {
      const float angle = kPi / 2 * (quadrant + static_cast<float>(i) / segments);
      meridians.push_back(
          {std::cos(angle), std::sin(angle), kCornerX[quadrant], kCornerY[quadrant]});
    }
  }
  meridians.push_back(meridians.front());
  return Revolve(RoundedProfile(segments), meridians);
}

Mesh RoundedCylinderMesh(int segments) {
  return Revolve(RoundedProfile(segments), CircleMeridians(2 * segments));
}

Mesh ConeMesh(int segments) {
  constexpr float kSlope = 0.4f;  // the normal's z for the flattest cone that is drawn
  const float radial = std::sqrt(1 - kSlope * kSlope);
  return Revolve({{radial, kSlope, 0, 1}, {radial, kSlope, 1, 0}, {0, -1, 1, 0}, {0, -1, 0, 0}},
                 CircleMeridians(segments));
}

Mesh HullMesh(const physics::Hull& hull) {
  Mesh mesh;
  for (const physics::Hull::Face& face : hull.faces) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const int corner : face.corners) {
      PREHEND_DCHECK(corner >= 0 && corner < std::ssize(hull.corners_m));
      mesh.vertices.push_back({hull.corners_m[static_cast<std::size_t>(corner)].cast<float>(),
                               face.nhat_S.cast<float>()});
    }
    for (std::uint32_t i = 2; i < face.corners.size(); ++i)
      mesh.triangles.insert(mesh.triangles.end(), {first, first + i - 1, first + i});
  }
  return mesh;
}

Mesh TubeMesh(const std::vector<Vector3f>& points, int segments) {
  Mesh mesh;
  if (points.size() < 2) return mesh;
  Vector3f tangent = FirstDirection(points);
  Vector3f across = tangent.unitOrthogonal();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f chord = points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1];
    const Vector3f next = chord.norm() > 1e-9f ? Vector3f(chord.normalized()) : tangent;
    // Rotating the frame with the tangent prevents twist of the tube.
    across = (RotationBetween(tangent, next) * across).normalized();
    tangent = next;
    const Vector3f up = tangent.cross(across);
    for (int k = 0; k <= segments; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k % segments) / segments;
      mesh.vertices.push_back({points[i], std::cos(angle) * across + std::sin(angle) * up});
    }
  }
  const auto around = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t ring = 0; ring + 1 < points.size(); ++ring) {
    for (std::uint32_t k = 0; k + 1 < around; ++k) {
      const std::uint32_t here = ring * around + k, ahead = here + around;
      mesh.triangles.insert(mesh.triangles.end(),
                            {here, here + 1, ahead, here + 1, ahead + 1, ahead});
    }
  }
  return mesh;
}

Eigen::Quaternionf RotationBetween(const Vector3f& from, const Vector3f& to) {
  return Eigen::Quaternionf::FromTwoVectors(from, to);
}

}  // namespace prehend::render
