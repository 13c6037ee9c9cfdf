// SPDX-License-Identifier: Apache-2.0
// One Resolver per step turns the step into a trajectory.
#include "physics/hand/script_player.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/hand/hand_clearance.h"
#include "physics/hand/reach_planner.h"
#include "physics/hand/step_notes.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"
#include "physics/scene/landing.h"

namespace prehend::physics {
namespace {

/// How far the target goes below the first contact when an object is put down, so that it stands
/// firmly before the hand opens. With the palm's spring this makes 5 N; more would squeeze the
/// object.
constexpr double kPress_m = 0.002;
/// The integral of the palm's PID carries the object's weight and takes a second to decay: the
/// target goes lower by the extension of the palm's spring under that weight, at most this much.
constexpr double kMaxSpring_m = 0.01;
/// Share of a put-down's time after which the motion ends; the object settles in the rest.
constexpr double kLoweringShare = 0.85;
constexpr double kLevel_m = 1e-6;
/// Number of way-points on the arc of a joint: between two of them the arc deviates from a straight
/// line by 0.1 mm at most.
constexpr int kJointWaypoints = 40;
/// Likewise of an orbit or a turn, per whole turn.
constexpr int kTurnWaypoints = 160;

/// Whether a part of the body ends at this height: what lands there lands on a level face.
bool IsLevelAt(double height_m, const Body& body, const Pose& X_WB) {
  return std::ranges::any_of(body.shapes, [&](const PlacedShape& part) {
    const double top_m = WorldBounds(part.shape, X_WB * part.X_BS).max().z();
    return std::abs(top_m - height_m) < kLevel_m;
  });
}

/// A target that has given way, in the world's axes.
Pose Yielded(const Pose& X_WH, const Pose& by) {
  return {X_WH.p_m + by.p_m, (by.q * X_WH.q).normalized()};
}

}  // namespace

/// Turns one step into a motion. An empty `problem` afterwards means success.
class ScriptPlayer::Resolver {
 public:
  Resolver(const Scene& scene, const Snapshot& now, const Step& step, const Standings& stood,
           HandState& hand)
      : scene_(scene), now_(now), step_(step), stood_(stood), hand_(hand) {}

  std::string Resolve() {
    std::visit(*this, step_.action);
    return problem_;
  }
  /// The remark on this step; empty if there is none.
  const std::string& note() const { return note_; }

  void operator()(const WaitStep&) {}
  void operator()(const ReachStep& reach);
  void operator()(const TriggerStep& trigger);
  void operator()(const MoveStep& move) {
    if (step_.keep_upright.value_or(false)) TurnUpright(HeldBody());
    MoveBy(move.by_m, step_.over_s);
  }
  void operator()(const CarryStep& carry);
  void operator()(const PlaceStep& place);
  void operator()(const RetreatStep& retreat);
  void operator()(const FollowJointStep& follow);
  void operator()(const PosesStep& poses);
  void operator()(const TurnHandStep& turn);
  void operator()(const OrbitStep& orbit);
  void operator()(const PressStep& press);

 private:
  void MoveBy(const Eigen::Vector3d& by_m, double duration_s);
  /// The next MoveBy() turns the hand about the body's centre until the body stands as it stood.
  void TurnUpright(BodyIndex body);
  void Follow(const Segment& segment);
  void Follow(const std::vector<TimedPose>& poses);
  BodyIndex HeldBody() const;
  struct Landing {
    BodyIndex body;
    double height_m = 0, drop_m = 0;
    double mass_kg = 0;  ///< of all that is glued to it
  };
  /// Of what is held, and what is glued to it: straight down on the support.
  std::optional<Landing> FirstToLand(BodyIndex held, BodyIndex support) const;
  /// Of what it is to carry or to put down; what another hand has, it has lost, too.
  void NoteLoss(BodyIndex held) {
    if (!Touches(step_.hand, held, now_))
      note_ = "'" + scene_.hand(step_.hand).name + "' does not touch '" + scene_.body(held).name +
              "', which this step is to move: was that lost on the way? 'poses' tells where it is "
              "at each moment";
  }
  /// Where it is; a problem if there is no such thing.
  Pose PoseOf(const PoseFrame& frame);
  Pose InWorld(const Pose& X_FH, const PoseFrame& frame);

  const Scene& scene_;
  const Snapshot& now_;
  const Step& step_;
  const Standings& stood_;
  HandState& hand_;
  Pose turn_ = {};  ///< of what MoveBy() moves, in the world
  std::string problem_, note_;
};

void ScriptPlayer::Resolver::Follow(const Segment& segment) {
  hand_.motion = Trajectory(hand_.target);
  hand_.motion.Append(segment);
  hand_.target = hand_.motion.At(hand_.motion.duration_s());
}

void ScriptPlayer::Resolver::Follow(const std::vector<TimedPose>& poses) {
  hand_.turns_from = hand_.target.X_WH.q;
  hand_.motion = WaypointTrajectory(hand_.target, poses);
  hand_.target = hand_.motion.At(hand_.motion.duration_s());
}

void ScriptPlayer::Resolver::MoveBy(const Eigen::Vector3d& by_m, double duration_s) {
  Pose to = hand_.target.X_WH;
  if (turn_.q.w() != 1) to = turn_ * to;
  to.p_m += by_m;
  Follow(StraightSegment(hand_.target, to, duration_s));
}

void ScriptPlayer::Resolver::TurnUpright(BodyIndex body) {
  if (body == kNone || !At(stood_, body) || !Touches(step_.hand, body, now_)) return;
  const Pose& X_WB = now_.body(body).X_WB;
  const Eigen::Vector3d up_W = X_WB.q * At(stood_, body)->up_B;
  if (up_W.z() < kCosMostLean) return;
  const Eigen::Vector3d centre_W = X_WB * BoundingBox(scene_.body(body)).p_BC_m;
  const Eigen::Quaterniond turn = RotationBetween(up_W, Eigen::Vector3d::UnitZ());
  turn_ = {centre_W - turn * centre_W, turn};
}

void ScriptPlayer::Resolver::operator()(const ReachStep& reach) {
  const HandModel& model = scene_.hand(step_.hand).model;
  const BodyIndex object = FindBody(scene_, reach.object);
  const int style = FindStyle(model, reach.style);
  if (object == kNone) {
    problem_ = "reach: there is no entity '" + reach.object + "'";
  } else if (style < 0) {
    problem_ = "reach: hand '" + model.name + "' has no style '" + reach.style + "'";
  } else {
    const ReachQuery query{.hand = step_.hand,
                           .object = object,
                           .style = style,
                           .approach = reach.approach,
                           .offset_m = reach.offset_m,
                           .point_m = reach.point_m,
                           .from = hand_.target,
                           .over_s = step_.over_s};
    const ReachPlan plan = PlanReach(scene_, now_, query);
    hand_.style = style;
    hand_.object = object;
    hand_.let_go = false;
    hand_.came_along_W = plan.toward_W;
    note_ = NoteAboutReach(scene_, now_, query, plan);
    Follow(plan.segment);
  }
}

void ScriptPlayer::Resolver::operator()(const TriggerStep& trigger) {
  Segment segment = StraightSegment(hand_.target, hand_.target.X_WH, step_.over_s);
  segment.trigger_end = trigger.trigger;
  hand_.closes = trigger.trigger > hand_.target.trigger;
  if (!hand_.closes && hand_.object != kNone && Touches(step_.hand, hand_.object, now_))
    hand_.let_go = true;
  Follow(segment);
}

/// The body last reached for; without a reach, the movable body that is pressed most; or none.
BodyIndex ScriptPlayer::Resolver::HeldBody() const {
  if (hand_.object != kNone) return hand_.object;
  std::vector<double> impulse(scene_.bodies.size(), 0);
  for (const ContactPoint& contact : now_.contacts) {
    const ContactSide &body = contact.a.body != kNone ? contact.a : contact.b,
                      &hand = contact.a.body != kNone ? contact.b : contact.a;
    if (body.body == kNone || hand.hand != step_.hand || !MovesFreely(scene_, body.body)) continue;
    At(impulse, body.body) += contact.normal_impulse_n_s;
  }
  const auto most = std::max_element(impulse.begin(), impulse.end());
  return most == impulse.end() || *most <= 0 ? kNone : BodyIndex(most - impulse.begin());
}

void ScriptPlayer::Resolver::operator()(const CarryStep& carry) {
  Eigen::Vector3d centre = hand_.target.X_WH.p_m;
  if (const BodyIndex held = HeldBody(); held != kNone) {
    centre = now_.body(held).X_WB * BoundingBox(scene_.body(held)).p_BC_m;
    NoteLoss(held);
  }
  if (step_.keep_upright.value_or(false)) TurnUpright(HeldBody());
  MoveBy({carry.to_m.x() - centre.x(), carry.to_m.y() - centre.y(), 0}, step_.over_s);
}

std::optional<ScriptPlayer::Resolver::Landing> ScriptPlayer::Resolver::FirstToLand(
    BodyIndex held, BodyIndex support) const {
  std::optional<Landing> first;
  double mass_kg = 0;
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const BodyIndex part(i);
    if (RootOf(scene_, part) != RootOf(scene_, held)) continue;
    const Body& body = scene_.bodies[i];
    mass_kg += body.mass_kg;
    const Pose X_WB = turn_ * now_.body(part).X_WB;
    const std::optional<double> height_m =
        LandingHeight(scene_.body(support), now_.body(support).X_WB, body, X_WB);
    if (!height_m) continue;
    const double drop_m = WorldBounds(body, X_WB).min().z() - *height_m;
    if (!first || drop_m < first->drop_m) first = {part, *height_m, drop_m};
  }
  if (first) first->mass_kg = mass_kg;
  return first;
}

void ScriptPlayer::Resolver::operator()(const PlaceStep& place) {
  const BodyIndex held = HeldBody(), support = FindBody(scene_, place.support);
  if (support == kNone) {
    problem_ = "place_on: there is no entity '" + place.support + "'";
  } else if (held == kNone) {
    problem_ = "place_on: the hand holds nothing and has not reached for anything";
  } else {
    const Body& below = scene_.body(support);
    NoteLoss(held);
    if (step_.keep_upright.value_or(true)) TurnUpright(held);
    std::optional<Landing> lands = FirstToLand(held, support);
    if (!step_.keep_upright && lands &&
        !IsLevelAt(lands->height_m, below, now_.body(support).X_WB)) {
      turn_ = {};
      lands = FirstToLand(held, support);
    }
    if (!lands) {
      problem_ = "place_on: no part of '" + place.support + "' is below '" +
                 scene_.body(held).name + "'" +
                 (note_.empty() ? ": carry it there first" : "; " + note_);
      return;
    }
    const double stiffness = scene_.hand(step_.hand).model.translation.proportional;
    const double weight_n =
        lands->mass_kg * scene_.world.gravity_m_per_s2 / std::max(HandsOn(held, now_), 1);
    const double spring = std::min(weight_n / std::max(stiffness, 1.0), kMaxSpring_m);
    MoveBy({0, 0, -lands->drop_m - kPress_m - spring}, kLoweringShare * step_.over_s);
    hand_.placing = Placing{.body = lands->body, .support = support, .weight_n = weight_n};
  }
}

void ScriptPlayer::Resolver::operator()(const RetreatStep& retreat) {
  // A hand that never reached moves in the direction of its back.
  const bool came = !hand_.came_along_W.isZero();
  const Eigen::Vector3d back =
      came ? Eigen::Vector3d(-hand_.came_along_W) : hand_.target.X_WH.q * Eigen::Vector3d::UnitZ();
  MoveBy(back * retreat.by_m, step_.over_s);
}

void ScriptPlayer::Resolver::operator()(const PosesStep& poses) {
  if (!poses.style.empty()) {
    const HandModel& model = scene_.hand(step_.hand).model;
    hand_.style = FindStyle(model, poses.style);
    if (hand_.style < 0)
      problem_ = "poses: hand '" + model.name + "' has no style '" + poses.style + "'";
  }
  std::vector<TimedPose> in_world = poses.poses;
  for (std::size_t i = 0; i < poses.frames.size(); ++i)
    in_world[i].X_WH = InWorld(in_world[i].X_WH, poses.frames[i]);
  if (problem_.empty() && !in_world.empty()) Follow(in_world);
}

Pose ScriptPlayer::Resolver::InWorld(const Pose& X_FH, const PoseFrame& frame) {
  const Pose X_WF = PoseOf(frame);
  if (!frame.world_axes) return X_WF * X_FH;
  const Eigen::Quaterniond q = frame.own_hand ? X_FH.q * X_WF.q : X_FH.q;
  return {X_WF.p_m + X_FH.p_m, q.normalized()};
}

Pose ScriptPlayer::Resolver::PoseOf(const PoseFrame& frame) {
  if (frame.own_hand) return hand_.target.X_WH;
  if (frame.name.empty()) return {};
  if (const BodyIndex body = FindBody(scene_, frame.name); body != kNone)
    return now_.body(body).X_WB;
  for (std::size_t i = 0; i < scene_.hands.size(); ++i)
    if (scene_.hands[i].name == frame.name) return now_.hands[i].palm.X_WB;
  problem_ = "relative_to: there is no entity '" + frame.name + "'";
  return {};
}

void ScriptPlayer::Resolver::operator()(const FollowJointStep& follow) {
  const BodyIndex body = FindBody(scene_, follow.entity);
  const int index = body == kNone ? -1 : JointThatMoves(scene_, body);
  if (index < 0) {
    problem_ = "follow_joint: no joint moves '" + follow.entity + "'";
    return;
  }
  const Joint& joint = scene_.joints[static_cast<std::size_t>(index)];
  const Pose& X_WBase = now_.body(joint.base).X_WB;
  const double to = joint.lower + follow.to * (joint.upper - joint.lower);
  const double change = to - now_.joints[static_cast<std::size_t>(index)].position;
  std::vector<TimedPose> poses;
  for (int i = 1; i <= kJointWaypoints; ++i) {
    const double x = static_cast<double>(i) / kJointWaypoints;
    const Pose motion = MotionAlong(scene_, joint, X_WBase, MinimumJerk(x) * change);
    poses.push_back({.t_s = x * step_.over_s, .X_WH = motion * hand_.target.X_WH, .trigger = {}});
  }
  Follow(poses);
}

void ScriptPlayer::Resolver::operator()(const TurnHandStep& turn) {
  const double angle = turn.by_rad.norm();
  if (angle == 0) return;
  const int count = std::max(2, static_cast<int>(std::ceil(kTurnWaypoints * angle / (2 * M_PI))));
  const Pose& X_WH = hand_.target.X_WH;
  std::vector<TimedPose> poses;
  for (int i = 1; i <= count; ++i) {
    const double x = static_cast<double>(i) / count;
    const Eigen::Quaterniond by(
        Eigen::AngleAxisd(MinimumJerk(x) * angle, Eigen::Vector3d(turn.by_rad / angle)));
    const Eigen::Quaterniond q = turn.own_axes ? X_WH.q * by : by * X_WH.q;
    poses.push_back({.t_s = x * step_.over_s, .X_WH = {X_WH.p_m, q.normalized()}, .trigger = {}});
  }
  Follow(poses);
}

void ScriptPlayer::Resolver::operator()(const OrbitStep& orbit) {
  const BodyIndex body = FindBody(scene_, orbit.around);
  if (body == kNone) {
    problem_ = "orbit: there is no entity '" + orbit.around + "'";
    return;
  }
  const Eigen::Vector3d centre = now_.body(body).X_WB * BoundingBox(scene_.body(body)).p_BC_m;
  const Pose& X_WH = hand_.target.X_WH;
  const Eigen::Vector2d away = (X_WH.p_m - centre).head<2>();
  const double from_m = away.norm();
  if (from_m < 0.001) {
    problem_ = "orbit: the hand is above the centre of '" + orbit.around + "'";
    return;
  }
  const double to_m = orbit.at_m.value_or(from_m);
  const int count = std::max(
      8, static_cast<int>(std::ceil(kTurnWaypoints * std::abs(orbit.by_rad) / (2 * M_PI))));
  std::vector<TimedPose> poses;
  for (int i = 1; i <= count; ++i) {
    const double x = static_cast<double>(i) / count, share = MinimumJerk(x);
    const Eigen::Quaterniond by(Eigen::AngleAxisd(share * orbit.by_rad, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector2d out = away * ((from_m + share * (to_m - from_m)) / from_m);
    const Eigen::Vector3d offset =
        by * Eigen::Vector3d(out.x(), out.y(), X_WH.p_m.z() - centre.z());
    poses.push_back({.t_s = x * step_.over_s,
                     .X_WH = {centre + offset, (by * X_WH.q).normalized()},
                     .trigger = {}});
  }
  Follow(poses);
}

void ScriptPlayer::Resolver::operator()(const PressStep& press) {
  const BodyIndex body = FindBody(scene_, press.against);
  if (body == kNone) {
    problem_ = "press_n: there is no entity '" + press.against + "'";
    return;
  }
  hand_.pressing = Pressing{.against = body, .force_n = press.force_n, .along_W = press.along_W};
}

ScriptPlayer::ScriptPlayer(const Scene& scene, Script script)
    : scene_(scene), script_(std::move(script)), stood_(scene.bodies.size()) {
  const std::vector<int> styles = FirstStyles(scene_, script_);
  for (std::size_t i = 0; i < scene_.hands.size(); ++i) {
    HandState hand{.target = {.X_WH = scene_.hands[i].X_WH}, .style = styles[i]};
    hand.motion = Trajectory(hand.target);
    hands_.push_back(hand);
  }
}

std::vector<int> ScriptPlayer::FirstStyles(const Scene& scene, const Script& script) {
  std::vector<int> styles(scene.hands.size(), -1);
  for (const ScriptStage& stage : script.stages) {
    for (const Step& step : stage.steps) {
      const auto* reach = std::get_if<ReachStep>(&step.action);
      const auto* poses = std::get_if<PosesStep>(&step.action);
      const std::string style = reach ? reach->style : poses ? poses->style : std::string();
      int& first = At(styles, step.hand);
      if (!style.empty() && first < 0) first = FindStyle(scene.hand(step.hand).model, style);
    }
  }
  for (int& style : styles) style = std::max(style, 0);
  return styles;
}

void ScriptPlayer::Settle(HandState& hand) {
  if (hand.turns_from)
    hand.came_along_W = hand.target.X_WH.q * hand.turns_from->conjugate() * hand.came_along_W;
  hand.turns_from.reset();
  double& height_m = hand.target.X_WH.p_m.z();
  if (hand.placing) height_m = hand.placing->HeightOf(height_m);
  hand.placing.reset();
  if (hand.yielded) hand.target.X_WH = Yielded(hand.target.X_WH, *hand.yielded);
  hand.yielded.reset();
  hand.yields_m_per_s.setZero();
  hand.yields_rad_per_s.setZero();
  hand.waiting.reset();
  if (hand.pressing) hand.target.X_WH.p_m += hand.pressing->depth_m * hand.pressing->along_W;
  hand.pressing.reset();
  hand.begin_tick = hand.late_ticks = 0;
  hand.pace = 1;
  hand.behind_s = 0;
  hand.motion = Trajectory(hand.target);
}

void ScriptPlayer::StartStage() {
  for (HandState& hand : hands_) {
    Settle(hand);
    hand.step.reset();
  }
  tick_in_stage_ = late_ticks_ = 0;
  settling_ = stage_ == script_.stages.size();
  if (settling_) return;
  clock_ = StageClock(script_.stages[stage_++], scene_.world.rate_hz);
}

void ScriptPlayer::Progress(const Snapshot& now) {
  if (settling_ || stage_ == 0) return;
  for (bool changed = true; changed && problem_.empty();) {
    changed = EndSteps(now);
    changed |= StartSteps(now);
  }
  if (problem_.empty() && clock_.IsStuck())
    Fail(HandIndex(0), "the steps of a stage wait for each other");
}

bool ScriptPlayer::StartSteps(const Snapshot& now) {
  const std::size_t hands_steps = script_.stages[stage_ - 1].steps.size();
  const std::vector<std::size_t> turns = clock_.TakeTurns(tick_in_stage_);
  const std::vector<std::size_t> starts = clock_.TakeBegun(tick_in_stage_);
  BegunSteps begun{.stage = stage_ - 1, .steps = {}, .person_steps = {}};
  for (const std::size_t step : turns)
    if (step < hands_steps) begun.steps.push_back(step);
  for (const std::size_t step : starts) {
    if (!problem_.empty()) break;
    if (step < hands_steps)
      StartStep(step, now);
    else
      begun.person_steps.push_back(step - hands_steps);
  }
  if (!begun.steps.empty() || !begun.person_steps.empty()) begun_.push_back(std::move(begun));
  return !turns.empty() || !starts.empty();
}

/// In an ordered stage steps end one by one.
bool ScriptPlayer::EndSteps(const Snapshot& now) {
  if (!clock_.is_ordered()) return false;
  const ScriptStage& stage = script_.stages[stage_ - 1];
  bool changed = false;
  for (std::size_t i = 0; i < stage.steps.size() + stage.person_steps.size(); ++i) {
    if (!clock_.Plays(i) || tick_in_stage_ < clock_.EndOf(i)) continue;
    if (i < stage.steps.size()) {
      const std::size_t h = stage.steps[i].hand.index();
      if (Waits(h, hands_[h].late_ticks)) {
        ++hands_[h].late_ticks;
        clock_.SetEnd(i, tick_in_stage_ + 1);
        continue;
      }
      CheckThatItStands(h, now);
      if (problem_.empty()) CheckGuard(h, now);
      NoteTheGrip(h, now);
      NoteTheWay(h, now);
      Settle(hands_[h]);
    }
    clock_.Finish(i);
    changed = true;
  }
  return changed;
}

bool ScriptPlayer::EndStage(const Snapshot& now) {
  if (settling_) return false;
  const std::optional<std::int64_t> end = clock_.End();
  if (!end || tick_in_stage_ < *end + late_ticks_) return false;
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    if (clock_.is_ordered() || !Waits(h, late_ticks_)) continue;
    ++late_ticks_;
    return false;
  }
  for (std::size_t h = 0; h < hands_.size() && !clock_.is_ordered() && problem_.empty(); ++h)
    CheckThatItStands(h, now);
  for (std::size_t h = 0; h < hands_.size() && !clock_.is_ordered() && problem_.empty(); ++h)
    CheckGuard(h, now);
  for (std::size_t h = 0; h < hands_.size() && !clock_.is_ordered(); ++h) {
    NoteTheGrip(h, now);
    NoteTheWay(h, now);
  }
  return problem_.empty();
}

std::int64_t ScriptPlayer::PlannedEnd(const HandState& hand) const {
  if (clock_.is_ordered() && hand.step) return clock_.EndOf(*hand.step) - hand.late_ticks;
  return clock_.End().value_or(std::numeric_limits<std::int64_t>::max());
}

void ScriptPlayer::StartStep(std::size_t index, const Snapshot& now) {
  const Step& step = script_.stages[stage_ - 1].steps[index];
  HandState& hand = At(hands_, step.hand);
  Settle(hand);
  hand.step = index;
  hand.begin_tick = clock_.BeginOf(index);
  hand.written_at = step.written_at;
  if (step.until) {
    hand.waiting = Waiting{.until = *step.until, .thing = FindBody(scene_, step.until->thing)};
    if (hand.waiting->thing == kNone)
      return Fail(step.hand, "until: there is no entity '" + step.until->thing + "'");
  }
  Resolver resolver(scene_, now, step, stood_, hand);
  problem_ = resolver.Resolve();
  const bool grips = std::holds_alternative<TriggerStep>(step.action);
  hand.took = hand.took && (grips || std::holds_alternative<WaitStep>(step.action));
  const bool reaches = std::holds_alternative<ReachStep>(step.action);
  if ((grips && hand.closes) || reaches) RememberHowItStands(hand, now);
  hand.took = hand.took && !reaches;
  if (!resolver.note().empty()) notes_.push_back({now.tick, step.hand, resolver.note()});
  if (!problem_.empty()) Fail(step.hand, std::string(problem_));
}

double ScriptPlayer::MotionTime(const HandState& hand) const {
  return static_cast<double>(tick_in_stage_ - hand.begin_tick) / scene_.world.rate_hz -
         hand.behind_s;
}

TargetState ScriptPlayer::TargetOf(const HandState& hand) const {
  TargetState target = hand.motion.At(MotionTime(hand));
  if (hand.yielded) target.X_WH = Yielded(target.X_WH, *hand.yielded);
  target.v_m_per_s = target.v_m_per_s * hand.pace + hand.yields_m_per_s;
  target.w_rad_per_s = target.w_rad_per_s * hand.pace + hand.yields_rad_per_s;
  return target;
}

void ScriptPlayer::Fail(HandIndex hand, const std::string& problem) {
  const std::string written_at = hand == kNone ? "" : At(hands_, hand).written_at;
  problem_ = written_at.empty() ? problem : written_at + ": " + problem;
  problem_hand_ = hand;
}

const std::vector<HandCommand>* ScriptPlayer::Advance(const Snapshot& now) {
  commands_.clear();
  begun_.clear();
  Watch(now);
  WatchGuards(now);
  WatchPersons(now);
  Press(now);
  GiveWay(now);
  WithdrawNotes(now);
  Progress(now);
  while (problem_.empty() && EndStage(now)) {
    StartStage();
    Progress(now);
  }
  const std::int64_t settle_ticks = std::llround(script_.settle_s * scene_.world.rate_hz);
  if (!problem_.empty() || (settling_ && tick_in_stage_ == settle_ticks)) return nullptr;
  ++tick_in_stage_;
  for (const HandState& hand : hands_) {
    HandCommand& command = commands_.emplace_back(HandCommand{TargetOf(hand), hand.style});
    if (hand.lets_go) command.lets_go_to = hand.target.trigger;
    double& height_m = command.target.X_WH.p_m.z();
    if (hand.placing) height_m = hand.placing->HeightOf(height_m);
    if (hand.pressing) command.target.X_WH.p_m += hand.pressing->depth_m * hand.pressing->along_W;
  }
  return &commands_;
}

}  // namespace prehend::physics
