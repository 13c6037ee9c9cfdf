// SPDX-License-Identifier: Apache-2.0
// See tests/witnesses/metamorphic/metamorphic.h. Tested by
// tests/witnesses/metamorphic/metamorphic_test.cc
#include "tests/witnesses/metamorphic/metamorphic.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "grammar/contents.h"
#include "harness/scenario/transform/transform.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/timeline/event_text.h"
#include "tests/witnesses/metamorphic/change_entities.h"
#include "tests/witnesses/metamorphic/move_scenario.h"

namespace prehend::witnesses {
namespace {

/// In other steps, physics is another approximation of the same motion.
constexpr double kToleranceAtOtherRate_s = 0.05;

/// Why a copy would not be alone; "": it is.
std::string WhyNoRoomForCopy(const scenario::Scenario& scenario) {
  if (!scenario.sensing.sensors.IsPerfect())
    return "the noise of its sensors is drawn for each entity by its place in the list";
  for (const physics::Body& body : scenario.scene.bodies) {
    const physics::LocalBox box = physics::BoundingBox(body);
    if (body.abstract == physics::Abstract::kNot &&
        (body.X_WB * box.p_BC_m).norm() + box.half_size_m.norm() > kMostExtentBesideCopy_m)
      return body.name + " reaches too far for a copy beside it";
  }
  return "";
}

/// Why the transform makes another story of the scenario; "": it does not.
std::string WhyNot(const scenario::Scenario& scenario, const std::string& transform) {
  if (transform == "mirror") {
    const std::string why = WhyDirected(scenario);
    return why.empty() && !scenario.scene.persons.empty()
               ? "a person's right hand would be on the left"
               : why;
  }
  if (transform == "copies") return WhyNoRoomForCopy(scenario);
  if (transform == "watch" && scenario.sensing.sensing_hz == scenario.scene.world.rate_hz)
    return "the grammar sees every tick already";
  return "";
}

/// Events as they were called before Renamed().
void RenameBack(const std::map<std::string, std::string>& originals,
                const grammar::Program& program, grammar::Timeline& timeline) {
  std::set<std::string> symmetric;
  for (const grammar::EventSignature& signature : grammar::EventSignatures(program))
    if (signature.symmetric) symmetric.insert(signature.name);
  for (grammar::NamedEvent& event : timeline.events) {
    for (grammar::Role& role : event.roles) {
      const auto original = originals.find(role.value);
      if (!truth::IsAttribute(role) && original != originals.end()) role.value = original->second;
    }
    // The alphabet decides which of the two is named first.
    if (symmetric.contains(event.event) && event.roles[1].value < event.roles[0].value)
      std::swap(event.roles[0].value, event.roles[1].value);
  }
  Sort(timeline);
}

}  // namespace

const std::vector<std::string>& TransformNames() {
  static const std::vector<std::string> names = {"nudge",  "shift",   "far",       "turn",
                                                 "mirror", "reorder", "bystander", "rename",
                                                 "copies", "rate",    "watch"};
  return names;
}

tl::expected<suite::TransformedScenario, std::string> TransformedBy(
    const episode::LoadedRun& loaded, const std::string& transform) {
  const scenario::Scenario& scenario = loaded.scenario;
  if (const std::string why = WhyNot(scenario, transform); !why.empty()) return tl::unexpected(why);
  suite::TransformedScenario there{
      .name = transform, .scenario = scenario, .tolerance = scenario::DefaultTolerance(scenario)};
  physics::WorldSettings& world = there.scenario.scene.world;
  if (transform == "mirror") {
    there.scenario = Moved(scenario, WorldMotion{.mirrors = true, .X = {}});
  } else if (transform == "rename") {
    const std::map<std::string, std::string> names = NamesTurnedRound(scenario);
    there.scenario = Renamed(scenario, names);
    std::map<std::string, std::string> originals;
    for (const auto& [written, name] : names) originals[name] = written;
    there.rename_back = [originals, program = loaded.program](grammar::Timeline& timeline) {
      RenameBack(originals, *program, timeline);
    };
  } else if (transform == "copies") {
    there.scenario = WithCopy(scenario);
  } else if (transform == "rate") {
    world.rate_hz *= 2;
    there.tolerance = truth::TickAt(kToleranceAtOtherRate_s, world.rate_hz);
  } else if (transform == "watch") {
    int& sensing_hz = there.scenario.sensing.sensing_hz;
    sensing_hz = std::min(2 * sensing_hz, world.rate_hz);
  } else {
    const auto same = std::ranges::find(scenario::kTransforms, transform, scenario::NameOf);
    if (same == scenario::kTransforms.end())
      return tl::unexpected<std::string>("there is no such transform");
    auto transformed = scenario::Transformed(scenario, *same);
    if (!transformed) return tl::unexpected(transformed.error());
    there.scenario = std::move(*transformed);
  }
  return there;
}

TransformVerdict JudgeTransform(const suite::CheckedRun& checked, const truth::Golden& here,
                                const std::string& transform) {
  const auto there = TransformedBy(checked.loaded, transform);
  if (!there) return {transform, kNotApplied, there.error(), ""};
  suite::TransformedPlay play = suite::Play(*there, checked.loaded, here);
  // A claim that does not hold here either says nothing of the transform.
  const std::vector<truth::ClaimVerdict> claims_here =
      suite::JudgeClaims(checked.loaded, checked.result.timeline);
  for (std::size_t i = play.claims.size(); i-- > 0;)
    if (truth::IsContradicted(claims_here[i])) play.claims.erase(play.claims.begin() + i);
  const suite::Findings broken = suite::BrokenIn(play, transform);
  if (!broken.empty())
    return {transform, kOtherStory, broken.front().reason, broken.front().details};
  if (play.differs.empty()) return {transform, kSameStory, "", ""};
  // All but other names transform rounding or the order of computations.
  if (!here.unsteady.empty() && transform != "rename")
    return {transform, kMayDiffer, here.unsteady, ""};
  return {transform, kOtherStory, play.differs.front().reason, play.differs.front().details};
}

}  // namespace prehend::witnesses
