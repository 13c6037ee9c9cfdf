// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/read_hand_model_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;
using physics::GraspApproach;
using physics::JointDriver;
using physics::PidGains;

ValueFormat<double> PartLength() { return Number(0.001, 0.5); }
ValueFormat<double> PartMass() { return Number(0.001, 10); }
ValueFormat<Vector3d> InHand() { return Vector<3>(-1, 1); }

/// A direction of any length but 0; what is read has length 1.
ValueFormat<Vector3d> Direction() {
  const auto vector = Vector<3>(-1, 1);
  return ValueFormat<Vector3d>(
             vector.schema(),
             [vector](const YamlNode& node, DiagnosticList& errors, Vector3d& value) {
               if (!vector.Read(node, errors, value)) return false;
               if (value.norm() < 1e-6)
                 return ReportExpected(node, errors, "a direction other than [0, 0, 0]");
               value.normalize();
               return true;
             })
      .ShownAs(vector);
}

ValueFormat<PerDigit> PerDigitFormat(double lowest, double highest) {
  return MapOf(Identifier(), WithPlace(ListOf(WithPlace(Number(lowest, highest)), 1, 8)), 1, 16);
}

/// Distinct names.
ValueFormat<std::vector<std::string>> DifferentNames(std::size_t most) {
  const auto list = ListOf(Identifier(), 1, most);
  return ValueFormat<std::vector<std::string>>(
      list.schema(),
      [list](const YamlNode& node, DiagnosticList& errors, std::vector<std::string>& names) {
        if (!list.Read(node, errors, names)) return false;
        bool good = true;
        for (std::size_t i = 0; i < names.size(); ++i) {
          const auto here = names.begin() + static_cast<std::ptrdiff_t>(i);
          if (std::find(names.begin(), here, *here) == here) continue;
          errors.Add(node.children[i].where,
                     fmt::format("{}: '{}' is given twice", node.key, *here));
          good = false;
        }
        return good;
      });
}

constexpr double kDegPerRad = 180 / std::numbers::pi;

/// Between two lines, 0 to 90 degrees, of directions of length 1.
double DegreesBetween(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b)))) * kDegPerRad;
}

/// Reports a `direction`, given by `key` of the node, that is not perpendicular to another one.
void CheckAcross(const YamlNode& node, const char* key, const Vector3d& direction,
                 const std::string& other_key, const Vector3d& other, DiagnosticList& errors,
                 const std::string& hint) {
  constexpr double kMaxOff_deg = 1;  // two written digits
  const double degrees = DegreesBetween(direction, other);
  if (90 - degrees <= kMaxOff_deg) return;
  errors.Add(node.Find(key)->where,
             fmt::format("{}: expected a direction at right angles to {}, found one at {:.3g} "
                         "degrees to it",
                         key, other_key, degrees),
             hint);
}

ValueFormat<PalmYaml> PalmFormat() {
  using P = PalmYaml;
  return StructFormat<P>("the palm")
      .Optional("size_m", &P::size_m, Vector<3>(0.005, 0.5),
                "Full edge lengths of its box [x, y, z].")
      .Optional("mass_kg", &P::mass_kg, PartMass(), "Mass.")
      .Optional("inertia_scale", &P::inertia_scale, Number(1, 100),
                "Factor on the box's inertia; accounts for the forearm.")
      .Required("sensor_set", &P::sensor_set, Identifier(),
                "The sensor set that feels its contacts.")
      .format();
}

/// `effort` is "Force" or "Torque".
ValueFormat<PidGains> PidFormat(const std::string& noun, const std::string& effort,
                                const std::string (&keys)[4]) {
  return StructFormat<PidGains>(noun)
      .Required(keys[0], &PidGains::proportional, Number(0, 1e6), effort + " per error.")
      .Required(keys[1], &PidGains::derivative, Number(0, 1e5), effort + " per speed of the error.")
      .Required(keys[2], &PidGains::integral, Number(0, 1e6), effort + " per error and second.")
      .Required(keys[3], &PidGains::limit, Number(0, 1e4),
                effort == "Force" ? "Largest force." : "Largest torque.")
      .Optional("integral_share", &PidGains::integral_share, Number(0, 1),
                "Largest share of the integral's part.")
      .format();
}

ValueFormat<JointDriver> DriverFormat() {
  using D = JointDriver;
  return StructFormat<D>("the joint driver")
      .Optional("stiffness", &D::stiffness, Number(0, 1),
                "Share of the error that it tries to remove per tick at 480 Hz.")
      .Optional("damping", &D::damping, Number(0, 1), "How firmly it holds its target speed.")
      .Optional("max_speed_rad_per_s", &D::max_speed_rad_per_s, Number(0.1, 100),
                "Maximum speed of a joint.")
      .Optional("max_slide_m_per_s", &D::max_slide_m_per_s, Number(0.001, 10),
                "Maximum speed of a jaw.")
      .format();
}

/// Adds the fields that a phalanx and a jaw share; the units are those of its joint.
ValueFormat<LinkYaml> LinkFormat(StructFormat<LinkYaml>& record, const char* strength,
                                 double strongest, const char* range, double farthest) {
  using L = LinkYaml;
  return record.Required("length_m", &L::length_m, PartLength(), "From its joint to the next one.")
      .Required("half_width_m", &L::half_width_m, PartLength(), "Half of its width.")
      .Required("half_thickness_m", &L::half_thickness_m, PartLength(),
                "Half of its thickness, from back to pad.")
      .Required("mass_kg", &L::mass_kg, PartMass(), "Mass.")
      .Required(strength, &L::strength, Number(0, strongest),
                "Largest torque or force of its joint at effort 1.")
      .Required(range, &L::range, Vector<2>(-farthest, farthest), "Joint limits [min, max].")
      .Check([key = std::string(range)](const YamlNode&, const L& link, DiagnosticList& errors) {
        CheckLeastMost(key, link.range.value, link.range.where, errors);
      })
      .format();
}

ValueFormat<LinkYaml> PhalanxFormat() {
  using L = LinkYaml;
  return LinkFormat(
      StructFormat<L>("a phalanx")
          .Required("name", &L::called, Identifier(), "Its name after the digit's: index_proximal.")
          .Optional("joint_axis", &L::joint_axis, Direction(),
                    "Axis of the joint at its base, in H; positive angles close."),
      "strength_nm", 100, "range_deg", 180);
}

ValueFormat<LinkYaml> JawFormat() {
  return LinkFormat(
      StructFormat<LinkYaml>("a jaw").Required("slides", &LinkYaml::joint_axis, Direction(),
                                               "In H: the way it slides; positive values close."),
      "strength_n", 1000, "range_m", 0.5);
}

/// A last joint along the digit's own direction neither opens nor closes it.
void CheckLastJoint(const YamlNode& node, const DigitYaml& digit, DiagnosticList& errors) {
  constexpr double kMinAngle_deg = 1;
  if (digit.phalanges.empty()) return;
  if (DegreesBetween(digit.phalanges.back().joint_axis, digit.direction) >= kMinAngle_deg) return;
  const YamlNode& last = node.Find("phalanges")->children.back();
  const YamlNode* axis = last.Find("joint_axis");
  errors.Add(axis ? axis->where : last.where,
             fmt::format("joint_axis: expected an axis across the direction of digit '{}', "
                         "found one along it; such a joint moves nothing",
                         node.key),
             axis ? "" : "without joint_axis it is [0, 1, 0]");
}

ValueFormat<DigitYaml> DigitFormat() {
  using D = DigitYaml;
  return StructFormat<D>("digit")
      .NamedByKey()
      .Required("sensor_set", &D::sensor_set, Identifier(),
                "The sensor set that feels its contacts.")
      .Required("base_m", &D::base_m, InHand(), "Its first joint, in H.")
      .Required("direction", &D::direction, Direction(),
                "Where it points with all joints at 0, in H.")
      .Optional("phalanges", &D::phalanges, ListOf(PhalanxFormat(), 1, 8),
                "From the palm to the tip.")
      .Optional("jaw", &D::jaw, JawFormat(), "One stiff part that slides, instead of phalanges.")
      .ExactlyOneOf({"phalanges", "jaw"})
      .Check(CheckLastJoint)
      .format();
}

ValueFormat<GripYaml> GripFormat() {
  using G = GripYaml;
  return StructFormat<G>("the grip")
      .Required("axis", &G::axis, Direction(),
                "In H: from the stiff side (the post) to the force-limited side.")
      .Required("post_m", &G::post_m, InHand(),
                "In H: where the object's face meets the post when closed.")
      .Optional("opening_m", &G::opening_m, Number(0.001, 0.5),
                "Widest object that fits along the axis.")
      .format();
}

StructFormat<GraspApproach> ApproachRecord(const std::string& noun) {
  using A = GraspApproach;
  return StructFormat<A>(noun)
      .Required("toward", &A::toward, Direction(),
                "In H: the direction of the last part of the motion.")
      .Required("palm_gap_m", &A::palm_gap_m, Number(-0.5, 0.5),
                "H's origin stays this far from the nearest face.")
      .Required("pads_m", &A::pads_m, Number(0, 0.5),
                "Wanted distance of the object's centre from H's origin.")
      .Required("floor_m", &A::floor_m, Number(-0.5, 0.5),
                "H's origin stays this high above what is below the object; negative: below it.");
}

/// The grip axis and the up direction must be perpendicular to the approach; otherwise no
/// orientation of the hand fits.
void CheckApproaches(const YamlNode& node, const StyleYaml& style, DiagnosticList& errors) {
  const auto check_toward = [&](const char* key, const GraspApproach& approach) {
    CheckAcross(*node.Find(key), "toward", approach.toward, "grip.axis", style.grip.axis, errors,
                "the hand arrives along toward and closes along grip.axis");
  };
  if (style.above) check_toward("above", *style.above);
  if (!style.side) return;
  check_toward("side", *style.side);
  CheckAcross(*node.Find("side"), "up", style.side->up, "toward", style.side->toward, errors,
              "the hand arrives horizontally, along toward, with up pointing up");
}

ValueFormat<StyleYaml> StyleFormat() {
  using S = StyleYaml;
  return StructFormat<S>("style")
      .NamedByKey()
      .Required("grip", &S::grip, GripFormat(), "Where the object is held.")
      .Optional("above", &S::above, ApproachRecord("the approach from above").format(),
                "How it comes from above.")
      .Optional("side", &S::side,
                ApproachRecord("the approach from the side")
                    .Required("up", &GraspApproach::up, Direction(),
                              "In H: the direction that is up in the world.")
                    .format(),
                "How it comes from the side.")
      .Required(
          "effort", &S::effort, PerDigitFormat(0, 10),
          "For each digit the share of its strength: one number for all joints, or one for each.")
      .Optional("frames_deg", &S::frames_deg, ListOf(WithPlace(PerDigitFormat(-180, 180)), 2, 16),
                "Joint angles from open to closed: for each digit one number for each joint.")
      .Optional("frames_m", &S::frames_m, ListOf(WithPlace(PerDigitFormat(-0.5, 0.5)), 2, 16),
                "Positions of the jaws from open to closed: for each jaw one number.")
      .Check([](const YamlNode& node, const S& style, DiagnosticList& errors) {
        if (style.above || style.side) return;
        errors.Add(node.key_where, "style '" + node.key + "' has no approach",
                   "give 'above', 'side' or both");
      })
      .Check(CheckApproaches)
      .format();
}

ValueFormat<std::vector<Named<StyleYaml>>> StylesFormat() {
  return MapOf(Identifier(), StyleFormat(), 1, 64);
}

ValueFormat<GainsYaml> GainsFormat() {
  return StructFormat<GainsYaml>("the gains")
      .Required("translation", &GainsYaml::translation,
                PidFormat("the translation gains", "Force",
                          {"proportional_n_per_m", "derivative_n_s_per_m", "integral_n_per_m_s",
                           "limit_n"}),
                "How the palm follows a position.")
      .Required("rotation", &GainsYaml::rotation,
                PidFormat("the rotation gains", "Torque",
                          {"proportional_nm_per_rad", "derivative_nm_s_per_rad",
                           "integral_nm_per_rad_s", "limit_nm"}),
                "How the palm follows an orientation.")
      .format();
}

ValueFormat<HandYaml> BuildHandFormat() {
  using H = HandYaml;
  return StructFormat<H>("the hand")
      .Required("hand", &H::name, Identifier(), "Its name: that of the file without '.hand.yaml'.")
      .Required("sensor_sets", &H::sensor_sets, DifferentNames(16), "Groups of contact sensors.")
      .Optional("ahead", &H::ahead, Direction(), "In H: where the region of interest lies.")
      .Optional("friction", &H::friction, Number(0, 5),
                "Friction of the skin; multiplied with the object's.")
      .Optional("spinning_friction", &H::spinning_friction, Number(0, 1),
                "Friction against spinning in place.")
      .Required("palm", &H::palm, PalmFormat(), "The palm, a box.")
      .Required("gains", &H::gains, GainsFormat(), "How the palm follows its tracked target.")
      .Optional("driver", &H::driver, DriverFormat(), "How the joints follow their targets.")
      .Required("digits", &H::digits, MapOf(Identifier(), DigitFormat(), 1, 16),
                "Fingers and thumb.")
      .Optional("grasps", &H::grasps, ListOf(WithPlace(Identifier()), 1, 16),
                "Grasp files in the same folder, by name, without '.grasps.yaml'.")
      .Optional("styles", &H::styles, StylesFormat(), "Grasps, by name.")
      .Check([](const YamlNode& node, const H& hand, DiagnosticList& errors) {
        if (hand.grasps.empty() && hand.styles.empty())
          errors.Add(node.where, "the hand has no grasp style", "give 'grasps', 'styles' or both");
      })
      .format();
}

ValueFormat<GraspsYaml> BuildGraspsFormat() {
  return StructFormat<GraspsYaml>("the grasps")
      .Required("grasps", &GraspsYaml::name, Identifier(),
                "Their name: that of the file without '.grasps.yaml'.")
      .Required("styles", &GraspsYaml::styles, StylesFormat(), "Grasps, by name.")
      .format();
}

ValueFormat<MirrorYaml> BuildMirrorFormat() {
  return StructFormat<MirrorYaml>("the hand")
      .Required("hand", &MirrorYaml::name, Identifier(),
                "Its name: that of the file without '.hand.yaml'.")
      .Required("mirror_of", &MirrorYaml::mirror_of, Identifier(),
                "The hand in the same folder that it mirrors.")
      .format();
}

}  // namespace

const ValueFormat<HandYaml>& HandFormat() {
  static const ValueFormat<HandYaml> format = BuildHandFormat();
  return format;
}

const ValueFormat<GraspsYaml>& GraspsFormat() {
  static const ValueFormat<GraspsYaml> format = BuildGraspsFormat();
  return format;
}

const ValueFormat<MirrorYaml>& MirrorFormat() {
  static const ValueFormat<MirrorYaml> format = BuildMirrorFormat();
  return format;
}

}  // namespace prehend::scenario
