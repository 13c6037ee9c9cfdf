// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/build_persons_test.cc
#include "harness/scenario/resolve/build_persons.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "physics/person/skeleton.h"

namespace prehend::scenario {
namespace {

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

void AddPersons(const ScenarioYaml& entry, physics::Scene& scene, DiagnosticList& errors) {
  PersonBuilder builder(entry, scene, errors);
  for (const auto& actor : entry.persons) builder.Add(actor);
}

}  // namespace prehend::scenario
