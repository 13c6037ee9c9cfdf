// SPDX-License-Identifier: Apache-2.0
// The head approaches the eyes' direction exponentially.
#include "physics/person/gaze.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/motion/trajectory.h"
#include "physics/person/skeleton.h"
#include "physics/scene/geometry.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

constexpr double kSaccadeBase_s = 0.021;
constexpr double kSaccade_s_per_deg = 0.0022;
/// A target that moves by more than this within one tick counts as a new one.
constexpr double kSaccadeFrom_deg = 2;
/// Time after which the head has covered 63 % of its way.
constexpr double kHeadLag_s = 0.15;
/// In yaw, and in pitch.
constexpr double kHeadFastest_rad_per_s = 600 * std::numbers::pi / 180;

double AngleDeg(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

double YawOf(const Vector3d& way) { return std::atan2(way.y(), way.x()); }
double PitchOf(const Vector3d& way) { return std::asin(std::clamp(way.z(), -1.0, 1.0)); }

Vector3d Direction(double yaw, double pitch) {
  return {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
}

/// Eyes alone look so steeply; the head keeps its yaw.
bool IsSteep(const Vector3d& way) { return std::abs(way.z()) > kSteepestHead; }

/// The shorter way round; to the left if both are as long. 0 straight up and down.
double YawBetween(const Vector3d& from, const Vector3d& to) {
  const double way =
      std::atan2(from.x() * to.y() - from.y() * to.x(), from.head<2>().dot(to.head<2>()));
  return way > 1e-9 - std::numbers::pi ? way : std::numbers::pi;
}

/// A share of the way: straight, or, to what is behind, around by this yaw.
Vector3d Between(const Vector3d& from, const Vector3d& to, double yaw, double share) {
  if (std::abs(yaw) > std::numbers::pi / 2)
    return Direction(YawOf(from) + share * yaw, std::lerp(PitchOf(from), PitchOf(to), share));
  const Eigen::Quaterniond turn = RotationBetween(from, to);
  return (Eigen::Quaterniond::Identity().slerp(share, turn) * from).normalized();
}

}  // namespace

std::optional<Vector3d> PointOf(const GazeTarget& target, const Scene& scene, const Snapshot& now) {
  switch (target.kind) {
    case GazeTarget::Kind::kAhead:
      return std::nullopt;
    case GazeTarget::Kind::kBody:
      return now.body(target.body).X_WB * BoundingBox(scene.body(target.body)).p_BC_m;
    case GazeTarget::Kind::kHand:
      return now.hand(target.hand).palm.X_WB.p_m;
    case GazeTarget::Kind::kPoint:
      return target.p_W_m;
  }
  return std::nullopt;
}

std::optional<TargetSeen> TargetInSight(const Scene& scene, const GazeState& gaze,
                                        const SightLine& line) {
  std::optional<TargetSeen> seen;
  double nearest_m = gaze.body == kNone && gaze.hand == kNone ? line.length_m : gaze.distance_m;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.abstract != Abstract::kGazeTarget) continue;
    const double reach_m = std::get<Sphere>(body.shapes.front().shape).radius_m + line.radius_m;
    const Vector3d way = body.X_WB.p_m - gaze.p_WE_m;
    const double along_m = way.dot(gaze.toward_W), beside2 = way.squaredNorm() - along_m * along_m;
    if (along_m < 0 || beside2 > reach_m * reach_m) continue;
    const double distance_m =
        std::max(0.0, along_m - std::sqrt(reach_m * reach_m - std::max(0.0, beside2)));
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    seen = TargetSeen{BodyIndex(i), distance_m};
  }
  return seen;
}

GazeLeader::GazeLeader(const Scene& scene, const Script& script, const Person& person)
    : scene_(scene), script_(script), person_(person), reached_(scene.hands.size()) {}

void GazeLeader::Begin(std::size_t stage, const std::vector<std::size_t>& steps,
                       const Snapshot& now) {
  // The right hand first: she looks at one of two hands that do different things.
  for (const HandIndex hand : {person_.right_hand, person_.left_hand}) {
    for (const std::size_t index : steps) {
      if (hand == kNone || script_.stages[stage].steps[index].hand != hand) continue;
      if (const auto target = TargetOf(stage, index, now)) {
        target_ = *target;
        return;
      }
    }
  }
}

/// Nullopt if the step gives no target: then the eyes stay.
std::optional<GazeTarget> GazeLeader::TargetOf(std::size_t stage, std::size_t index,
                                               const Snapshot& now) {
  const Step& step = script_.stages[stage].steps[index];
  BodyIndex& reached = At(reached_, step.hand);
  const auto body = [](BodyIndex target) {
    return GazeTarget{.kind = GazeTarget::Kind::kBody, .body = target};
  };
  const auto moved = [&] {
    return reached != kNone ? body(reached)
                            : GazeTarget{.kind = GazeTarget::Kind::kHand, .hand = step.hand};
  };
  using Target = std::optional<GazeTarget>;
  return std::visit(
      Overloaded{[&](const ReachStep& reach) -> Target {
                   reached = FindBody(scene_, reach.object);
                   return body(reached);
                 },
                 [&](const CarryStep& carry) -> Target {
                   const auto place = LandingPlace(carry, stage, index, now);
                   if (!place) return moved();
                   return GazeTarget{.kind = GazeTarget::Kind::kPoint, .p_W_m = *place};
                 },
                 [](const RetreatStep&) -> Target { return GazeTarget{}; },
                 [](const OneOf<WaitStep, PlaceStep> auto&) -> Target { return std::nullopt; },
                 [&](const OneOf<TriggerStep, MoveStep, FollowJointStep, PosesStep, TurnHandStep,
                                 OrbitStep, PressStep> auto&) -> Target { return moved(); }},
      step.action);
}

/// The place on the support of the next put-down; nullopt if none follows.
std::optional<Vector3d> GazeLeader::LandingPlace(const CarryStep& carry, std::size_t stage,
                                                 std::size_t index, const Snapshot& now) const {
  const HandIndex hand = script_.stages[stage].steps[index].hand;
  for (std::size_t later = stage; later < script_.stages.size(); ++later) {
    const std::vector<Step>& steps = script_.stages[later].steps;
    for (std::size_t i = later == stage ? index + 1 : 0; i < steps.size(); ++i) {
      const auto* place = std::get_if<PlaceStep>(&steps[i].action);
      const BodyIndex support =
          place && steps[i].hand == hand ? FindBody(scene_, place->support) : kNone;
      if (support == kNone) continue;
      const double top = WorldBounds(scene_.body(support), now.body(support).X_WB).max().z();
      return Vector3d(carry.to_m.x(), carry.to_m.y(), top);
    }
  }
  return std::nullopt;
}

void EyesAndHead::Set(const Vector3d& toward_W) {
  eyes_W_ = head_W_ = from_W_ = toward_W;
  saccade_s_ = 0;
}

void EyesAndHead::Turn(const Vector3d& wanted_W, double dt_s) {
  if (saccade_s_ == 0) {
    const double way_deg = AngleDeg(eyes_W_, wanted_W);
    if (way_deg > kSaccadeFrom_deg) {
      saccade_s_ = kSaccadeBase_s + kSaccade_s_per_deg * way_deg;
      since_s_ = 0;
      from_W_ = eyes_W_;
      yaw_ = IsSteep(from_W_) || IsSteep(wanted_W) ? 0 : YawBetween(from_W_, wanted_W);
    }
  }
  since_s_ += dt_s;
  if (saccade_s_ > 0 && since_s_ < saccade_s_) {
    // Round the same side, though her eyes move with her head past what is straight behind.
    if (std::abs(yaw_) > std::numbers::pi / 2)
      yaw_ += std::remainder(YawBetween(from_W_, wanted_W) - yaw_, 2 * std::numbers::pi);
    eyes_W_ = Between(from_W_, wanted_W, yaw_, MinimumJerk(since_s_ / saccade_s_));
  } else {
    saccade_s_ = 0;
    eyes_W_ = wanted_W;
  }
  TurnHead(dt_s);
}

void EyesAndHead::TurnHead(double dt_s) {
  const Vector3d to_W =
      IsSteep(eyes_W_)
          ? Direction(YawOf(head_W_), std::copysign(std::asin(kSteepestHead), eyes_W_.z()))
          : eyes_W_;
  const double yaw = YawBetween(head_W_, to_W);
  const Vector3d next_W = Between(head_W_, to_W, yaw, 1 - std::exp(-dt_s / kHeadLag_s));
  const double most = kHeadFastest_rad_per_s * dt_s;
  const double yaw_step = YawBetween(head_W_, next_W);
  const double pitch_step = PitchOf(next_W) - PitchOf(head_W_);
  if (std::max(std::abs(yaw_step), std::abs(pitch_step)) <= most)
    head_W_ = next_W;
  else
    head_W_ = Direction(YawOf(head_W_) + std::clamp(yaw_step, -most, most),
                        PitchOf(head_W_) + std::clamp(pitch_step, -most, most));
}

}  // namespace prehend::physics
