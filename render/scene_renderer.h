// SPDX-License-Identifier: Apache-2.0
// Draws a DrawList with OpenGL: shadow map, solids with ambient occlusion, paths, ghosts, markers.
// Tested by tests/render/painter_test.cc
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/draw_list.h"
#include "render/gl/gl_objects.h"

namespace prehend::render {

class SceneRenderer {
 public:
  /// Null, with the reason in *error, if a shader does not compile or the driver refuses buffers.
  static std::unique_ptr<SceneRenderer> Create(const GlFunctions& gl, std::string* error);
  ~SceneRenderer();

  /// Draws a triangle and checks its pixels: function addresses alone prove nothing.
  bool PassesSelfTest() const;
  /// Draws the scene without labels and strip. Empty if the driver refuses buffers of that size.
  Image Render(const DrawList& list, const View& view);
  /// For every pixel, rows from the top, the index into DrawList::objects of the object drawn
  /// there, regions excepted.
  std::vector<std::uint32_t> RenderIds(const DrawList& list, const View& view);

 private:
  struct Targets;
  struct Frame;
  explicit SceneRenderer(const GlFunctions& gl);
  bool CompilePrograms(std::string* error);
  bool PrepareTargets(int width_px, int height_px);
  Frame MakeFrame(const DrawList& list, const View& view) const;

  void DrawShadows(const Frame& frame) const;
  void DrawSolids(const Frame& frame) const;
  void DrawGround(const Frame& frame) const;
  void DarkenCorners(const Frame& frame) const;
  void DrawHiddenPaths(const Frame& frame) const;
  void DrawGhosts(const Frame& frame) const;
  void DrawMarkers(const Frame& frame) const;
  const Program& UseSurface(const Frame& frame, const std::unique_ptr<Program>& surface) const;
  void DrawItem(const Program& program, const Frame& frame, const Item& item) const;
  void DrawScreen() const;

  const GlFunctions& gl_;
  std::unique_ptr<Program> solid_, ground_, ghost_, region_, flat_;  // surfaces
  std::unique_ptr<Program> depth_only_, ids_, backdrop_, occlusion_, occlusion_blur_, darken_;
  std::unique_ptr<GpuMesh> box_, ball_, small_ball_, cylinder_, cone_;
  std::unique_ptr<Framebuffer> shadow_map_;
  std::unique_ptr<Targets> targets_;
};

}  // namespace prehend::render
