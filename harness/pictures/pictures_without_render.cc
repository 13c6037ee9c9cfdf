// SPDX-License-Identifier: Apache-2.0
// Answers of a build without render/: it cannot draw.
#include "harness/pictures/pictures.h"

namespace prehend::harness {

namespace {
PictureResult CannotDraw() { return {{}, "this build cannot draw pictures (PREHEND_RENDER=OFF)"}; }
}  // namespace

bool CanDrawPictures() { return false; }

void PrepareToDraw() {}

PictureResult DrawPictures(const Scenario&, const RunResult&, const std::string&,
                           const PictureFormat&) {
  return CannotDraw();
}

PictureResult DrawAndCompare(const Scenario&, const RunResult&, const std::string&,
                             const GoldenOf&) {
  return CannotDraw();
}

PictureResult DrawGoldens(const Scenario&, const RunResult&, const std::string&) {
  return CannotDraw();
}

PictureResult DrawPicture(const Scenario&, const RunResult&, const PictureYaml&, const std::string&,
                          const PictureFormat&) {
  return CannotDraw();
}

PictureResult DrawSheet(const Scenario&, const RunResult&, const std::vector<PictureYaml>&, int,
                        const std::string&, const PictureFormat&) {
  return CannotDraw();
}

PictureResult DrawSheet(const std::vector<SheetEntry>&, int, const std::string&,
                        const PictureFormat&) {
  return CannotDraw();
}

bool WritePictureDifference(const std::string&, const std::string&, const std::string&) {
  return false;
}

}  // namespace prehend::harness
