// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/read_scenario_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/scenario/format/scenario_formats.h"
#include "harness/scenario/resolve/resolve.h"
#include "physics/motion/stage_clock.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"

namespace prehend::scenario {
namespace {

/// The words of relative_to.
constexpr const char* kWorldFrame = "world";
constexpr const char* kHandFrame = "hand";
/// How far outside an entity a point to grasp may be, since written numbers are rounded.
constexpr double kMaxOutside_m = 0.005;

template <class T>
std::vector<std::string> NamesOf(const std::vector<Named<T>>& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

int IndexOf(const std::string& name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

physics::TimedPose TimedPoseOf(const PoseYaml& pose) {
  physics::TimedPose timed;
  timed.t_s = pose.t_s;
  timed.X_WH = {pose.at_m, pose.q};
  timed.trigger = pose.trigger;
  return timed;
}

/// Builds a step from each kind of entry; the names in it must be those of the scenario.
struct StepMaker {
  const ScenarioYaml& entry;
  const std::vector<std::string>& entities;
  const physics::Scene& scene;
  bool is_hand;                     ///< false: there is no such actor
  const physics::HandModel* model;  ///< null when the hand is not known
  const Named<StepYaml>& written;
  DiagnosticList& errors;

  physics::Step operator()(const ReachYaml& e) const {
    CheckEntity("reach", e.reach);
    const Where where =
        e.style.where.place.line > 0 ? e.style.where : e.reach.where;  // the default has no place
    if (const physics::GraspStyle* style = FindStyle(e.style.value, where))
      CheckApproach(e, *style);
    CheckPoint(e);
    physics::ReachStep reach{e.reach.value, e.style.value, e.from, e.offset_m.value, {}};
    if (e.point_m) reach.point_m = e.point_m->value;
    return {physics::kNone, std::move(reach), e.over_s};
  }
  physics::Step operator()(const CloseYaml& e) const {
    return {physics::kNone, physics::TriggerStep{e.close_to}, e.over_s};
  }
  physics::Step operator()(const OpenYaml& e) const {
    return {physics::kNone, physics::TriggerStep{e.open_to}, e.over_s};
  }
  physics::Step operator()(const LiftYaml& e) const {
    return {physics::kNone, physics::MoveStep{{0, 0, e.lift_by_m}}, e.over_s};
  }
  physics::Step operator()(const MoveYaml& e) const {
    return {physics::kNone, physics::MoveStep{e.move_by_m.value}, e.over_s};
  }
  physics::Step operator()(const CarryYaml& e) const {
    return {physics::kNone, physics::CarryStep{e.carry_to_m.value}, e.over_s};
  }
  physics::Step operator()(const PlaceYaml& e) const {
    CheckEntity("place_on", e.place_on);
    return {physics::kNone, physics::PlaceStep{e.place_on.value}, e.over_s};
  }
  physics::Step operator()(const RetreatYaml& e) const {
    return {physics::kNone, physics::RetreatStep{e.retreat_by_m}, e.over_s};
  }
  physics::Step operator()(const FollowJointYaml& e) const {
    CheckEntity("follow_joint", e.follow_joint);
    CheckJoint(e.follow_joint);
    return {physics::kNone, physics::FollowJointStep{e.follow_joint.value, e.to}, e.over_s};
  }
  physics::Step operator()(const WaitYaml& e) const {
    return {physics::kNone, physics::WaitStep{}, e.wait_s};
  }
  physics::Step operator()(const PosesYaml& e) const {
    physics::PosesStep step;
    for (const PoseYaml& pose : e.poses) step.poses.push_back(TimedPoseOf(pose));
    step.frames = FramesOf(e);
    return Follow(std::move(step), e.style);
  }
  physics::Step operator()(const RecordingYaml& e) const {
    return Follow(physics::PosesStep{e.poses}, e.style);
  }
  physics::Step operator()(const TurnHandYaml& e) const {
    if (e.turn_by_deg.value.isZero())
      errors.Add(e.turn_by_deg.where, "turn_by_deg: all three are 0, so nothing turns");
    return {physics::kNone, physics::TurnHandStep{e.turn_by_deg.value * (M_PI / 180), e.own_axes},
            e.over_s};
  }
  physics::Step operator()(const OrbitYaml& e) const {
    CheckEntity("orbit", e.orbit.around);
    return {physics::kNone,
            physics::OrbitStep{e.orbit.around.value, e.orbit.by_deg * M_PI / 180, e.orbit.at_m},
            e.over_s};
  }
  physics::Step operator()(const PressYaml& e) const {
    CheckEntity("press_n", e.against);
    if (e.along.value.norm() < 0.01)
      errors.Add(e.along.where, "along: the direction has no length");
    return {physics::kNone,
            physics::PressStep{e.against.value, e.press_n, e.along.value.normalized()}, e.over_s};
  }
  physics::Step operator()(const StepOfPerson auto&) const {
    if (is_hand)
      errors.Add(written.name_where,
                 fmt::format("'{}' is a hand; this step is for persons", written.name),
                 "hands reach, close, move; persons look, walk, lean");
    return {};
  }

 private:
  /// What each way-point is relative to; none if all are in the world.
  std::vector<physics::PoseFrame> FramesOf(const PosesYaml& e) const {
    std::vector<physics::PoseFrame> frames;
    bool all_in_world = true;
    if (e.relative_to.where.place.line > 0) FrameOf(e.relative_to);  // reports it once
    for (const PoseYaml& pose : e.poses) {
      frames.push_back(pose.relative_to ? FrameOf(*pose.relative_to) : NamedFrame(e.relative_to));
      frames.back().world_axes = e.world_axes;
      all_in_world &= !frames.back().own_hand && frames.back().name.empty();
    }
    if (all_in_world) frames.clear();
    return frames;
  }

  static physics::PoseFrame NamedFrame(const Located<std::string>& name) {
    if (name.value == kHandFrame) return {.own_hand = true};
    return {.name = name.value == kWorldFrame ? "" : name.value};
  }

  /// Reports what has no coordinate frame.
  physics::PoseFrame FrameOf(const Located<std::string>& name) const {
    std::vector<std::string> known{kWorldFrame, kHandFrame};
    known.insert(known.end(), entities.begin(), entities.end());
    for (std::size_t i = entities.size(); i < scene.bodies.size(); ++i)
      known.push_back(scene.bodies[i].name);  // of persons
    for (const physics::Hand& hand : scene.hands)
      if (hand.name != written.name) known.push_back(hand.name);
    if (std::ranges::count(known, name.value) > 1)
      errors.Add(name.where,
                 fmt::format("relative_to: '{}' is a word of its own here, and something is called "
                             "so, too",
                             name.value),
                 "call that something else");
    else if (name.value == written.name && name.value != kHandFrame)
      errors.Add(name.where, fmt::format("relative_to: '{}' is this hand itself", name.value),
                 "write 'relative_to: hand'");
    else
      errors.Find(name, "relative_to", known, "entity or hand");
    return NamedFrame(name);
  }

  /// Reports entities that do not exist or are not physical objects.
  void CheckEntity(const char* key, const Located<std::string>& name) const {
    const auto index = FindEntity(entry, name, key, errors);
    if (!index || *index >= scene.bodies.size()) return;
    const std::string what = WhyNoThing(scene.bodies[*index]);
    if (!what.empty())
      errors.Add(name.where,
                 fmt::format("{}: '{}' is {}, not a physical object", key, name.value, what),
                 what == "grains" ? "name the vessel that holds them" : "hands cannot touch it");
  }

  /// A point to grasp must be on or in the entity.
  void CheckPoint(const ReachYaml& e) const {
    const auto found = std::find(entities.begin(), entities.end(), e.reach.value);
    if (!e.point_m || found == entities.end()) return;
    const auto index = static_cast<std::size_t>(found - entities.begin());
    if (index >= scene.bodies.size() || scene.bodies[index].shapes.empty()) return;
    const double away_m = physics::DistanceTo(scene.bodies[index], e.point_m->value);
    if (away_m <= kMaxOutside_m) return;
    errors.Add(e.point_m->where,
               fmt::format("point_m: the point is {:.1f} mm outside '{}', more than {:g} mm",
                           1000 * away_m, *found, 1000 * kMaxOutside_m),
               "point_m is in the entity's own frame: [0, 0, 0] is where its at_m is");
  }

  void CheckJoint(const Located<std::string>& name) const {
    const auto found = std::find(entities.begin(), entities.end(), name.value);
    if (found == entities.end()) return;  // already reported
    const int joint = physics::JointThatMoves(scene, physics::BodyIndex(found - entities.begin()));
    if (joint >= 0 &&
        scene.joints[static_cast<std::size_t>(joint)].kind != physics::JointKind::kBall)
      return;
    errors.Add(name.where, fmt::format("follow_joint: '{}' has no slider or hinge", name.value),
               "give it one, or use 'move_by_m'");
  }

  physics::Step Follow(physics::PosesStep step, const Located<std::string>& style) const {
    if (!style.value.empty()) FindStyle(style.value, style.where);
    step.style = style.value;
    const double over_s = step.poses.empty() ? 0 : step.poses.back().t_s;
    return {physics::kNone, std::move(step), over_s};
  }

  /// Null after an error, and when the hand is unknown.
  const physics::GraspStyle* FindStyle(const std::string& name, const Where& where) const {
    if (!model || model->styles.empty()) return nullptr;
    const int style = physics::FindStyle(*model, name);
    if (style >= 0) return &model->styles[static_cast<std::size_t>(style)];
    std::vector<std::string> known;
    for (const auto& candidate : model->styles) known.push_back(candidate.name);
    errors.AddUnknownName(
        where, fmt::format("style: hand '{}' has no style '{}'", model->name, name), name, known);
    return nullptr;
  }

  void CheckApproach(const ReachYaml& e, const physics::GraspStyle& chosen) const {
    const bool above_missing = e.from == physics::Approach::kAbove && !chosen.above;
    const bool side_missing = e.from == physics::Approach::kSide && !chosen.side;
    if (above_missing || side_missing) {
      errors.Add(e.reach.where, fmt::format("style '{}' does not grasp from {}", chosen.name,
                                            above_missing ? "above" : "the side"));
    }
  }
};

/// Checks the limits of the whole script; the error is at the stage that exceeds them.
void CheckLength(const ScenarioYaml& entry, const physics::Script& script, DiagnosticList& errors) {
  double total_s = script.settle_s;
  std::size_t poses = 0;
  for (std::size_t i = 0; i < script.stages.size(); ++i) {
    for (const Named<StepYaml>& step : entry.script[i]) {
      if (const auto* given = std::get_if<PosesYaml>(&step.value)) poses += given->poses.size();
    }
    total_s += physics::DurationOf(script.stages[i]);
    const Where where = entry.script[i].front().name_where;
    if (total_s > kMaxDuration_s) {
      return errors.Add(where,
                        fmt::format("the script and settle_s are longer than {} s at this point",
                                    kMaxDuration_s));
    }
    if (poses > kMaxPoses)
      return errors.Add(where, fmt::format("more than {} poses at this point", kMaxPoses));
  }
}

/// Steps that move a held object need a hand that may hold one.
struct HoldingCheck {
  const std::string& hand;
  DiagnosticList& errors;
  std::string reached = {};  ///< the entity last reached for
  bool closed = false;       ///< its grip has been commanded

  void operator()(const ReachYaml& reach) { reached = reach.reach.value; }
  void operator()(const CloseYaml& close) { closed |= close.close_to > 0; }
  void operator()(const PosesYaml& e) { Follow(e.poses); }
  void operator()(const RecordingYaml& e) { Follow(e.poses); }
  void operator()(const CarryYaml& carry) { MustHold("carry_to_m", carry.where); }
  void operator()(const PlaceYaml& place) {
    MustHold("place_on", place.where);
    if (place.place_on.value == reached)
      errors.Add(
          place.place_on.where,
          fmt::format("place_on: {} holds '{}' and cannot place it on itself", hand, reached));
  }
  /// They can be done with an empty hand, too.
  void operator()(const physics::OneOf<OpenYaml, LiftYaml, MoveYaml, RetreatYaml, FollowJointYaml,
                                       WaitYaml, TurnHandYaml, OrbitYaml, PressYaml> auto&) {}
  void operator()(const StepOfPerson auto&) {}

 private:
  template <class T>
  void Follow(const std::vector<T>& poses) {
    closed |= std::ranges::any_of(poses, [](const T& pose) { return pose.trigger > 0.0; });
  }
  void MustHold(const char* key, const Where& where) const {
    if (!reached.empty() || closed) return;
    errors.Add(where, fmt::format("{}: {} cannot hold anything here", key, hand),
               "no step before this one reaches for something or closes the hand");
  }
};

void CheckHolding(const std::vector<StageYaml>& script, DiagnosticList& errors) {
  std::map<std::string, HoldingCheck> hands;
  for (const StageYaml& stage : script) {
    for (const Named<StepYaml>& step : stage)
      std::visit(hands.try_emplace(step.name, HoldingCheck{step.name, errors}).first->second,
                 step.value);
  }
}

using StepName = std::optional<Located<std::string>>;

std::string TextOf(const StepName& name) { return name ? name->value : std::string(); }

/// Which stages have steps of these names.
using StagesByName = std::map<std::string, std::vector<std::size_t>>;

StagesByName NamesOf(const std::vector<StageYaml>& stages, DiagnosticList& errors) {
  StagesByName names;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    for (const Named<StepYaml>& step : stages[i]) {
      const StepName& name = TimingOf(step.value).name;
      if (!name) continue;
      std::vector<std::size_t>& found = names[name->value];
      if (!found.empty() && found.back() == i)
        errors.Add(name->where,
                   fmt::format("name: two steps of this stage are called '{}'", name->value));
      else
        found.push_back(i);
    }
  }
  return names;
}

class LinkCheck {
 public:
  LinkCheck(const std::vector<std::string>& actors, const StagesByName& names,
            DiagnosticList& errors)
      : actors_(actors), names_(names), errors_(errors) {}

  /// False after an error.
  bool Check(const char* key, const StepName& name, std::size_t stage) const {
    if (!name) return true;
    const auto found = names_.find(name->value);
    if (found != names_.end() && std::ranges::count(found->second, stage) > 0) return true;
    const std::string what =
        fmt::format("{}: no step of this stage is called '{}'", key, name->value);
    if (found != names_.end()) {
      const bool before = found->second.front() < stage;
      errors_.Add(name->where, what,
                  before ? "that of an earlier stage has ended when this stage begins"
                         : "that of a later stage begins when this stage has ended");
    } else if (std::ranges::count(actors_, name->value) > 0) {
      errors_.Add(
          name->where, what,
          fmt::format("'{}' is an actor: give the step 'name: ..', and name that", name->value));
    } else {
      std::vector<std::string> known;
      for (const auto& [other, stages] : names_)
        if (std::ranges::count(stages, stage) > 0) known.push_back(other);
      if (known.empty())
        errors_.Add(name->where, what,
                    fmt::format("write 'name: {}' in the step that it waits for", name->value));
      else
        errors_.AddUnknownName(name->where, what, name->value, known);
    }
    return false;
  }

 private:
  const std::vector<std::string>& actors_;
  const StagesByName& names_;
  DiagnosticList& errors_;
};

/// The steps of a stage in the order of physics/motion/stage_clock.h.
std::vector<const StepYaml*> InPhysicsOrder(const StageYaml& stage,
                                            const std::vector<bool>& of_persons) {
  std::vector<const StepYaml*> ordered;
  for (const bool persons : {false, true})
    for (std::size_t i = 0; i < stage.size(); ++i)
      if (of_persons[i] == persons) ordered.push_back(&stage[i].value);
  return ordered;
}

/// A step that waits for itself, by way of others, and says for what it waits.
std::size_t StepOfCircle(const std::vector<std::size_t>& stuck,
                         const std::vector<physics::StepLinks>& links,
                         const std::vector<const StepYaml*>& steps) {
  const auto before = [&](std::size_t step) {
    for (const std::size_t other : links[step].after)
      if (std::ranges::count(stuck, other) > 0) return other;
    return links[step].with.value_or(step);
  };
  std::size_t step = stuck.front();
  for (std::size_t i = 0; i < steps.size(); ++i) step = before(step);  // now it is in the circle
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (TimingOf(*steps[step]).after || TimingOf(*steps[step]).with) return step;
    step = before(step);
  }
  return step;
}

void CheckCircles(const StageYaml& stage, const physics::ScriptStage& built,
                  const std::vector<bool>& of_persons, DiagnosticList& errors) {
  const std::vector<std::size_t> stuck = physics::StuckSteps(built);
  const std::vector<const StepYaml*> steps = InPhysicsOrder(stage, of_persons);
  if (stuck.empty() || steps.size() != built.steps.size() + built.person_steps.size()) return;
  const StepTimingYaml& timing =
      TimingOf(*steps[StepOfCircle(stuck, physics::LinksOf(built), steps)]);
  const bool after = timing.after.has_value();
  const Located<std::string>& other = after ? *timing.after : *timing.with;
  errors.Add(other.where,
             timing.name && timing.name->value == other.value
                 ? fmt::format("{}: a step cannot wait for itself", after ? "after" : "with")
                 : fmt::format("{}: this step would never begin, since '{}' waits for it",
                               after ? "after" : "with", other.value));
}

}  // namespace

physics::Script BuildScript(const ScenarioYaml& entry, const physics::Scene& scene,
                            DiagnosticList& errors) {
  const std::vector<std::string> entities = NamesOf(entry.entities), hands = NamesOf(entry.hands),
                                 persons = NamesOf(entry.persons);
  physics::Script script;
  script.settle_s = entry.settle_s;
  for (const StageYaml& beat_entry : entry.script) {
    physics::ScriptStage& stage = script.stages.emplace_back();
    for (const Named<StepYaml>& named : beat_entry) {
      const int hand = IndexOf(named.name, hands), person = IndexOf(named.name, persons);
      if (person >= 0) {
        stage.person_steps.push_back(MakePersonStep(named, person, scene, errors));
        continue;
      }
      if (hand < 0) {
        errors.AddUnknownName(named.name_where, fmt::format("no actor is called '{}'", named.name),
                              named.name, NamesOf(entry.actors));
      }
      const physics::HandIndex index(hand);
      const bool known = index.IsBelow(scene.hands.size());
      const physics::HandModel* model = known ? &scene.hand(index).model : nullptr;
      const StepMaker maker{entry, entities, scene, hand >= 0, model, named, errors};
      physics::Step step = std::visit(maker, named.value);
      step.until = UntilOf(named.value, scene, false, errors);
      step.keep_upright = std::visit(
          [](const auto& e) -> std::optional<bool> {
            if constexpr (requires { e.keep_upright; }) return e.keep_upright;
            return std::nullopt;
          },
          named.value);
      step.delay_s = TimingOf(named.value).delay_s;
      step.order = OrderOf(named.value);
      step.hand = index;
      step.written_at = errors.PlaceText(named.name_where);
      stage.steps.push_back(std::move(step));
    }
  }
  CheckHolding(entry.script, errors);
  CheckStepOrder(entry.script, NamesOf(entry.actors), persons, script, errors);
  CheckLength(entry, script, errors);
  return script;
}

std::optional<physics::Until> UntilOf(const StepYaml& step, const physics::Scene& scene,
                                      bool is_person, DiagnosticList& errors) {
  /// Hands look no farther for what they come near to (physics/hand/hand_clearance.h).
  constexpr double kMaxGap_m = 0.09;
  const std::optional<Located<physics::Until>>& written = TimingOf(step).until;
  if (!written) return {};
  const physics::Until& until = written->value;
  std::vector<std::string> bodies, hands;
  for (const physics::Body& body : scene.bodies) bodies.push_back(body.name);
  for (const physics::Hand& hand : scene.hands) hands.push_back(hand.name);
  const auto thing = errors.Find({until.thing, written->where}, "until", bodies);
  const std::string what = thing ? WhyNoThing(scene.bodies[*thing]) : "";
  if (!what.empty())
    errors.Add(written->where,
               fmt::format("until: '{}' is {}, not a physical object", until.thing, what),
               what == "grains" ? "name the vessel that holds them" : "hands cannot touch it");
  if (is_person && until.who.empty())
    errors.Add(written->where, "until: a person waits for somebody or something else",
               fmt::format("write who: touching({}, {})", hands.empty() ? "can" : hands.front(),
                           until.thing));
  std::vector<std::string>& known = hands;
  if (!until.gap_m) known.insert(known.end(), bodies.begin(), bodies.end());
  if (!until.who.empty())
    errors.Find({until.who, written->where}, "until", known, until.gap_m ? "hand" : "entity");
  if (until.who == until.thing)
    errors.Add(written->where, fmt::format("until: '{}' is itself", until.who));
  if (const double gap_m = until.gap_m.value_or(0); gap_m > kMaxGap_m)
    errors.Add(written->where, fmt::format("until: a gap of {:g} mm is too far, at most {:g} mm",
                                           1000 * gap_m, 1000 * kMaxGap_m));
  return until;
}

const StepTimingYaml& TimingOf(const StepYaml& step) {
  return std::visit([](const StepTimingYaml& timing) -> const StepTimingYaml& { return timing; },
                    step);
}

physics::StepOrder OrderOf(const StepYaml& step) {
  const StepTimingYaml& timing = TimingOf(step);
  return {.name = TextOf(timing.name), .after = TextOf(timing.after), .with = TextOf(timing.with)};
}

void CheckStepOrder(const std::vector<StageYaml>& stages, const std::vector<std::string>& actors,
                    const std::vector<std::string>& persons, const physics::Script& script,
                    DiagnosticList& errors) {
  const StagesByName names = NamesOf(stages, errors);
  const LinkCheck links(actors, names, errors);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    bool known = true;
    std::vector<bool> of_persons;
    for (const Named<StepYaml>& step : stages[i]) {
      const StepTimingYaml& timing = TimingOf(step.value);
      known &= links.Check("after", timing.after, i) && links.Check("with", timing.with, i);
      of_persons.push_back(std::ranges::count(persons, step.name) > 0);
    }
    if (known) CheckCircles(stages[i], script.stages[i], of_persons, errors);
  }
}

}  // namespace prehend::scenario
