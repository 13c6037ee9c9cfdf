// SPDX-License-Identifier: Apache-2.0
// The shader sources (GLSL 3.30). What each computes is said beside it in render/shaders.cc.
// Tested by tests/render/painter_test.cc
#pragma once

namespace prehend::render {

/// Number that changes whenever pixels change on purpose; part of the fingerprint.
inline constexpr int kRendererVersion = 2;

extern const char* const
    kSolidVertexShader;  ///< corner * half_size + direction * rounding, to world and clip
extern const char* const kSurfaceFragmentShader;  ///< light, shadow, ground grid, region rim; wants
                                                  ///< a version, FINISH and SHADOWS before it
extern const char* const kDepthFragmentShader;    ///< nothing but depth
extern const char* const kIdFragmentShader;       ///< the object's number
extern const char* const kScreenVertexShader;     ///< one triangle over the whole target
extern const char* const kBackdropFragmentShader;
extern const char* const kOcclusionFragmentShader;
extern const char* const kOcclusionBlurFragmentShader;
extern const char* const kDarkenFragmentShader;  ///< by how much corners are darker

}  // namespace prehend::render
