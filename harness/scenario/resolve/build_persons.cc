// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/build_persons_test.cc
// Tested by tests/harness/scenario/resolve/build_persons_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/scenario/resolve/resolve.h"
#include "physics/person/skeleton.h"

namespace prehend::scenario {

namespace {

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
