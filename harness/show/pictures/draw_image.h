// SPDX-License-Identifier: Apache-2.0
// From a composed picture to pixels. Tested by tests/harness/show/pictures/scene_painter_test.cc
#pragma once

#include "harness/show/pictures/pictures.h"
#include "render/picture.h"

namespace prehend::show {

/// Draws as the format says; a transparent ground is found by drawing on white and on black paper.
/// An empty image on failure; the painter then has the reason.
render::Image DrawImage(render::Painter& painter, const render::Picture& picture,
                        const PictureFormat& format);

/// The first picture in pale grey, with every pixel in red that differs. Both have one size.
render::Image PaleWithRed(const render::Image& first, const render::Image& second);

}  // namespace prehend::show
