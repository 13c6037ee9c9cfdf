// SPDX-License-Identifier: Apache-2.0
// The off-screen context by OSMesa. osmesa.h includes the system's gl.h, which conflicts with the
// core profile header; defining gl.h's include guard avoids that.
// Tested by tests/render/painter_test.cc
#include "render/osmesa_context.h"

#include <GL/glcorearb.h>

#include <array>
#include <cstdint>

#define __gl_h_ 1
#ifndef GLAPIENTRY
#define GLAPIENTRY APIENTRY
#endif
#ifndef GLAPI
#define GLAPI extern
#endif
#include <GL/osmesa.h>

namespace prehend::render {
namespace {

// All drawing goes to framebuffer objects; the window-system buffer only has to exist.
constexpr int kDummySize = 16;

}  // namespace

struct OffscreenContext::State {
  OSMesaContext context = nullptr;
  std::array<std::uint8_t, kDummySize* kDummySize* 4> dummy = {};
};

OffscreenContext::OffscreenContext(std::unique_ptr<State> state) : state_(std::move(state)) {}

std::unique_ptr<OffscreenContext> OffscreenContext::Create(std::string* error) {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_STENCIL_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  auto state = std::make_unique<State>();
  state->context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (state->context == nullptr) {
    *error = "OSMesa cannot create an OpenGL 3.3 core context";
    return nullptr;
  }
  std::unique_ptr<OffscreenContext> context(new OffscreenContext(std::move(state)));
  if (!context->MakeCurrent()) {
    *error = "OSMesa cannot make its context current";
    return nullptr;
  }
  return context;
}

OffscreenContext::~OffscreenContext() {
  if (state_->context != nullptr) OSMesaDestroyContext(state_->context);
}

bool OffscreenContext::MakeCurrent() {
  return OSMesaMakeCurrent(state_->context, state_->dummy.data(), GL_UNSIGNED_BYTE, kDummySize,
                           kDummySize) == GL_TRUE;
}

void* OffscreenContext::FunctionAddress(const char* name) {
  return reinterpret_cast<void*>(OSMesaGetProcAddress(name));
}

}  // namespace prehend::render
