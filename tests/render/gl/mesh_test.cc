// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "render/gl/gl_objects.h"

namespace prehend::render {
namespace {

using Eigen::Vector3f;

Vector3f PositionOf(const Vertex& vertex, const Vector3f& half, float rounding) {
  return vertex.corner.cwiseProduct(half) + vertex.direction * rounding;
}

// Volume by the divergence theorem: right only if the mesh is closed and every triangle faces
// outwards.
float Volume(const Mesh& mesh, const Vector3f& half, float rounding) {
  double volume = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return PositionOf(mesh.vertices[mesh.triangles[i + k]], half, rounding);
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return static_cast<float>(volume);
}

constexpr float kPi = std::numbers::pi_v<float>;

TEST(MeshTest, VolumesAreThoseOfTheSolids) {
  const struct {
    const char* what;
    Mesh mesh;
    Vector3f half;
    float rounding;
    float volume;
  } kCases[] = {
      {"sharp box", RoundedBoxMesh(4), {1, 2, 3}, 0, 48},
      {"ball", RoundedBoxMesh(16), {0, 0, 0}, 1, 4 * kPi / 3},
      {"capsule", RoundedBoxMesh(16), {0, 0, 1}, 1, 4 * kPi / 3 + 2 * kPi},
      {"cylinder", RoundedCylinderMesh(16), {1, 1, 2}, 0, 4 * kPi},
      {"cone", ConeMesh(32), {1, 1, 3}, 0, kPi},
  };
  for (const auto& c : kCases)
    EXPECT_NEAR(Volume(c.mesh, c.half, c.rounding), c.volume, 0.01f * c.volume) << c.what;
}

TEST(MeshTest, DirectionsAreUnitVectors) {
  for (const Mesh& mesh : {RoundedBoxMesh(3), RoundedCylinderMesh(3), ConeMesh(3)}) {
    for (const Vertex& vertex : mesh.vertices) EXPECT_NEAR(vertex.direction.norm(), 1, 1e-5f);
  }
}

TEST(MeshTest, TubeKeepsItsRadiusAroundBends) {
  const std::vector<Vector3f> corner = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  const Mesh mesh = TubeMesh(corner, 8);
  ASSERT_EQ(mesh.vertices.size(), corner.size() * 9);
  for (const Vertex& vertex : mesh.vertices) EXPECT_NEAR(vertex.direction.norm(), 1, 1e-5f);
}

TEST(MeshTest, TubeFacesOutwards) {
  const Mesh mesh = TubeMesh({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, 64);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return PositionOf(mesh.vertices[mesh.triangles[i + k]], {1, 1, 1}, 0.1f);
    };
    const Vector3f normal = (at(1) - at(0)).cross(at(2) - at(0));
    EXPECT_GT(normal.dot(mesh.vertices[mesh.triangles[i]].direction), 0);
  }
}

TEST(MeshTest, TubeOfNothingIsEmpty) {
  EXPECT_TRUE(TubeMesh({}, 8).triangles.empty());
  EXPECT_TRUE(TubeMesh({{1, 2, 3}}, 8).triangles.empty());
}

TEST(MeshTest, TubeWithARepeatedPointStaysFinite) {
  for (const Vertex& vertex : TubeMesh({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 8).vertices) {
    EXPECT_TRUE(vertex.corner.allFinite());
    EXPECT_TRUE(vertex.direction.allFinite());
  }
}

}  // namespace
}  // namespace prehend::render
