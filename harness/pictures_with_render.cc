// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "harness/compose_picture_with_render.h"
#include "harness/moment.h"
#include "harness/pictures.h"

namespace prehend::harness {

namespace {

/// Draws one entry; returns an error text or "".
std::string DrawOne(render::Painter& painter, const Scenario& scenario, const RunResult& run,
                    const PictureEntry& entry, const std::string& file,
                    std::vector<WrittenPicture>& written) {
  if (!painter.error().empty()) return painter.error();
  if (run.recording.empty()) return "the run recorded nothing to draw";
  const render::Picture picture = ComposePicture(scenario, run, entry);
  const render::Image image = painter.Draw(picture);
  if (image.rgb.empty()) return painter.error();
  if (!render::WritePng(image, file)) return "cannot write " + file;
  written.push_back({file, picture.title, FindMoment(entry.at.value, run).missed});
  return "";
}

}  // namespace

bool CanDrawPictures() { return true; }

PictureResult DrawPictures(const Scenario& scenario, const RunResult& run,
                           const std::string& directory) {
  PictureResult result;
  if (scenario.pictures.empty()) return result;
  render::Painter painter;
  for (std::size_t i = 0; i < scenario.pictures.size(); ++i) {
    const std::string suffix = i == 0 ? "" : fmt::format("-{}", i + 1);
    const std::string file = fmt::format("{}/{}{}.png", directory, scenario.name, suffix);
    const std::string error =
        DrawOne(painter, scenario, run, scenario.pictures[i], file, result.pictures);
    if (!error.empty() && result.error.empty()) result.error = error;
  }
  return result;
}

PictureResult DrawPicture(const Scenario& scenario, const RunResult& run, const PictureEntry& entry,
                          const std::string& file) {
  PictureResult result;
  render::Painter painter;
  result.error = DrawOne(painter, scenario, run, entry, file, result.pictures);
  return result;
}

}  // namespace prehend::harness
