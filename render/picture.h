// SPDX-License-Identifier: Apache-2.0
// One picture as a value: what to draw, from which camera, with which labels and timeline. It knows
// neither grammar nor simulation. Tested by tests/render/painter_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "render/image/image.h"

namespace prehend::render {

/// An interval of a hand's path in one phase. An interval that begins near the end of the previous
/// one is joined to it.
struct PathInterval {
  std::string label;  ///< empty: the hand is idle, and the path thin
  Color color = {0.54f, 0.56f, 0.60f};
  std::vector<Eigen::Vector3f> points_m;
  double points_per_s = 60;
  bool square_beads = false;  ///< tells a second hand's path from the first one's
};

/// A translucent copy of a hand and the objects that it holds, at another time.
struct Ghost {
  physics::HandIndex hand = physics::HandIndex(0);
  std::vector<physics::BodyIndex> bodies;  ///< drawn with it
  physics::Snapshot snapshot;
  Color tint = {0.7f, 0.7f, 0.7f};
};

enum class MarkerKind {
  kContact,
  kSupport,
  kRegion,          ///< a bubble around a thing
  kPersonsContact,  ///< of a person's body, which would hide a small mark
  kSphere,          ///< a region of interest
  kCylinder,        ///< likewise, upright
  kCandidate        ///< a star above what a hand may be reaching for
};
struct Marker {
  MarkerKind kind = MarkerKind::kContact;
  Eigen::Vector3f p_W_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_size_m = {0.02f, 0.02f, 0.02f};
  std::optional<Color> color = std::nullopt;  ///< instead of that of its kind
  /// World frame of its axes x, y, z. Of a support.
  Eigen::Quaternionf q_WM = Eigen::Quaternionf::Identity();
};

/// Something solid that only the picture has, upright: a leg of a table.
struct Prop {
  std::string name;
  Eigen::Vector3f center_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_size_m = {0.02f, 0.02f, 0.02f};
  Color color = {0.6f, 0.5f, 0.4f};
};

/// Where a person looks; a ball marks what she sees.
struct GazeRay {
  Eigen::Vector3f from_m = Eigen::Vector3f::Zero(), to_m = Eigen::Vector3f::UnitX();
  bool hits = false;
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
  int rows_left_out = 0;  ///< that there was no room for
};

enum class Theme {
  kLight,  ///< a floor with a grid under a pale sky
  kPrint   ///< white paper
};

struct Picture {
  int width_px = 1280, height_px = 720;
  const physics::Scene* scene = nullptr;  ///< outlives the call
  physics::Snapshot snapshot;
  std::vector<Color> body_colors;        ///< one per scene body; missing ones: from a palette
  std::vector<float> body_alphas;        ///< one per scene body; missing ones: 1
  std::vector<std::string> body_labels;  ///< one per scene body, empty: none
  std::vector<std::string> hand_labels;  ///< one per scene hand, empty: none
  /// Per scene hand the colours of palm and links, in this order; missing ones: skin.
  std::vector<std::vector<Color>> hand_colors;
  std::vector<PathInterval> path;
  std::vector<Ghost> ghosts;
  std::vector<Marker> markers;
  std::vector<Prop> props;
  std::vector<GazeRay> gazes;
  Theme theme = Theme::kLight;
  Color paper = {1, 1, 1};  ///< of Theme::kPrint
  float text_scale = 1;
  Camera camera;
  Eigen::Vector3f to_light = {0.38f, -0.42f, 0.82f};  ///< direction of the distant light
  TimelineStrip strip;
  std::string title;
};

/// The object that is visible at each pixel, exact and without anti-aliasing, for comparing
/// pictures.
struct IdImage {
  int width_px = 0, height_px = 0;
  std::vector<std::uint32_t> ids;  ///< rows from top; indices into names
  std::vector<std::string>
      names;  ///< "background", "ground", "body:milk", "hand:right_hand", "path:0:reaching", ...
};

struct ListedPicture;  // render/inventory.h

inline constexpr const char* kDefaultFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/// Owns an off-screen context. Make one per process and draw many pictures with it: the first one
/// compiles the shaders.
class Painter {
 public:
  explicit Painter(const std::string& font_file = kDefaultFontFile);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Loads the OpenGL library, which the first Painter does otherwise. For a process that forks
  /// others that draw: each of them would load it again.
  static void LoadLibrary();

  /// The reason why no picture can be drawn (no context, missing font, failed self-test), or empty.
  const std::string& error() const;
  /// An empty image on failure; error() then has the reason.
  Image Draw(const Picture& picture);
  /// Object numbers of the same scene from the same camera, without labels, strip and regions.
  IdImage DrawIds(const Picture& picture);
  /// The picture with its inventory; an empty image on failure.
  ListedPicture DrawListed(const Picture& picture);
  /// Everything that pixels depend on: "Mesa 22.3.6 llvmpipe ... renderer 1".
  std::string Fingerprint() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A camera that frames the box [low, high] from a named side; CameraNames() lists the names. An
/// unknown name gives "front".
Camera NamedCamera(const std::string& name, const Eigen::Vector3f& low_m,
                   const Eigen::Vector3f& high_m, double aspect);
/// The same, with the eye in the direction `from` of the box.
Camera CameraFrom(const Eigen::Vector3f& from, const Eigen::Vector3f& low_m,
                  const Eigen::Vector3f& high_m, double aspect);
const std::vector<std::string>& CameraNames();

}  // namespace prehend::render
