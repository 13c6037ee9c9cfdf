// SPDX-License-Identifier: Apache-2.0
// Composes a render::Picture of a recorded run at one moment: camera, colours, paths, ghosts,
// markers, and the rows of the strip. Tested by tests/harness/show/pictures/compose_picture_test.cc
#pragma once

#include "harness/show/pictures/pictures.h"
#include "render/picture.h"

namespace prehend::show {

/// The recording must not be empty. The scenario must outlive the picture.
render::Picture ComposePicture(const scenario::Scenario& scenario, const episode::RunResult& run,
                               const scenario::PictureYaml& entry,
                               const PictureFormat& format = {});

/// Draws as the format says; a transparent ground is found by drawing on white and on black paper.
/// An empty image on failure; the painter then has the reason.
render::Image DrawImage(render::Painter& painter, const render::Picture& picture,
                        const PictureFormat& format);

/// The first picture in pale grey, with every pixel in red that differs. Both have one size.
render::Image PaleWithRed(const render::Image& first, const render::Image& second);

}  // namespace prehend::show
