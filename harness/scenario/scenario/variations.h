// SPDX-License-Identifier: Apache-2.0
// The trials of a scenario: `vary:`, what differs between them, and `outcomes:`, how one can end.
// harness/scenario/format/trial_fields.cc declares their keys. Tested by
// tests/harness/scenario/read/sample_variations_test.cc and
// tests/harness/episode/run/outcome_test.cc
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/base/located.h"
#include "physics/base/ids.h"

namespace prehend::scenario {

/// One sample for all its fields. Exactly one distribution is set.
struct VariationYaml {
  Where where;
  std::vector<std::string> fields;         ///< paths as for --set
  std::optional<Eigen::Vector2d> uniform;  ///< [min, max]
  std::optional<Eigen::Vector2d> normal;   ///< [mean, standard deviation]
  std::optional<Eigen::Vector2d> plus;     ///< uniform, added to the written value
  std::optional<Eigen::Vector2d> times;    ///< uniform, multiplied with the written value
  std::optional<std::vector<std::string>> choose;
};

/// A condition on one entity; it holds when everything that is set holds.
struct ConditionYaml {
  Where where;
  std::string entity;
  std::optional<double> at_s;                 ///< when; default: at the end
  std::optional<std::vector<double>> near_m;  ///< its centre is near [x, y] or [x, y, z]
  double within_m = 0.05;
  std::optional<double> above_m, below_m;                ///< its centre's height
  std::optional<double> tilt_below_deg, tilt_above_deg;  ///< since it was placed
  std::optional<double> slower_than_m_per_s;
  std::optional<double> joint_above, joint_below;  ///< fraction of its joint's range
  std::optional<Located<std::string>>
      inside;        ///< its centre is in the bounding box of this entity ...
  double share = 1;  ///< ... or, of grains, at least this share of them
};

/// An outcome whose entities are resolved; it holds when all its conditions do.
struct Outcome {
  struct Condition {
    physics::BodyIndex body = physics::BodyIndex(0);
    int joint = -1;                  ///< index into Scene::joints
    physics::BodyIndex vessel = {};  ///< that it must be inside, or none
    ConditionYaml wanted;
  };
  std::string name;
  std::vector<Condition> conditions;
};

}  // namespace prehend::scenario
