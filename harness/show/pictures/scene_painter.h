// SPDX-License-Identifier: Apache-2.0
// Scenes as PNGs in memory, for sheets, comparisons and films that are put together of several.
// Built with the render room (harness/show/pictures/scene_painter_with_render.cc) or without it
// (harness/show/pictures/scene_painter_without_render.cc). Tested by
// tests/harness/show/pictures/scene_painter_test.cc
#pragma once

#include <memory>
#include <string>

#include "harness/show/pictures/pictures.h"

namespace prehend::show {

/// A scene at one moment of a run.
struct DrawnScene {
  std::string png;  ///< the bytes of a PNG file; empty: it could not be drawn
  double time_s = 0;
  std::string missed;  ///< empty, or why the end is shown instead of the moment that was asked for
};

/// Draws scenes one after another. The first one costs more: the shaders are compiled.
class ScenePainter {
 public:
  ScenePainter();
  ~ScenePainter();

  /// Why nothing can be drawn, or "".
  const std::string& error() const;

  /// Of a run with a recording. On failure error() has the reason.
  DrawnScene Draw(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const scenario::PictureYaml& entry, const PictureFormat& format);

  /// The camera of such a scene as text (harness/scenario/scenario/scenario.h), for other scenes
  /// in the same view.
  static std::string CameraOf(const scenario::Scenario& scenario, const episode::RunResult& run,
                              const scenario::PictureYaml& entry, const PictureFormat& format);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Two pictures of one size on top of each other.
struct SceneDifference {
  std::string png;   ///< the first one, pale, and what differs in red; empty: not of one size
  double share = 0;  ///< of the pixels that differ
};
SceneDifference DifferenceOf(const std::string& first_png, const std::string& second_png);

}  // namespace prehend::show
