// SPDX-License-Identifier: Apache-2.0
// An OpenGL context without a window or a graphics card. Few functions are public, so that
// another off-screen library can replace OSMesa without changes elsewhere.
// Tested by tests/render/painter_test.cc
#pragma once

#include <memory>
#include <string>

namespace prehend::render {

class OffscreenContext {
 public:
  /// Creates an OpenGL 3.3 core context and makes it current. Null, with the reason in *error, on
  /// failure.
  static std::unique_ptr<OffscreenContext> Create(std::string* error);
  ~OffscreenContext();
  /// Loads the library, which Create() does otherwise.
  static void LoadLibrary();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Several contexts may exist in one process; the one made current last gets the commands.
  bool MakeCurrent();
  /// Address of an OpenGL function. A non-null address does not prove that the function exists.
  static void* FunctionAddress(const char* name);

 private:
  struct State;
  explicit OffscreenContext(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prehend::render
