// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/scenario_fields_test.cc
#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <string_view>
#include <utility>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

constexpr double kMaxMove_m = 10;
constexpr double kMaxSway_m = 0.4;   // farther, she would fall
constexpr double kMinStep_s = 0.01;  // shorter than any human movement
constexpr double kMaxStep_s = 600;

const std::string kDelayDoc = "Seconds to wait first, while others in this stage already act.";
const std::string kUntilDoc =
    "Ends the step before its time: 'touching(milk)' or 'gap(milk) < 5 mm', of this hand; or of "
    "another one, 'touching(left_hand, milk)', or of two things. If that never happens the run "
    "fails; with ', or go on' it goes on.";
const std::string kUprightDoc =
    "Whether the hand turns so that what it holds stands as it stood when the hand took it; "
    "default: in 'place_on', where the support is level.";
const std::string kForceDoc =
    "Yields: slows down so that it pushes with no more than this, newtons.";
const std::string kRelativeDoc =
    "Whose coordinate frame at_m and rpy_deg are in, as it is when the step begins: 'world', "
    "'hand' (this hand itself), an entity or another hand.";
const std::string kStyleDoc = "The grasp style that the hand takes; default: unchanged.";

enum class MayEnd { kInTime, kBefore };

/// With the keys that say when a step begins and ends.
template <class Entry>
ValueFormat<StepYaml> Step(StructFormat<Entry>& format, MayEnd may_end = MayEnd::kInTime) {
  using T = StepTimingYaml;
  if constexpr (requires { &Entry::over_s; })
    format.Optional("over_s", &Entry::over_s, Number(kMinStep_s, kMaxStep_s),
                    "Duration in seconds.");
  if constexpr (requires { &Entry::keep_upright; })
    format.Optional("keep_upright", &Entry::keep_upright, Flag(), kUprightDoc);
  if (may_end == MayEnd::kBefore) format.Optional("until", &T::until, UntilFormat(), kUntilDoc);
  format.Optional("delay_s", &T::delay_s, Number(0, kMaxStep_s), kDelayDoc)
      .Optional("name", &T::name, Identifier(), "What other steps of this stage call it.")
      .Optional("after", &T::after, Identifier(),
                "It begins when the step of this name, in the same stage, has ended.")
      .Optional("with", &T::with, Identifier(),
                "It begins when the step of this name, in the same stage, begins.")
      .AtMostOneOf({"after", "with"});
  for (const char* word : {"times", "repeat", "count"}) format.Remedy(word, kRepeatRemedy);
  return AsAlternative<StepYaml>(format.format());
}

/// A point [x, y]; whoever gives a height is told why it has none.
ValueFormat<Eigen::Vector2d> GroundPoint(const std::string& why) {
  const auto point = Vector<2>(-kMaxDistance_m, kMaxDistance_m);
  return ValueFormat<Eigen::Vector2d>(
      point.schema(),
      [point, why](const YamlNode& node, DiagnosticList& errors, Eigen::Vector2d& value) {
        if (node.kind != YamlNode::Kind::kSequence || node.children.size() != 3)
          return point.Read(node, errors, value);
        errors.Add(node.where, fmt::format("{}: expected [x, y], found 3 numbers", node.key), why);
        return false;
      });
}

/// "a wait_s step".
std::string StepNoun(const std::string& key) {
  return (std::string("aeiou").find(key.front()) == std::string::npos ? "a " : "an ") + key +
         " step";
}

/// A step with one value; most steps are of this kind.
template <class Entry, class M, class F>
ValueFormat<StepYaml> OneValueStep(const std::string& key, M Entry::*member,
                                   const ValueFormat<F>& format, const std::string& doc,
                                   MayEnd may_end = MayEnd::kInTime) {
  return Step(StructFormat<Entry>(StepNoun(key)).Required(key, member, format, doc), may_end);
}

ValueFormat<StepYaml> TurnHandFormat() {
  using T = TurnHandYaml;
  return Step(StructFormat<T>("a turn_by_deg step")
                  .Required("turn_by_deg", &T::turn_by_deg, Vector<3>(-3600, 3600),
                            "The hand turns about its palm: degrees about x, y or z; of several "
                            "about the axis that they point along, by their length.")
                  .Optional("axes", &T::own_axes, Choice<bool>({{"world", false}, {"hand", true}}),
                            "Whose axes these are."));
}

ValueFormat<StepYaml> OrbitFormat() {
  using O = OrbitYaml;
  using A = OrbitYaml::Around;
  return Step(StructFormat<O>("an orbit step")
                  .Required("orbit", &O::orbit,
                            StructFormat<A>("an orbit")
                                .Required("around", &A::around, Identifier(),
                                          "The entity that the hand goes around, turning with it.")
                                .Optional("by_deg", &A::by_deg, Number(-3600, 3600),
                                          "How far, counter-clockwise as seen from above.")
                                .Optional("at_m", &A::at_m, Number(0.01, kMaxMove_m),
                                          "Distance from its centre in the end; default: as now.")
                                .format(),
                            "Around the vertical through an entity's centre."),
              MayEnd::kBefore);
}

ValueFormat<StepYaml> PressFormat() {
  using P = PressYaml;
  return Step(StructFormat<P>("a press_n step")
                  .Required("press_n", &P::press_n, Number(0.1, 200),
                            "Press with this force, with the hand or with what it holds.")
                  .Required("against", &P::against, Identifier(), "The entity that is pressed.")
                  .Optional("along", &P::along, Vector<3>(-1, 1),
                            "Where to, a direction in world axes; default: down."));
}

ValueFormat<StepYaml> ReachFormat() {
  using R = ReachYaml;
  using physics::Approach;
  return Step(
      StructFormat<R>("a reach step")
          .Required("reach", &R::reach, Identifier(),
                    "The entity to move the hand to, ready to close around it.")
          .Optional("style", &R::style, Identifier(), "The grasp style, one of the hand's.")
          .Optional("from", &R::from,
                    Choice<Approach>({{"auto", Approach::kAuto},
                                      {"above", Approach::kAbove},
                                      {"side", Approach::kSide}}),
                    "Where the hand comes from; auto chooses by style and shape.")
          .Optional("offset_m", &R::offset_m, Vector<3>(-kMaxMove_m, kMaxMove_m),
                    "Added to where the hand goes, world axes: reach beside or above the entity.")
          .Optional(
              "point_m", &R::point_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
              "The point to grasp, in the entity's own coordinate frame; default: its centre."));
}

ValueFormat<StepYaml> FollowJointFormat() {
  using F = FollowJointYaml;
  return Step(
      StructFormat<F>("a follow_joint step")
          .Required(
              "follow_joint", &F::follow_joint, Identifier(),
              "The entity on a slider or hinge whose path the hand follows, with what it holds.")
          .Optional("to", &F::to, Number(0, 1),
                    "Where the joint ends: 0 is the minimum of its range, 1 the maximum."));
}

ValueFormat<StepYaml> WaitFormat() {
  return Step(StructFormat<WaitYaml>("a wait step")
                  .Required("wait_s", &WaitYaml::wait_s, Number(kMinStep_s, kMaxStep_s),
                            "Hold still for this long."),
              MayEnd::kBefore);
}

ValueFormat<PoseYaml> PoseFormat() {
  using P = PoseYaml;
  using Eigen::Quaterniond;
  return StructFormat<P>("a pose")
      .Required("t_s", &P::t_s, Number(0, kMaxDuration_s),
                "When, since the start of the step; increasing.")
      .Required("at_m", &P::at_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                "The palm's centre, in world coordinates or as 'relative_to' says.")
      .Optional("rpy_deg", &P::q,
                AsAlternative<Quaterniond>(Vector<3>(-360, 360), physics::FromRollPitchYaw),
                "Roll, pitch and yaw; default is no rotation.")
      .Optional(
          "quat_wxyz", &P::q,
          AsAlternative<Quaterniond>(UnitQuaternion(),
                                     [](const Eigen::Vector4d& q) {
                                       return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
                                     }),
          "Unit quaternion [w, x, y, z], instead of rpy_deg.")
      .Optional("trigger", &P::trigger, Number(0, 1), "Grip at that time; default: stays.")
      .Optional("relative_to", &P::relative_to, Identifier(),
                "As that of the step, for this way-point alone.")
      .AtMostOneOf({"rpy_deg", "quat_wxyz"})
      .format();
}

ValueFormat<StepYaml> PosesFormat() {
  return Step(
      StructFormat<PosesYaml>("a poses step")
          .Required("poses", &PosesYaml::poses, ListOf(PoseFormat(), 1, kMaxPoses),
                    "Way-points of the tracked target, as a tracker would give them; the last one "
                    "ends the step.")
          .Optional("style", &PosesYaml::style, Identifier(), kStyleDoc)
          .Optional("relative_to", &PosesYaml::relative_to, Identifier(), kRelativeDoc)
          .Optional("axes", &PosesYaml::world_axes, Choice<bool>({{"own", false}, {"world", true}}),
                    "Whose axes relative way-points are in: its own, or the world's.")
          .Check([](const YamlNode& node, const PosesYaml& step, DiagnosticList& errors) {
            for (std::size_t i = 1; i < step.poses.size(); ++i) {
              const double before_s = step.poses[i - 1].t_s, t_s = step.poses[i].t_s;
              if (t_s > before_s) continue;
              errors.Add(
                  node.Find("poses")->children[i].Find("t_s")->where,
                  fmt::format("t_s: expected more than {}, the time of the previous pose, found {}",
                              before_s, t_s),
                  "t_s counts from the beginning of the step, not from the previous pose");
            }
          }));
}

/// Reports keys that apply to another kind of file.
void CheckKindOfRecording(const YamlNode& node, const RecordingYaml& entry,
                          DiagnosticList& errors) {
  const bool body = entry.recording.value.ends_with(".bvh");
  const auto refuse = [&](const char* key, const char* why) {
    if (const YamlNode* found = node.Find(key))
      errors.Add(found->key_where, fmt::format("{}: {}", key, why));
  };
  if (!body) return refuse("scale", "only a BVH file has units of its own");
  for (const char* key : {"device", "button", "press_s", "style", "palm_m", "palm_rpy_deg"})
    refuse(key, "a BVH file moves a whole body, not a hand");
}

ValueFormat<StepYaml> RecordingFormat() {
  using R = RecordingYaml;
  const auto seconds = Number(0, kMaxDuration_s);
  return Step(
      StructFormat<R>("a recording step")
          .Required("recording", &R::recording,
                    Word("[A-Za-z0-9_./-]+\\.(csv|json|bvh)", "a .csv, .json or .bvh file", 255),
                    "A recorded motion: a CSV file, JSON of aframe-motion-capture-components, or "
                    "BVH of a whole body.")
          .Optional("device", &R::device, Word("[A-Za-z0-9_-]+", "a name like 'right'"),
                    "Which device of a JSON file moves the hand; required there.")
          .Optional("button", &R::button, Integer<int>(0, 31),
                    "Which button of that device is the trigger; default 1.")
          .Optional("press_s", &R::press_s, Number(0, 5),
                    "Duration of a press, for recordings that only have pressed and released.")
          .Optional("style", &R::style, Identifier(), kStyleDoc)
          .Optional("from_s", &R::from_s, seconds, "Samples before this time are left out.")
          .Optional("to_s", &R::to_s, seconds,
                    "Samples after this time are left out; default: none.")
          .Optional("start_at_m", &R::start_at_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                    "The motion is shifted so that the palm starts here; default: not shifted.")
          .Optional("yaw_deg", &R::yaw_deg, Number(-360, 360),
                    "The motion is turned by this about the vertical, before it is shifted.")
          .Optional("palm_m", &R::palm_m, Vector<3>(-1, 1),
                    "The palm's centre, in the device's axes.")
          .Optional("palm_rpy_deg", &R::palm_rpy_deg, Vector<3>(-360, 360),
                    "Rotation of the palm relative to the device.")
          .Optional("join_s", &R::join_s, Number(0, 60),
                    "Time to get from where the target is to where the recording starts.")
          .Optional("max_gap_s", &R::max_gap_s, Number(0, 60), "Longer gaps are refused.")
          .Optional("max_jump_m", &R::max_jump_m, Number(0, 100), "Larger jumps are refused.")
          .Optional("scale", &R::scale, Number(1e-4, 100),
                    "Metres per unit of a BVH file; default: scaled to the length of her legs.")
          .Renamed("most_gap_s", "max_gap_s")
          .Renamed("most_jump_m", "max_jump_m")
          .Check(CheckKindOfRecording));
}

ValueFormat<StepYaml> MoveLimbFormat() {
  using M = MoveLimbYaml;
  using physics::LimbEnd;
  return Step(StructFormat<M>("a move_limb step")
                  .Required("move_limb", &M::move_limb,
                            Choice<LimbEnd>({{"right_elbow", LimbEnd::kRightElbow},
                                             {"left_elbow", LimbEnd::kLeftElbow},
                                             {"right_wrist", LimbEnd::kRightWrist},
                                             {"left_wrist", LimbEnd::kLeftWrist},
                                             {"right_foot", LimbEnd::kRightFoot},
                                             {"left_foot", LimbEnd::kLeftFoot}}),
                            "Which part of a person goes there; the rest of the limb follows.")
                  .Optional("to_m", &M::to_m, Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                            "World coordinates; without it the limb returns to its rest position.")
                  .Optional("max_force_n", &M::max_force_n, Number(1, 10000), kForceDoc)
                  .Renamed("most_n", "max_force_n"));
}

ValueFormat<StepYaml> WalkFormat() {
  using W = WalkYaml;
  return Step(StructFormat<W>("a walk_to_m step")
                  .Required("walk_to_m", &W::walk_to_m, GroundPoint("she stays on the floor"),
                            "The point between a person's feet goes to this [x, y].")
                  .Optional("max_force_n", &W::max_force_n, Number(1, 10000), kForceDoc));
}

ValueFormat<StepYaml> OneStepFormat() {
  const auto grip = Number(0, 1);
  return ByKey<StepYaml>(
      "a step",
      {{"reach", ReachFormat()},
       {"close_to", OneValueStep("close_to", &CloseYaml::close_to, grip,
                                 "Grip: 0 open, 1 closed with full effort.", MayEnd::kBefore)},
       {"open_to", OneValueStep("open_to", &OpenYaml::open_to, grip,
                                "Grip: 0 open, 1 closed with full effort.")},
       {"lift_by_m",
        OneValueStep("lift_by_m", &LiftYaml::lift_by_m, Number(-kMaxMove_m, kMaxMove_m),
                     "Straight up by this much; negative is down.", MayEnd::kBefore)},
       {"move_by_m",
        OneValueStep("move_by_m", &MoveYaml::move_by_m, Vector<3>(-kMaxMove_m, kMaxMove_m),
                     "Straight by [x, y, z], world axes.", MayEnd::kBefore)},
       {"carry_to_m", OneValueStep("carry_to_m", &CarryYaml::carry_to_m,
                                   GroundPoint("the height is kept; 'lift_by_m' changes it"),
                                   "The held object's centre goes to this [x, y], height kept.",
                                   MayEnd::kBefore)},
       {"place_on", OneValueStep("place_on", &PlaceYaml::place_on, Identifier(),
                                 "Lower until the held object stands on this entity.")},
       {"retreat_by_m",
        OneValueStep("retreat_by_m", &RetreatYaml::retreat_by_m, Number(0, kMaxMove_m),
                     "Back by this much, along the path the hand came.", MayEnd::kBefore)},
       {"follow_joint", FollowJointFormat()},
       {"wait_s", WaitFormat()},
       {"poses", PosesFormat()},
       {"turn_by_deg", TurnHandFormat()},
       {"orbit", OrbitFormat()},
       {"press_n", PressFormat()},
       {"recording", RecordingFormat()},
       {"look_at", OneValueStep("look_at", &LookAtYaml::look_at, Identifier(),
                                "The entity or hand that a person looks at from now on.")},
       {"look_at_m", OneValueStep("look_at_m", &LookAtPointYaml::look_at_m,
                                  Vector<3>(-kMaxDistance_m, kMaxDistance_m),
                                  "The point that a person looks at from now on.")},
       {"eyes", OneValueStep("eyes", &EyesYaml::eyes, EyesFormat(),
                             "A person's eyes lead her hands again, or look ahead.")},
       {"walk_to_m", WalkFormat()},
       {"turn_to_deg", OneValueStep("turn_to_deg", &TurnYaml::turn_to_deg, Number(-360, 360),
                                    "A person turns to this yaw.")},
       {"lean_deg", OneValueStep("lean_deg", &LeanYaml::lean_deg, Number(-30, 90),
                                 "A person's trunk leans forwards by this.")},
       {"sway_by_m",
        OneValueStep("sway_by_m", &SwayYaml::sway_by_m, Vector<2>(-kMaxSway_m, kMaxSway_m),
                     "A person's hips shift this far [ahead, left] from above her feet.")},
       {"move_limb", MoveLimbFormat()}},
      StepRemedies());
}

/// One step, or a list of them.
ValueFormat<std::vector<Located<StepYaml>>> StepsFormat() {
  using Steps = std::vector<Located<StepYaml>>;
  const auto one = WithPlace(OneStepFormat());
  const auto several = ListOf(one, 1, kMaxStepsInARow);
  const auto read = [one, several](const YamlNode& node, DiagnosticList& errors, Steps& steps) {
    if (node.kind == YamlNode::Kind::kSequence) return several.Read(node, errors, steps);
    Located<StepYaml> step;
    if (!one.Read(node, errors, step)) return false;
    step.where = {};  // it is named by its key
    steps.push_back(std::move(step));
    return true;
  };
  return ValueFormat<Steps>(AnyOf({one.schema(), several.schema()}), read);
}

constexpr const char* kConditions =
    "'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on'";

/// What a condition says, as far as it says it.
struct SaidUntil {
  std::string word, who, thing;
  std::optional<double> number;  ///< of "< 5 mm"
  std::string_view rest;         ///< what follows the number
};

SaidUntil SaidBy(std::string_view text) {
  SaidUntil said;
  const std::size_t open = text.find('('), close = text.find(')');
  if (open == std::string::npos || close == std::string::npos || close < open) return said;
  said.word = text.substr(0, open);
  said.thing = text.substr(open + 1, close - open - 1);
  if (const std::size_t comma = said.thing.find(", "); comma != std::string::npos) {
    said.who = said.thing.substr(0, comma);
    said.thing.erase(0, comma + 2);
  }
  const std::size_t digits = text.find_first_of("0123456789", text.find('<', close));
  if (digits == std::string::npos) return said;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + digits, end, said.number.emplace());
  said.rest = {read.ptr, static_cast<std::size_t>(end - read.ptr)};
  return said;
}

/// How one that cannot be read was meant; "" if it can be read, or that is not known.
std::string Remedy(const SaidUntil& said) {
  if (said.word != "touching" && said.word.starts_with("touch"))
    return fmt::format("write: touching({})", said.thing);
  const bool has_unit = !said.rest.empty() && !said.rest.starts_with(',');
  if (said.word != "gap" || !said.number || has_unit) return "";
  // Who leaves the unit out thinks of millimetres, or of metres as elsewhere in the file.
  return fmt::format("a length has a unit: gap({}) < {} mm", said.thing,
                     *said.number < 1 ? 1000 * *said.number : *said.number);
}

}  // namespace

ValueFormat<StageYaml> StageFormat() {
  const auto by_actor = MapOf(Identifier(), StepsFormat(), 1, kMaxActors);
  return ValueFormat<StageYaml>(
      by_actor.schema(),
      [by_actor](const YamlNode& node, DiagnosticList& errors, StageYaml& stage) {
        for (const YamlNode& child : node.children) {
          if (node.kind != YamlNode::Kind::kMapping || child.kind != YamlNode::Kind::kScalar)
            continue;
          errors.Add(child.where,
                     fmt::format("{}: expected a mapping with the fields of a step, found '{}'",
                                 child.key, child.text),
                     "write who does what: 'right_hand: {close_to: 1}'");
          return false;
        }
        std::vector<Named<std::vector<Located<StepYaml>>>> actors;
        if (!by_actor.Read(node, errors, actors)) return false;
        for (auto& actor : actors) {
          for (Located<StepYaml>& step : actor.value) {
            const Where where = step.where.place.line > 0 ? step.where : actor.name_where;
            stage.push_back({actor.name, where, std::move(step.value)});
          }
        }
        return true;
      });
}

Remedies StepRemedies() {
  const std::pair<const char*, const char*> groups[] = {
      {"grasp grip grab take pick pick_up",
       "a grasp is two steps: 'reach: milk', then 'close_to: 1'"},
      {"release let_go drop", "to let go is 'open_to: 0'; before it 'place_on: table' sets down"},
      {"open open_hand",
       "a hand opens by 'open_to: 0'; a drawer or door by 'reach: handle', 'close_to: 1', "
       "'follow_joint: drawer'"},
      {"close close_hand shut",
       "a hand closes by 'close_to: 1'; a drawer or door by 'follow_joint: drawer, to: 0'"},
      {"lift lift_m raise", "straight up is 'lift_by_m: 0.2'"},
      {"move move_to move_to_m go_to goto carry carry_to transport",
       "'reach: milk' goes to a thing, 'move_by_m: [x, y, z]' by a way, 'carry_to_m: [x, y]' "
       "brings what is held to a place, 'poses: [..]' goes anywhere"},
      {"wait pause hold sleep delay_s", "to hold still is 'wait_s: 1'"},
      {"turn rotate twist", "to turn the hand is 'turn_by_deg: [0, 0, 90]'"},
      {"place put put_down put_on set_down", "to set down is 'place_on: table'"},
      {"push push_to_m push_by_m slide slide_to slide_to_m slide_by_m drag",
       "a hand that moves pushes, and what it holds slides where it still rests on something: "
       "'close_to: 0.8', then 'move_by_m: [0.1, 0, 0]'"},
      {"pour", "'lift_by_m', 'carry_to_m' above the vessel, then 'turn_by_deg: [120, 0, 0]'"},
      {"retreat withdraw leave", "'retreat_by_m: 0.2' goes back the way the hand came"},
      {"press squeeze",
       "'press_n: 5, against: table' presses with 5 N; 'close_to: 1' closes with full effort"},
      {"touch brush tap poke nudge",
       "'move_by_m: [0.2, 0, 0], until: touching(milk)' goes until it touches"},
      {"circle circle_around go_around",
       "'orbit: {around: milk, by_deg: 180, at_m: 0.2}' goes around a thing"},
      {"times loop for", kRepeatRemedy},
      {"shake stir wipe",
       "'repeat: 3' with 'steps: [..]' plays steps several times; docs/script-cookbook.md has a "
       "script"},
      {"hand_over give stack throw",
       "it takes several steps; docs/script-cookbook.md and 'prehend new NAME' have scripts"},
      {"look", "a person looks by 'look_at: milk'"},
      {"walk walk_to", "a person walks by 'walk_to_m: [x, y]'"}};
  Remedies remedies = {
      {"",
       "steps that follow each other are a list: 'right_hand: [{reach: milk}, {close_to: 1}]'"}};
  for (const auto& [words, remedy] : groups) {
    std::istringstream each(words);
    for (std::string word; each >> word;) remedies.emplace_back(word, remedy);
  }
  return remedies;
}

ValueFormat<physics::Until> UntilFormat() {
  const auto condition = Word(
      "(touching\\(([a-z][a-z0-9_]*, )?[a-z][a-z0-9_]*\\)|gap\\(([a-z][a-z0-9_]*, "
      ")?[a-z][a-z0-9_]*\\) < [0-9]+(\\.[0-9]+)? (mm|cm|m))(, or go on)?",
      kConditions, 120);
  const auto read = [condition](const YamlNode& node, DiagnosticList& errors,
                                physics::Until& until) {
    const SaidUntil said =
        SaidBy(node.kind == YamlNode::Kind::kScalar ? std::string_view(node.text) : "");
    if (const std::string remedy = Remedy(said); !remedy.empty()) {
      errors.Add(node.where, fmt::format("until: expected {}, found '{}'", kConditions, node.text),
                 remedy);
      return false;
    }
    std::string text;
    if (!condition.Read(node, errors, text)) return false;
    until = {.thing = said.thing, .or_go_on = text.ends_with("or go on"), .who = said.who};
    if (said.number)
      until.gap_m = *said.number * (said.rest.starts_with(" mm")   ? 0.001
                                    : said.rest.starts_with(" cm") ? 0.01
                                                                   : 1);
    return true;
  };
  return ValueFormat<physics::Until>(condition.schema(), read);
}

}  // namespace prehend::scenario
