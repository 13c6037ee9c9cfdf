// SPDX-License-Identifier: Apache-2.0
// From where a picture is seen. A camera is fitted to the whole episode, not to the moment, so
// that pictures of one scenario can be laid over each other. Tested by
// tests/harness/show/pictures/compose_picture_test.cc
#pragma once

#include <string>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/pictures.h"
#include "render/picture.h"

namespace prehend::show {

/// `name` is one of CamerasOf(): a camera of the scenario, or
///  - front, left, right, top, three_quarter: hands, small things and what moves, all the time;
///  - action: hands, and small things that move, all the time;
///  - body: persons, too;
///  - hand: the hands as they are in the picture's snapshot, what is near them, and
///  `format.framed`.
///    Where that names hands, other hands are left out;
///  - a place and where it looks (harness/scenario/scenario/own_camera.h).
render::Camera CameraFor(const scenario::Scenario& scenario, const episode::RunResult& run,
                         const render::Picture& picture, const std::string& name,
                         const PictureFormat& format = {});

}  // namespace prehend::show
