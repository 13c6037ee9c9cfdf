// SPDX-License-Identifier: Apache-2.0
// Looks up the function table.
#include "render/gl/gl_functions.h"

namespace prehend::render {

bool LoadGlFunctions(void* (*address_of)(const char*), GlFunctions* gl, std::string* error) {
#define PREHEND_LOAD(type, name)                             \
  gl->name = reinterpret_cast<type>(address_of("gl" #name)); \
  if (gl->name == nullptr) {                                 \
    *error = "the OpenGL function gl" #name " is missing";   \
    return false;                                            \
  }
  PREHEND_GL_FUNCTIONS(PREHEND_LOAD)
#undef PREHEND_LOAD
  return true;
}

}  // namespace prehend::render
