// SPDX-License-Identifier: Apache-2.0
// Answers of a build without render/: it cannot draw.
#include "harness/pictures/pictures.h"

namespace prehend::harness {

namespace {
PictureResult NoRenderRoom() { return {{}, "this build has no render room (PREHEND_RENDER=OFF)"}; }
}  // namespace

bool CanDrawPictures() { return false; }

PictureResult DrawPictures(const Scenario&, const RunResult&, const std::string&) {
  return NoRenderRoom();
}

PictureResult DrawPicture(const Scenario&, const RunResult&, const PictureYaml&,
                          const std::string&) {
  return NoRenderRoom();
}

PictureDifference ComparePicture(const std::string&, const std::string&) { return {}; }

bool WritePictureDifference(const std::string&, const std::string&, const std::string&) {
  return false;
}

}  // namespace prehend::harness
