// SPDX-License-Identifier: Apache-2.0
// Draws and compares pictures, with render/. Tested by tests/program/acceptance_test.cc and
// tests/harness/show/pictures/scene_painter_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/pictures.h"
#include "harness/show/pictures/scenery.h"
#include "physics/scene/geometry.h"
#include "render/inventory.h"

namespace prehend::show {
namespace {

constexpr render::PngKind kSmall = render::PngKind::kSmall;

double SecondsOf(const render::Picture& picture, const episode::RunResult& run) {
  return truth::SecondsOf(picture.snapshot.tick, run.timeline.ticks_per_second);
}

/// What a list of pictures says of one, also if it has no title.
std::string CaptionOf(const render::Picture& picture, const episode::RunResult& run) {
  return picture.title.empty() ? fmt::format("{:.3f} s", SecondsOf(picture, run)) : picture.title;
}

/// What is done with a drawn picture; returns an error text or "".
using Keep = std::function<std::string(const render::Picture&, WrittenPicture& as)>;

/// Composes one entry and hands it on; returns an error text or "".
std::string DrawOne(const render::Painter& painter, const scenario::Scenario& scenario,
                    const episode::RunResult& run, const scenario::PictureYaml& entry,
                    const PictureFormat& format, const std::string& file, const Keep& keep,
                    std::vector<WrittenPicture>& written) {
  if (!painter.error().empty()) return painter.error();
  if (run.recording.empty()) return "the run recorded nothing to draw";
  const render::Picture picture = ComposePicture(scenario, run, entry, format);
  WrittenPicture drawn{file, CaptionOf(picture, run),
                       episode::FindEventTime(entry.at.value, run).missed};
  const std::string error = keep(picture, drawn);
  if (error.empty()) written.push_back(std::move(drawn));
  return error;
}

std::string WriteImage(const render::Painter& painter, const render::Image& image,
                       const std::string& file, render::PngKind kind = render::PngKind::kExact) {
  if (image.rgb.empty()) return painter.error();
  return WriteTextFile(file, render::EncodePng(image, kind));
}

PictureResult DrawEach(const render::Painter& painter, const scenario::Scenario& scenario,
                       const episode::RunResult& run, const std::string& directory,
                       const PictureFormat& format, const Keep& keep) {
  PictureResult result;
  for (std::size_t i = 0; i < scenario.pictures.size(); ++i) {
    const std::string suffix = i == 0 ? "" : fmt::format("-{}", i + 1);
    const std::string file = fmt::format("{}/{}{}.png", directory, scenario.name, suffix);
    const std::string error =
        DrawOne(painter, scenario, run, scenario.pictures[i], format, file, keep, result.pictures);
    if (!error.empty() && result.error.empty()) result.error = error;
  }
  return result;
}

/// Against a golden and, if it was kept, its inventory.
PictureDifference CompareWith(const std::string& golden_file, const render::ListedPicture& drawn) {
  const std::string things_file = ThingsFile(golden_file);
  std::optional<render::Inventory> golden;
  std::error_code ignored;
  if (std::filesystem::exists(things_file, ignored)) {
    const auto text = ReadTextFile(things_file);
    if (text) golden = render::ReadInventory(*text);
    if (!golden) return {.told = {things_file + " cannot be read"}};
  }
  const auto read = [&] { return render::ReadPng(golden_file); };
  if (golden) {
    return {.told = render::TellApart(*golden, read, drawn),
            .same_size = golden->width_px == drawn.image.width_px &&
                         golden->height_px == drawn.image.height_px};
  }
  const render::Image image = read();
  if (image.rgb.empty()) return {.told = {golden_file + " cannot be read"}};
  const std::string text = render::PixelsText(image, drawn.image);
  PictureDifference difference{.same_size = render::CompareImages(image, drawn.image).same_size};
  if (!text.empty()) difference.told.push_back(text);
  return difference;
}

/// What lets white paper through more than black one is transparent. Colours are those that give
/// both pictures (Smith and Blinn, "Blue screen matting", 1996).
render::Image Matte(const render::Image& on_white, const render::Image& on_black) {
  render::Image image = on_black;
  image.alpha.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    int through = 0;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      through += std::max(0, on_white.rgb[k] - on_black.rgb[k]);
    const int alpha = 255 - (through + 1) / 3;
    image.alpha[i] = static_cast<std::uint8_t>(alpha);
    for (std::size_t k = 3 * i; k < 3 * i + 3 && alpha > 0; ++k)
      image.rgb[k] = static_cast<std::uint8_t>(
          std::clamp<long>(std::lround(255.0 * on_black.rgb[k] / alpha), 0, 255));
  }
  return image;
}

/// A larger body is scenery, unless it moves: it does not affect what the camera frames.
constexpr double kSceneryFrom_m = 0.5;
/// A body that moves farther than this takes part in the action.
constexpr double kMoves_m = 0.02;
/// What is nearer to a hand than this is framed with it.
constexpr double kNearHand_m = 0.18;
constexpr double kNearStar_m = 0.08;
/// A table larger than this is cut by `top`.
constexpr double kMostTable_m = 2.5;
constexpr double kPalmReach_m = 0.11;
constexpr double kLeastRise =
    0.25;                           ///< of the eye of `hand` above what it looks at, per way across
constexpr float kLeastFrom = 0.1f;  ///< shorter: the hands look in opposite directions
/// Snapshots that are looked at per episode, at most.
constexpr std::size_t kLooks = 400;

class Framing {
 public:
  Framing(const scenario::Scenario& scenario, const episode::RunResult& run,
          const PictureFormat& format)
      : scenario_(scenario), run_(run) {
    const double rate_hz = static_cast<double>(run.timeline.ticks_per_second);
    const auto index_of = [&](double time_s) {
      const auto tick = static_cast<grammar::Tick>(time_s * rate_hz);
      const auto at = std::ranges::lower_bound(run.recording, tick, {}, &physics::Snapshot::tick);
      return std::min(run.recording.size() - 1,
                      static_cast<std::size_t>(at - run.recording.begin()));
    };
    if (format.framed_from_s) first_ = index_of(*format.framed_from_s);
    last_ = format.framed_to_s ? std::max(first_, index_of(*format.framed_to_s))
                               : run.recording.size() - 1;
  }

  void AddBody(std::size_t body, const physics::Snapshot& now) {
    if (!IsSmall(body)) {
      box_.extend(physics::WorldBounds(scenario_.scene.bodies[body], now.bodies[body].X_WB));
      return;
    }
    const physics::LocalBox local = physics::BoundingBox(scenario_.scene.bodies[body]);
    AddBall((now.bodies[body].X_WB * local.p_BC_m), local.half_size_m.norm());
  }
  /// All that is no floor or furniture, where a scene has nothing else.
  void AddThings(const physics::Snapshot& now) {
    for (std::size_t i = 0; i < scenario_.scene.bodies.size(); ++i) {
      const physics::Body& body = scenario_.scene.bodies[i];
      if (physics::IsThing(body) && !body.fixed && !body.shapes.empty()) AddBody(i, now);
    }
  }
  void AddBall(const Eigen::Vector3d& p_W_m, double radius_m) {
    box_.extend(Eigen::Vector3d(p_W_m.array() - radius_m));
    box_.extend(Eigen::Vector3d(p_W_m.array() + radius_m));
  }
  void AddHand(const physics::HandState& hand) { AddBall(hand.palm.X_WB.p_m, kPalmReach_m); }
  void AddHands(const physics::Snapshot& now) {
    for (const physics::HandState& hand : now.hands) AddHand(hand);
  }
  /// Of the time that is framed, evenly.
  template <class Visit>
  void ForEachLook(const Visit& visit) const {
    const std::size_t step = std::max<std::size_t>(1, (last_ - first_ + 1) / kLooks);
    for (std::size_t i = first_; i <= last_; i += step) visit(run_.recording[i]);
    visit(run_.recording[last_]);
  }
  bool Moves(std::size_t body) const {
    double most_m = 0;
    const Eigen::Vector3d begin = run_.recording.front().bodies[body].X_WB.p_m;
    ForEachLook([&](const physics::Snapshot& now) {
      most_m = std::max(most_m, (now.bodies[body].X_WB.p_m - begin).norm());
    });
    return most_m > kMoves_m;
  }
  bool IsSmall(std::size_t body) const {
    return 2 * physics::BoundingBox(scenario_.scene.bodies[body]).half_size_m.maxCoeff() <=
           kSceneryFrom_m;
  }
  /// Fixed things that what is framed stands on or beside.
  void AddTables(const physics::Snapshot& now) {
    const Eigen::AlignedBox3d framed = box_;
    for (std::size_t i = 0; i < scenario_.scene.bodies.size(); ++i) {
      const physics::Body& body = scenario_.scene.bodies[i];
      if (!body.fixed || !physics::IsThing(body) || body.shapes.empty()) continue;
      const Eigen::AlignedBox3d table = physics::WorldBounds(body, now.bodies[i].X_WB);
      if (table.intersects(framed) && table.sizes().maxCoeff() <= kMostTable_m) box_.extend(table);
    }
  }
  const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  const scenario::Scenario& scenario_;
  const episode::RunResult& run_;
  std::size_t first_ = 0, last_ = 0;  ///< in the recording
  Eigen::AlignedBox3d box_;
};

/// Returns from where one looks into the open side of their grips: between thumb and fingers, from
/// the side of the palm, not from below.
Eigen::Vector3f FrameHands(const scenario::Scenario& scenario, const physics::Snapshot& now,
                           const std::vector<std::string>& framed, Framing& framing) {
  const physics::Scene& scene = scenario.scene;
  const auto is_named = [&](const auto& entity) {
    return std::ranges::find(framed, entity.name) != framed.end();
  };
  const bool names_hands = std::ranges::any_of(scene.hands, is_named);
  std::vector<physics::HandState> hands;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < now.hands.size(); ++i) {
    if (names_hands && !is_named(scene.hands[i])) continue;
    hands.push_back(now.hands[i]);
    const double thumb = scene.hands[i].model.left ? -1 : 1;
    from += now.hands[i].palm.X_WB.q * Eigen::Vector3d(0.5, 0.7 * thumb, -0.5);
  }
  for (const physics::HandState& hand : hands) framing.AddHand(hand);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!physics::IsThing(scene.bodies[i]) || !framing.IsSmall(i)) continue;
    const bool is_near = std::ranges::any_of(hands, [&](const physics::HandState& hand) {
      return (now.bodies[i].X_WB.p_m - hand.palm.X_WB.p_m).norm() < kNearHand_m;
    });
    if (is_near || is_named(scene.bodies[i])) framing.AddBody(i, now);
    if (is_near && !physics::MovesFreely(scene, physics::BodyIndex(i)))
      from.setZero();  // furniture hides the open side
  }
  from.z() = std::max(from.z(), kLeastRise * from.head<2>().norm());
  return from.cast<float>();
}

/// Of what is framed.
void FrameStars(const std::vector<render::Marker>& markers, Framing& framing) {
  const Eigen::AlignedBox3d framed = framing.box();
  for (const render::Marker& marker : markers) {
    const Eigen::Vector3d p_W_m = marker.p_W_m.cast<double>();
    if (marker.kind == render::MarkerKind::kCandidate &&
        framed.exteriorDistance(p_W_m) < kNearStar_m)
      framing.AddBall(p_W_m, marker.half_size_m.x());
  }
}

void FramePaths(const std::vector<render::PathInterval>& path, Framing& framing) {
  for (const render::PathInterval& interval : path)
    for (const Eigen::Vector3f& point_m : interval.points_m)
      framing.AddBall(point_m.cast<double>(), 0);
}

/// A person who has a body and a hand of the scene is looked over the shoulder: only her hands are
/// framed, unless `body` asks for all of her.
bool IsFramed(const scenario::Scenario& scenario, std::size_t body, const std::string& camera) {
  const physics::Body& of_scene = scenario.scene.bodies[body];
  if (!IsSeen(of_scene)) return false;
  if (!of_scene.kinematic) return true;
  const bool has_bodies = std::ranges::any_of(scenario.scene.persons, &physics::Person::has_body);
  return camera == "body" || scenario.scene.hands.empty() || !has_bodies;
}

}  // namespace

bool CanDrawPictures() { return true; }

void PrepareToDraw() { render::Painter::LoadLibrary(); }

PictureResult DrawPictures(const scenario::Scenario& scenario, const episode::RunResult& run,
                           const std::string& directory, const PictureFormat& format) {
  if (scenario.pictures.empty()) return {};
  render::Painter painter;
  return DrawEach(painter, scenario, run, directory, format,
                  [&](const render::Picture& picture, const WrittenPicture& as) {
                    return WriteImage(painter, DrawImage(painter, picture, format), as.file);
                  });
}

PictureResult DrawAndCompare(const scenario::Scenario& scenario, const episode::RunResult& run,
                             const std::string& directory, const GoldenOf& golden_of) {
  if (scenario.pictures.empty()) return {};
  render::Painter painter;
  return DrawEach(painter, scenario, run, directory, kGoldenFormat,
                  [&](const render::Picture& picture, WrittenPicture& as) {
                    as.golden = golden_of(std::filesystem::path(as.file).filename().string());
                    if (as.golden.empty())
                      return WriteImage(painter, painter.Draw(picture), as.file, kSmall);
                    const render::ListedPicture drawn = painter.DrawListed(picture);
                    if (!drawn.image.rgb.empty()) as.difference = CompareWith(as.golden, drawn);
                    return WriteImage(painter, drawn.image, as.file, kSmall);
                  });
}

PictureResult DrawGoldens(const scenario::Scenario& scenario, const episode::RunResult& run,
                          const std::string& directory) {
  if (scenario.pictures.empty()) return {};
  render::Painter painter;
  return DrawEach(painter, scenario, run, directory, kGoldenFormat,
                  [&](const render::Picture& picture, const WrittenPicture& as) {
                    const render::ListedPicture drawn = painter.DrawListed(picture);
                    std::string error = WriteImage(painter, drawn.image, as.file, kSmall);
                    if (error.empty())
                      error = WriteTextFile(ThingsFile(as.file),
                                            render::InventoryText(drawn.inventory));
                    return error;
                  });
}

PictureResult DrawPicture(const scenario::Scenario& scenario, const episode::RunResult& run,
                          const scenario::PictureYaml& entry, const std::string& file,
                          const PictureFormat& format) {
  PictureResult result;
  render::Painter painter;
  result.error = DrawOne(
      painter, scenario, run, entry, format, file,
      [&](const render::Picture& picture, const WrittenPicture& as) {
        return WriteImage(painter, DrawImage(painter, picture, format), as.file);
      },
      result.pictures);
  return result;
}

bool WritePictureDifference(const std::string& golden_file, const std::string& drawn_file,
                            const std::string& file) {
  const render::Image golden = render::ReadPng(golden_file), drawn = render::ReadPng(drawn_file);
  if (golden.rgb.empty() || !render::CompareImages(golden, drawn).same_size) return false;
  return WriteTextFile(file, render::EncodePng(PaleWithRed(golden, drawn))).empty();
}

struct ScenePainter::State {
  render::Painter painter;
  std::string error = painter.error();
};

ScenePainter::ScenePainter() : state_(std::make_unique<State>()) {}

ScenePainter::~ScenePainter() = default;

const std::string& ScenePainter::error() const { return state_->error; }

DrawnScene ScenePainter::Draw(const scenario::Scenario& scenario, const episode::RunResult& run,
                              const scenario::PictureYaml& entry, const PictureFormat& format) {
  if (!state_->error.empty()) return {};
  if (run.recording.empty()) {
    state_->error = "the run recorded nothing to draw";
    return {};
  }
  const render::Picture picture = ComposePicture(scenario, run, entry, format);
  const render::Image image = DrawImage(state_->painter, picture, format);
  if (image.rgb.empty()) state_->error = state_->painter.error();
  return {.png = render::EncodePng(image),
          .time_s = truth::SecondsOf(picture.snapshot.tick, run.timeline.ticks_per_second),
          .missed = episode::FindEventTime(entry.at.value, run).missed};
}

std::string ScenePainter::CameraOf(const scenario::Scenario& scenario,
                                   const episode::RunResult& run,
                                   const scenario::PictureYaml& entry,
                                   const PictureFormat& format) {
  const render::Camera camera = ComposePicture(scenario, run, entry, format).camera;
  const auto text = [](const Eigen::Vector3f& place_m) {
    return fmt::format("{:.5f},{:.5f},{:.5f}", place_m.x(), place_m.y(), place_m.z());
  };
  return fmt::format("{}:{}:{}", text(camera.eye_m), text(camera.look_at_m),
                     camera.vertical_field_of_view_deg);
}

SceneDifference DifferenceOf(const std::string& first_png, const std::string& second_png) {
  const render::Image first = render::DecodePng(first_png), second = render::DecodePng(second_png);
  const render::ImageDifference found = render::CompareImages(first, second);
  if (first.rgb.empty() || !found.same_size) return {};
  return {.png = render::EncodePng(PaleWithRed(first, second)),
          .share = 3.0 * static_cast<double>(found.pixels) / static_cast<double>(first.rgb.size())};
}

render::Image DrawImage(render::Painter& painter, const render::Picture& picture,
                        const PictureFormat& format) {
  if (!format.transparent) return painter.Draw(picture);
  render::Picture on_paper = picture;
  on_paper.theme = render::Theme::kPrint;
  const render::Image on_white = painter.Draw(on_paper);
  on_paper.paper = render::Color::Zero();
  const render::Image on_black = painter.Draw(on_paper);
  if (on_white.rgb.empty() || on_black.rgb.empty()) return {};
  return Matte(on_white, on_black);
}

render::Image PaleWithRed(const render::Image& first, const render::Image& second) {
  render::Image image = first;
  for (std::size_t i = 0; i < first.rgb.size(); i += 3) {
    const bool differs = render::PixelDiffers(first, second, i);
    const int grey = (first.rgb[i] + first.rgb[i + 1] + first.rgb[i + 2]) / 3;
    const auto pale = static_cast<std::uint8_t>(160 + grey * 3 / 8);
    image.rgb[i] = differs ? 220 : pale;
    image.rgb[i + 1] = image.rgb[i + 2] = differs ? 20 : pale;
  }
  return image;
}

render::Camera CameraFor(const scenario::Scenario& scenario, const episode::RunResult& run,
                         const render::Picture& picture, const std::string& name,
                         const PictureFormat& format) {
  if (const auto own = scenario::ParseOwnCamera(name)) {
    return {.eye_m = own->eye_m.cast<float>(),
            .look_at_m = own->look_at_m.cast<float>(),
            .vertical_field_of_view_deg = static_cast<float>(own->view_deg)};
  }
  for (const physics::Body& body : scenario.scene.bodies) {
    if (body.name != name || body.abstract != physics::Abstract::kCamera) continue;
    const Eigen::Vector3d ahead_m = body.X_WB * Eigen::Vector3d::UnitX();
    return {.eye_m = body.X_WB.p_m.cast<float>(),
            .look_at_m = ahead_m.cast<float>(),
            .vertical_field_of_view_deg = static_cast<float>(body.view_deg)};
  }
  Framing framing(scenario, run, format);
  std::optional<Eigen::Vector3f> from;
  if (name == "hand" && !scenario.scene.hands.empty()) {
    from = FrameHands(scenario, picture.snapshot, format.framed, framing);
    if (format.framed_from_s) FramePaths(picture.path, framing);
    FrameStars(picture.markers, framing);
  } else {
    framing.ForEachLook([&](const physics::Snapshot& now) { framing.AddHands(now); });
    for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
      const bool is_part = scenario.scene.bodies[i].kinematic;
      const bool is_scenery = !framing.IsSmall(i) && (is_part || !framing.Moves(i));
      if (is_scenery || !IsFramed(scenario, i, name)) continue;
      const bool is_named =
          std::ranges::find(format.framed, scenario.scene.bodies[i].name) != format.framed.end();
      if (is_named || framing.Moves(i))
        framing.ForEachLook([&](const physics::Snapshot& now) { framing.AddBody(i, now); });
      else if (name != "action")
        framing.AddBody(i, run.recording.front());
    }
    if (framing.box().isEmpty()) framing.AddThings(picture.snapshot);
    if (name == "top") framing.AddTables(run.recording.front());
  }
  Eigen::AlignedBox3f box = framing.box().cast<float>();
  if (box.isEmpty()) box = {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 1, 1)};
  const double aspect = static_cast<double>(picture.width_px) / picture.height_px;
  return from && from->norm() > kLeastFrom
             ? render::CameraFrom(*from, box.min(), box.max(), aspect)
             : render::NamedCamera(name, box.min(), box.max(), aspect);
}

}  // namespace prehend::show
