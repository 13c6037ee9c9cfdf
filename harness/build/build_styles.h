// SPDX-License-Identifier: Apache-2.0
// Grasp styles as they are written -> ordered frames of joint targets, and effort. Tested by
// tests/harness/read/read_hand_model_test.cc
#pragma once

#include <vector>

#include "harness/format/hand_fields.h"

namespace prehend::harness {

/// What becomes of a style of the same name as an earlier one.
enum class SameName { kIsRefused, kTakesItsPlace };

/// Of a hand with these digits.
void AddStyles(const std::vector<Named<DigitYaml>>& digits,
               const std::vector<Named<StyleYaml>>& styles, SameName rule, DiagnosticList& errors,
               std::vector<physics::GraspStyle>& to);

}  // namespace prehend::harness
