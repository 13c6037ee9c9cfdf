// SPDX-License-Identifier: Apache-2.0
// See harness/show/pictures/scene_painter.h. Tested by
// tests/harness/show/pictures/scene_painter_test.cc
#include <fmt/format.h>

#include "harness/episode/run/run_scenario.h"
#include "harness/show/pictures/compose_picture.h"
#include "harness/show/pictures/scene_painter.h"

namespace prehend::show {

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

}  // namespace prehend::show
