// SPDX-License-Identifier: Apache-2.0
// Motions start at stages of the script; every tick turns them into body targets and these into
// poses.
#include "physics/person/person_player.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "physics/motion/trajectory.h"
#include "physics/scene/geometry.h"

namespace prehend::physics {

using Eigen::Vector3d;

namespace {

/// What would go deeper into a fixed thing within a tick is stopped.
constexpr double kDeeper_m = 1e-7;

}  // namespace

double PersonPlayer::Motion::At(double t_s) const {
  if (duration_s <= 0) return to;
  return from + (to - from) * MinimumJerk((t_s - begin_s) / duration_s);
}

/// Starts the motion of one step.
class PersonPlayer::Resolver {
 public:
  Resolver(PersonPlayer& player, double over_s) : player_(player), over_s_(over_s) {}

  void operator()(const WaitStep&) {}
  void operator()(const LookAtStep& look) {
    if (const auto* name = std::get_if<std::string>(&look.target)) {
      const BodyIndex body = FindBody(player_.scene_, *name);
      player_.told_ = GazeTarget{.kind = GazeTarget::Kind::kBody, .body = body};
      for (std::size_t i = 0; i < player_.scene_.hands.size(); ++i) {
        if (player_.scene_.hands[i].name == *name)
          player_.told_ = GazeTarget{.kind = GazeTarget::Kind::kHand, .hand = HandIndex(i)};
      }
    } else {
      player_.told_ =
          GazeTarget{.kind = GazeTarget::Kind::kPoint, .p_W_m = std::get<Vector3d>(look.target)};
    }
  }
  void operator()(const EyesStep& step) {
    player_.eyes_ = step.eyes;
    player_.told_ = std::nullopt;
  }
  void operator()(const WalkStep& walk) {
    Start(player_.x_, walk.to_m.x(), player_.walk_.behind_s);
    Start(player_.y_, walk.to_m.y(), player_.walk_.behind_s);
    player_.walk_ = {.max_force_n = walk.max_force_n};
  }
  void operator()(const TurnStep& turn) { Start(player_.yaw_, turn.to_rad); }
  void operator()(const LeanStep& lean) { Start(player_.lean_, lean.to_rad); }
  void operator()(const SwayStep& sway) {
    Start(player_.sway_ahead_, sway.by_m.x());
    Start(player_.sway_left_, sway.by_m.y());
  }
  void operator()(const MoveLimbStep& move) {
    const Pose X_SW = player_.targets_.X_WS.inverse();
    LimbMotion& limb = player_.limbs_[static_cast<std::size_t>(LimbOf(move.limb))];
    limb.end = move.limb;
    limb.from_S_m = X_SW * PlaceOf(move.limb, player_.person_, player_.targets_);
    if (LimbOf(move.limb) < 2)
      limb.forearm_S = X_SW.q * ForearmOf(move.limb, player_.person_, player_.targets_);
    limb.to_rest = !move.to_m;
    if (move.to_m) limb.to_S_m = X_SW * *move.to_m;
    limb.progress = {0, 1, player_.t_s_, over_s_};
    limb.yielding = {.max_force_n = move.max_force_n};
  }
  void operator()(const HeadPosesStep& head) {
    const TargetState from{.X_WH = player_.targets_.X_WHead};
    player_.head_ = {WaypointTrajectory(from, head.poses), player_.t_s_};
    player_.head_leaving_.reset();
    if (head.poses.front().t_s <= 0) player_.jumping_ = std::max<std::size_t>(player_.jumping_, 1);
  }
  void operator()(const BodyPosesStep& body) {
    const Posture from = PostureOf(player_.person_, player_.targets_);
    const double join_s = body.postures.front().t_s;
    player_.body_ = RecordedBody{PostureTrack(from, body.postures), player_.t_s_};
    player_.leaving_.reset();
    if (player_.head_leaving_) player_.head_leaving_->progress.duration_s = join_s;
    if (join_s <= 0) player_.jumping_ = player_.places_.size();
  }

 private:
  void Start(Motion& motion, double to, double behind_s = 0) {
    motion = {motion.At(player_.t_s_ - behind_s), to, player_.t_s_, over_s_};
  }

  PersonPlayer& player_;
  double over_s_;
};

PersonPlayer::PersonPlayer(const Scene& scene, const Script& script, int person)
    : scene_(scene),
      script_(script),
      person_(scene.persons[static_cast<std::size_t>(person)]),
      fixed_(scene),
      index_(person),
      targets_(Standing(scene, person_)),
      places_(PlacesOf(person_, targets_, {})),
      leader_(scene, script, person_),
      eyes_(person_.eyes),
      gaze_(targets_.X_WHead.q * Vector3d::UnitX()) {
  const Vector3d ahead = person_.X_WS.q * Vector3d::UnitX();
  x_.to = person_.X_WS.p_m.x();
  y_.to = person_.X_WS.p_m.y();
  yaw_.to = std::atan2(ahead.y(), ahead.x());
  for (int limb = 0; limb < 4; ++limb)
    limbs_[static_cast<std::size_t>(limb)].end = RestOf(limb, person_, targets_).end;
}

void PersonPlayer::Begin(std::size_t stage, const std::vector<std::size_t>& hands_steps,
                         const std::vector<std::size_t>& person_steps, const Snapshot& now) {
  leader_.Begin(stage, hands_steps, now);
  for (const std::size_t index : person_steps) {
    const PersonStep& step = script_.stages[stage].person_steps[index];
    if (step.person != index_) continue;
    if (head_ && !person_.has_body) StandBelowHead();
    if (head_ || body_) {
      const Pose& X_WHead = targets_.X_WHead;
      head_leaving_ = {{X_WHead.p_m - NeckTop(person_, targets_), X_WHead.q},
                       {0, 1, t_s_, step.over_s}};
    }
    head_.reset();
    if (body_) {
      leaving_ = Leaving{*targets_.posture, {0, 1, t_s_, step.over_s}};
      body_.reset();
    }
    Resolver resolver(*this, step.over_s);
    std::visit(resolver, step.action);
  }
}

BodyTargets::Limb PersonPlayer::LimbAt(int limb, const Snapshot& now) const {
  const HandIndex hand = HandAt(limb, person_);
  const BodyTargets::Limb rest = RestOf(limb, person_, targets_);
  if (hand != kNone) {
    const Pose& X_WH = now.hand(hand).palm.X_WB;
    return {rest.end, X_WH * WristInHand(person_, scene_.hand(hand).model)};
  }
  const LimbMotion& motion = limbs_[static_cast<std::size_t>(limb)];
  const double progress =
      motion.progress.duration_s > 0 ? motion.progress.At(t_s_ - motion.yielding.behind_s) : 1;
  if (motion.to_rest && progress == 1) return rest;
  Vector3d to_W = targets_.X_WS * motion.to_S_m;
  Vector3d forearm_W = FoldedForearm(motion.end, targets_.X_WS);
  if (motion.to_rest) {
    BodyTargets resting = targets_;
    resting.limbs[static_cast<std::size_t>(limb)] = rest;
    to_W = PlaceOf(motion.end, person_, resting);
    if (limb < 2) forearm_W = ForearmOf(motion.end, person_, resting);
  }
  const Vector3d from_W = targets_.X_WS * motion.from_S_m;
  const Eigen::Quaterniond turn = RotationBetween(targets_.X_WS.q * motion.forearm_S, forearm_W);
  const Eigen::Quaterniond turned = Eigen::Quaterniond::Identity().slerp(progress, turn);
  return {motion.end, from_W + progress * (to_W - from_W),
          turned * (targets_.X_WS.q * motion.forearm_S)};
}

double PersonPlayer::ResistanceTo(int limb, const Snapshot& now) const {
  const LimbMotion& motion = limbs_[static_cast<std::size_t>(limb)];
  const PartRange parts = PartsOfLimb(person_, limb);
  return ResistanceTo(parts.begin, parts.end,
                      targets_.X_WS * motion.to_S_m - targets_.X_WS * motion.from_S_m, now);
}

double PersonPlayer::ResistanceToWalk(const Snapshot& now) const {
  return ResistanceTo(0, static_cast<int>(places_.size()), {x_.to - x_.from, y_.to - y_.from, 0},
                      now);
}

double PersonPlayer::ResistanceTo(int begin, int end, const Vector3d& way,
                                  const Snapshot& now) const {
  if (way.norm() < 1e-6) return 0;
  const auto is_part = [&](const ContactSide& side) {
    return side.body >= person_.head + begin && side.body < person_.head + end;
  };
  double against_n_s = 0;
  for (const ContactPoint& contact : now.contacts) {
    const double into_a = is_part(contact.a) ? 1 : is_part(contact.b) ? -1 : 0;
    against_n_s -= into_a * contact.normal_impulse_n_s * contact.nhat_BA_W.dot(way.normalized());
  }
  return std::max(0.0, against_n_s) * scene_.world.rate_hz;
}

void PersonPlayer::Yield(Yielding& motion, double resistance_n) const {
  // Resistance in the solver grows with speed, so the pace is divided by the excess. It then grows
  // back exponentially from where it was: a resistance that was met at a slow pace is met at a slow
  // pace again. It begins again so slowly that what stays is not moved by all that she tries.
  constexpr double kGrow_s = 0.1, kMinPace = 1e-5;
  const double dt_s = 1.0 / scene_.world.rate_hz;
  if (!motion.max_force_n) return;
  motion.pace = resistance_n > *motion.max_force_n
                    ? motion.pace * *motion.max_force_n / resistance_n
                    : std::min(1.0, std::max(motion.pace, kMinPace) * (1 + dt_s / kGrow_s));
  motion.behind_s += (1 - motion.pace) * dt_s;
}

void PersonPlayer::StandBelow(const Posture& posture) {
  const auto rest = [](double at) { return Motion{at, at, 0, 0}; };
  const Vector3d& left = posture.directions_W[Posture::kAcrossHips];
  x_ = rest(posture.hips_W_m.x());
  y_ = rest(posture.hips_W_m.y());
  if (std::hypot(left.x(), left.y()) > 1e-6) yaw_ = rest(std::atan2(-left.x(), left.y()));
  lean_ = sway_ahead_ = sway_left_ = rest(0);
  for (int limb = 0; limb < 4; ++limb)
    limbs_[static_cast<std::size_t>(limb)] = LimbMotion{.end = RestOf(limb, person_, targets_).end};
}

void PersonPlayer::StandBelowHead() {
  const Pose& X_WHead = targets_.X_WHead;
  const Vector3d ahead = X_WHead.q * Vector3d::UnitX();
  if (std::hypot(ahead.x(), ahead.y()) > 1e-6)
    yaw_ = Motion{.to = std::atan2(ahead.y(), ahead.x())};
  AimStance();
  const Vector3d by_m = X_WHead.p_m - HeadToward(person_, NeckTop(person_, targets_), ahead).p_m;
  x_ = Motion{.to = targets_.X_WS.p_m.x() + by_m.x()};
  y_ = Motion{.to = targets_.X_WS.p_m.y() + by_m.y()};
  AimStance();
}

void PersonPlayer::HoldPosture() {
  if (body_) {
    const Posture posture = body_->track.At(t_s_ - body_->begin_s);
    StandBelow(posture);
    targets_.posture = posture;
  } else if (leaving_) {
    const double share = leaving_->progress.At(t_s_);
    if (share < 1)
      targets_.posture = Mix(leaving_->from, PostureOf(person_, targets_), share);
    else
      leaving_.reset();
  }
}

void PersonPlayer::TurnHead(const Snapshot& now) {
  if (body_) {
    targets_.X_WHead = HeadOfPosture(person_, targets_);
    LeaveRecordedHead();
    gaze_.Set(targets_.X_WHead.q * Vector3d::UnitX());
    return;
  }
  if (head_) {
    targets_.X_WHead = head_->first.At(t_s_ - head_->second).X_WH;
    gaze_.Set(targets_.X_WHead.q * Vector3d::UnitX());
    return;
  }
  const GazeTarget target = told_ ? *told_ : eyes_ == Eyes::kLead ? leader_.target() : GazeTarget{};
  Vector3d toward = targets_.X_WS.q * Vector3d::UnitX();
  if (const auto point = PointOf(target, scene_, now)) {
    const Vector3d way = *point - EyesOf(person_, targets_.X_WHead);
    if (way.norm() > 1e-3) toward = way.normalized();
  }
  gaze_.Turn(toward, 1.0 / scene_.world.rate_hz);
  targets_.X_WHead = HeadToward(person_, NeckTop(person_, targets_), gaze_.head_W());
  LeaveRecordedHead();
}

void PersonPlayer::LeaveRecordedHead() {
  if (!head_leaving_) return;
  const double share = head_leaving_->progress.At(t_s_);
  if (share >= 1) return head_leaving_.reset();
  const Vector3d neck = NeckTop(person_, targets_);
  const Pose &from = head_leaving_->from, &to = targets_.X_WHead;
  targets_.X_WHead = {neck + from.p_m + share * (to.p_m - neck - from.p_m),
                      from.q.slerp(share, to.q).normalized()};
}

void PersonPlayer::AimStance() {
  const double walk_s = t_s_ - walk_.behind_s;
  targets_.X_WS = {{x_.At(walk_s), y_.At(walk_s), person_.X_WS.p_m.z()},
                   Eigen::Quaterniond(Eigen::AngleAxisd(yaw_.At(t_s_), Vector3d::UnitZ()))};
  targets_.lean_rad = lean_.At(t_s_);
  targets_.sway_m = {sway_ahead_.At(t_s_), sway_left_.At(t_s_)};
}

void PersonPlayer::AimLimbs(const Snapshot& now) {
  for (int limb = 0; limb < 4; ++limb)
    targets_.limbs[static_cast<std::size_t>(limb)] = LimbAt(limb, now);
}

std::vector<PersonPlayer::Yielding*> PersonPlayer::WhatGoesIntoFixed() {
  std::vector<Yielding*> motions;
  const auto yields = [](const LimbMotion& limb) { return limb.yielding.max_force_n.has_value(); };
  if (body_ || leaving_ || (!walk_.max_force_n && std::ranges::none_of(limbs_, yields))) return {};
  for (const FixedTouch& touch : fixed_.TouchedBy(person_, PlacesOf(person_, targets_, places_))) {
    const auto before = std::ranges::find_if(touches_, [&](const FixedTouch& old) {
      return old.part == touch.part && old.thing == touch.thing;
    });
    const double before_m = before == touches_.end() ? 0 : std::max(before->depth_m, 0.0);
    if (touch.depth_m <= before_m + kDeeper_m) continue;
    bool follows_hand = false;
    for (int i = 0; i < 4; ++i) {
      const PartRange parts = PartsOfLimb(person_, i);
      if (touch.part < parts.begin || touch.part >= parts.end) continue;
      follows_hand = HandAt(i, person_) != kNone;
      LimbMotion& limb = limbs_[static_cast<std::size_t>(i)];
      if (yields(limb)) motions.push_back(&limb.yielding);
    }
    if (walk_.max_force_n && !follows_hand) motions.push_back(&walk_);
  }
  return motions;
}

void PersonPlayer::StopBeforeFixed(const Snapshot& now) {
  // Halved so often, a step of 30 mm is known to less than what touches. At the pace at which she
  // tries again a whole step is.
  constexpr int kHalvings = 10;
  constexpr double kFast = 0.02;
  struct Stopped {
    double behind_s, step_s;
  };
  std::map<Yielding*, Stopped> stopped;
  for (Yielding* motion : WhatGoesIntoFixed())
    stopped[motion] = {motion->behind_s, motion->pace / scene_.world.rate_hz};
  if (stopped.empty()) return;
  const auto go = [&](double share) {
    for (const auto& [motion, was] : stopped)
      motion->behind_s = was.behind_s + (1 - share) * was.step_s;
    AimStance();
    AimLimbs(now);
  };
  const bool is_fast =
      std::ranges::any_of(stopped, [](const auto& each) { return each.first->pace > kFast; });
  double free = 0, share = 0.5;
  for (int i = 0; is_fast && i < kHalvings; ++i, share /= 2) {
    go(free + share);
    if (WhatGoesIntoFixed().empty()) free += share;
  }
  go(free);
  for (const auto& [motion, was] : stopped) motion->pace = 0;
}

void PersonPlayer::Advance(const Snapshot& now, World& world) {
  t_s_ = static_cast<double>(++tick_) / scene_.world.rate_hz;
  targets_.posture.reset();
  if (walk_.max_force_n) Yield(walk_, ResistanceToWalk(now));
  AimStance();
  for (int limb = 0; limb < 4; ++limb) {
    Yielding& yielding = limbs_[static_cast<std::size_t>(limb)].yielding;
    if (yielding.max_force_n) Yield(yielding, ResistanceTo(limb, now));
  }
  AimLimbs(now);
  StopBeforeFixed(now);
  HoldPosture();
  TurnHead(now);
  places_ = PlacesOf(person_, targets_, places_);
  touches_ = fixed_.TouchedBy(person_, places_);
  for (std::size_t i = 0; i < places_.size(); ++i)
    world.MoveKinematic(person_.head + static_cast<int>(i), places_[i], i < jumping_);
  jumping_ = 0;
}

double PersonPlayer::LimbIsShortBy(int limb) const {
  const auto index = static_cast<std::size_t>(limb);
  const HandIndex hand = HandAt(limb, person_);
  const bool is_led = hand != kNone || (!limbs_[index].to_rest && !targets_.posture);
  if (!person_.has_body || !is_led) return 0;
  const BodyTargets::Limb& target = targets_.limbs[index];
  return (target.p_W_m - PlaceOf(target.end, person_, targets_)).norm();
}

double PersonPlayer::HeadIsOffBy() const {
  if (!head_ || !person_.has_body) return 0;
  const Vector3d over_neck_m = HeadToward(person_, Vector3d::Zero(), Vector3d::UnitX()).p_m;
  return (targets_.X_WHead * -over_neck_m - NeckTop(person_, targets_)).norm();
}

GazeState PersonPlayer::See(const World& world) const {
  GazeState gaze{.p_WE_m = EyesOf(person_, targets_.X_WHead), .toward_W = gaze_.eyes_W()};
  const Sight sight = world.Look({.from_W_m = gaze.p_WE_m,
                                  .toward_W = gaze.toward_W,
                                  .ignore_from = person_.head,
                                  .ignore_to = person_.head + static_cast<int>(places_.size())});
  gaze.body = sight.body;
  gaze.hand = sight.hand;
  gaze.distance_m = sight.distance_m;
  if (const auto target = TargetInSight(scene_, gaze))
    gaze.body = target->body, gaze.hand = kNone, gaze.distance_m = target->distance_m;
  return gaze;
}

}  // namespace prehend::physics
