// SPDX-License-Identifier: Apache-2.0
// Composes a render::Picture of a recorded run at one moment: camera, colours, paths, ghosts,
// markers, and the rows of the strip. Tested by tests/harness/show/pictures/compose_picture_test.cc
#pragma once

#include <string>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"
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

// From where a picture is seen. A camera is fitted to the whole episode, not to the moment, so
// that pictures of one scenario can be laid over each other. Tested by
// tests/harness/show/pictures/compose_picture_test.cc

/// `name` is one of CamerasOf(): a camera of the scenario, or
///  - front, left, right, top, three_quarter: hands, small things and what moves, all the time;
///    top also what these stand on;
///  - action: hands, and small things that move, all the time;
///  - body: persons, too;
///  - hand: the hands as they are in the picture's snapshot, what is near them, and
///  `format.framed`.
///    Where that names hands, other hands are left out;
///  - a place and where it looks (harness/scenario/scenario/scenario.h).
render::Camera CameraFor(const scenario::Scenario& scenario, const episode::RunResult& run,
                         const render::Picture& picture, const std::string& name,
                         const PictureFormat& format = {});

}  // namespace prehend::show
