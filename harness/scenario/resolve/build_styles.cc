// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/read_hand_model_test.cc and
// tests/harness/scenario/format/abstract_entities_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/scenario/resolve/resolve.h"
#include "physics/person/skeleton.h"

namespace prehend::scenario {
namespace {

bool HasJaw(const DigitYaml& digit) { return digit.jaw.has_value(); }
bool HasPhalanges(const DigitYaml& digit) { return !HasJaw(digit); }
std::size_t JointsOf(const DigitYaml& digit) { return HasJaw(digit) ? 1 : digit.phalanges.size(); }

class StyleBuilder {
 public:
  StyleBuilder(const std::vector<Named<DigitYaml>>& digits, DiagnosticList& errors)
      : digits_(digits), errors_(errors) {}

  physics::GraspStyle BuildStyle(const Named<StyleYaml>& style);

 private:
  using Concerned = bool (*)(const DigitYaml&);
  std::vector<std::vector<double>> JointNumbers(const Located<PerDigit>& numbers,
                                                bool one_is_enough, Concerned concerned);
  std::vector<std::vector<double>> FramesOf(const Named<StyleYaml>& style);
  /// Reports joint targets outside the joint's limits.
  void CheckRanges(const Located<PerDigit>& frame, const char* unit);
  /// False after an error: the hand has no such digit.
  bool CheckDigitNames(const Located<PerDigit>& numbers);

  const std::vector<Named<DigitYaml>>& digits_;
  DiagnosticList& errors_;
};

bool StyleBuilder::CheckDigitNames(const Located<PerDigit>& numbers) {
  std::vector<std::string> names;
  for (const auto& digit : digits_) names.push_back(digit.name);
  bool good = true;
  for (const auto& given : numbers.value) {
    if (std::find(names.begin(), names.end(), given.name) != names.end()) continue;
    good = false;
    errors_.AddUnknownName(given.name_where, fmt::format("the hand has no digit '{}'", given.name),
                           given.name, names);
  }
  return good;
}

/// One number per joint of every concerned digit; the others stay empty.
std::vector<std::vector<double>> StyleBuilder::JointNumbers(const Located<PerDigit>& numbers,
                                                            bool one_is_enough,
                                                            Concerned concerned) {
  const bool names_are_right = CheckDigitNames(numbers);
  std::vector<std::vector<double>> all(digits_.size());
  for (std::size_t i = 0; i < digits_.size(); ++i) {
    const auto& digit = digits_[i];
    const auto given =
        std::find_if(numbers.value.begin(), numbers.value.end(),
                     [&](const auto& candidate) { return candidate.name == digit.name; });
    if (!concerned(digit.value)) {
      if (given != numbers.value.end())
        errors_.Add(
            given->name_where,
            fmt::format("{}: phalanges belong in frames_deg, jaws in frames_m", digit.name));
      continue;
    }
    if (given == numbers.value.end()) {
      if (names_are_right)
        errors_.Add(numbers.where, fmt::format("digit '{}' is missing", digit.name));
      continue;
    }
    const std::size_t joints = JointsOf(digit.value);
    std::vector<double> values;
    for (const Located<double>& number : given->value.value) values.push_back(number.value);
    if (values.size() == 1 && one_is_enough) values.resize(joints, values.front());
    if (values.size() != joints) {
      errors_.Add(given->value.where,
                  fmt::format("{}: expected {} {}, one for each joint, found {}", digit.name,
                              joints, joints == 1 ? "number" : "numbers", values.size()));
    }
    values.resize(joints);
    all[i] = std::move(values);
  }
  return all;
}

void StyleBuilder::CheckRanges(const Located<PerDigit>& frame, const char* unit) {
  for (const auto& [name, name_where, targets] : frame.value) {
    const auto digit = std::ranges::find(digits_, name, &Named<DigitYaml>::name);
    if (digit == digits_.end() || targets.value.size() != JointsOf(digit->value)) continue;
    for (std::size_t i = 0; i < targets.value.size(); ++i) {
      const bool is_jaw = HasJaw(digit->value);
      const LinkYaml& link = is_jaw ? *digit->value.jaw : digit->value.phalanges[i];
      const Eigen::Vector2d& range = link.range.value;
      const double target = targets.value[i].value;
      if (target >= range[0] && target <= range[1]) continue;
      const std::string part = is_jaw ? name : name + "_" + link.called.value;
      errors_.Add(targets.value[i].where,
                  fmt::format("{}: expected {} to {} {}, the range of the joint of '{}', found {}",
                              name, range[0], range[1], unit, part, target));
    }
  }
}

/// From open to closed, one number per link; empty after an error.
std::vector<std::vector<double>> StyleBuilder::FramesOf(const Named<StyleYaml>& style) {
  const auto& angles = style.value.frames_deg;
  const auto& ways = style.value.frames_m;
  const auto any = [&](Concerned of) {
    return std::any_of(digits_.begin(), digits_.end(),
                       [&](const auto& digit) { return of(digit.value); });
  };
  const auto missing = [&](const char* key) {
    errors_.Add(style.name_where, fmt::format("style '{}' has no '{}'", style.name, key));
  };
  if (angles.empty() && any(HasPhalanges)) missing("frames_deg");
  if (ways.empty() && any(HasJaw)) missing("frames_m");
  if (!angles.empty() && !ways.empty() && angles.size() != ways.size()) {
    errors_.Add(ways.front().where, fmt::format("frames_m: {} frames, but frames_deg has {}",
                                                ways.size(), angles.size()));
    return {};
  }
  std::vector<std::vector<double>> frames(std::max(angles.size(), ways.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::vector<std::vector<double>> turned(digits_.size()), slid = turned;
    if (!angles.empty()) {
      turned = JointNumbers(angles[i], false, HasPhalanges);
      CheckRanges(angles[i], "degrees");
    }
    if (!ways.empty()) {
      slid = JointNumbers(ways[i], false, HasJaw);
      CheckRanges(ways[i], "m");
    }
    for (std::size_t k = 0; k < turned.size(); ++k) {
      for (const double angle : turned[k]) frames[i].push_back(angle * physics::kRadPerDeg);
      frames[i].insert(frames[i].end(), slid[k].begin(), slid[k].end());
    }
  }
  return frames;
}

physics::GraspStyle StyleBuilder::BuildStyle(const Named<StyleYaml>& style) {
  physics::GraspStyle built{.name = style.name,
                            .frames = FramesOf(style),
                            .grip_axis = style.value.grip.axis,
                            .post_m = style.value.grip.post_m,
                            .opening_m = style.value.grip.opening_m,
                            .above = style.value.above,
                            .side = style.value.side};
  const auto all = [](const DigitYaml&) { return true; };
  for (const auto& effort : JointNumbers(style.value.effort, true, all))
    built.effort.insert(built.effort.end(), effort.begin(), effort.end());
  return built;
}

/// A camera or a light is a point; bodies have shapes.
constexpr double kPointRadius_m = 0.005;

/// An orientation with x along `way` and z as close to up as possible. A camera that looks straight
/// up or down has its top towards the world's y.
Eigen::Quaterniond LookingAlong(const Eigen::Vector3d& way) {
  constexpr double kVertical = 1e-6;
  Eigen::Matrix3d R;
  R.col(0) = way.normalized();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(R.col(0));
  R.col(1) =
      left.norm() > kVertical ? left.normalized() : Eigen::Vector3d(-Eigen::Vector3d::UnitX());
  R.col(2) = R.col(0).cross(R.col(1));
  if (left.norm() <= kVertical) {
    R.col(2) = Eigen::Vector3d::UnitY();
    R.col(1) = R.col(2).cross(R.col(0));
  }
  return Eigen::Quaterniond(R);
}

// Tested by tests/harness/scenario/resolve/build_persons_test.cc
// Tested by tests/harness/scenario/resolve/build_persons_test.cc

struct PersonStepMaker {
  const Named<StepYaml>& step;
  const physics::Person& person;
  const physics::Scene& scene;
  DiagnosticList& errors;

  physics::PersonStep operator()(const WaitYaml& e) const {
    return {0, physics::WaitStep{}, e.wait_s};
  }
  physics::PersonStep operator()(const LookAtYaml& e) const {
    CheckSeen(e.look_at);
    return {0, physics::LookAtStep{e.look_at.value}, e.over_s};
  }
  physics::PersonStep operator()(const LookAtPointYaml& e) const {
    return {0, physics::LookAtStep{e.look_at_m}, e.over_s};
  }
  physics::PersonStep operator()(const EyesYaml& e) const {
    return {0, physics::EyesStep{e.eyes}, e.over_s};
  }
  physics::PersonStep operator()(const WalkYaml& e) const {
    return {0, physics::WalkStep{e.walk_to_m, e.max_force_n}, e.over_s};
  }
  physics::PersonStep operator()(const TurnYaml& e) const {
    return {0, physics::TurnStep{e.turn_to_deg * physics::kRadPerDeg}, e.over_s};
  }
  physics::PersonStep operator()(const LeanYaml& e) const {
    return {0, physics::LeanStep{e.lean_deg * physics::kRadPerDeg}, e.over_s};
  }
  physics::PersonStep operator()(const SwayYaml& e) const {
    CheckBody(e.sway_by_m.where, "sway_by_m");
    return {0, physics::SwayStep{e.sway_by_m.value}, e.over_s};
  }
  physics::PersonStep operator()(const MoveLimbYaml& e) const {
    CheckFree(e.move_limb);
    return {0, physics::MoveLimbStep{e.move_limb.value, e.to_m, e.max_force_n}, e.over_s};
  }
  physics::PersonStep operator()(const RecordingYaml& e) const {
    if (!e.style.value.empty())
      errors.Add(e.style.where, "style: a person's recording moves the head, not a hand");
    if (!e.postures.empty()) {
      CheckBody(e.recording.where, "recording");
      return {0, physics::BodyPosesStep{e.postures}, e.postures.back().t_s};
    }
    const double over_s = e.poses.empty() ? 0 : e.poses.back().t_s;
    return {0, physics::HeadPosesStep{e.poses}, over_s};
  }
  physics::PersonStep operator()(const StepOfHand auto&) const {
    errors.Add(step.name_where, fmt::format("'{}' is a person; this step is for hands", step.name),
               "persons look, walk, turn, lean, move a limb; their hands are actors of their own");
    return {};
  }

 private:
  /// Whether a body is a part of this person. Her parts follow her head in the scene's bodies.
  bool IsHers(std::size_t body) const {
    const auto next = std::ranges::find_if(
        scene.persons, [&](const physics::Person& other) { return other.head > person.head; });
    const std::size_t end = next == scene.persons.end() ? scene.bodies.size() : next->head.index();
    return body >= person.head.index() && body < end;
  }

  void CheckSeen(const Located<std::string>& name) const {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].name == name.value && IsHers(i))
        return errors.Add(name.where,
                          fmt::format("look_at: '{}' cannot look at herself", person.name),
                          "name a thing, a hand or another person, or give a point with look_at_m");
    }
    std::vector<std::string> names;
    for (const physics::Body& body : scene.bodies) names.push_back(body.name);
    for (const physics::Hand& hand : scene.hands) names.push_back(hand.name);
    errors.Find(name, "look_at", names);
  }

  bool CheckBody(const Where& where, const char* key) const {
    if (!person.has_body)
      errors.Add(where, fmt::format("{}: '{}' is only a head", key, person.name),
                 "write 'person: body'");
    return person.has_body;
  }

  void CheckFree(const Located<physics::LimbEnd>& limb) const {
    using physics::LimbEnd;
    if (!CheckBody(limb.where, "move_limb")) return;
    const bool right = limb.value == LimbEnd::kRightElbow || limb.value == LimbEnd::kRightWrist;
    const bool left = limb.value == LimbEnd::kLeftElbow || limb.value == LimbEnd::kLeftWrist;
    const physics::HandIndex hand = right  ? person.right_hand
                                    : left ? person.left_hand
                                           : physics::kNone;
    if (hand == physics::kNone) return;
    errors.Add(limb.where,
               fmt::format("move_limb: this arm follows the hand '{}'", scene.hand(hand).name),
               "move the hand instead");
  }
};

class PersonBuilder {
 public:
  PersonBuilder(const ScenarioYaml& entry, physics::Scene& scene, DiagnosticList& errors)
      : scene_(scene), errors_(errors) {
    for (const auto& hand : entry.hands) hands_.push_back(hand.name);
    for (const auto& entity : entry.entities) taken_.insert(entity.name);
    for (const auto& actor : entry.actors) taken_.insert(actor.name);
  }

  void Add(const Named<PersonActorYaml>& actor) {
    const PersonActorYaml& written = actor.value;
    physics::Person person{
        .name = actor.name,
        .head = physics::BodyIndex(scene_.bodies.size()),
        .has_body = written.person == PersonKind::kBody,
        .height_m = written.height_m,
        .X_WS = {written.at_m.value, physics::FromRollPitchYaw({0, 0, written.yaw_deg})},
        .eyes = written.eyes};
    if (written.right_hand) person.right_hand = FindHand("right_hand", *written.right_hand);
    if (written.left_hand) person.left_hand = FindHand("left_hand", *written.left_hand);
    AddParts(person, actor.name_where);
    scene_.persons.push_back(std::move(person));
  }

 private:
  physics::HandIndex FindHand(const char* key, const Located<std::string>& name) {
    const auto found = errors_.Find(name, key, hands_, "hand");
    if (!found) return physics::kNone;
    if (!used_.insert(name.value).second)
      errors_.Add(name.where, fmt::format("{}: '{}' is already on another arm", key, name.value));
    return physics::HandIndex(*found);
  }

  void AddParts(const physics::Person& person, const Where& where) {
    std::vector<physics::Body> parts = physics::PartsOf(person);
    const std::vector<physics::Pose> places =
        physics::PlacesOf(person, physics::Standing(scene_, person), {});
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0 && !taken_.insert(parts[i].name).second)
        errors_.Add(where, fmt::format("'{}' names both a part of '{}' and something else",
                                       parts[i].name, person.name));
      parts[i].X_WB = places[i];
      scene_.bodies.push_back(std::move(parts[i]));
    }
  }

  physics::Scene& scene_;
  DiagnosticList& errors_;
  std::vector<std::string> hands_;
  std::set<std::string> taken_, used_;
};

}  // namespace

void AddStyles(const std::vector<Named<DigitYaml>>& digits,
               const std::vector<Named<StyleYaml>>& styles, SameName rule, DiagnosticList& errors,
               std::vector<physics::GraspStyle>& to) {
  StyleBuilder builder(digits, errors);
  for (const auto& style : styles) {
    physics::GraspStyle built = builder.BuildStyle(style);
    const auto same_name = std::ranges::find(to, style.name, &physics::GraspStyle::name);
    if (same_name == to.end()) {
      to.push_back(std::move(built));
    } else if (rule == SameName::kTakesItsPlace) {
      *same_name = std::move(built);
    } else {
      errors.Add(style.name_where, fmt::format("the hand already has a style '{}'", style.name),
                 "one of its files defines it; only a scenario's `grasps` replace styles");
    }
  }
}

void MakeAbstract(const EntityYaml& entity, physics::Body& body) {
  body.abstract = AbstractOf(entity);
  body.fixed = true;
  physics::Shape shape = physics::Sphere{kPointRadius_m};
  if (entity.region && entity.region->size_m) shape = physics::Box{*entity.region->size_m};
  if (entity.region && entity.region->radius_m) shape = physics::Sphere{*entity.region->radius_m};
  if (entity.gaze_target) shape = physics::Sphere{entity.gaze_target->radius_m};
  if (entity.camera && entity.at_m.value.size() == 3) {
    const Eigen::Vector3d at_m(entity.at_m.value[0], entity.at_m.value[1], entity.at_m.value[2]);
    body.view_deg = entity.camera->view_deg;
    body.X_WB.q = LookingAlong(entity.camera->toward_m.value - at_m);
  }
  body.shapes = {{shape, {}}};
}

std::string WhyNoThing(const physics::Body& body) {
  return body.grains ? "grains" : NounOf(body.abstract);
}

physics::PersonStep MakePersonStep(const Named<StepYaml>& step, int person,
                                   const physics::Scene& scene, DiagnosticList& errors) {
  const physics::Person& who = scene.persons[static_cast<std::size_t>(person)];
  physics::PersonStep made = std::visit(PersonStepMaker{step, who, scene, errors}, step.value);
  made.person = person;
  made.delay_s = TimingOf(step.value).delay_s;
  made.order = OrderOf(step.value);
  made.until = UntilOf(step.value, scene, true, errors);
  return made;
}

void AddPersons(const ScenarioYaml& entry, physics::Scene& scene, DiagnosticList& errors) {
  PersonBuilder builder(entry, scene, errors);
  for (const auto& actor : entry.persons) builder.Add(actor);
}

}  // namespace prehend::scenario
