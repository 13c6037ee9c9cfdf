// SPDX-License-Identifier: Apache-2.0
// Faces, then their outlines, then mass properties from tetrahedra.
#include "physics/scene/hull.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace prehend::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// A point this near to a plane or an edge lies on it; larger than single-precision rounding at one
/// metre.
constexpr double kOnPlane_m = 1e-7;

double HeightOver(const Hull::Face& face, const Vector3d& p) {
  return face.nhat_S.dot(p) - face.offset_m;
}

/// The face in the plane through three points, if no other point is outside.
std::optional<Hull::Face> FaceThrough(const Points& points, int a, int b, int c) {
  const Vector3d normal = (points[b] - points[a]).cross(points[c] - points[a]);
  const double longest = std::max({(points[b] - points[a]).norm(), (points[c] - points[a]).norm(),
                                   (points[c] - points[b]).norm()});
  if (normal.norm() <= longest * kOnPlane_m) return std::nullopt;  // collinear
  Hull::Face face{.nhat_S = normal.normalized(), .offset_m = 0};
  face.offset_m = face.nhat_S.dot(points[a]);
  bool above = false, below = false;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const double height = HeightOver(face, points[i]);
    above |= height > kOnPlane_m;
    below |= height < -kOnPlane_m;
    if (above && below) return std::nullopt;
    if (std::abs(height) <= kOnPlane_m) face.corners.push_back(i);
  }
  if (!above) return face;
  face.nhat_S = -face.nhat_S;
  face.offset_m = -face.offset_m;
  return face;
}

/// All faces, those with many points first. Two faces share at most an edge; two that share more
/// and have the same normal are one face with rounding errors.
std::vector<Hull::Face> FacesOf(const Points& points) {
  const int count = static_cast<int>(points.size());
  std::vector<Hull::Face> found;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      for (int c = b + 1; c < count; ++c)
        if (auto face = FaceThrough(points, a, b, c)) found.push_back(std::move(*face));
  std::stable_sort(found.begin(), found.end(), [](const auto& l, const auto& r) {
    return l.corners.size() > r.corners.size();
  });
  std::vector<Hull::Face> faces;
  const auto same = [](const Hull::Face& l, const Hull::Face& r) {
    constexpr double kSameWay =
        0.9999;  // cosine; rounding tilts no face by more, as points are far apart
    return l.nhat_S.dot(r.nhat_S) > kSameWay &&
           std::count_if(l.corners.begin(), l.corners.end(), [&](int corner) {
             return std::binary_search(r.corners.begin(), r.corners.end(), corner);
           }) > 2;
  };
  for (Hull::Face& face : found) {
    if (std::none_of(faces.begin(), faces.end(),
                     [&](const auto& other) { return same(face, other); }))
      faces.push_back(std::move(face));
  }
  return faces;
}

/// Keeps the corners of the face's outline, counter-clockwise (Andrew's monotone chain).
void FindOutline(const Points& points, Hull::Face& face) {
  const Vector3d u = face.nhat_S.unitOrthogonal(), v = face.nhat_S.cross(u);
  const auto flat = [&](int i) { return Eigen::Vector2d(u.dot(points[i]), v.dot(points[i])); };
  std::sort(face.corners.begin(), face.corners.end(), [&](int l, int r) {
    const Eigen::Vector2d a = flat(l), b = flat(r);
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  const auto chain = [&](auto begin, auto end) {
    std::vector<int> kept;
    for (auto at = begin; at != end; ++at) {
      const auto turns_left = [&] {
        const Eigen::Vector2d last = flat(kept.back()), from = flat(kept[kept.size() - 2]),
                              way = flat(*at) - from;
        const Eigen::Vector2d off = last - from;
        return off.x() * way.y() - off.y() * way.x() > kOnPlane_m * way.norm();
      };
      while (kept.size() > 1 && !turns_left()) kept.pop_back();
      kept.push_back(*at);
    }
    kept.pop_back();
    return kept;
  };
  std::vector<int> outline = chain(face.corners.begin(), face.corners.end());
  const std::vector<int> back = chain(face.corners.rbegin(), face.corners.rend());
  outline.insert(outline.end(), back.begin(), back.end());
  face.corners = std::move(outline);
}

/// Volume, centre of mass and moments, from the tetrahedra between each triangle of the surface and
/// the first corner.
void Weigh(Hull& hull) {
  const Vector3d origin = hull.corners_m.front();
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (const Hull::Face& face : hull.faces) {
    for (std::size_t i = 2; i < face.corners.size(); ++i) {
      const Vector3d a = hull.corners_m[face.corners[0]] - origin,
                     b = hull.corners_m[face.corners[i - 1]] - origin,
                     c = hull.corners_m[face.corners[i]] - origin;
      const double volume = a.dot(b.cross(c)) / 6;
      const Vector3d sum = a + b + c;
      hull.volume_m3 += volume;
      first += volume / 4 * sum;
      second += volume / 20 *
                (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
  }
  const Vector3d centre = first / hull.volume_m3;
  const Matrix3d spread = second / hull.volume_m3 - centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(spread.trace() * Matrix3d::Identity() -
                                                     spread);
  Matrix3d R = axes.eigenvectors();
  if (R.determinant() < 0) R.col(2) = -R.col(2);
  hull.gyration_m2 = axes.eigenvalues();
  hull.X_SC = {origin + centre, Eigen::Quaterniond(R)};
}

MadeHull NoHull(int point, std::string problem, std::string remedy) {
  return {.hull = std::nullopt,
          .point = point,
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

std::optional<MadeHull> FindDouble(const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((points[i] - points[j]).norm() < kMinHullPointDistance_m)
        return NoHull(
            static_cast<int>(i),
            "point " + std::to_string(i) + " is at the same place as point " + std::to_string(j),
            "points must be at least 0.1 mm apart; the first one is point 0");
    }
  }
  return std::nullopt;
}

/// The smallest distance of two parallel planes with all points between them, one of them a face.
double ThicknessOf(const Hull& hull) {
  double thinnest = HUGE_VAL;
  for (const Hull::Face& face : hull.faces) {
    double deepest = 0;
    for (const Vector3d& corner : hull.corners_m)
      deepest = std::max(deepest, -HeightOver(face, corner));
    thinnest = std::min(thinnest, deepest);
  }
  return hull.faces.size() < 4 ? 0 : thinnest;
}

Vector3d NearestOnEdge(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const Vector3d way = b - a;
  return a + way * std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
}

Vector3d NearestOn(const Hull& hull, const Hull::Face& face, const Vector3d& p) {
  const Vector3d foot = p - HeightOver(face, p) * face.nhat_S;
  Vector3d nearest = foot;
  double least = HUGE_VAL;
  bool inside = true;
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vector3d &a = hull.corners_m[face.corners[i]],
                   &b = hull.corners_m[face.corners[(i + 1) % face.corners.size()]];
    inside &= (b - a).cross(foot - a).dot(face.nhat_S) >= 0;
    const Vector3d on_edge = NearestOnEdge(a, b, p);
    if ((on_edge - p).norm() < least) nearest = on_edge, least = (on_edge - p).norm();
  }
  return inside ? foot : nearest;
}

}  // namespace

MadeHull MakeHull(const Points& points_m) {
  if (auto twice = FindDouble(points_m)) return *twice;
  Hull hull{.corners_m = points_m,
            .faces = FacesOf(points_m),
            .volume_m3 = 0,
            .gyration_m2 = Vector3d::Zero()};
  if (ThicknessOf(hull) < kMinHullThickness_m) {
    return NoHull(-1, "the points lie in a plane, or within 1 mm of one",
                  "a hull is a solid: add points on both sides of the plane");
  }
  std::vector<bool> is_corner(points_m.size());
  for (Hull::Face& face : hull.faces) {
    FindOutline(points_m, face);
    for (const int corner : face.corners) is_corner[static_cast<std::size_t>(corner)] = true;
  }
  const auto inner = std::find(is_corner.begin(), is_corner.end(), false);
  if (inner != is_corner.end()) {
    const auto point = static_cast<int>(inner - is_corner.begin());
    return NoHull(
        point,
        "point " + std::to_string(point) +
            " is not a corner: it lies inside, on a face or on an edge of the hull",
        "leave it out; build a shape that is not convex from 'parts'. The first point is point 0");
  }
  Weigh(hull);
  return {.hull = std::move(hull), .point = -1, .problem = {}};
}

Vector3d NearestIn(const Hull& hull, const Vector3d& p_S) {
  Vector3d nearest = p_S;
  double least = HUGE_VAL;
  for (const Hull::Face& face : hull.faces) {
    if (HeightOver(face, p_S) <= 0)
      continue;  // the nearest point is on a face that is visible from p_S
    const Vector3d on_face = NearestOn(hull, face, p_S);
    if ((on_face - p_S).norm() < least) nearest = on_face, least = (on_face - p_S).norm();
  }
  return nearest;
}

double SignedDistance(const Hull& hull, const Vector3d& p_S) {
  double highest = -HUGE_VAL;
  for (const Hull::Face& face : hull.faces) highest = std::max(highest, HeightOver(face, p_S));
  return highest <= 0 ? highest : (p_S - NearestIn(hull, p_S)).norm();
}

Points EdgesOf(const Hull& hull) {
  constexpr double kParallel = 1e-6;
  Points edges;
  for (const Hull::Face& face : hull.faces) {
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const int next = face.corners[(i + 1) % face.corners.size()];
      const Vector3d edge = (hull.corners_m[next] - hull.corners_m[face.corners[i]]).normalized();
      const bool known = std::any_of(edges.begin(), edges.end(), [&](const Vector3d& other) {
        return edge.cross(other).norm() < kParallel;
      });
      if (!known) edges.push_back(edge);
    }
  }
  return edges;
}

}  // namespace prehend::physics
