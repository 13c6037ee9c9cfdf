// SPDX-License-Identifier: Apache-2.0
// Composes a render::Picture of a recorded run at one moment: camera, colours, paths, ghosts,
// markers, and the rows of the strip. Tested by tests/harness/pictures/compose_picture_test.cc
#pragma once

#include "harness/pictures/pictures.h"
#include "render/picture.h"

namespace prehend::harness {

/// The recording must not be empty. The scenario must outlive the picture.
render::Picture ComposePicture(const Scenario& scenario, const RunResult& run,
                               const PictureYaml& entry, const PictureFormat& format = {});

}  // namespace prehend::harness
