// SPDX-License-Identifier: Apache-2.0
// One picture as a value: what to draw, from where, with which labels and timeline. Draws immutable
// values and knows neither grammar nor simulation. Colours are sRGB 0..1.
// Tested by tests/render/painter_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::render {

using Color = Eigen::Vector3f;

/// A stretch of a hand's path in one phase; one that begins near the end of the one before is
/// joined to it.
struct PathStretch {
  std::string label;  ///< empty: the hand is idle, drawn thin
  Color color = {0.54f, 0.56f, 0.60f};
  std::vector<Eigen::Vector3f> points_m;
  double points_per_s = 60;
};

/// A translucent copy of a hand (and what it holds) at another time.
struct Ghost {
  int hand = 0;
  std::vector<int> bodies;  ///< drawn with it
  physics::Snapshot snapshot;
  Color tint = {0.7f, 0.7f, 0.7f};
};

enum class MarkerKind { kContact, kSupport, kRegion };
struct Marker {
  MarkerKind kind = MarkerKind::kContact;
  Eigen::Vector3f p_W_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_size_m = {0.02f, 0.02f, 0.02f};
};

struct Camera {
  Eigen::Vector3f eye_m = {1.0f, -1.6f, 1.8f};
  Eigen::Vector3f look_at_m = {0, 0, 0.85f};
  float vertical_field_of_view_deg = 33;
};

struct StripSegment {
  std::string label;
  double begin_s = 0, end_s = 0;
  Color color = {0.5f, 0.5f, 0.5f};
};
struct StripRow {
  std::string label;
  std::vector<StripSegment> segments;
};
struct TimelineStrip {
  double begin_s = 0, end_s = 1;
  double playhead_s = 0;
  std::vector<StripRow> rows;
};

inline constexpr int kMaxPictureSide_px = 8192;

struct Picture {
  int width_px = 1280, height_px = 720;
  const physics::Scene* scene = nullptr;  ///< outlives the call
  physics::Snapshot snapshot;
  std::vector<Color> body_colors;        ///< one per scene body; shorter: colours from a palette
  std::vector<std::string> body_labels;  ///< one per scene body, empty: none
  std::vector<std::string> hand_labels;  ///< one per scene hand, empty: none
  std::vector<PathStretch> path;
  std::vector<Ghost> ghosts;
  std::vector<Marker> markers;
  Camera camera;
  Eigen::Vector3f to_light = {0.38f, -0.42f, 0.82f};  ///< the light comes from far away there
  TimelineStrip strip;
  std::string title;
};

struct Image {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from top, 3 bytes a pixel
};

/// Which object is seen at each pixel, exactly and without anti-aliasing: for comparing pictures.
struct IdImage {
  int width_px = 0, height_px = 0;
  std::vector<std::uint32_t> ids;  ///< rows from top; indices into names
  std::vector<std::string>
      names;  ///< "background", "ground", "body:milk", "hand:right_hand", "path:0:reaching", ...
};

inline constexpr const char* kDefaultFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/// Off-screen context; make one per process and draw many pictures (the first costs shader
/// compilation).
class Painter {
 public:
  explicit Painter(const std::string& font_file = kDefaultFontFile);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Empty, or why no picture can be drawn (no context, missing font, failed self-test).
  const std::string& error() const;
  /// An empty image when something failed; then error() says why.
  Image Draw(const Picture& picture);
  /// The same scene from the same camera as object numbers, without labels, strip and markers.
  IdImage DrawIds(const Picture& picture);
  /// "Mesa 22.3.6 llvmpipe ... renderer 1": what the pixels depend on.
  std::string Fingerprint() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// False when the file could not be written.
bool WritePng(const Image& image, const std::string& path);
/// An empty image when the file is missing, broken or larger than a picture may be.
Image ReadPng(const std::string& path);
/// FNV-1a of size and pixels.
std::uint64_t PixelHash(const Image& image);

/// A camera that frames the box [low, high] from a named side: "front", "left", "right", "top",
/// "three_quarter". An unknown name gives nullopt-like default "front"; names are listed by
/// CameraNames().
Camera NamedCamera(const std::string& name, const Eigen::Vector3f& low_m,
                   const Eigen::Vector3f& high_m, double aspect);
const std::vector<std::string>& CameraNames();

}  // namespace prehend::render
