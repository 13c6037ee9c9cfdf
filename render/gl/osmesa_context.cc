// SPDX-License-Identifier: Apache-2.0
// The off-screen context by OSMesa. The library is loaded with the first context: with LLVM, which
// it needs, it takes most of the time in which the program starts, and most of its address space.
// osmesa.h includes the system's gl.h, which conflicts with the core profile header; defining
// gl.h's include guard avoids that.
#include "render/gl/osmesa_context.h"

#include <GL/glcorearb.h>
#include <dlfcn.h>

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

/// The functions of OSMesa that are called, with the types that its header declares.
struct Library {
  decltype(&OSMesaCreateContextAttribs) create_context = nullptr;
  decltype(&OSMesaDestroyContext) destroy_context = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetProcAddress) get_address = nullptr;
  std::string problem;  ///< empty if all of them were found
};

template <typename Function>
void Find(void* library, const char* name, Function& function, std::string& problem) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) problem.append("OSMesa has no function ").append(name);
}

Library Load() {
  Library found;
  void* library = dlopen(PREHEND_OSMESA_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    found.problem.append("OSMesa cannot be loaded: ").append(dlerror());
    return found;
  }
  Find(library, "OSMesaCreateContextAttribs", found.create_context, found.problem);
  Find(library, "OSMesaDestroyContext", found.destroy_context, found.problem);
  Find(library, "OSMesaMakeCurrent", found.make_current, found.problem);
  Find(library, "OSMesaGetProcAddress", found.get_address, found.problem);
  return found;
}

/// Stays loaded until the program ends.
const Library& OsMesa() {
  static const Library library = Load();
  return library;
}

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
  if (!OsMesa().problem.empty()) {
    *error = OsMesa().problem;
    return nullptr;
  }
  auto state = std::make_unique<State>();
  state->context = OsMesa().create_context(attributes, nullptr);
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

void OffscreenContext::LoadLibrary() { OsMesa(); }

OffscreenContext::~OffscreenContext() {
  if (state_->context != nullptr) OsMesa().destroy_context(state_->context);
}

bool OffscreenContext::MakeCurrent() {
  return OsMesa().make_current(state_->context, state_->dummy.data(), GL_UNSIGNED_BYTE, kDummySize,
                               kDummySize) == GL_TRUE;
}

void* OffscreenContext::FunctionAddress(const char* name) {
  return reinterpret_cast<void*>(OsMesa().get_address(name));
}

}  // namespace prehend::render
