// SPDX-License-Identifier: Apache-2.0
// A recorded run becomes a render::Picture: which moment, which ghosts, which colours, which rows
// in the strip. Tested by tests/program/acceptance_test.cc
#pragma once

#include "harness/pictures/pictures.h"
#include "render/picture.h"

namespace prehend::harness {

/// The recording must not be empty. The scenario must outlive the picture.
render::Picture ComposePicture(const Scenario& scenario, const RunResult& run,
                               const PictureYaml& entry);

}  // namespace prehend::harness
