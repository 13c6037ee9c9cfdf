// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/classes_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "harness/scenario/resolve/resolve.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/person/skeleton.h"
#include "physics/scene/geometry.h"
#include "physics/scene/planar.h"
#include "physics/scene/run_limits.h"

namespace prehend::scenario {
namespace {

/// The declaration of this class and its base class; null if there is none.
const Named<Located<std::string>>* BaseOf(const ScenarioYaml& entry,
                                          const std::string& class_name) {
  const auto found =
      std::ranges::find(entry.classes, class_name, &Named<Located<std::string>>::name);
  return found == entry.classes.end() ? nullptr : &*found;
}

bool IsItsOwnBase(const ScenarioYaml& entry, const Named<Located<std::string>>& kind) {
  const Named<Located<std::string>>* next = &kind;
  for (std::size_t steps = 0; next && steps <= entry.classes.size(); ++steps) {
    if (next->value.value == kind.name) return true;
    next = BaseOf(entry, next->value.value);
  }
  return false;
}

/// Osmium has 22.6, gold 19.3, styrofoam 0.02, the lightest packing foam 0.006.
constexpr double kMaxDensity_kg_per_l = 25, kMinDensity_kg_per_l = 0.005;
constexpr double kMaxLoose_m = 5, kMaxFixed_m = 60, kMin_m = 0.004;

double Litres(const physics::Body& body) {
  double volume_m3 = 0;
  for (const physics::PlacedShape& part : body.shapes) volume_m3 += VolumeOf(part.shape);
  return 1000 * volume_m3;
}

void JudgeMass(const Named<EntityYaml>& entity, const physics::Body& body, DiagnosticList& odd) {
  const auto& mass_kg = entity.value.mass_kg;
  const double volume_l = Litres(body);
  if (!mass_kg || body.grains || volume_l <= 0) return;
  const double density = mass_kg->value / volume_l;
  if (density <= kMaxDensity_kg_per_l && density >= kMinDensity_kg_per_l) return;
  odd.Add(
      mass_kg->where,
      fmt::format("mass_kg: {:.6g} kg are {} for '{}', whose shape has {:.3g} litres: {:.3g} kg "
                  "per litre",
                  mass_kg->value, density > 1 ? "much" : "little", entity.name, volume_l, density),
      density > 1 ? "water has 1, lead 11; a mass is in kg, a size in metres"
                  : "air has 0.001, foam 0.02; a mass is in kg, a size in metres");
}

void JudgeSize(const Named<EntityYaml>& entity, const physics::Body& body, DiagnosticList& odd) {
  if (body.abstract != physics::Abstract::kNot || body.grains) return;
  const double largest_m = 2 * BoundingBox(body).half_size_m.maxCoeff();
  const double most_m = body.fixed ? kMaxFixed_m : kMaxLoose_m;
  if (largest_m <= most_m && largest_m >= kMin_m) return;
  odd.Add(entity.name_where,
          largest_m > most_m
              ? fmt::format("'{}' is {:.3g} m long{}", entity.name, largest_m,
                            body.fixed ? "" : ", and it is not fixed")
              : fmt::format("'{}' is {:.3g} mm large, and contacts are exact to 1 mm", entity.name,
                            1000 * largest_m),
          "sizes are in metres: 0.1 is 10 cm");
}

/// What stands on an entity, and on that, kilograms.
double LoadOn(const ScenarioYaml& entry, const std::string& name) {
  double load_kg = 0;
  for (const auto& other : entry.entities)
    if (other.value.on && other.value.on->value == name && other.value.mass_kg)
      load_kg += other.value.mass_kg->value + LoadOn(entry, other.name);
  return load_kg;
}

void JudgeLoad(const ScenarioYaml& entry, const Named<EntityYaml>& entity, DiagnosticList& odd) {
  const auto& mass_kg = entity.value.mass_kg;
  if (!mass_kg || mass_kg->value <= 0 || entity.value.fixed) return;
  const double ratio = LoadOn(entry, entity.name) / mass_kg->value;
  if (ratio <= physics::kMaxMassRatio) return;
  odd.Add(mass_kg->where,
          fmt::format("mass_kg: {:.0f} times as much as '{}' weighs stands on it, and from {:.0f} "
                      "times on it may sink in",
                      ratio, entity.name, physics::kMaxMassRatio),
          "make it heavier, or what stands on it lighter; or raise 'world: {rate_hz: ..}'");
}

// Tested by tests/harness/scenario/resolve/validate_planar_test.cc

constexpr double kOnPlane_m = 1e-6;

/// The hint for a position or a displacement.
constexpr const char* kZeroY = "y must be 0 in a planar world";

const char* RemedyFor(physics::JointKind kind) {
  return kind == physics::JointKind::kSlider ? "axis: [x, 0, z]" : "hinge with axis: [0, 1, 0]";
}

/// Checks for each actor's steps whether they stay in the plane.
struct StepCheck {
  const physics::Scene& scene;
  const physics::Hand& hand;
  DiagnosticList& errors;

  void operator()(const ReachYaml& e) const {
    CheckWay("offset_m", e.offset_m.value.y(), e.offset_m.where);
    for (const physics::Body& body : scene.bodies) {
      if (e.point_m && body.name == e.reach.value)
        CheckWay("point_m", (body.X_WB * e.point_m->value).y(), e.point_m->where);
    }
  }
  void operator()(const MoveYaml& e) const {
    CheckWay("move_by_m", e.move_by_m.value.y(), e.move_by_m.where);
  }
  void operator()(const CarryYaml& e) const {
    CheckWay("carry_to_m", e.carry_to_m.value.y(), e.carry_to_m.where);
  }
  void operator()(const PosesYaml& e) const {
    for (const PoseYaml& pose : e.poses) {
      CheckWay("at_m", pose.at_m.y(), pose.where);
      const Eigen::Vector3d y = pose.q * Eigen::Vector3d::UnitY();
      if ((y - hand.X_WH.q * Eigen::Vector3d::UnitY()).norm() > kOnPlane_m)
        errors.Add(pose.where, "this pose turns the hand out of the plane y = 0",
                   "a hand turns about y only: rpy_deg: [0, pitch, 0]");
    }
  }
  void operator()(const RecordingYaml& e) const {
    errors.Add(e.recording.where, "a recorded motion does not stay in the plane y = 0",
               "write the motion as way-points: poses: [..]");
  }
  void operator()(const TurnHandYaml& e) const {
    if (e.turn_by_deg.value.x() != 0 || e.turn_by_deg.value.z() != 0)
      errors.Add(e.turn_by_deg.where, "turn_by_deg: this turns the hand out of the plane y = 0",
                 "a hand turns about y only: [0, degrees, 0]");
  }
  void operator()(const OrbitYaml& e) const {
    errors.Add(e.orbit.around.where, "orbit: this leaves the plane y = 0", kZeroY);
  }
  void operator()(const PressYaml& e) const { CheckWay("along", e.along.value.y(), e.along.where); }
  /// They keep to the plane by themselves; persons are refused as a whole.
  void operator()(const physics::OneOf<CloseYaml, OpenYaml, LiftYaml, PlaceYaml, RetreatYaml,
                                       FollowJointYaml, WaitYaml> auto&) const {}
  void operator()(const StepOfPerson auto&) const {}

 private:
  void CheckWay(const char* key, double y, const Where& where) const {
    if (std::abs(y) > kOnPlane_m)
      errors.Add(where, fmt::format("{}: this leaves the plane y = 0", key), kZeroY);
  }
};

void CheckBodies(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors) {
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const physics::Body& body = scene.bodies[i];
    const std::string why = physics::WhyNotPlanar(body);
    if (why.empty()) continue;
    const bool beside = !body.grains && std::abs(body.X_WB.p_m.y()) > kOnPlane_m;
    errors.Add(beside ? entry.entities[i].value.at_m.where : entry.entities[i].name_where,
               fmt::format("'{}' does not fit a planar world: {}", body.name, why),
               beside ? kZeroY
                      : "rotate it about y only, and keep its parts in the plane; see "
                        "docs/scenario-format.md");
  }
}

void CheckJoints(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors) {
  for (const physics::Joint& joint : scene.joints) {
    const std::string why = physics::WhyNotPlanar(joint);
    if (why.empty()) continue;
    const auto& named = At(entry.entities, joint.body);
    errors.Add(named.value.joint->where,
               fmt::format("the joint of '{}' does not fit a planar world: {}", named.name, why),
               RemedyFor(joint.kind));
  }
}

void CheckHand(const Named<HandActorYaml>& actor, const physics::Hand& hand,
               DiagnosticList& errors) {
  if (const std::string why = physics::WhyNotPlanar(hand.model); !why.empty())
    errors.Add(actor.value.hand.where,
               fmt::format("hand '{}' does not fit a planar world: {}", hand.model.name, why),
               "use the hand 'planar_gripper'");
  if (std::abs(hand.X_WH.p_m.y()) > kOnPlane_m)
    errors.Add(actor.value.at_m.where,
               fmt::format("at_m: '{}' starts outside the plane y = 0", actor.name), kZeroY);
  else if (!physics::KeepsPlane(hand.X_WH))
    errors.Add(actor.name_where, fmt::format("'{}' is turned out of the plane y = 0", actor.name),
               "a hand turns about y only: rpy_deg: [0, pitch, 0]");
}

/// 1 for "right_hand", -1 for "hands/human_left", 0 if it names no side, or both.
int SideOf(std::string_view name) {
  const auto has = [name = name.substr(name.rfind('/') + 1)](std::string_view side) {
    const auto is_letter = [&](std::size_t i) {
      return i < name.size() && std::isalpha(static_cast<unsigned char>(name[i]));
    };
    const std::size_t at = name.find(side);
    return at != name.npos && !is_letter(at - 1) && !is_letter(at + side.size());
  };
  return static_cast<int>(has("right")) - static_cast<int>(has("left"));
}

/// Hands that are those of the other side, by their names.
void JudgeSides(const ScenarioYaml& entry, DiagnosticList& odd) {
  std::map<std::string, int> sides;
  const auto judge = [&](std::string_view of, int side, const Located<std::string>& hand, int its) {
    if (side * its < 0)
      odd.Add(hand.where,
              fmt::format("{}: '{}' is a {} hand", of, hand.value, its < 0 ? "left" : "right"),
              "its thumb is on the other side; name what is meant");
  };
  for (const auto& hand : entry.hands) {
    const int side = SideOf(hand.value.hand.value), by_name = SideOf(hand.name);
    judge(hand.name, by_name, hand.value.hand, side);
    sides[hand.name] = side != 0 ? side : by_name;
  }
  for (const Named<PersonActorYaml>& person : entry.persons) {
    const PersonActorYaml& she = person.value;
    if (she.right_hand) judge("right_hand", 1, *she.right_hand, sides[she.right_hand->value]);
    if (she.left_hand) judge("left_hand", -1, *she.left_hand, sides[she.left_hand->value]);
  }
}

}  // namespace

std::optional<std::size_t> FindEntity(const ScenarioYaml& entry, const Located<std::string>& name,
                                      std::string_view key, DiagnosticList& errors) {
  std::vector<std::string> names;
  for (const auto& entity : entry.entities) names.push_back(entity.name);
  if (std::ranges::count(names, name.value) > 0) return errors.Find(name, key, names);
  const auto is_no_thing = [&](const std::string& what) {
    errors.Add(name.where, fmt::format("{}: '{}' is {}, not a thing", key, name.value, what),
               "name one of the 'entities'");
    return std::nullopt;
  };
  if (std::ranges::any_of(entry.hands, [&](const auto& hand) { return hand.name == name.value; }))
    return is_no_thing("a hand");
  for (const Named<PersonActorYaml>& person : entry.persons) {
    if (person.name == name.value) return is_no_thing("a person");
    const bool has_body = person.value.person == PersonKind::kBody;
    for (const physics::Body& part : physics::PartsOf({.name = person.name, .has_body = has_body}))
      if (part.name == name.value) return is_no_thing("a part of '" + person.name + "'");
  }
  return errors.Find(name, key, names);
}

void ValidateClasses(const ScenarioYaml& entry, DiagnosticList& errors) {
  std::set<std::string> used;  // classes that an entity or another class has
  for (const auto& entity : entry.entities) used.insert(entity.value.class_name.value);
  for (const auto& kind : entry.classes) used.insert(kind.value.value);
  for (const auto& kind : entry.classes) {
    for (const auto& [name, where] :
         {std::pair{kind.name, kind.name_where}, std::pair{kind.value.value, kind.value.where}}) {
      if (grammar::IsRootClass(name))
        errors.Add(where, fmt::format("classes: '{}' is a built-in class", name),
                   "declare your own classes, for example 'Cup: Container'");
    }
    if (!used.contains(kind.name))
      errors.AddUnknownName(kind.name_where,
                            fmt::format("classes: no entity has the class '{}'", kind.name),
                            kind.name, {used.begin(), used.end()});
    if (IsItsOwnBase(entry, kind))
      errors.Add(kind.value.where,
                 fmt::format("classes: '{}' is, directly or not, its own base class", kind.name));
  }
}

grammar::Diagnostics ImplausibleSizes(const ScenarioYaml& entry, const physics::Scene& scene,
                                      const YamlDocument& document) {
  DiagnosticList odd(document);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    JudgeMass(entry.entities[i], scene.bodies[i], odd);
    JudgeSize(entry.entities[i], scene.bodies[i], odd);
    JudgeLoad(entry, entry.entities[i], odd);
  }
  JudgeSides(entry, odd);
  grammar::Diagnostics warnings = odd.Sorted();
  for (grammar::Diagnostic& warning : warnings) warning.is_warning = true;
  return warnings;
}

void ValidatePlanar(const ScenarioYaml& entry, const physics::Scene& scene,
                    DiagnosticList& errors) {
  CheckBodies(entry, scene, errors);
  CheckJoints(entry, scene, errors);
  std::map<std::string, const physics::Hand*> hands;
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    CheckHand(entry.hands[i], scene.hands[i], errors);
    hands[entry.hands[i].name] = &scene.hands[i];
  }
  for (const Named<PersonActorYaml>& person : entry.persons)
    errors.Add(person.name_where,
               fmt::format("'{}' is a person; a planar world has no persons", person.name),
               "remove 'planar: true' and use engine: bullet");
  for (const StageYaml& stage : entry.script) {
    for (const Named<StepYaml>& step : stage) {
      const auto hand = hands.find(step.name);
      if (hand != hands.end()) std::visit(StepCheck{scene, *hand->second, errors}, step.value);
    }
  }
}

}  // namespace prehend::scenario
