// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/scenario_fields_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {
namespace {

using physics::JointKind;

constexpr std::size_t kMaxParts = 256;
constexpr double kMaxResistance = 1e5;
constexpr double kMaxSlide_m = 10;
constexpr double kMaxTurn_deg = 170;  // at half a turn the two directions are the same

/// A joint's range is [min, max] and contains 0, the position as placed.
void CheckRange(const YamlNode&, const JointYaml& joint, DiagnosticList& errors) {
  const Eigen::Vector2d& range = joint.range.value;
  if (range[0] <= 0 && range[1] >= 0 && range[0] < range[1]) return;
  errors.Add(
      joint.range.where,
      fmt::format(
          "expected a range [min, max] that contains 0, the position as placed, found [{}, {}]",
          range[0], range[1]));
}

StructFormat<JointYaml> JointRecord(const std::string& noun) {
  using J = JointYaml;
  return StructFormat<J>(noun).Required("to", &J::to, Identifier(),
                                        "The entity that it is attached to.");
}

ValueFormat<JointYaml> OfKind(JointKind kind, const char* key, const StructFormat<JointYaml>& as) {
  return AsAlternative<JointYaml>(as.format(), [=](JointYaml joint) {
    joint.kind = kind;
    joint.key = key;
    return joint;
  });
}

ValueFormat<JointYaml> GlueFormat() {
  return AsAlternative<JointYaml>(WithPlace(Identifier()), [](Located<std::string> to) {
    return JointYaml{{}, "fixed_to", std::move(to)};
  });
}

/// A compound that is described as a whole.
template <class Compound>
ValueFormat<std::vector<physics::PlacedShape>> CompoundOf(const ValueFormat<Compound>& format) {
  return AsAlternative<std::vector<physics::PlacedShape>>(
      format, [](const Compound& compound) { return physics::ShapesOf(compound); });
}

ValueFormat<Eigen::Vector3d> Axis() { return Vector<3>(-1, 1); }

void CheckAxis(const YamlNode& node, const JointYaml& joint, DiagnosticList& errors) {
  if (joint.axis_W.norm() > 1e-6) return;
  errors.Add(node.Find("axis")->where, "axis: expected a direction other than [0, 0, 0]");
}

/// A rest position without a spring has no effect. A spring of stiffness 0 is allowed.
std::function<void(const YamlNode&, const JointYaml&, DiagnosticList&)> SpringPullsTo(
    const char* rest, const char* spring) {
  return [rest, spring](const YamlNode& node, const JointYaml&, DiagnosticList& errors) {
    const YamlNode* given = node.Find(rest);
    if (!given || node.Find(spring)) return;
    errors.Add(given->key_where, fmt::format("{}: there is no spring", rest),
               fmt::format("add {}", spring));
  };
}

ValueFormat<JointYaml> SliderFormat() {
  using J = JointYaml;
  return OfKind(JointKind::kSlider, "slider",
                JointRecord("a slider")
                    .Required("axis", &J::axis_W, Axis(),
                              "The direction in which it opens, in the world, as placed.")
                    .Required("range_m", &J::range, Vector<2>(-kMaxSlide_m, kMaxSlide_m),
                              "Range of motion relative to where it is placed: [min, max].")
                    .Optional("friction_n", &J::friction, Number(0, kMaxResistance),
                              "Largest force that it holds against.")
                    .Optional("damping_n_s_per_m", &J::damping, Number(0, kMaxResistance),
                              "Damping: force per speed.")
                    .Optional("spring_n_per_m", &J::spring, Number(0, kMaxResistance),
                              "Force that pulls it to rest_m.")
                    .Optional("rest_m", &J::rest, Number(-kMaxSlide_m, kMaxSlide_m),
                              "Where its spring exerts no force.")
                    .Check(CheckAxis)
                    .Check(CheckRange)
                    .Check(SpringPullsTo("rest_m", "spring_n_per_m")));
}

ValueFormat<JointYaml> HingeFormat() {
  using J = JointYaml;
  return OfKind(
      JointKind::kHinge, "hinge",
      JointRecord("a hinge")
          .Required("at_m", &J::pivot_W_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                    "A point of its axis, in the world, as placed.")
          .Required("axis", &J::axis_W, Axis(),
                    "The direction of its axis; positive angles follow the right-hand rule.")
          .Required("range_deg", &J::range, Vector<2>(-kMaxTurn_deg, kMaxTurn_deg),
                    "Range of rotation relative to where it is placed: [min, max].")
          .Optional("friction_nm", &J::friction, Number(0, kMaxResistance),
                    "Largest torque that it holds against.")
          .Optional("damping_nm_s_per_rad", &J::damping, Number(0, kMaxResistance),
                    "Damping: torque per angular speed.")
          .Optional("spring_nm_per_rad", &J::spring, Number(0, kMaxResistance),
                    "Torque that turns it to rest_deg.")
          .Optional("rest_deg", &J::rest, Number(-kMaxTurn_deg, kMaxTurn_deg),
                    "Where its spring exerts no force.")
          .Check(CheckAxis)
          .Check(CheckRange)
          .Check(SpringPullsTo("rest_deg", "spring_nm_per_rad")));
}

ValueFormat<JointYaml> BallJointFormat() {
  using J = JointYaml;
  return OfKind(JointKind::kBall, "ball_joint",
                JointRecord("a ball joint")
                    .Required("at_m", &J::pivot_W_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                              "The point about which it rotates, in the world, as placed."));
}

/// A word is looked up; its hint is the nearest word.
ValueFormat<std::string> ColorFormat() {
  return ValueFormat<std::string>(
      []() -> Json {
        return {
            {"anyOf",
             {{{"enum", ColorWords()}}, {{"type", "string"}, {"pattern", "^#[0-9A-Fa-f]{6}$"}}}}};
      },
      [](const YamlNode& node, DiagnosticList& errors, std::string& color) {
        color = node.text;
        if (node.kind == YamlNode::Kind::kNull) {
          errors.Add(node.where, "color: expected a word or \"#RRGGBB\" in quotes, found nothing",
                     "'#' begins a comment in YAML: a colour goes in quotes, color: \"#ff0000\"");
          return false;
        }
        if (node.kind == YamlNode::Kind::kScalar && ColorOfText(color)) return true;
        const std::string found = node.kind == YamlNode::Kind::kScalar ? color : "a list or a map";
        errors.AddUnknownName(
            node.where,
            fmt::format("color: expected a word or \"#RRGGBB\" in quotes, found '{}'", found),
            color, ColorWords());
        return false;
      });
}

void CheckClass(const EntityYaml& entity, DiagnosticList& errors) {
  if (!grammar::IsRootClass(entity.class_name.value)) return;
  errors.Add(
      entity.class_name.where,
      "class: '" + entity.class_name.value + "' is a built-in class; entities get it automatically",
      "name what the entity is, for example Cup");
}

/// An entity on a joint can move, and one that is fixed to another has the surface of that one.
void CheckJoint(const YamlNode& node, const EntityYaml& entity, DiagnosticList& errors) {
  const std::string title = "entity '" + node.key + "'";
  for (const char* key : {"fixed_to", "slider", "hinge", "ball_joint"}) {
    const YamlNode* joint = node.Find(key);
    if (joint && entity.fixed) {
      errors.Add(joint->key_where, title + " is fixed: it cannot have a joint",
                 "remove fixed or " + std::string(key));
    }
  }
  const Located<std::string>* const whole = FixedTo(entity);
  if (!whole) return;
  for (const char* key : {"friction", "rolling_friction", "restitution", "linear_damping_per_s",
                          "angular_damping_per_s"}) {
    const YamlNode* surface = node.Find(key);
    if (surface) {
      errors.Add(
          surface->key_where,
          std::string(key) + ": an entity that is fixed to another has the surface of that one",
          "give it to '" + whole->value + "'");
    }
  }
}

/// Only grains are placed in a vessel. They are many, so the keys of a single body do not apply.
void CheckGrains(const YamlNode& node, const EntityYaml& entity, DiagnosticList& errors) {
  const std::string title = "entity '" + node.key + "'";
  if (entity.in && !entity.grains)
    errors.Add(entity.in->where, "in: only grains can be put into a vessel",
               "for a thing: 'on', with at_m: [x, y]");
  if (!entity.grains) return;
  if (!entity.in)
    errors.Add(node.key_where, title + " is grains: it needs the key 'in'",
               "the vessel that they fill");
  for (const char* key : {"fixed", "part_of", "fixed_to", "slider", "hinge", "ball_joint", "on",
                          "at_m", "rpy_deg", "yaw_deg"}) {
    if (const YamlNode* given = node.Find(key))
      errors.Add(
          given->key_where,
          std::string(key) + ": this key does not apply to grains; they lie loose in their vessel");
  }
}

void CheckEntity(const YamlNode& node, const EntityYaml& entity, DiagnosticList& errors) {
  CheckClass(entity, errors);
  CheckJoint(node, entity, errors);
  CheckGrains(node, entity, errors);
  CheckAbstract(node, entity, errors);
  const bool abstract = AbstractOf(entity) != physics::Abstract::kNot;
  const std::string title = "entity '" + node.key + "'";
  if (entity.fixed && entity.mass_kg) {
    errors.Add(entity.mass_kg->where, title + " is fixed: it cannot have a mass",
               "remove fixed or mass_kg");
  }
  if (!entity.fixed && !entity.mass_kg && !abstract) {
    errors.Add(node.key_where, title + " can move: it needs the key 'mass_kg'", "or 'fixed: true'");
  }
  const std::size_t wanted = entity.on && !abstract ? 2 : 3;
  if (!entity.in && !entity.grains && entity.at_m.value.size() != wanted) {
    errors.Add(entity.at_m.where,
               wanted == 2 ? "at_m: with 'on' expected [x, y], found 3 numbers"
                           : "at_m: expected [x, y, z], the centre, found 2 numbers",
               wanted == 2 ? "z follows from the top of the support"
               : abstract  ? ""
                           : "or [x, y] together with 'on: SUPPORT'");
  }
}

ValueFormat<PidOverride> PidFormat(const std::string& noun, const std::string (&keys)[4]) {
  return StructFormat<PidOverride>(noun)
      .Optional(keys[0], &PidOverride::proportional, Number(0, 1e6), "Force or torque per error.")
      .Optional(keys[1], &PidOverride::derivative, Number(0, 1e5),
                "Force or torque per speed of the error.")
      .Optional(keys[2], &PidOverride::integral, Number(0, 1e6),
                "Force or torque per error and second.")
      .Optional(keys[3], &PidOverride::limit, Number(0, 1e4), "Largest force or torque.")
      .format();
}

ValueFormat<GainsOverride> GainsOverrideFormat() {
  return StructFormat<GainsOverride>("the gains")
      .Optional("translation", &GainsOverride::translation,
                PidFormat("the translation gains", {"proportional_n_per_m", "derivative_n_s_per_m",
                                                    "integral_n_per_m_s", "limit_n"}),
                "How the palm follows the position of its tracked target.")
      .Optional(
          "rotation", &GainsOverride::rotation,
          PidFormat("the rotation gains", {"proportional_nm_per_rad", "derivative_nm_s_per_rad",
                                           "integral_nm_per_rad_s", "limit_nm"}),
          "How the palm follows the orientation of its tracked target.")
      .format();
}

/// Reports a share of lost samples that losses of the given mean length cannot reach.
void CheckLosses(const YamlNode& node, const physics::TrackerSettings& t, DiagnosticList& errors) {
  if (t.dropped_run_s <= 0) return;
  const double run_samples = std::max(1.0, t.dropped_run_s * t.tracker_hz);
  const double min_samples = t.dropped_share / (1 - t.dropped_share);
  if (run_samples >= min_samples) return;
  errors.Add(node.Find("dropped_run_s")->where,
             fmt::format("dropped_run_s: a share of {} needs losses of at least {:.3f} s",
                         t.dropped_share, min_samples / t.tracker_hz));
}

ValueFormat<physics::TrackerSettings> TrackingFormat() {
  using T = physics::TrackerSettings;
  return StructFormat<T>("the tracking")
      .Optional("tracker_hz", &T::tracker_hz, Integer<int>(1, 4800),
                "Samples of the tracker per second, at most rate_hz.")
      .Optional("latency_s", &T::latency_s, Number(0, 2), "Delay from a sample to its arrival.")
      .Optional("jitter_mm", &T::jitter_mm, Number(0, 100),
                "Standard deviation of each coordinate of a sample.")
      .Optional("jitter_deg", &T::jitter_deg, Number(0, 45),
                "Standard deviation of each component of a sample's rotation vector.")
      .Optional("dropped_share", &T::dropped_share, Number(0, 0.95),
                "Share of the samples that are lost.")
      .Optional("dropped_run_s", &T::dropped_run_s, Number(0, 10),
                "Mean length of a loss; 0: losses are independent.")
      .Optional("tremor_mm", &T::tremor_mm, Number(0, 50), "Amplitude of the tremor on each axis.")
      .Optional("tremor_hz", &T::tremor_hz, Number(0.1, 60), "Frequency of the tremor.")
      .Check(CheckLosses)
      .format();
}

/// What hands and persons have in common.
ValueFormat<Eigen::Vector3d> Position() { return Vector<3>(-kMaxDistance_m, kMaxDistance_m); }

ValueFormat<HandActorYaml> HandActorFormat() {
  using A = HandActorYaml;
  return StructFormat<A>("actor")
      .NamedByKey()
      .Required("hand", &A::hand,
                Word("[A-Za-z0-9_./-]+", "a hand like 'human_right', or a .hand.yaml file", 255),
                "A hand of the library, or a .hand.yaml file beside the scenario.")
      .Optional(
          "grasps", &A::grasps,
          ListOf(WithPlace(Word("[A-Za-z0-9_./-]+\\.grasps\\.yaml", "a .grasps.yaml file", 255)), 1,
                 16),
          "Files beside the scenario with more grasp styles for the hand; a style replaces an "
          "earlier one of the same name.")
      .Required("at_m", &A::at_m, Position(),
                "World coordinates of the palm's centre at the start.")
      .Optional("rpy_deg", &A::rpy_deg, Vector<3>(-360, 360),
                "Roll, pitch and yaw in degrees: turns about the world's x, then y, then z axis. "
                "At 0 the fingers point along x and the palm faces down.")
      .Optional("gains", &A::gains, GainsOverrideFormat(),
                "Replaces gains of the hand file; gains not given here stay.")
      .Optional("tracking", &A::tracking, TrackingFormat(),
                "An imperfect tracker between the wanted pose and the tracked target.")
      .format();
}

ValueFormat<PersonActorYaml> PersonActorFormat() {
  using P = PersonActorYaml;
  return StructFormat<P>("actor")
      .NamedByKey()
      .Required("person", &P::person,
                Choice<PersonKind>({{"head", PersonKind::kHead}, {"body", PersonKind::kBody}}),
                "How much of the person is simulated: a head that looks, or a whole body.")
      .Required("at_m", &P::at_m, Position(),
                "World coordinates of the point between the feet, on the floor.")
      .Optional("yaw_deg", &P::yaw_deg, Number(-360, 360), "The direction she faces; 0 is along x.")
      .Optional("height_m", &P::height_m, Number(1, 2.3), "Height from the floor to the crown.")
      .Optional("eyes", &P::eyes, EyesFormat(),
                "Where she looks when no step says so: where her hands go next, or ahead.")
      .Optional("right_hand", &P::right_hand, Identifier(), "The actor that is her right hand.")
      .Optional("left_hand", &P::left_hand, Identifier(), "The actor that is her left hand.")
      .format();
}

}  // namespace

ValueFormat<EntityYaml> EntityFormat() {
  using E = EntityYaml;
  return StructFormat<E>("entity")
      .NamedByKey()
      .Optional("class", &E::class_name,
                Word("[A-Z][A-Za-z0-9]*", "a class name like 'MilkCarton'"),
                "What it is; grammars select roles by class.")
      .Optional("part_of", &E::part_of, Identifier(),
                "The entity that it is a part of, as a handle is of a door.")
      .Optional("color", &E::color, ColorFormat(),
                "How pictures show it: a word like blue, or '#RRGGBB'.")
      .Optional("box", &E::shape, AsAlternative<physics::Shape>(BoxFormat()), "Its shape: a box.")
      .Optional("sphere", &E::shape, AsAlternative<physics::Shape>(SphereFormat()),
                "Its shape: a sphere.")
      .Optional("cylinder", &E::shape, AsAlternative<physics::Shape>(CylinderFormat()),
                "Its shape: a cylinder, axis along z.")
      .Optional("capsule", &E::shape, AsAlternative<physics::Shape>(CapsuleFormat()),
                "Its shape: a cylinder with half spheres at its ends, axis along z.")
      .Optional("hull", &E::shape, AsAlternative<physics::Shape>(HullFormat()),
                "Its shape: a solid of flat faces, by its corners.")
      .Optional("tray", &E::parts, CompoundOf(TrayFormat()), "Its shape: a flat box without a lid.")
      .Optional("mug", &E::parts, CompoundOf(MugFormat()),
                "Its shape: a round cup, perhaps with a handle.")
      .Optional("bowl", &E::parts, CompoundOf(BowlFormat()), "Its shape: a round dish.")
      .Optional("shelf", &E::parts, CompoundOf(ShelfFormat()),
                "Its shape: boards between two sides, as a shelf or a cupboard.")
      .Optional("parts", &E::parts, ListOf(PartFormat(), 1, kMaxParts),
                "Its shape: several shapes, rigidly together.")
      .Optional("grains", &E::grains, GrainsFormat(),
                "Many loose balls in a vessel, seen as one entity.")
      .Optional("region", &E::region, RegionFormat(), "Abstract: a region, a box or a ball.")
      .Optional("gaze_target", &E::gaze_target, GazeTargetFormat(),
                "Abstract: a point that eyes can look at.")
      .Optional("camera", &E::camera, CameraFormat(), "Abstract: a viewpoint for pictures.")
      .Optional("light", &E::light, LightFormat(), "Abstract: a light source for pictures.")
      .Optional("fixed", &E::fixed, Flag(), "True: never moves and has no mass.")
      .Optional("mass_kg", &E::mass_kg, Number(0.001, 1000),
                "Mass; required unless fixed or abstract. Of grains: of all together.")
      .Optional("friction", &E::friction, Number(0, 5),
                "Coulomb friction; the values of two touching bodies are multiplied. Default 0.8.")
      .Optional("rolling_friction", &E::rolling_friction, Number(0, 1),
                "Slows rolling; default 0.006 for a sphere and for grains, 0 for the others.")
      .Optional("restitution", &E::restitution, Number(0, 1),
                "0: does not bounce. 1: bounces without loss.")
      .Optional("linear_damping_per_s", &E::linear_damping_per_s, Number(0, 36),
                "Rate at which its speed decays.")
      .Optional("angular_damping_per_s", &E::angular_damping_per_s, Number(0, 36),
                "Rate at which its turning decays.")
      .Optional("on", &E::on, Identifier(), "The entity it stands on; then at_m is [x, y].")
      .Optional("in", &E::in, Identifier(),
                "Of grains: the vessel that they fill; instead of at_m.")
      .Optional("fixed_to", &E::joint, GlueFormat(),
                "The entity that it is glued to: both move as one.")
      .Optional("slider", &E::joint, SliderFormat(),
                "It slides on another entity, as a drawer does.")
      .Optional("hinge", &E::joint, HingeFormat(), "It turns on another entity, as a door does.")
      .Optional("ball_joint", &E::joint, BallJointFormat(),
                "It rotates freely about a point of another entity.")
      .Optional("at_m", &E::at_m, ListOf(Number(-kMaxDistance_m, kMaxDistance_m), 2, 3),
                "World coordinates of its centre: [x, y, z], or [x, y] with 'on'.")
      .Optional("rpy_deg", &E::q,
                AsAlternative<Eigen::Quaterniond>(Vector<3>(-360, 360), physics::FromRollPitchYaw),
                "Roll, pitch and yaw in degrees: turns about the world's x, then y, then z axis.")
      .Optional(
          "yaw_deg", &E::q,
          AsAlternative<Eigen::Quaterniond>(Number(-360, 360),
                                            [](double yaw_deg) {
                                              return physics::FromRollPitchYaw({0, 0, yaw_deg});
                                            }),
          "Turn about the vertical, degrees.")
      .ExactlyOneOf({"box", "sphere", "cylinder", "capsule", "hull", "tray", "mug", "bowl", "shelf",
                     "parts", "grains", "region", "gaze_target", "camera", "light"})
      .ExactlyOneOf({"at_m", "in"})
      .AtMostOneOf({"rpy_deg", "yaw_deg"})
      .AtMostOneOf({"fixed_to", "slider", "hinge", "ball_joint"})
      .Check(CheckEntity)
      .format();
}

ValueFormat<physics::Eyes> EyesFormat() {
  return Choice<physics::Eyes>({{"lead", physics::Eyes::kLead}, {"ahead", physics::Eyes::kAhead}});
}

ValueFormat<ActorYaml> ActorFormat() {
  return ByKey<ActorYaml>("an actor", {{"hand", AsAlternative<ActorYaml>(HandActorFormat())},
                                       {"person", AsAlternative<ActorYaml>(PersonActorFormat())}});
}

void SortActors(ScenarioYaml& entry) {
  for (const Named<ActorYaml>& actor : entry.actors) {
    if (const auto* hand = std::get_if<HandActorYaml>(&actor.value))
      entry.hands.push_back({actor.name, actor.name_where, *hand});
    if (const auto* person = std::get_if<PersonActorYaml>(&actor.value))
      entry.persons.push_back({actor.name, actor.name_where, *person});
  }
}

}  // namespace prehend::scenario
