// SPDX-License-Identifier: Apache-2.0
// Answers of a build without render/: it cannot draw.
#include "harness/show/pictures/pictures.h"

namespace prehend::show {
namespace {

PictureResult CannotDraw() { return {{}, "this build cannot draw pictures (PREHEND_RENDER=OFF)"}; }

}  // namespace

bool CanDrawPictures() { return false; }

void PrepareToDraw() {}

PictureResult DrawPictures(const scenario::Scenario&, const episode::RunResult&, const std::string&,
                           const PictureFormat&) {
  return CannotDraw();
}

PictureResult DrawAndCompare(const scenario::Scenario&, const episode::RunResult&,
                             const std::string&, const GoldenOf&) {
  return CannotDraw();
}

PictureResult DrawGoldens(const scenario::Scenario&, const episode::RunResult&,
                          const std::string&) {
  return CannotDraw();
}

PictureResult DrawPicture(const scenario::Scenario&, const episode::RunResult&,
                          const scenario::PictureYaml&, const std::string&, const PictureFormat&) {
  return CannotDraw();
}

bool WritePictureDifference(const std::string&, const std::string&, const std::string&) {
  return false;
}

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
