// SPDX-License-Identifier: Apache-2.0
// The script is played once more, over the recorded motion: what waits for something happens when
// it did.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/show/replay/replay_data.h"
#include "physics/base/visitors.h"
#include "physics/hand/script_player.h"

namespace prehend::show {
namespace {

using namespace physics;

std::string Text(const StepAction& action) {
  return std::visit(
      Overloaded{[](const WaitStep&) { return std::string("wait"); },
                 [](const ReachStep& step) { return "reach " + step.object; },
                 [](const TriggerStep& step) {
                   return step.trigger > 0 ? fmt::format("close to {:g}", step.trigger)
                                           : std::string("open to 0");
                 },
                 [](const MoveStep& step) {
                   const bool is_lift = step.by_m.head<2>().isZero() && step.by_m.z() > 0;
                   return std::string(is_lift ? "lift" : "move");
                 },
                 [](const CarryStep&) { return std::string("carry"); },
                 [](const PlaceStep& step) { return "place on " + step.support; },
                 [](const RetreatStep&) { return std::string("retreat"); },
                 [](const FollowJointStep& step) {
                   return fmt::format("move {} to {:g}", step.entity, step.to);
                 },
                 [](const PosesStep&) { return std::string("way-points"); },
                 [](const TurnHandStep&) { return std::string("turn"); },
                 [](const OrbitStep& step) { return "around " + step.around; },
                 [](const PressStep& step) { return "press " + step.against; }},
      action);
}

std::string Text(const PersonAction& action) {
  return std::visit(Overloaded{[](const WaitStep&) { return std::string("wait"); },
                               [](const LookAtStep& step) {
                                 const auto* const name = std::get_if<std::string>(&step.target);
                                 return name ? "look at " + *name : std::string("look at a point");
                               },
                               [](const EyesStep&) { return std::string("look ahead"); },
                               [](const WalkStep&) { return std::string("walk"); },
                               [](const TurnStep&) { return std::string("turn"); },
                               [](const LeanStep&) { return std::string("lean"); },
                               [](const SwayStep&) { return std::string("sway"); },
                               [](const MoveLimbStep&) { return std::string("move a limb"); },
                               [](const HeadPosesStep&) { return std::string("recorded head"); },
                               [](const BodyPosesStep&) { return std::string("recorded body"); }},
                    action);
}

}  // namespace

std::vector<PlayedStep> PlayedSteps(const scenario::Scenario& scenario,
                                    const episode::RunResult& run) {
  const Scene& scene = scenario.scene;
  std::vector<PlayedStep> played;
  std::map<std::string, std::size_t> last_of;  // by actor, its step that has no end yet
  const auto end_of_all = [&](grammar::Tick tick) {
    for (const auto& [_, step] : last_of) played[step].end = tick;
    last_of.clear();
  };
  const auto begin = [&](const std::string& who, std::string what, grammar::Tick tick) {
    if (const auto last = last_of.find(who); last != last_of.end()) played[last->second].end = tick;
    last_of[who] = played.size();
    played.push_back({who, std::move(what), tick, tick});
  };
  const auto ticks = [&](double seconds) {
    return static_cast<grammar::Tick>(seconds * static_cast<double>(scene.world.rate_hz));
  };
  ScriptPlayer player(scene, scenario.script);
  std::size_t stage = 0;
  grammar::Tick end = 0;
  for (const Snapshot& snapshot : run.recording) {
    end = snapshot.tick;
    if (!player.Advance(snapshot)) break;
    for (const BegunSteps& begun : player.begun()) {
      if (begun.stage != stage) end_of_all(snapshot.tick);
      stage = begun.stage;
      const ScriptStage& of = scenario.script.stages[stage];
      for (const std::size_t i : begun.steps)
        begin(scene.hand(of.steps[i].hand).name, Text(of.steps[i].action),
              snapshot.tick + ticks(of.steps[i].delay_s));
      for (const std::size_t i : begun.person_steps)
        begin(scene.persons[static_cast<std::size_t>(of.person_steps[i].person)].name,
              Text(of.person_steps[i].action), snapshot.tick);
    }
  }
  end_of_all(std::max<grammar::Tick>(0, end - ticks(scenario.script.settle_s)));
  std::erase_if(played, [](const PlayedStep& step) { return step.end <= step.begin; });
  return played;
}

}  // namespace prehend::show
