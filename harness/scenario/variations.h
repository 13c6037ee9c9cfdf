// SPDX-License-Identifier: Apache-2.0
// What a scenario says about trials: `vary:`, what differs from one to the next, and `outcomes:`,
// how one can end. Their YAML face is in harness/format/trial_fields.cc. Tested by
// tests/harness/read/sample_variations_test.cc and tests/harness/run/outcome_test.cc
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/located.h"

namespace prehend::harness {

/// One draw for all its fields; exactly one distribution is given.
struct VariationYaml {
  Where where;
  std::vector<std::string> fields;         ///< paths as of --set
  std::optional<Eigen::Vector2d> uniform;  ///< [least, most]
  std::optional<Eigen::Vector2d> normal;   ///< [mean, standard deviation]
  std::optional<Eigen::Vector2d> plus;     ///< uniform, added to what is written
  std::optional<Eigen::Vector2d> times;    ///< uniform, multiplied with what is written
  std::optional<std::vector<std::string>> choose;
};

/// What has to be true of one entity; everything that is given.
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
    int body = 0;
    int joint = -1;   ///< index into Scene::joints
    int vessel = -1;  ///< what it has to be inside of
    ConditionYaml wanted;
  };
  std::string name;
  std::vector<Condition> conditions;
};

}  // namespace prehend::harness
