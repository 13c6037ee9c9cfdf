// SPDX-License-Identifier: Apache-2.0
// Reads a hand, its strengths, gains, sensor sets and grasp styles from a .hand.yaml file.
// Tested by tests/harness/read_hand_model_test.cc
#pragma once

#include <string>

#include "harness/read_result.h"
#include "physics/hand_model.h"

namespace prehend::harness {

ReadResult<physics::HandModel> ReadHandModel(const std::string& path);

}  // namespace prehend::harness
