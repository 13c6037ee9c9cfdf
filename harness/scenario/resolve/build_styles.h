// SPDX-License-Identifier: Apache-2.0
// From grasp styles as written to ordered frames of joint targets, and effort. Bodies of entities
// without matter: regions, gaze targets, cameras, lights. Tested by
// tests/harness/scenario/read/read_hand_model_test.cc and
// tests/harness/scenario/format/abstract_entities_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/format/hand_fields.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// How a style with the name of an earlier one is treated.
enum class SameName { kIsRefused, kTakesItsPlace };

/// Appends the styles of a hand with these digits to `to`.
void AddStyles(const std::vector<Named<DigitYaml>>& digits,
               const std::vector<Named<StyleYaml>>& styles, SameName rule, DiagnosticList& errors,
               std::vector<physics::GraspStyle>& to);

/// Sets the body's shape and, for a camera, its orientation. `entity` is abstract; the body is at
/// its position.
void MakeAbstract(const EntityYaml& entity, physics::Body& body);

/// "a region" for a body without matter, "grains" for grains; "" for a thing.
std::string WhyNoThing(const physics::Body& body);

}  // namespace prehend::scenario
