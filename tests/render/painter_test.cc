// SPDX-License-Identifier: Apache-2.0
// Pictures as a whole. One painter serves all tests, as it would in a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "render/picture.h"
#include "tests/render/demo_picture.h"

namespace prehend::render {
namespace {

using Eigen::Vector3f;

class PainterTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { painter_ = new Painter; }
  static void TearDownTestSuite() { delete painter_; }
  void SetUp() override {
    ASSERT_EQ(painter_->error(), "");
    scene_ = DemoScene();
    picture_ = DemoPicture(scene_);
    picture_.width_px = 480;
    picture_.height_px = 300;
  }

  Image Draw(const Picture& picture) {
    Image image = painter_->Draw(picture);
    EXPECT_EQ(painter_->error(), "");
    EXPECT_EQ(image.rgb.size(), 3u * picture.width_px * picture.height_px);
    return image;
  }

  static Painter* painter_;
  physics::Scene scene_;
  Picture picture_;
};
Painter* PainterTest::painter_ = nullptr;

Vector3f Pixel(const Image& image, std::size_t i) {
  return Vector3f(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]) / 255;
}

// A colour's direction away from gray; shading changes it much less than brightness.
Vector3f Hue(const Vector3f& color) { return (color.array() - color.mean()).matrix().normalized(); }

int PixelsExactly(const Image& image, const Color& color) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size() / 3; ++i)
    count += (Pixel(image, i) - color).cwiseAbs().maxCoeff() < 0.003f ? 1 : 0;
  return count;
}

int PixelsThatDiffer(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size() / 3; ++i) count += Pixel(a, i) != Pixel(b, i) ? 1 : 0;
  return count;
}

std::map<std::string, int> PixelsByName(const IdImage& image) {
  std::map<std::string, int> counts;
  for (const std::uint32_t id : image.ids) ++counts[image.names.at(id)];
  return counts;
}

TEST_F(PainterTest, FingerprintNamesWhatPixelsDependOn) {
  const std::string text = painter_->Fingerprint();
  EXPECT_NE(text.find("Mesa"), std::string::npos) << text;
  EXPECT_NE(text.find("llvmpipe"), std::string::npos) << text;
  EXPECT_NE(text.find("renderer "), std::string::npos) << text;
}

TEST_F(PainterTest, SamePictureSamePixels) {
  const std::uint64_t first = PixelHash(Draw(picture_));
  Picture other = picture_;
  other.width_px = 200;
  other.path.clear();
  EXPECT_NE(PixelHash(Draw(other)), first);
  EXPECT_EQ(PixelHash(Draw(picture_)), first) << "after a picture of another size";
  Painter second;
  EXPECT_EQ(PixelHash(second.Draw(picture_)), first) << "from another context";
  EXPECT_EQ(PixelHash(Draw(picture_)), first) << "while another context lives";
}

TEST_F(PainterTest, TubesHaveTheColourOfTheirPhase) {
  picture_.ghosts.clear();
  picture_.markers.clear();
  picture_.body_labels.clear();
  picture_.hand_labels.clear();
  const Image image = Draw(picture_);
  const IdImage ids = painter_->DrawIds(picture_);
  ASSERT_EQ(ids.ids.size(), image.rgb.size() / 3);
  for (const std::size_t interval : {0, 3, 4, 5}) {
    const std::string name =
        "path:" + std::to_string(interval) + ":" + picture_.path[interval].label;
    const Vector3f hue = Hue(picture_.path[interval].color);
    int of_tube = 0, in_color = 0;
    for (std::size_t i = 0; i < ids.ids.size(); ++i) {
      if (ids.names[ids.ids[i]] != name) continue;
      ++of_tube;
      in_color += Hue(Pixel(image, i)).dot(hue) > 0.93f ? 1 : 0;
    }
    EXPECT_GT(of_tube, 60) << name;
    EXPECT_GT(in_color, 0.7 * of_tube) << name;
  }
}

TEST_F(PainterTest, ChangingOnePhaseColourIsSeen) {
  const Image before = Draw(picture_);
  picture_.path[3].color = {0.9f, 0.1f, 0.6f};
  EXPECT_GT(PixelsThatDiffer(before, Draw(picture_)), 100);
}

TEST_F(PainterTest, IdsTellWhoIsWhere) {
  const IdImage ids = painter_->DrawIds(picture_);
  const std::map<std::string, int> counts = PixelsByName(ids);
  for (const char* name : {"background", "body:table", "body:milk", "body:mug", "hand:right_hand",
                           "path:0:reaching", "ghost:2:right_hand"}) {
    EXPECT_GT(counts.contains(name) ? counts.at(name) : 0, 20) << name;
  }
  EXPECT_EQ(ids.names.at(ids.ids.front()), "background") << "rows start at the top";
  EXPECT_EQ(painter_->DrawIds(picture_).ids, ids.ids);
}

TEST_F(PainterTest, StripIsDrawnInItsExactColours) {
  picture_.path.clear();
  const Image with = Draw(picture_);
  const Color blue = picture_.strip.rows[0].segments[4].color;
  EXPECT_GT(PixelsExactly(with, blue), 100);
  picture_.strip.rows[0].segments.clear();
  EXPECT_EQ(PixelsExactly(Draw(picture_), blue), 0);
}

TEST_F(PainterTest, LabelsOfThingsThatTheSceneLacksAreIgnored) {
  const Image plain = Draw(picture_);
  picture_.body_labels.resize(scene_.bodies.size() + 1, "nobody");
  picture_.hand_labels.resize(scene_.hands.size() + 1, "nobody");
  EXPECT_EQ(PixelsThatDiffer(plain, Draw(picture_)), 0);
}

TEST_F(PainterTest, LabelsTitleAndMarkersAreDrawn) {
  const Image plain = Draw(picture_);
  const auto changed = [&](const auto& change) {
    Picture other = picture_;
    change(&other);
    return PixelsThatDiffer(plain, Draw(other));
  };
  EXPECT_GT(changed([](Picture* p) { p->body_labels[1] = ""; }), 100);
  EXPECT_GT(changed([](Picture* p) { p->hand_labels = {}; }), 100);
  EXPECT_GT(changed([](Picture* p) { p->title = ""; }), 300);
  EXPECT_GT(changed([](Picture* p) { p->markers.pop_back(); }), 500);
  EXPECT_GT(changed([](Picture* p) { p->ghosts.pop_back(); }), 300);
}

TEST_F(PainterTest, HiddenPathsShineThrough) {
  scene_.bodies = {{.name = "wall", .shapes = {{physics::Box{{2, 0.02, 2}}, {}}}, .fixed = true}};
  const Picture without{.width_px = 200,
                        .height_px = 200,
                        .scene = &scene_,
                        .camera = {.eye_m = {0, -3, 0}, .look_at_m = {0, 0, 0}}};
  Picture with = without;
  with.path = {{"reaching", {1, 0, 0}, {{-0.4f, 0.5f, 0}, {0.4f, 0.5f, 0}}}};
  const Image before = Draw(without), after = Draw(with);
  int fainter = 0;
  for (std::size_t i = 0; i < before.rgb.size() / 3; ++i) {
    const float change = (Pixel(before, i) - Pixel(after, i)).cwiseAbs().maxCoeff();
    EXPECT_LT(change, 0.25f);
    fainter += change > 0.05f ? 1 : 0;
  }
  EXPECT_GT(fainter, 40);
}

TEST_F(PainterTest, EmptyAndTinyPicturesAreDrawn) {
  Draw({.width_px = 64, .height_px = 64});
  Draw({.width_px = 1, .height_px = 1});
  Draw({.width_px = 7, .height_px = 1000, .strip = picture_.strip, .title = "title"});
  picture_.width_px = picture_.height_px = 64;
  Draw(picture_);
}

TEST_F(PainterTest, NonsenseIsDrawnWithoutHarm) {
  const double nan = std::nan("");
  const float nanf = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  picture_.camera.eye_m.x() = nanf;
  picture_.path[0].points_m = {{nanf, nanf, nanf}};
  picture_.path[1].points_m.clear();
  picture_.path[2].points_m.assign(3, {1e30f, 0, -1e30f});
  picture_.path[3].points_m[10] = {infinity, 0, 0};
  picture_.path[4].color = {nanf, 0, 0};
  picture_.snapshot.bodies.resize(1);
  picture_.snapshot.hands[0].X_WL.resize(3);
  picture_.snapshot.hands[0].palm.X_WB.p_m.z() = nan;
  picture_.markers[0].half_size_m = {-1, 0, nanf};
  picture_.body_labels.assign(100, "too many \xFF labels");
  picture_.strip.rows[0].segments[0].begin_s = nan;
  picture_.strip.playhead_s = nan;
  Draw(picture_);
}

TEST_F(PainterTest, AThousandBodiesAreDrawn) {
  physics::Scene many;
  for (int i = 0; i < 1000; ++i) {
    const physics::Shape shapes[] = {physics::Box{}, physics::Sphere{}, physics::Cylinder{},
                                     physics::Capsule{0.03, 0.1}};
    many.bodies.push_back({.name = "b",
                           .shapes = {{shapes[i % 4], {}}},
                           .X_WB = {{0.3 * (i % 32), 0.3 * (i / 32), 0.1}, {1, 0, 0, 0}}});
  }
  const Camera camera = NamedCamera("three_quarter", {0, 0, 0}, {9.6f, 9.6f, 0.2f}, 1.5);
  const Picture picture{.width_px = 480,
                        .height_px = 320,
                        .scene = &many,
                        .body_labels = std::vector<std::string>(1000, "body"),
                        .camera = camera};
  Draw(picture);
  EXPECT_GT(PixelsByName(painter_->DrawIds(picture))["b"] +
                PixelsByName(painter_->DrawIds(picture))["body:b"],
            5000);
}

TEST_F(PainterTest, ImpossibleSizesAreErrorsAndDoNotStick) {
  for (const auto& [width, height] :
       {std::pair{0, 100}, {100, -1}, {kMaxPictureSide_px + 1, 100}, {100, 1 << 30}}) {
    picture_.width_px = width;
    picture_.height_px = height;
    EXPECT_TRUE(painter_->Draw(picture_).rgb.empty());
    EXPECT_NE(painter_->error().find(std::to_string(height)), std::string::npos)
        << painter_->error();
    EXPECT_TRUE(painter_->DrawIds(picture_).ids.empty());
  }
  Draw({.width_px = kMaxPictureSide_px, .height_px = 8});
}

TEST(PainterErrorTest, MissingFontIsSaidAndNothingIsDrawn) {
  Painter painter("/no/such/font.ttf");
  EXPECT_NE(painter.error().find("/no/such/font.ttf"), std::string::npos);
  EXPECT_TRUE(painter.Draw({}).rgb.empty());
  EXPECT_TRUE(painter.DrawIds({}).ids.empty());
  EXPECT_EQ(painter.Fingerprint(), "");
  EXPECT_FALSE(painter.error().empty());
}

}  // namespace
}  // namespace prehend::render
