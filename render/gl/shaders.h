// SPDX-License-Identifier: Apache-2.0
// The shader sources (GLSL 3.30). render/gl/shaders.cc describes what each computes.
// Tested by tests/render/painter_test.cc
#pragma once

namespace prehend::render {

/// Version of the pixels: raise it whenever they change on purpose. Part of the fingerprint.
inline constexpr int kRendererVersion = 3;

extern const char* const
    kSolidVertexShader;  ///< corner * half_size + direction * rounding, to world and clip
extern const char* const kSurfaceFragmentShader;  ///< light, shadow, ground grid, region rim; needs
                                                  ///< #version, FINISH and SHADOWS before it
extern const char* const kDepthFragmentShader;    ///< depth only
extern const char* const kIdFragmentShader;       ///< the object's number
extern const char* const kScreenVertexShader;     ///< one triangle over the whole target
extern const char* const kBackdropFragmentShader;
extern const char* const kOcclusionFragmentShader;
extern const char* const kOcclusionBlurFragmentShader;
extern const char* const kDarkenFragmentShader;  ///< factor by which corners darken

}  // namespace prehend::render
