// SPDX-License-Identifier: Apache-2.0
// Reads a hand, its strengths, gains and sensor sets from a .hand.yaml file, its grasp styles from
// there or from .grasps.yaml files. Tested by tests/harness/scenario/read/read_hand_model_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "physics/scene/hand_model.h"

namespace prehend::scenario {

/// The styles of `more_grasps`, paths of grasp files, come after those of the hand; a style
/// replaces an earlier one of the same name. For a mirror image they are written for the original
/// hand. The paths of all files that were read are appended to `files`.
Result<physics::HandModel> ReadHandModel(const std::string& path,
                                         const std::vector<std::string>& more_grasps = {},
                                         std::vector<std::string>* files = nullptr);

}  // namespace prehend::scenario
