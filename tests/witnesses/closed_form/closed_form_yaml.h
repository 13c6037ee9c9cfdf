// SPDX-License-Identifier: Apache-2.0
// A closed form as written (tests/witnesses/README.md): a recording without physics, and the events
// in it that are known on paper. tests/witnesses/closed_form/closed_form_fields.cc says how each
// field is called; tests/witnesses/closed_form/closed_form.h computes the recording. Tested by
// tests/witnesses/closed_form/read_closed_form_test.cc
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/yaml/value_format.h"
#include "harness/scenario/format/scenario_yaml.h"

namespace prehend::witnesses {

using FormulaYaml = Located<std::string>;        ///< its place is that of the first character
using VectorFormula = std::vector<FormulaYaml>;  ///< three; or none where it may be left out

/// How an entity moves from where it is placed.
struct MotionYaml {
  VectorFormula by_m;     ///< displacement; none: it stays
  VectorFormula rpy_deg;  ///< how it is turned; none: as it is placed
};

/// A finger, or a thumb: a box of a hand with sensors of its own.
struct HandSideYaml {
  Eigen::Vector3d size_m = {0.002, 0.002, 0.002};
  VectorFormula at_m;  ///< its middle, in the hand's frame; none: that of the palm
};

struct KinematicHandYaml {
  VectorFormula at_m;
  VectorFormula rpy_deg;
  std::optional<FormulaYaml> trigger;  ///< none: open
  Eigen::Vector3d ahead = {1, 0, 0};
  Eigen::Vector3d palm_m = {0.002, 0.002, 0.002};
  std::vector<Named<HandSideYaml>> sides = {{"thumb", {}, {}}, {"fingers", {}, {}}};
};

/// A point where two surfaces touch.
struct TouchYaml {
  std::vector<Located<std::string>> between;  ///< two: "cup", or "hand.thumb"
  FormulaYaml during;                         ///< they touch while it is not 0
  VectorFormula normal;                       ///< on the first one; none: up
  VectorFormula at_m;                         ///< none: where the first one is
  std::optional<FormulaYaml> force_n;         ///< none: the weight of the first one
};

struct SamplingYaml {
  int hz = 240;
  std::optional<FormulaYaml> lost;
};

/// Begin and end of an event, in seconds.
struct KnownEventYaml {
  Located<std::string> label;
  FormulaYaml begin, end;
};

struct ClosedFormYaml {
  Located<std::string> name;
  std::string shows;
  double lasts_s = 0;
  std::vector<Named<FormulaYaml>> numbers, curves;
  std::vector<Named<scenario::EntityYaml>> entities;
  std::vector<Named<MotionYaml>> motions;
  std::vector<Named<KinematicHandYaml>> hands;
  std::vector<TouchYaml> contacts;
  std::vector<SamplingYaml> sampled;  ///< none: the usual ones
  std::vector<KnownEventYaml> truth;
};

ValueFormat<ClosedFormYaml> ClosedFormFormat();

}  // namespace prehend::witnesses
