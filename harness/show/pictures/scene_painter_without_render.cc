// SPDX-License-Identifier: Apache-2.0
// Answers of a build without render/: it cannot draw.
#include "harness/show/pictures/scene_painter.h"

namespace prehend::show {

struct ScenePainter::State {
  std::string error = "this build cannot draw pictures (PREHEND_RENDER=OFF)";
};

ScenePainter::ScenePainter() : state_(std::make_unique<State>()) {}

ScenePainter::~ScenePainter() = default;

const std::string& ScenePainter::error() const { return state_->error; }

DrawnScene ScenePainter::Draw(const scenario::Scenario&, const episode::RunResult&,
                              const scenario::PictureYaml&, const PictureFormat&) {
  return {};
}

std::string ScenePainter::CameraOf(const scenario::Scenario&, const episode::RunResult&,
                                   const scenario::PictureYaml& entry, const PictureFormat&) {
  return entry.camera.value;
}

SceneDifference DifferenceOf(const std::string&, const std::string&) { return {}; }

}  // namespace prehend::show
