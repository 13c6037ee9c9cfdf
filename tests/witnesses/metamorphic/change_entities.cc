// SPDX-License-Identifier: Apache-2.0
// See tests/witnesses/metamorphic/change_entities.h. Tested by
// tests/witnesses/metamorphic/metamorphic_test.cc
#include "tests/witnesses/metamorphic/change_entities.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "tests/witnesses/metamorphic/move_scenario.h"

namespace prehend::witnesses {
namespace {

using Eigen::Vector3d;

constexpr double kToCopy_m = 13;

template <typename T>
void Append(const std::vector<T>& more, std::vector<T>& items) {
  items.insert(items.end(), more.begin(), more.end());
}

/// Names in a scene and in the steps of its script.
struct RenameIn {
  const std::map<std::string, std::string>& names;
  void operator()(std::string& name) const {
    if (const auto found = names.find(name); found != names.end()) name = found->second;
  }
  void operator()(physics::ReachStep& step) const { (*this)(step.object); }
  void operator()(physics::PlaceStep& step) const { (*this)(step.support); }
  void operator()(physics::FollowJointStep& step) const { (*this)(step.entity); }
  void operator()(physics::OrbitStep& step) const { (*this)(step.around); }
  void operator()(physics::PressStep& step) const { (*this)(step.against); }
  void operator()(physics::PosesStep& step) const {
    for (physics::PoseFrame& frame : step.frames) (*this)(frame.name);
  }
  void operator()(physics::LookAtStep& step) const {
    if (auto* const name = std::get_if<std::string>(&step.target)) (*this)(*name);
  }
  /// They name nobody.
  void operator()(const physics::OneOf<
                  physics::WaitStep, physics::TriggerStep, physics::MoveStep, physics::CarryStep,
                  physics::RetreatStep, physics::TurnHandStep, physics::EyesStep, physics::WalkStep,
                  physics::TurnStep, physics::LeanStep, physics::SwayStep, physics::MoveLimbStep,
                  physics::HeadPosesStep, physics::BodyPosesStep> auto&) const {}
};

constexpr const char* kOfTheCopy = "_of_the_copy";

/// The steps of the copy wait for each other, not for those of the original.
void RenameOrder(physics::StepOrder& order) {
  for (std::string* name : {&order.name, &order.after, &order.with})
    if (!name->empty()) *name += kOfTheCopy;
}

}  // namespace

std::map<std::string, std::string> NamesTurnedRound(const scenario::Scenario& scenario) {
  std::set<std::string> written;
  for (const physics::Body& body : scenario.scene.bodies) written.insert(body.name);
  for (const physics::Hand& hand : scenario.scene.hands) written.insert(hand.name);
  for (const physics::Person& person : scenario.scene.persons) written.insert(person.name);
  std::map<std::string, std::string> names;
  for (const std::string& name : written)
    names[name] = fmt::format("e{:05}_{}", written.size() - names.size(), name);
  return names;
}

scenario::Scenario Renamed(scenario::Scenario scenario,
                           const std::map<std::string, std::string>& names) {
  const RenameIn rename{names};
  for (physics::Body& body : scenario.scene.bodies) rename(body.name);
  for (physics::Hand& hand : scenario.scene.hands) rename(hand.name);
  for (physics::Person& person : scenario.scene.persons) rename(person.name);
  for (physics::ScriptStage& stage : scenario.script.stages) {
    for (physics::Step& step : stage.steps) {
      std::visit(rename, step.action);
      if (step.until) rename(step.until->thing);
    }
    for (physics::PersonStep& step : stage.person_steps) std::visit(rename, step.action);
  }
  return scenario;
}

scenario::Scenario WithCopy(scenario::Scenario scenario) {
  std::map<std::string, std::string> names = NamesTurnedRound(scenario);
  for (auto& [written, name] : names) name = written + kOfTheCopy;
  const scenario::Scenario copy =
      Renamed(Moved(scenario, {.X = {.p_m = {kToCopy_m, 0, 0}}}), names);
  physics::Scene& scene = scenario.scene;
  const int bodies = static_cast<int>(scene.bodies.size());
  const int hands = static_cast<int>(scene.hands.size());
  const int persons = static_cast<int>(scene.persons.size());
  Append(copy.scene.bodies, scene.bodies);
  Append(copy.scene.hands, scene.hands);
  Append(copy.body_classes, scenario.body_classes);
  for (int whole : copy.body_part_of)
    scenario.body_part_of.push_back(whole < 0 ? whole : whole + bodies);
  for (physics::Joint joint : copy.scene.joints) {
    joint.body = joint.body + bodies;
    joint.base = joint.base + bodies;
    scene.joints.push_back(joint);
  }
  for (physics::Person person : copy.scene.persons) {
    person.head = person.head + bodies;
    if (person.right_hand != physics::kNone) person.right_hand = person.right_hand + hands;
    if (person.left_hand != physics::kNone) person.left_hand = person.left_hand + hands;
    scene.persons.push_back(std::move(person));
  }
  for (std::size_t i = 0; i < scenario.script.stages.size(); ++i) {
    physics::ScriptStage& stage = scenario.script.stages[i];
    for (physics::Step step : copy.script.stages[i].steps) {
      step.hand = step.hand + hands;
      RenameOrder(step.order);
      stage.steps.push_back(std::move(step));
    }
    for (physics::PersonStep step : copy.script.stages[i].person_steps) {
      step.person += persons;
      RenameOrder(step.order);
      stage.person_steps.push_back(std::move(step));
    }
  }
  return scenario;
}

}  // namespace prehend::witnesses
