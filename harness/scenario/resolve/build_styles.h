// SPDX-License-Identifier: Apache-2.0
// From grasp styles as written to ordered frames of joint targets, and effort. Tested by
// tests/harness/scenario/read/read_hand_model_test.cc
#pragma once

#include <vector>

#include "harness/scenario/format/hand_fields.h"

namespace prehend::scenario {

/// How a style with the name of an earlier one is treated.
enum class SameName { kIsRefused, kTakesItsPlace };

/// Appends the styles of a hand with these digits to `to`.
void AddStyles(const std::vector<Named<DigitYaml>>& digits,
               const std::vector<Named<StyleYaml>>& styles, SameName rule, DiagnosticList& errors,
               std::vector<physics::GraspStyle>& to);

}  // namespace prehend::scenario
