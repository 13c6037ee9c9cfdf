// SPDX-License-Identifier: Apache-2.0
// An OpenGL context without a window or a graphics card, behind three functions so that another
// off-screen library can replace OSMesa without touching the rest of the room.
// Tested by tests/render/painter_test.cc
#pragma once

#include <memory>
#include <string>

namespace prehend::render {

class OffscreenContext {
 public:
  /// A current OpenGL 3.3 core context, or null and why in *error.
  static std::unique_ptr<OffscreenContext> Create(std::string* error);
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Several contexts may live in one process; the last one made current gets the commands.
  bool MakeCurrent();
  /// Address of an OpenGL function. Non-null does not prove that the function exists.
  static void* FunctionAddress(const char* name);

 private:
  struct State;
  explicit OffscreenContext(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prehend::render
