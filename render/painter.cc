// SPDX-License-Identifier: Apache-2.0
// Composes a picture: strip layout, camera, scene, then flat elements on top.
// Tested by tests/render/painter_test.cc
#include "render/draw_list.h"
#include "render/gl/gl_functions.h"
#include "render/gl/gl_objects.h"
#include "render/gl/osmesa_context.h"
#include "render/inventory.h"
#include "render/overlay.h"
#include "render/picture.h"
#include "render/scene_renderer.h"

namespace prehend::render {
namespace {

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
  DrawList list;
  View view;
  Overlay overlay;
  std::vector<std::uint32_t> seen;  ///< at each pixel; empty: nothing has a label
};

Plan MakePlan(const Picture& picture, const Font& font, SceneRenderer& renderer) {
  Plan plan;
  plan.list = MakeDrawList(picture);
  plan.overlay.strip = LayOutStripOf(picture, font);
  plan.view = MakeView(picture.camera, picture.width_px, picture.height_px,
                       plan.overlay.strip.reserved_px(), plan.list.bounds);
  if (!picture.body_labels.empty() || !picture.hand_labels.empty())
    plan.seen = renderer.RenderIds(plan.list, plan.view);
  AddTitleAndLabels(picture, plan.list, plan.view, plan.seen, font, &plan.overlay);
  return plan;
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
  const Plan plan = MakePlan(picture, *state_->font, *state_->renderer);
  Image image = state_->renderer->Render(plan.list, plan.view);
  if (image.rgb.empty()) {
    state_->error = "OpenGL has no memory for a picture of this size";
    return {};
  }
  Canvas canvas(*state_->font, &image);
  DrawOverlay(plan.overlay, &canvas);
  return image;
}

IdImage Painter::DrawIds(const Picture& picture) {
  if (!state_->Prepare(picture)) return {};
  const Plan plan = MakePlan(picture, *state_->font, *state_->renderer);
  IdImage image{
      picture.width_px, picture.height_px, state_->renderer->RenderIds(plan.list, plan.view), {}};
  if (image.ids.empty()) {
    state_->error = "OpenGL has no memory for a picture of this size";
    return {};
  }
  for (const DrawnObject& object : plan.list.objects) image.names.push_back(object.name);
  return image;
}

ListedPicture Painter::DrawListed(const Picture& picture) {
  ListedPicture listed{.image = Draw(picture)};
  if (listed.image.rgb.empty()) return listed;
  const Plan plan = MakePlan(picture, *state_->font, *state_->renderer);
  listed.things = state_->renderer->RenderIds(plan.list, plan.view);
  if (listed.things.empty()) {
    state_->error = "OpenGL has no memory for a picture of this size";
    return {};
  }
  listed.inventory.drawn_by = Fingerprint();
  listed.inventory.pixels = PixelHash(listed.image);
  ListThings(plan.list, plan.overlay, &listed);
  return listed;
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
