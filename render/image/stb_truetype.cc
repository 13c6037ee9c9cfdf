// SPDX-License-Identifier: Apache-2.0
// Compiles stb_truetype; render/image/canvas.cc uses it.
// Tested by tests/render/image/canvas_test.cc
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-compare"
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop
