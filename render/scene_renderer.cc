// SPDX-License-Identifier: Apache-2.0
// The passes, in order:
//   1. depth from the light (solids have shadows; paths have none: a second path on the table would
//   compete);
//   2. backdrop, ground, solids, paths into a multisampled buffer;
//   3. ambient occlusion at half size from its depth, blurred there and multiplied in;
//   4. hidden parts of paths, faintly; ghosts, each after its own depth so that inner joints do not
//   show; markers;
//   5. resolve and read back.
// Every pass leaves depth test on, depth writes on, blending off and back faces culled.
// Tested by tests/render/painter_test.cc
#include "render/scene_renderer.h"

#include <algorithm>
#include <cmath>

#include "render/gl/gl_objects.h"

namespace prehend::render {

// The sphere in which shadows and ground are drawn: all objects, or the surroundings of the
// camera's target if these are much smaller.
struct Focus {
  Eigen::Vector3f center_m;
  float radius_m;
};

namespace {

using Eigen::Vector3f;

constexpr int kSamples = 4;  // the most that llvmpipe has
constexpr int kShadowSize_px = 2048;
constexpr float kRegionAlpha = 0.5f;  // regions are fainter than marks of contact
constexpr float kHiddenAlpha = 0.16f;
constexpr float kHiddenMarkShare = 0.4f;
constexpr float kOcclusionRadius_m = 0.09f;
constexpr int kOcclusionTaps = 8;
constexpr float kGroundDrop_m =
    0.002f;  // keeps a floor body at z = 0 from flickering with the ground

const Color kGroundColor = {0.90f, 0.91f, 0.925f};

Focus FocusOf(const DrawList& list, const View& view) {
  const Vector3f forward = -view.world_to_view.block<1, 3>(2, 0).transpose();
  const float to_center = (list.bounds.center_m() - view.eye_m).norm();
  const float radius = std::max(list.bounds.radius_m(), 0.2f);
  if (radius <= 1.5f * to_center) return {list.bounds.center_m(), radius};
  return {view.eye_m + forward * 0.5f * to_center, to_center};
}

float DistanceTo(const View& view, const Item& item) {
  return (item.X_WI.translation() - view.eye_m).norm();
}

Eigen::Vector4f LinearColor(const Item& item) {
  const auto linear = [](float c) { return std::pow(std::max(c, 0.0f), 2.2f); };
  return {linear(item.color.x()), linear(item.color.y()), linear(item.color.z()), item.alpha};
}

/// Near ones first, so that what they hide is not shaded.
std::vector<Item> NearFirst(std::vector<Item> items, const View& view) {
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
    return DistanceTo(view, a) < DistanceTo(view, b);
  });
  return items;
}

/// A ball of fewer pixels has fewer triangles: hundreds of grains would cost more than the picture.
constexpr float kSmallBall_px = 9;

bool IsSmallBall(const View& view, const Item& item) {
  const float px_per_m = 0.5f * static_cast<float>(view.height_px) * view.view_to_clip(1, 1);
  return item.primitive == Primitive::kBall && item.half_size_m.isZero() &&
         item.rounding_m * item.X_WI.linear().colwise().norm().maxCoeff() * px_per_m <
             kSmallBall_px * DistanceTo(view, item);
}

std::string SurfaceShader(Finish finish, bool shadows) {
  return "#version 330 core\n#define FINISH " + std::to_string(static_cast<int>(finish)) +
         "\n#define SHADOWS " + (shadows ? "1" : "0") + kSurfaceFragmentShader;
}

}  // namespace

struct SceneRenderer::Targets {
  std::unique_ptr<Framebuffer> sampled, resolved, occlusion, blurred;
};

// State that all passes of one picture share.
struct SceneRenderer::Frame {
  const DrawList& list;
  const View& view;
  Focus focus;
  Eigen::Matrix4f world_to_light;
  std::vector<std::unique_ptr<GpuMesh>> meshes;
};

SceneRenderer::SceneRenderer(const GlFunctions& gl) : gl_(gl) {}
SceneRenderer::~SceneRenderer() = default;

std::unique_ptr<SceneRenderer> SceneRenderer::Create(const GlFunctions& gl, std::string* error) {
  std::unique_ptr<SceneRenderer> made(new SceneRenderer(gl));
  if (!made->CompilePrograms(error)) return nullptr;
  made->box_ = std::make_unique<GpuMesh>(gl, RoundedBoxMesh(4));
  made->ball_ = std::make_unique<GpuMesh>(gl, RoundedBoxMesh(10));
  made->small_ball_ = std::make_unique<GpuMesh>(gl, RoundedBoxMesh(3));
  made->cylinder_ = std::make_unique<GpuMesh>(gl, RoundedCylinderMesh(5));
  made->cone_ = std::make_unique<GpuMesh>(gl, ConeMesh(6));
  made->shadow_map_ = Framebuffer::Create(gl, kShadowSize_px, kShadowSize_px, 0,
                                          Framebuffer::Color::kNone, Framebuffer::Depth::kCompare);
  if (made->shadow_map_ == nullptr) {
    *error = "OpenGL refuses the shadow map";
    return nullptr;
  }
  return made;
}

bool SceneRenderer::CompilePrograms(std::string* error) {
  const struct {
    std::unique_ptr<Program>* program;
    const char* vertex_source;
    std::string fragment_source;
  } kAll[] = {{&solid_, kSolidVertexShader, SurfaceShader(Finish::kSolid, true)},
              {&ground_, kSolidVertexShader, SurfaceShader(Finish::kGround, true)},
              {&ghost_, kSolidVertexShader, SurfaceShader(Finish::kSolid, false)},
              {&region_, kSolidVertexShader, SurfaceShader(Finish::kRegion, false)},
              {&flat_, kSolidVertexShader, SurfaceShader(Finish::kFlat, false)},
              {&depth_only_, kSolidVertexShader, kDepthFragmentShader},
              {&ids_, kSolidVertexShader, kIdFragmentShader},
              {&backdrop_, kScreenVertexShader, kBackdropFragmentShader},
              {&occlusion_, kScreenVertexShader, kOcclusionFragmentShader},
              {&occlusion_blur_, kScreenVertexShader, kOcclusionBlurFragmentShader},
              {&darken_, kScreenVertexShader, kDarkenFragmentShader}};
  return std::all_of(std::begin(kAll), std::end(kAll), [&](const auto& each) {
    *each.program = Program::Create(gl_, each.vertex_source, each.fragment_source.c_str(), error);
    return *each.program != nullptr;
  });
}

bool SceneRenderer::PassesSelfTest() const {
  constexpr int kSize_px = 16;
  constexpr GLuint kInk = 41;
  const auto target = Framebuffer::Create(gl_, kSize_px, kSize_px, 0, Framebuffer::Color::kId,
                                          Framebuffer::Depth::kRead);
  if (target == nullptr) return false;
  const Mesh lower_left{
      {{{-1, -1, 0}, {0, 0, 1}}, {{1, -1, 0}, {0, 0, 1}}, {{-1, 1, 0}, {0, 0, 1}}}, {0, 1, 2}};
  const GpuMesh triangle(gl_, lower_left);
  target->Bind();
  const GLuint background[4] = {};
  gl_.ClearBufferuiv(GL_COLOR, 0, background);
  gl_.Disable(GL_DEPTH_TEST);
  ids_->Use();
  const Eigen::Matrix4f identity = Eigen::Matrix4f::Identity();
  ids_->Set("model", identity);
  ids_->Set("world_to_clip", identity);
  ids_->Set("half_size", Vector3f(1, 1, 1));
  ids_->Set("rounding", 0.0f);
  ids_->SetUnsigned("object", kInk);
  triangle.Draw();
  GLuint pixels[kSize_px][kSize_px] = {};
  gl_.ReadPixels(0, 0, kSize_px, kSize_px, GL_RED_INTEGER, GL_UNSIGNED_INT, pixels);
  const bool inside = pixels[2][2] == kInk && pixels[5][7] == kInk;
  const bool outside = pixels[13][13] == 0 && pixels[10][12] == 0;
  return inside && outside && gl_.GetError() == GL_NO_ERROR;
}

bool SceneRenderer::PrepareTargets(int width_px, int height_px) {
  if (targets_ != nullptr && targets_->sampled->width_px() == width_px &&
      targets_->sampled->height_px() == height_px) {
    return true;
  }
  targets_ = nullptr;  // frees the old buffers before new ones are allocated
  using Plane = Framebuffer::Color;
  using Depth = Framebuffer::Depth;
  auto made = std::make_unique<Targets>();
  made->sampled =
      Framebuffer::Create(gl_, width_px, height_px, kSamples, Plane::kRgba8, Depth::kRead);
  made->resolved = Framebuffer::Create(gl_, width_px, height_px, 0, Plane::kRgba8, Depth::kRead);
  for (auto* half : {&made->occlusion, &made->blurred}) {
    *half = Framebuffer::Create(gl_, (width_px + 1) / 2, (height_px + 1) / 2, 0, Plane::kR8,
                                Depth::kNone);
    if (!*half) return false;
  }
  if (!made->sampled || !made->resolved || gl_.GetError() != GL_NO_ERROR) return false;
  targets_ = std::move(made);
  return true;
}

SceneRenderer::Frame SceneRenderer::MakeFrame(const DrawList& list, const View& view) const {
  const Focus focus = FocusOf(list, view);
  Frame frame{list, view, focus, WorldToLight(list.to_light, focus.center_m, focus.radius_m), {}};
  for (const Mesh& mesh : list.meshes) frame.meshes.push_back(std::make_unique<GpuMesh>(gl_, mesh));
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.ActiveTexture(GL_TEXTURE0);
  return frame;
}

Image SceneRenderer::Render(const DrawList& list, const View& view) {
  if (!PrepareTargets(view.width_px, view.height_px)) return {};
  const Frame frame = MakeFrame(list, view);
  DrawShadows(frame);
  DrawSolids(frame);
  DarkenCorners(frame);
  DrawHiddenPaths(frame);
  DrawGhosts(frame);
  DrawMarkers(frame);
  targets_->sampled->BlitTo(*targets_->resolved, GL_COLOR_BUFFER_BIT);

  Image image{view.width_px, view.height_px, {}};
  const std::size_t row = static_cast<std::size_t>(image.width_px) * 3;
  std::vector<std::uint8_t> from_bottom(row * image.height_px);
  targets_->resolved->Bind();
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, image.width_px, image.height_px, GL_RGB, GL_UNSIGNED_BYTE,
                 from_bottom.data());
  if (gl_.GetError() != GL_NO_ERROR) return {};
  image.rgb.reserve(from_bottom.size());
  for (auto end = from_bottom.end(); end != from_bottom.begin();
       end -= static_cast<std::ptrdiff_t>(row)) {
    image.rgb.insert(image.rgb.end(), end - static_cast<std::ptrdiff_t>(row), end);
  }
  return image;
}

std::vector<std::uint32_t> SceneRenderer::RenderIds(const DrawList& list, const View& view) {
  const auto target = Framebuffer::Create(gl_, view.width_px, view.height_px, 0,
                                          Framebuffer::Color::kId, Framebuffer::Depth::kRead);
  if (target == nullptr) return {};
  const Frame frame = MakeFrame(list, view);
  target->Bind();
  const GLuint background[4] = {};
  gl_.ClearBufferuiv(GL_COLOR, 0, background);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  ids_->Use();
  ids_->Set("world_to_clip", view.world_to_clip());
  const auto draw = [&](const std::vector<Item>& items) {
    for (const Item& item : items) DrawItem(*ids_, frame, item);
  };
  draw(list.solids);
  draw(list.paths);
  for (const auto& ghost : list.ghosts) draw(ghost);
  for (const Item& marker : list.markers) {
    if (marker.alpha > kRegionAlpha) DrawItem(*ids_, frame, marker);
  }

  const std::size_t row = static_cast<std::size_t>(view.width_px);
  std::vector<std::uint32_t> ids(row * view.height_px);
  gl_.ReadPixels(0, 0, view.width_px, view.height_px, GL_RED_INTEGER, GL_UNSIGNED_INT, ids.data());
  if (gl_.GetError() != GL_NO_ERROR) return {};
  for (int top = 0, bottom = view.height_px - 1; top < bottom; ++top, --bottom) {
    std::swap_ranges(ids.begin() + top * row, ids.begin() + (top + 1) * row,
                     ids.begin() + bottom * row);
  }
  return ids;
}

void SceneRenderer::DrawShadows(const Frame& frame) const {
  shadow_map_->Bind();
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1.5f, 2);
  depth_only_->Use();
  depth_only_->Set("world_to_clip", frame.world_to_light);
  for (const Item& item : frame.list.solids) DrawItem(*depth_only_, frame, item);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void SceneRenderer::DrawSolids(const Frame& frame) const {
  targets_->sampled->Bind();
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_DEPTH_TEST);
  backdrop_->Use();
  backdrop_->Set("plain", frame.list.theme == Theme::kPrint ? 1.0f : 0.0f);
  backdrop_->Set("paper", frame.list.paper);
  DrawScreen();
  gl_.Enable(GL_DEPTH_TEST);

  const Program& surface = UseSurface(frame, solid_);
  for (const Item& item : NearFirst(frame.list.solids, frame.view)) DrawItem(surface, frame, item);
  for (const Item& item : frame.list.paths) DrawItem(surface, frame, item);
  if (frame.list.theme == Theme::kLight) DrawGround(frame);
}

// Drawn after the solids, so that hidden ground is not shaded; far out it fades into the backdrop.
void SceneRenderer::DrawGround(const Frame& frame) const {
  const float clear_radius = std::max(1.3f, 1.1f * frame.focus.radius_m);
  const Vector3f& center = frame.focus.center_m;
  const float lowest = frame.list.bounds.empty() ? 0 : std::min(0.0f, frame.list.bounds.low_m.z());
  Item ground{.color = kGroundColor, .gloss = 0, .object = 1};
  ground.X_WI = Eigen::Translation3f(center.x(), center.y(), lowest - kGroundDrop_m);
  ground.half_size_m = Vector3f(1, 1, 0) * (2.8f * clear_radius);
  const Program& surface = UseSurface(frame, ground_);
  surface.Set("ground", Vector3f(center.x(), center.y(), clear_radius));
  gl_.Enable(GL_BLEND);
  DrawItem(surface, frame, ground);
  gl_.Disable(GL_BLEND);
}

void SceneRenderer::DarkenCorners(const Frame& frame) const {
  targets_->sampled->BlitTo(*targets_->resolved, GL_DEPTH_BUFFER_BIT);
  const Framebuffer& half = *targets_->occlusion;
  const Eigen::Vector2f texel(1.0f / half.width_px(), 1.0f / half.height_px());
  half.Bind();
  gl_.Disable(GL_DEPTH_TEST);
  targets_->resolved->BindDepthTexture();
  occlusion_->Use();
  occlusion_->Set("depth_map", 0);
  occlusion_->Set("clip_to_view", Eigen::Matrix4f(frame.view.view_to_clip.inverse()));
  occlusion_->Set("texel", texel);
  occlusion_->Set("depth_size", Eigen::Vector2f(frame.view.width_px, frame.view.height_px));
  occlusion_->Set("view_to_uv", Eigen::Vector2f(frame.view.view_to_clip(0, 0) / 2,
                                                frame.view.view_to_clip(1, 1) / 2));
  occlusion_->Set("radius", kOcclusionRadius_m);
  occlusion_->Set("taps", kOcclusionTaps);
  DrawScreen();

  targets_->blurred->Bind();
  half.BindColorTexture();
  occlusion_blur_->Use();
  occlusion_blur_->Set("occlusion_map", 0);
  occlusion_blur_->Set("texel", texel);
  DrawScreen();

  targets_->sampled->Bind();
  targets_->blurred->BindColorTexture();
  darken_->Use();
  darken_->Set("occlusion_map", 0);
  gl_.Enable(GL_BLEND);
  gl_.BlendFunc(GL_ZERO, GL_SRC_COLOR);
  DrawScreen();
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
}

void SceneRenderer::DrawHiddenPaths(const Frame& frame) const {
  const Program& surface = UseSurface(frame, flat_);
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  gl_.DepthFunc(GL_GREATER);
  for (Item item : frame.list.paths) {
    item.alpha = kHiddenAlpha;
    DrawItem(surface, frame, item);
  }
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

void SceneRenderer::DrawGhosts(const Frame& frame) const {
  std::vector<std::vector<Item>> far_first = frame.list.ghosts;
  std::erase_if(far_first, [](const auto& ghost) { return ghost.empty(); });
  std::stable_sort(far_first.begin(), far_first.end(), [&](const auto& a, const auto& b) {
    return DistanceTo(frame.view, a.front()) > DistanceTo(frame.view, b.front());
  });
  for (const std::vector<Item>& ghost : far_first) {
    gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    depth_only_->Use();
    depth_only_->Set("world_to_clip", frame.view.world_to_clip());
    for (const Item& item : ghost) DrawItem(*depth_only_, frame, item);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

    const Program& surface = UseSurface(frame, ghost_);
    gl_.Enable(GL_BLEND);
    gl_.DepthMask(GL_FALSE);
    gl_.DepthFunc(GL_LEQUAL);
    for (const Item& item : ghost) DrawItem(surface, frame, item);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_BLEND);
  }
}

void SceneRenderer::DrawMarkers(const Frame& frame) const {
  std::vector<Item> far_first = frame.list.markers;
  std::stable_sort(far_first.begin(), far_first.end(), [&](const Item& a, const Item& b) {
    return DistanceTo(frame.view, a) > DistanceTo(frame.view, b);
  });
  const Program& surface = UseSurface(frame, region_);
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  for (const Item& item : far_first) {
    Item inside = item;
    inside.alpha *= 0.5f;
    gl_.CullFace(GL_FRONT);
    DrawItem(surface, frame, inside);
    gl_.CullFace(GL_BACK);
    DrawItem(surface, frame, item);
    if (!item.shines_through) continue;
    Item hidden = item;
    hidden.alpha *= kHiddenMarkShare;
    gl_.DepthFunc(GL_GREATER);
    DrawItem(surface, frame, hidden);
    gl_.DepthFunc(GL_LESS);
  }
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

const Program& SceneRenderer::UseSurface(const Frame& frame,
                                         const std::unique_ptr<Program>& surface) const {
  surface->Use();
  surface->Set("world_to_clip", frame.view.world_to_clip());
  surface->Set("world_to_light", frame.world_to_light);
  surface->Set("to_light", frame.list.to_light);
  surface->Set("eye", frame.view.eye_m);
  surface->Set("shadow_map", 0);
  surface->Set("shadow_texel", 1.0f / kShadowSize_px);
  shadow_map_->BindDepthTexture();
  return *surface;
}

void SceneRenderer::DrawItem(const Program& program, const Frame& frame, const Item& item) const {
  program.Set("model", item.X_WI.matrix());
  program.Set("model_normal", Eigen::Matrix3f(item.X_WI.linear().inverse().transpose()));
  program.Set("half_size", item.half_size_m);
  program.Set("rounding", item.rounding_m);
  program.Set("color", LinearColor(item));
  program.Set("gloss", item.gloss);
  program.SetUnsigned("object", static_cast<unsigned>(item.object));
  switch (item.primitive) {
    case Primitive::kBox:
      return box_->Draw();
    case Primitive::kBall:
      return (IsSmallBall(frame.view, item) ? small_ball_ : ball_)->Draw();
    case Primitive::kCylinder:
      return cylinder_->Draw();
    case Primitive::kCone:
      return cone_->Draw();
    case Primitive::kMesh:
      return frame.meshes[item.mesh]->Draw();
  }
}

void SceneRenderer::DrawScreen() const {
  // The core profile requires a bound vertex array even if the shader reads none.
  ball_->Bind();
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace prehend::render
