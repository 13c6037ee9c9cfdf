// SPDX-License-Identifier: Apache-2.0
// Snapshots of a world that moves by formulas. Tested by
// tests/witnesses/closed_form/read_closed_form_test.cc
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/located.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "tests/witnesses/closed_form/formula.h"

namespace prehend::witnesses {

using LocatedFormula = Located<std::optional<Formula>>;  ///< empty: not given
using LocatedVector = std::array<LocatedFormula, 3>;     ///< all of them or none

/// A world's formulas. Bodies and hands are in the order of the scene.
struct WorldFormulas {
  struct Curve {
    double* value = nullptr;  ///< a variable of the scope
    LocatedFormula formula;
  };
  struct BodyMotion {
    LocatedVector by_m, rpy_deg;
  };
  struct HandMotion {
    LocatedVector at_m, rpy_deg;
    LocatedFormula trigger;
    std::vector<LocatedVector> sides_m;  ///< one per link of the model
  };
  struct Touch {
    physics::ContactSide a, b;
    LocatedFormula during, force_n;
    LocatedVector normal, at_m;
  };

  FormulaScope scope;  ///< owns the variables
  double* t_s = nullptr;
  std::vector<Curve> curves;  ///< each may use those before it
  std::vector<BodyMotion> bodies;
  std::vector<HandMotion> hands;
  std::vector<Touch> touches;
};

/// A formula whose value was no number.
struct NoNumber {
  Where where;
  double t_s = 0;
};

class Kinematics {
 public:
  /// The scene outlives this object.
  Kinematics(const physics::Scene& scene, WorldFormulas formulas)
      : scene_(scene), formulas_(std::move(formulas)) {}

  /// The world at a tick of the scene's rate. Velocities are those with which the poses change up
  /// to this moment, from the microsecond before it.
  physics::Snapshot At(grammar::Tick tick);

  /// The first formula that failed in any call.
  const std::optional<NoNumber>& no_number() const { return no_number_; }

 private:
  void SetTime(double t_s);
  double Value(const LocatedFormula& formula);
  Eigen::Vector3d Vector(const LocatedVector& formulas, const Eigen::Vector3d& otherwise);
  physics::Pose BodyPose(std::size_t body);
  physics::Pose PalmPose(std::size_t hand);
  physics::HandState HandNow(std::size_t hand);
  void AddTouches(physics::Snapshot& snapshot);

  const physics::Scene& scene_;
  WorldFormulas formulas_;
  std::optional<NoNumber> no_number_;
};

}  // namespace prehend::witnesses
