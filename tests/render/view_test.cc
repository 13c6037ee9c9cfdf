// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/draw_list.h"

namespace prehend::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

const Vector3f kLow(-0.6f, -0.4f, 0.7f), kHigh(0.6f, 0.5f, 1.2f);

Bounds SceneBounds() {
  Bounds bounds;
  bounds.Add(kLow);
  bounds.Add(kHigh);
  return bounds;
}

// Smallest rectangle around the projected corners, in shares of the picture.
struct Extent {
  Vector2f low = {9, 9}, high = {-9, -9};
};

Extent ProjectedExtent(const View& view) {
  Extent extent;
  for (int i = 0; i < 8; ++i) {
    const Vector3f p((i & 1) ? kLow.x() : kHigh.x(), (i & 2) ? kLow.y() : kHigh.y(),
                     (i & 4) ? kLow.z() : kHigh.z());
    const auto pixel = ToPixel(view, p);
    if (!pixel.has_value()) return {{-9, -9}, {9, 9}};
    const Vector2f share(pixel->x() / static_cast<float>(view.width_px),
                         pixel->y() / static_cast<float>(view.height_px));
    extent.low = extent.low.cwiseMin(share);
    extent.high = extent.high.cwiseMax(share);
  }
  return extent;
}

TEST(ViewTest, NamedCamerasFrameTheBoxTightlyAndCentred) {
  ASSERT_EQ(CameraNames().size(), 8u);
  for (const std::string& name : CameraNames()) {
    for (const int width : {1280, 720, 400}) {
      const Camera camera = NamedCamera(name, kLow, kHigh, width / 720.0);
      const Extent extent = ProjectedExtent(MakeView(camera, width, 720, 0, SceneBounds()));
      EXPECT_GT(extent.low.minCoeff(), 0.02f) << name << " " << width;
      EXPECT_LT(extent.high.maxCoeff(), 0.98f) << name << " " << width;
      EXPECT_GT((extent.high - extent.low).maxCoeff(), 0.8f) << name << " " << width;
      EXPECT_NEAR(((extent.high + extent.low) / 2 - Vector2f(0.5f, 0.5f)).norm(), 0, 0.05f)
          << name << " " << width;
    }
  }
}

TEST(ViewTest, CamerasLookFromWhereTheirNamesSay) {
  EXPECT_LT(NamedCamera("front", kLow, kHigh, 1.5).eye_m.y(), kLow.y());
  EXPECT_LT(NamedCamera("left", kLow, kHigh, 1.5).eye_m.x(), kLow.x());
  EXPECT_GT(NamedCamera("right", kLow, kHigh, 1.5).eye_m.x(), kHigh.x());
  EXPECT_GT(NamedCamera("top", kLow, kHigh, 1.5).eye_m.z(), 2);
  EXPECT_EQ(NamedCamera("no such name", kLow, kHigh, 1.5).eye_m,
            NamedCamera("front", kLow, kHigh, 1.5).eye_m);
}

TEST(ViewTest, StripMovesTheMiddleUpAndKeepsProportions) {
  const Camera camera{.eye_m = {0, -2, 1}, .look_at_m = {0, 0, 1}};
  const View whole = MakeView(camera, 800, 600, 0, SceneBounds()),
             part = MakeView(camera, 800, 600, 200, SceneBounds());
  EXPECT_NEAR((*ToPixel(whole, camera.look_at_m) - Vector2f(400, 300)).norm(), 0, 0.01f);
  EXPECT_NEAR((*ToPixel(part, camera.look_at_m) - Vector2f(400, 200)).norm(), 0, 0.01f);
  const auto length = [](const View& view, const Vector3f& p) {
    return (*ToPixel(view, p) - *ToPixel(view, {0, 0, 1})).norm();
  };
  for (const View* view : {&whole, &part})
    EXPECT_NEAR(length(*view, {0.1f, 0, 1}), length(*view, {0, 0, 1.1f}), 0.01f);
}

TEST(ViewTest, PointsBehindTheCameraHaveNoPixel) {
  const View view = MakeView({.eye_m = {0, -2, 1}, .look_at_m = {0, 0, 1}}, 100, 100, 0, {});
  EXPECT_FALSE(ToPixel(view, {0, -3, 1}).has_value());
  EXPECT_FALSE(ToPixel(view, {std::nanf(""), 0, 1}).has_value());
}

TEST(ViewTest, SenselessCamerasAreReplaced) {
  const float nan = std::nanf("");
  const Camera cases[] = {{.eye_m = {nan, 0, 0}},
                          {.eye_m = {1, 1, 1}, .look_at_m = {1, 1, 1}},
                          {.vertical_field_of_view_deg = 0},
                          {.vertical_field_of_view_deg = 180},
                          {.vertical_field_of_view_deg = nan}};
  for (const Camera& camera : cases) {
    EXPECT_EQ(MakeView(camera, 100, 100, 0, {}).world_to_clip(),
              MakeView({}, 100, 100, 0, {}).world_to_clip());
  }
  EXPECT_TRUE(NamedCamera("front", {nan, 0, 0}, {1, 1, 1}, 1).eye_m.allFinite());
  EXPECT_TRUE(NamedCamera("top", {1, 1, 1}, {1, 1, 1}, 0).eye_m.allFinite());
}

TEST(ViewTest, StraightDownIsNotDegenerate) {
  const View view = MakeView({.eye_m = {0, 0, 3}, .look_at_m = {0, 0, 0}}, 100, 100, 0, {});
  EXPECT_LT(ToPixel(view, {0, 0.1f, 0})->y(), 50) << "north is up";
}

TEST(BoundsTest, IgnoresWhatIsNotFinite) {
  Bounds bounds;
  bounds.Add(Vector3f(std::numeric_limits<float>::infinity(), 0, 0));
  EXPECT_TRUE(bounds.empty());
  EXPECT_EQ(bounds.center_m(), Vector3f::Zero());
  bounds.Add(Vector3f(1, 2, 3));
  EXPECT_EQ(bounds.center_m(), Vector3f(1, 2, 3));
}

}  // namespace
}  // namespace prehend::render
