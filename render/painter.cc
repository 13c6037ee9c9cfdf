// SPDX-License-Identifier: Apache-2.0
// Composes a picture: strip layout, camera, scene, then flat elements on top.
// Tested by tests/render/painter_test.cc
#include <algorithm>
#include <cmath>

#include "render/draw_list.h"
#include "render/gl_functions.h"
#include "render/labels.h"
#include "render/osmesa_context.h"
#include "render/picture.h"
#include "render/scene_renderer.h"
#include "render/shaders.h"
#include "render/timeline_strip.h"

namespace prehend::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kTitleSize = 19;
constexpr int kMinSideWithText_px = 120;  // text would hide a smaller picture

// The processor feature that pixels depend on.
const char* FusedMultiplyAdd() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("fma") ? "fma" : "no-fma";
#else
  return "other-cpu";
#endif
}

std::string SizeError(const Picture& picture) {
  const auto fits = [](int side_px) { return side_px >= 1 && side_px <= kMaxPictureSide_px; };
  if (fits(picture.width_px) && fits(picture.height_px)) return "";
  return "a picture of " + std::to_string(picture.width_px) + " x " +
         std::to_string(picture.height_px) + " pixels cannot be drawn: each side must be 1 to " +
         std::to_string(kMaxPictureSide_px);
}

// Everything that is computed from a picture before drawing.
struct Plan {
  StripLayout strip;
  DrawList list;
  View view;
};

float TextScale(const Picture& picture) {
  return std::isfinite(picture.text_scale) ? std::clamp(picture.text_scale, 0.3f, 5.0f) : 1;
}

Plan MakePlan(const Picture& picture, const Font& font) {
  Plan plan;
  plan.strip =
      LayOutStrip(picture.strip, font, picture.width_px, picture.height_px, TextScale(picture));
  plan.list = MakeDrawList(picture);
  plan.view = MakeView(picture.camera, picture.width_px, picture.height_px,
                       plan.strip.reserved_px(), plan.list.bounds);
  return plan;
}

// Large objects (tables) would leave no free place; for labels they count as scenery.
constexpr float kMaxExtentShare = 0.10f;  // of the picture's area

LabelRequest RequestLabel(const std::string& text, const Color& color, const Bounds& bounds,
                          const View& view) {
  LabelRequest request{text, color, Vector2f::Constant(std::nanf("")), {}};
  const std::optional<Vector2f> middle = ToPixel(view, bounds.center_m());
  if (bounds.empty() || !middle.has_value()) return request;
  request.anchor = *middle;
  Vector2f low = *middle, high = *middle;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3f far_side(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Vector3f p = bounds.low_m.array() + far_side * (bounds.high_m - bounds.low_m).array();
    const std::optional<Vector2f> pixel = ToPixel(view, p);
    if (!pixel.has_value()) return request;
    low = low.cwiseMin(*pixel);
    high = high.cwiseMax(*pixel);
  }
  const Vector2f size = high - low;
  const float area = static_cast<float>(view.width_px) * static_cast<float>(view.height_px);
  if (size.x() * size.y() < kMaxExtentShare * area)
    request.extent = {low.x(), low.y(), size.x(), size.y()};
  return request;
}

std::vector<LabelRequest> RequestLabels(const Picture& picture, const Plan& plan) {
  std::vector<LabelRequest> requests;
  // Labels beyond `count` name objects that the scene does not have.
  const auto request = [&](const std::vector<std::string>& labels, std::size_t count,
                           int first_object, const auto& color_of) {
    for (std::size_t i = 0; i < std::min(labels.size(), count); ++i) {
      if (labels[i].empty()) continue;
      const Bounds& bounds = plan.list.objects[first_object + i].bounds;
      requests.push_back(RequestLabel(labels[i], color_of(i), bounds, plan.view));
    }
  };
  if (picture.scene == nullptr) return requests;
  request(picture.body_labels, picture.scene->bodies.size(), plan.list.first_body,
          [&](std::size_t i) { return BodyColor(picture, i); });
  request(picture.hand_labels, picture.scene->hands.size(), plan.list.first_hand,
          [](std::size_t) { return kSkinColor; });
  return requests;
}

// Points along paths, so dense that no label fits between two.
std::vector<Vector2f> PathPixels(const Plan& plan) {
  std::vector<Vector2f> pixels;
  for (const Item& item : plan.list.paths) {
    if (item.primitive != Primitive::kMesh) continue;
    const Mesh& tube = plan.list.meshes[static_cast<std::size_t>(item.mesh)];
    for (std::size_t i = 0; i < tube.vertices.size(); i += 13) {
      const std::optional<Vector2f> p = ToPixel(plan.view, tube.vertices[i].corner);
      if (p.has_value()) pixels.push_back(*p);
    }
  }
  return pixels;
}

Rect DrawTitle(const std::string& title, float scale, float width, Canvas* canvas) {
  if (title.empty()) return {};
  const float size = std::max(11.0f, kTitleSize * scale);
  const std::string text = canvas->font().Shortened(title, size, width - 56 * scale);
  if (text.empty()) return {};
  const Rect box = {12 * scale, 12 * scale, canvas->font().Width(text, size) + 24 * scale,
                    size + 12 * scale};
  canvas->FillRounded(box, 7 * scale, Hex(0xFFFFFF), 0.86f);
  canvas->DrawText(box.x + 12 * scale, box.y + 6 * scale, text, size, Hex(0x1B1F24));
  return box;
}

void DrawOverlay(const Picture& picture, const Plan& plan, Canvas* canvas) {
  if (std::min(picture.width_px, picture.height_px) < kMinSideWithText_px) return;
  const float scale = OverlayScale(picture.height_px) * TextScale(picture);
  const auto width = static_cast<float>(picture.width_px),
             height = static_cast<float>(picture.height_px);
  const Rect title = DrawTitle(picture.title, scale, width, canvas);
  const float free_height = height - static_cast<float>(plan.strip.reserved_px());
  const LabelObstacles obstacles{.area = Rect{0, 0, width, free_height}.Grown(-5 * scale),
                                 .forbidden = {title.Grown(4 * scale)},
                                 .avoid = PathPixels(plan)};
  DrawLabels(PlaceLabels(RequestLabels(picture, plan), obstacles, canvas->font(), scale), scale,
             canvas);
  DrawStrip(plan.strip, canvas);
}

}  // namespace

// Members are destroyed in reverse order: the renderer before the functions and the context that it
// needs.
struct Painter::State {
  std::string error;
  std::unique_ptr<Font> font;
  std::unique_ptr<OffscreenContext> context;
  GlFunctions gl;
  std::unique_ptr<SceneRenderer> renderer;

  bool ready() const { return renderer != nullptr; }
  // Sets `error` to the reason why this picture cannot be drawn, or to empty.
  bool Prepare(const Picture& picture);
};

bool Painter::State::Prepare(const Picture& picture) {
  if (!ready()) return false;
  error = SizeError(picture);
  if (error.empty() && !context->MakeCurrent())
    error = "the off-screen context cannot be made current";
  return error.empty();
}

void Painter::LoadLibrary() { OffscreenContext::LoadLibrary(); }

Painter::Painter(const std::string& font_file) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.font = Font::Read(font_file, &state.error);
  if (state.font == nullptr) return;
  state.context = OffscreenContext::Create(&state.error);
  if (state.context == nullptr) return;
  if (!LoadGlFunctions(&OffscreenContext::FunctionAddress, &state.gl, &state.error)) return;
  state.renderer = SceneRenderer::Create(state.gl, &state.error);
  if (state.renderer != nullptr && !state.renderer->PassesSelfTest()) {
    state.renderer = nullptr;
    state.error = "the OpenGL self-test did not draw the expected triangle";
  }
}

Painter::~Painter() {
  if (state_->context != nullptr) state_->context->MakeCurrent();
}

const std::string& Painter::error() const { return state_->error; }

Image Painter::Draw(const Picture& picture) {
  if (!state_->Prepare(picture)) return {};
  const Plan plan = MakePlan(picture, *state_->font);
  Image image = state_->renderer->Render(plan.list, plan.view);
  if (image.rgb.empty()) {
    state_->error = "OpenGL has no memory for a picture of this size";
    return {};
  }
  Canvas canvas(*state_->font, &image);
  DrawOverlay(picture, plan, &canvas);
  return image;
}

IdImage Painter::DrawIds(const Picture& picture) {
  if (!state_->Prepare(picture)) return {};
  const Plan plan = MakePlan(picture, *state_->font);
  IdImage image{
      picture.width_px, picture.height_px, state_->renderer->RenderIds(plan.list, plan.view), {}};
  if (image.ids.empty()) {
    state_->error = "OpenGL has no memory for a picture of this size";
    return {};
  }
  for (const DrawnObject& object : plan.list.objects) image.names.push_back(object.name);
  return image;
}

std::string Painter::Fingerprint() const {
  if (!state_->ready()) return "";
  state_->context->MakeCurrent();
  const auto text = [&](GLenum name) {
    const GLubyte* bytes = state_->gl.GetString(name);
    return std::string(bytes != nullptr ? reinterpret_cast<const char*>(bytes) : "unknown");
  };
  return text(GL_VERSION) + " | " + text(GL_RENDERER) + " | " + FusedMultiplyAdd() +
         " | renderer " + std::to_string(kRendererVersion);
}

}  // namespace prehend::render
