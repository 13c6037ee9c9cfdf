// SPDX-License-Identifier: Apache-2.0
// Draws and compares pictures, with render/. Tested by tests/program/acceptance_test.cc and
// tests/harness/show/pictures/scene_painter_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/show/pictures/compose_picture.h"
#include "harness/show/pictures/pictures.h"
#include "render/inventory.h"

namespace prehend::show {
namespace {

constexpr render::PngKind kSmall = render::PngKind::kSmall;

double SecondsOf(const render::Picture& picture, const episode::RunResult& run) {
  return static_cast<double>(picture.snapshot.tick) /
         static_cast<double>(run.timeline.ticks_per_second);
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
  return render::WritePng(image, file, kind) ? "" : "cannot write " + file;
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
  return render::WritePng(PaleWithRed(golden, drawn), file);
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
          .time_s = static_cast<double>(picture.snapshot.tick) /
                    static_cast<double>(run.timeline.ticks_per_second),
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

}  // namespace prehend::show
