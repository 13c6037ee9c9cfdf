// SPDX-License-Identifier: Apache-2.0
// Arms and legs are solved in closed form: two bones and the law of cosines.
#include "physics/person/skeleton.h"

#include <algorithm>
#include <cmath>

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

// Shares of the body height: levels of a standing person, lengths of limbs, half breadths, radii.
constexpr double kAnkle = 0.039, kHip = 0.530, kShoulder = 0.818, kNeckTop = 0.870;
constexpr double kThigh = 0.245, kShank = 0.246, kUpperArm = 0.186, kForearm = 0.146, kPalm = 0.108;
constexpr double kHalfShoulders = 0.129, kHalfHips = 0.050;
constexpr double kForearmRadius = 0.020;
constexpr double kHeadCentre = 0.065;  // above the top of the neck
constexpr double kHeadRadius = 0.050, kHeadLength = 0.030, kEyesAhead = 0.045, kEyesUp = 0.005;
constexpr double kFootLength = 0.090, kToesLength = 0.035, kHeel = 0.035;  // heel: behind the ankle
constexpr double kSole = 0.020;  // axis of the foot over the floor

/// A capsule between two points, by name.
struct Bone {
  const char* name;
  double radius;  ///< share of the height
  Vector3d lower_W_m, upper_W_m;
};

double Side(bool right) { return right ? -1 : 1; }

/// The points and directions that limbs and head are attached to.
struct Torso {
  Vector3d hips;      ///< midway between the hip joints
  Vector3d trunk_up;  ///< from there to midway between the shoulders, unit
  Vector3d neck_up, hips_left, shoulders_left;
};

/// Position of the hips: shifted sideways by the sway, and lowered as far as straight legs on fixed
/// feet require.
Vector3d SwayOf(const Person& person, const Pose& X_WS, const Eigen::Vector2d& sway_m) {
  if (sway_m.isZero()) return Vector3d::Zero();
  constexpr double kStretched = 0.998;  // of a leg that is straight
  const double h = person.height_m, leg = kStretched * (kThigh + kShank) * h;
  const double up = std::sqrt(std::max(0.0, leg * leg - sway_m.squaredNorm()));
  const double sink = std::min(0.0, kAnkle * h + up - kHip * h);
  return X_WS.q * Vector3d(sway_m.x(), sway_m.y(), sink);
}

Torso TorsoOf(const Person& person, const BodyTargets& targets) {
  if (targets.posture) {
    const Posture& posture = *targets.posture;
    return {posture.hips_W_m, posture.directions_W[Posture::kTrunk],
            posture.directions_W[Posture::kNeck], posture.directions_W[Posture::kAcrossHips],
            posture.directions_W[Posture::kAcrossShoulders]};
  }
  const double h = person.height_m;
  const Eigen::Quaterniond& q = targets.X_WS.q;
  const Vector3d over_feet = targets.X_WS * Vector3d(0, 0, kHip * h);
  const Vector3d leaning =
      q * (Eigen::AngleAxisd(targets.lean_rad, Vector3d::UnitY()) * Vector3d::UnitZ());
  const Vector3d shoulders = over_feet + (kShoulder - kHip) * h * leaning;
  const Vector3d hips = over_feet + SwayOf(person, targets.X_WS, targets.sway_m);
  const Vector3d up = (shoulders - hips).normalized();
  const Vector3d left = q * Vector3d::UnitY();
  return {hips, up, up, left, left};
}

/// A point of the trunk, given by its level in upright stance and its offset to her left, as shares
/// of the height.
Vector3d OnTrunk(const Person& person, const Torso& torso, double level, double left = 0) {
  return torso.hips +
         person.height_m * ((level - kHip) * torso.trunk_up + left * torso.shoulders_left);
}

Vector3d ShoulderOf(const Person& person, const Torso& torso, bool right) {
  return OnTrunk(person, torso, kShoulder, Side(right) * kHalfShoulders);
}

Vector3d HipOf(const Person& person, const Torso& torso, bool right) {
  return torso.hips + Side(right) * kHalfHips * person.height_m * torso.hips_left;
}

/// The joint between two bones from `from` towards `to`, on the side of `hint`; and the point where
/// the second bone ends.
struct TwoBones {
  Vector3d joint, end;
};
TwoBones Reach(const Vector3d& from, const Vector3d& to, double first_m, double second_m,
               const Vector3d& hint) {
  constexpr double kStraight = 0.999;  // a fully stretched limb has no bending plane
  const Vector3d way = to - from;
  const Vector3d toward =
      way.norm() > 1e-6 ? Vector3d(way.normalized()) : Vector3d(-Vector3d::UnitZ());
  const double least = std::abs(first_m - second_m) + 0.01, most = kStraight * (first_m + second_m);
  const double distance = std::clamp(way.norm(), least, most);
  const double along =
      (first_m * first_m - second_m * second_m + distance * distance) / (2 * distance);
  const double aside = std::sqrt(std::max(0.0, first_m * first_m - along * along));
  Vector3d side = hint - hint.dot(toward) * toward;
  side = side.norm() > 1e-6 ? side.normalized() : toward.unitOrthogonal();
  return {from + along * toward + aside * side, from + distance * toward};
}

struct Arm {
  Vector3d shoulder, elbow, wrist, palm_toward;
};

bool FollowsHand(const Person& person, bool right) {
  return (right ? person.right_hand : person.left_hand) != kNone;
}

Vector3d DirectionOf(const BodyTargets& targets, std::size_t way, bool right) {
  return targets.posture->directions_W[way + (right ? 0 : 1)];
}

Arm ArmOf(const Person& person, const BodyTargets& targets, bool right) {
  const double h = person.height_m;
  const Eigen::Quaterniond& q = targets.X_WS.q;
  const BodyTargets::Limb& limb = targets.limbs[right ? 0 : 1];
  Arm arm{
      .shoulder = ShoulderOf(person, TorsoOf(person, targets), right), .elbow = {}, .wrist = {}};
  if (targets.posture && !FollowsHand(person, right)) {
    arm.elbow = arm.shoulder + kUpperArm * h * DirectionOf(targets, Posture::kUpperArm, right);
    arm.wrist = arm.elbow + kForearm * h * DirectionOf(targets, Posture::kForearm, right);
    arm.palm_toward = DirectionOf(targets, Posture::kHand, right);
    return arm;
  }
  if (limb.end == LimbEnd::kRightElbow || limb.end == LimbEnd::kLeftElbow) {
    const Vector3d way = limb.p_W_m - arm.shoulder;
    arm.elbow = arm.shoulder +
                kUpperArm * h *
                    (way.norm() > 1e-6 ? Vector3d(way.normalized()) : Vector3d(-Vector3d::UnitZ()));
    arm.wrist = arm.elbow + kForearm * h * limb.forearm_W;
  } else {
    const Vector3d hint =
        q * Vector3d(-0.3, 0.5 * Side(right), -1);  // elbows hang, a little outwards
    const TwoBones bones = Reach(arm.shoulder, limb.p_W_m, kUpperArm * h, kForearm * h, hint);
    arm.elbow = bones.joint;
    arm.wrist = bones.end;
  }
  arm.palm_toward = (arm.wrist - arm.elbow).normalized();
  return arm;
}

/// From the ankle to the middle of the foot, along the foot and up.
Vector3d FootFromAnkle(double height_m) {
  return height_m * Vector3d(kFootLength / 2 - kHeel, 0, kSole - kAnkle);
}

struct Leg {
  Vector3d hip, knee, ankle;
  Vector3d foot_ahead, sole_down;
};
Leg LegOf(const Person& person, const BodyTargets& targets, bool right) {
  const double h = person.height_m;
  const Eigen::Quaterniond& q = targets.X_WS.q;
  const Vector3d hip = HipOf(person, TorsoOf(person, targets), right);
  if (targets.posture) {
    const Vector3d knee = hip + kThigh * h * DirectionOf(targets, Posture::kThigh, right);
    const Vector3d ankle = knee + kShank * h * DirectionOf(targets, Posture::kShank, right);
    return {hip, knee, ankle, DirectionOf(targets, Posture::kFoot, right),
            DirectionOf(targets, Posture::kSole, right)};
  }
  const Vector3d wanted = targets.limbs[right ? 2 : 3].p_W_m - q * FootFromAnkle(h);
  const TwoBones bones =
      Reach(hip, wanted, kThigh * h, kShank * h, q * Vector3d(1, 0.1 * Side(right), 0.2));
  return {hip, bones.joint, bones.end, q * Vector3d::UnitX(), q * -Vector3d::UnitZ()};
}

void AddArm(const Person& person, const BodyTargets& targets, bool right,
            std::vector<Bone>& bones) {
  const Arm arm = ArmOf(person, targets, right);
  bones.push_back({right ? "right_upper_arm" : "left_upper_arm", 0.026, arm.elbow, arm.shoulder});
  bones.push_back({right ? "right_forearm" : "left_forearm", kForearmRadius, arm.wrist, arm.elbow});
  if (FollowsHand(person, right)) return;  // a hand of the scene takes its place
  bones.push_back({right ? "right_hand" : "left_hand", 0.018,
                   arm.wrist + kPalm * person.height_m * arm.palm_toward, arm.wrist});
}

void AddLeg(const Person& person, const BodyTargets& targets, bool right,
            std::vector<Bone>& bones) {
  const double h = person.height_m;
  const Leg leg = LegOf(person, targets, right);
  const Vector3d heel =
      leg.ankle + h * (-kHeel * leg.foot_ahead + (kAnkle - kSole) * leg.sole_down);
  const Vector3d ball = heel + kFootLength * h * leg.foot_ahead;
  bones.push_back({right ? "right_thigh" : "left_thigh", 0.045, leg.knee, leg.hip});
  bones.push_back({right ? "right_shank" : "left_shank", 0.030, leg.ankle, leg.knee});
  bones.push_back({right ? "right_foot" : "left_foot", kSole, heel, ball});
  bones.push_back(
      {right ? "right_toes" : "left_toes", 0.014, ball, ball + kToesLength * h * leg.foot_ahead});
}

/// All but the head.
std::vector<Bone> BonesOf(const Person& person, const BodyTargets& targets) {
  const Torso torso = TorsoOf(person, targets);
  const auto trunk = [&](double level) { return OnTrunk(person, torso, level); };
  std::vector<Bone> bones = {
      {"neck", 0.030, trunk(kShoulder), NeckTop(person, targets)},
      {"chest", 0.080, trunk(0.690), trunk(0.750)},
      {"abdomen", 0.070, trunk(0.590), trunk(0.660)},
      {"pelvis", 0.070, HipOf(person, torso, true), HipOf(person, torso, false)}};
  for (const bool right : {true, false}) AddArm(person, targets, right, bones);
  for (const bool right : {true, false}) AddLeg(person, targets, right, bones);
  return bones;
}

/// The pose of a bone with its axis along z, rotated as little as possible from `before`.
Pose PlaceOf(const Bone& bone, const Pose* before) {
  const Vector3d axis = (bone.upper_W_m - bone.lower_W_m).normalized();
  const Eigen::Quaterniond q = before ? before->q : Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond turn = RotationBetween(q * Vector3d::UnitZ(), axis);
  return {(bone.lower_W_m + bone.upper_W_m) / 2, (turn * q).normalized()};
}

Body PartOf(std::string name, double radius_m, double length_m) {
  return {.name = std::move(name),
          .shapes = {PlacedShape{Capsule{radius_m, length_m}, {}}},
          .kinematic = true,
          .friction = 0.6,  // cloth
          .X_WB = {}};
}

/// Targets of a standing person with hanging arms, without the head's pose.
BodyTargets Resting(const Person& person) {
  BodyTargets targets{.X_WS = person.X_WS};
  for (int limb = 0; limb < 4; ++limb)
    targets.limbs[static_cast<std::size_t>(limb)] = RestOf(limb, person, targets);
  return targets;
}

}  // namespace

int LimbOf(LimbEnd end) {
  switch (end) {
    case LimbEnd::kRightElbow:
    case LimbEnd::kRightWrist:
      return 0;
    case LimbEnd::kLeftElbow:
    case LimbEnd::kLeftWrist:
      return 1;
    case LimbEnd::kRightFoot:
      return 2;
    case LimbEnd::kLeftFoot:
      return 3;
  }
  return 0;
}

HandIndex HandAt(int limb, const Person& person) {
  if (limb == 0) return person.right_hand;
  return limb == 1 ? person.left_hand : kNone;
}

PartRange PartsOfLimb(const Person& person, int limb) {
  constexpr int kTrunkParts = 5, kLegParts = 4;  // head, neck, chest, abdomen, pelvis
  const int right_arm = FollowsHand(person, true) ? 2 : 3,
            left_arm = FollowsHand(person, false) ? 2 : 3;
  const std::array<int, 4> sizes = {right_arm, left_arm, kLegParts, kLegParts};
  PartRange range{kTrunkParts, kTrunkParts};
  for (int i = 0; i <= limb; ++i) {
    range.begin = range.end;
    range.end += sizes[static_cast<std::size_t>(i)];
  }
  return range;
}

BodyTargets::Limb RestOf(int limb, const Person& person, const BodyTargets& targets) {
  const double h = person.height_m;
  const bool right = limb % 2 == 0;
  if (limb < 2) {
    const Vector3d hanging(0.05, Side(right) * 0.02, -0.95 * (kUpperArm + kForearm));
    return {right ? LimbEnd::kRightWrist : LimbEnd::kLeftWrist,
            ShoulderOf(person, TorsoOf(person, targets), right) + targets.X_WS.q * (h * hanging)};
  }
  const Vector3d ankle = h * Vector3d(0, Side(right) * kHalfHips, kAnkle);
  return {right ? LimbEnd::kRightFoot : LimbEnd::kLeftFoot,
          targets.X_WS * (ankle + FootFromAnkle(h))};
}

Eigen::Vector3d PlaceOf(LimbEnd end, const Person& person, const BodyTargets& targets) {
  const int limb = LimbOf(end);
  const bool right = limb % 2 == 0;
  if (limb >= 2)
    return LegOf(person, targets, right).ankle + targets.X_WS.q * FootFromAnkle(person.height_m);
  const Arm arm = ArmOf(person, targets, right);
  return end == LimbEnd::kRightElbow || end == LimbEnd::kLeftElbow ? arm.elbow : arm.wrist;
}

Eigen::Vector3d ForearmOf(LimbEnd end, const Person& person, const BodyTargets& targets) {
  return ArmOf(person, targets, LimbOf(end) % 2 == 0).palm_toward;
}

Eigen::Vector3d FoldedForearm(LimbEnd end, const Pose& X_WS) {
  return X_WS.q * Vector3d(-0.1, -0.5 * Side(LimbOf(end) % 2 == 0), 0.85).normalized();
}

Eigen::Vector3d NeckTop(const Person& person, const BodyTargets& targets) {
  const Torso torso = TorsoOf(person, targets);
  return OnTrunk(person, torso, kShoulder) +
         (kNeckTop - kShoulder) * person.height_m * torso.neck_up;
}

Pose HeadToward(const Person& person, const Vector3d& p_W_neck, const Vector3d& toward_W) {
  // Yaw and pitch, no roll.
  const double level = std::hypot(toward_W.x(), toward_W.y());
  const double yaw = level > 1e-9 ? std::atan2(toward_W.y(), toward_W.x()) : 0;
  const double pitch = -std::asin(std::clamp(toward_W.z(), -kSteepestHead, kSteepestHead));
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY());
  return {p_W_neck + q * Vector3d(0, 0, kHeadCentre * person.height_m), q};
}

Pose HeadOfPosture(const Person& person, const BodyTargets& targets) {
  const Vector3d& crown = targets.posture->directions_W[Posture::kCrown];
  const Vector3d& face = targets.posture->directions_W[Posture::kFace];
  const Vector3d level = face - face.dot(crown) * crown;
  Eigen::Matrix3d axes;
  axes.col(0) = level.norm() > 1e-6 ? Vector3d(level.normalized()) : crown.unitOrthogonal();
  axes.col(2) = crown;
  axes.col(1) = crown.cross(axes.col(0));
  return {NeckTop(person, targets) + kHeadCentre * person.height_m * crown,
          Eigen::Quaterniond(axes).normalized()};
}

Posture PostureOf(const Person& person, const BodyTargets& targets) {
  if (targets.posture) return *targets.posture;
  const Torso torso = TorsoOf(person, targets);
  Posture posture{.hips_W_m = torso.hips};
  auto& directions = posture.directions_W;
  directions[Posture::kTrunk] = torso.trunk_up;
  directions[Posture::kNeck] = torso.neck_up;
  directions[Posture::kFace] = targets.X_WHead.q * Vector3d::UnitX();
  directions[Posture::kCrown] = targets.X_WHead.q * Vector3d::UnitZ();
  directions[Posture::kAcrossHips] = torso.hips_left;
  directions[Posture::kAcrossShoulders] = torso.shoulders_left;
  for (const bool right : {true, false}) {
    const std::size_t side = right ? 0 : 1;
    const Arm arm = ArmOf(person, targets, right);
    directions[Posture::kUpperArm + side] = (arm.elbow - arm.shoulder).normalized();
    directions[Posture::kForearm + side] = (arm.wrist - arm.elbow).normalized();
    directions[Posture::kHand + side] = arm.palm_toward;
    const Leg leg = LegOf(person, targets, right);
    directions[Posture::kThigh + side] = (leg.knee - leg.hip).normalized();
    directions[Posture::kShank + side] = (leg.ankle - leg.knee).normalized();
    directions[Posture::kFoot + side] = leg.foot_ahead;
    directions[Posture::kSole + side] = leg.sole_down;
  }
  return posture;
}

double LegLength(double height_m) { return (kThigh + kShank) * height_m; }

double AnkleHeight(double height_m) { return kAnkle * height_m; }

Eigen::Vector3d EyesOf(const Person& person, const Pose& X_WHead) {
  return X_WHead * (person.height_m * Vector3d(kEyesAhead, 0, kEyesUp));
}

Eigen::Vector3d WristInHand(const Person& person, const HandModel& model) {
  return {-model.palm_size_m.x() / 2 - kForearmRadius * person.height_m, 0, 0};
}

BodyTargets Standing(const Scene& scene, const Person& person) {
  BodyTargets targets = Resting(person);
  for (const auto& [hand, limb] :
       {std::pair(person.right_hand, 0), std::pair(person.left_hand, 1)}) {
    if (hand == kNone) continue;
    const Hand& of_scene = scene.hand(hand);
    targets.limbs[static_cast<std::size_t>(limb)].p_W_m =
        of_scene.X_WH * WristInHand(person, of_scene.model);
  }
  targets.X_WHead = HeadToward(person, NeckTop(person, targets), person.X_WS.q * Vector3d::UnitX());
  return targets;
}

std::vector<Body> PartsOf(const Person& person) {
  const double h = person.height_m;
  std::vector<Body> parts = {PartOf(person.name, kHeadRadius * h, kHeadLength * h)};
  if (!person.has_body) return parts;
  for (const Bone& bone : BonesOf(person, Resting(person)))
    parts.push_back(PartOf(person.name + "_" + bone.name, bone.radius * h,
                           (bone.upper_W_m - bone.lower_W_m).norm()));
  return parts;
}

std::vector<Pose> PlacesOf(const Person& person, const BodyTargets& targets,
                           const std::vector<Pose>& before) {
  std::vector<Pose> places = {targets.X_WHead};
  if (!person.has_body) return places;
  for (const Bone& bone : BonesOf(person, targets))
    places.push_back(PlaceOf(bone, before.empty() ? nullptr : &before[places.size()]));
  return places;
}

}  // namespace prehend::physics
