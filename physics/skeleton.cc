// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/skeleton_test.cc
#include "physics/skeleton.h"

#include <algorithm>
#include <cmath>

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

// Shares of the height: levels of a standing person, lengths of limbs, half breadths, radii.
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

/// A point of the trunk, given as it is when she stands upright, in shares of the height.
Vector3d OnTrunk(const Person& person, const Pose& X_WS, double lean_rad, const Vector3d& share) {
  const Vector3d hips(0, 0, kHip);
  const Eigen::AngleAxisd lean(lean_rad, Vector3d::UnitY());
  return X_WS * (person.height_m * (hips + lean * (share - hips)));
}

Vector3d ShoulderOf(const Person& person, const Pose& X_WS, double lean_rad, bool right) {
  return OnTrunk(person, X_WS, lean_rad, {0, Side(right) * kHalfShoulders, kShoulder});
}

Vector3d HipOf(const Person& person, const Pose& X_WS, bool right) {
  return X_WS * (person.height_m * Vector3d(0, Side(right) * kHalfHips, kHip));
}

/// The joint between two bones that lead from `from` toward `to`, on the side of `hint`; and where
/// they really end.
struct TwoBones {
  Vector3d joint, end;
};
TwoBones Reach(const Vector3d& from, const Vector3d& to, double first_m, double second_m,
               const Vector3d& hint) {
  constexpr double kStraight = 0.999;  // fully stretched the joint would have no side
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
Arm ArmOf(const Person& person, const Posture& posture, bool right) {
  const double h = person.height_m;
  const Eigen::Quaterniond& q = posture.X_WS.q;
  const Posture::Limb& limb = posture.limbs[right ? 0 : 1];
  Arm arm{.shoulder = ShoulderOf(person, posture.X_WS, posture.lean_rad, right),
          .elbow = {},
          .wrist = {},
          .palm_toward = {}};
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
};
Leg LegOf(const Person& person, const Posture& posture, bool right) {
  const double h = person.height_m;
  const Eigen::Quaterniond& q = posture.X_WS.q;
  Leg leg{.hip = HipOf(person, posture.X_WS, right), .knee = {}, .ankle = {}};
  const Vector3d wanted = posture.limbs[right ? 2 : 3].p_W_m - q * FootFromAnkle(h);
  const TwoBones bones =
      Reach(leg.hip, wanted, kThigh * h, kShank * h, q * Vector3d(1, 0.1 * Side(right), 0.2));
  leg.knee = bones.joint;
  leg.ankle = bones.end;
  return leg;
}

void AddArm(const Person& person, const Posture& posture, bool right, std::vector<Bone>& bones) {
  const Arm arm = ArmOf(person, posture, right);
  bones.push_back({right ? "right_upper_arm" : "left_upper_arm", 0.026, arm.elbow, arm.shoulder});
  bones.push_back({right ? "right_forearm" : "left_forearm", kForearmRadius, arm.wrist, arm.elbow});
  if ((right ? person.right_hand : person.left_hand) >= 0) return;  // the scene has a better one
  bones.push_back({right ? "right_hand" : "left_hand", 0.018,
                   arm.wrist + kPalm * person.height_m * arm.palm_toward, arm.wrist});
}

void AddLeg(const Person& person, const Posture& posture, bool right, std::vector<Bone>& bones) {
  const double h = person.height_m;
  const Leg leg = LegOf(person, posture, right);
  const Vector3d ahead = posture.X_WS.q * Vector3d::UnitX();
  const Vector3d heel = leg.ankle + posture.X_WS.q * (h * Vector3d(-kHeel, 0, kSole - kAnkle));
  const Vector3d ball = heel + kFootLength * h * ahead;
  bones.push_back({right ? "right_thigh" : "left_thigh", 0.045, leg.knee, leg.hip});
  bones.push_back({right ? "right_shank" : "left_shank", 0.030, leg.ankle, leg.knee});
  bones.push_back({right ? "right_foot" : "left_foot", kSole, heel, ball});
  bones.push_back(
      {right ? "right_toes" : "left_toes", 0.014, ball, ball + kToesLength * h * ahead});
}

/// All but the head.
std::vector<Bone> BonesOf(const Person& person, const Posture& posture) {
  const auto trunk = [&](double y, double z) {
    return OnTrunk(person, posture.X_WS, posture.lean_rad, {0, y, z});
  };
  std::vector<Bone> bones = {{"neck", 0.030, trunk(0, kShoulder), trunk(0, kNeckTop)},
                             {"chest", 0.080, trunk(0, 0.690), trunk(0, 0.750)},
                             {"abdomen", 0.070, trunk(0, 0.590), trunk(0, 0.660)},
                             {"pelvis", 0.070, trunk(-kHalfHips, kHip), trunk(kHalfHips, kHip)}};
  for (const bool right : {true, false}) AddArm(person, posture, right, bones);
  for (const bool right : {true, false}) AddLeg(person, posture, right, bones);
  return bones;
}

/// Its axis along z, turned as little as possible from `before`.
Pose PlaceOf(const Bone& bone, const Pose* before) {
  const Vector3d axis = (bone.upper_W_m - bone.lower_W_m).normalized();
  const Eigen::Quaterniond q = before ? before->q : Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(q * Vector3d::UnitZ(), axis);
  return {(bone.lower_W_m + bone.upper_W_m) / 2, (turn * q).normalized()};
}

Body PartOf(std::string name, double radius_m, double length_m) {
  return {.name = std::move(name),
          .shapes = {PlacedShape{Capsule{radius_m, length_m}, {}}},
          .kinematic = true,
          .friction = 0.6,  // cloth
          .X_WB = {}};
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

Posture::Limb RestOf(int limb, const Person& person, const Pose& X_WS, double lean_rad) {
  const double h = person.height_m;
  const bool right = limb % 2 == 0;
  if (limb < 2) {
    const Vector3d hanging(0.05, Side(right) * 0.02, -0.95 * (kUpperArm + kForearm));
    return {right ? LimbEnd::kRightWrist : LimbEnd::kLeftWrist,
            ShoulderOf(person, X_WS, lean_rad, right) + X_WS.q * (h * hanging)};
  }
  const Vector3d ankle = h * Vector3d(0, Side(right) * kHalfHips, kAnkle);
  return {right ? LimbEnd::kRightFoot : LimbEnd::kLeftFoot, X_WS * (ankle + FootFromAnkle(h))};
}

Eigen::Vector3d PlaceOf(LimbEnd end, const Person& person, const Posture& posture) {
  const int limb = LimbOf(end);
  const bool right = limb % 2 == 0;
  if (limb >= 2)
    return LegOf(person, posture, right).ankle + posture.X_WS.q * FootFromAnkle(person.height_m);
  const Arm arm = ArmOf(person, posture, right);
  return end == LimbEnd::kRightElbow || end == LimbEnd::kLeftElbow ? arm.elbow : arm.wrist;
}

Eigen::Vector3d ForearmOf(LimbEnd end, const Person& person, const Posture& posture) {
  return ArmOf(person, posture, LimbOf(end) % 2 == 0).palm_toward;
}

Eigen::Vector3d FoldedForearm(LimbEnd end, const Pose& X_WS) {
  return X_WS.q * Vector3d(-0.1, -0.5 * Side(LimbOf(end) % 2 == 0), 0.85).normalized();
}

Eigen::Vector3d NeckTop(const Person& person, const Pose& X_WS, double lean_rad) {
  return OnTrunk(person, X_WS, lean_rad, {0, 0, kNeckTop});
}

Pose HeadToward(const Person& person, const Vector3d& p_W_neck, const Vector3d& toward_W) {
  // Yaw and pitch, never roll. Straight up or down there is no yaw: the head nods less than that.
  constexpr double kMostNod = 0.98;
  const double level = std::hypot(toward_W.x(), toward_W.y());
  const double yaw = level > 1e-9 ? std::atan2(toward_W.y(), toward_W.x()) : 0;
  const double pitch = -std::asin(std::clamp(toward_W.z(), -kMostNod, kMostNod));
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY());
  return {p_W_neck + q * Vector3d(0, 0, kHeadCentre * person.height_m), q};
}

Eigen::Vector3d EyesOf(const Person& person, const Pose& X_WHead) {
  return X_WHead * (person.height_m * Vector3d(kEyesAhead, 0, kEyesUp));
}

Eigen::Vector3d WristInHand(const Person& person, const HandModel& model) {
  return {-model.palm_size_m.x() / 2 - kForearmRadius * person.height_m, 0, 0};
}

Posture Standing(const Scene& scene, const Person& person) {
  Posture posture{.X_WS = person.X_WS, .limbs = {}, .X_WHead = {}};
  for (int limb = 0; limb < 4; ++limb)
    posture.limbs[static_cast<std::size_t>(limb)] = RestOf(limb, person, person.X_WS, 0);
  for (const auto& [hand, limb] :
       {std::pair(person.right_hand, 0), std::pair(person.left_hand, 1)}) {
    if (hand < 0) continue;
    const Hand& of_scene = scene.hands[static_cast<std::size_t>(hand)];
    posture.limbs[static_cast<std::size_t>(limb)].p_W_m =
        of_scene.X_WH * WristInHand(person, of_scene.model);
  }
  posture.X_WHead =
      HeadToward(person, NeckTop(person, person.X_WS, 0), person.X_WS.q * Vector3d::UnitX());
  return posture;
}

std::vector<Body> PartsOf(const Person& person) {
  const double h = person.height_m;
  std::vector<Body> parts = {PartOf(person.name, kHeadRadius * h, kHeadLength * h)};
  if (!person.has_body) return parts;
  Posture posture{.X_WS = person.X_WS, .limbs = {}, .X_WHead = {}};
  for (int limb = 0; limb < 4; ++limb)
    posture.limbs[static_cast<std::size_t>(limb)] = RestOf(limb, person, person.X_WS, 0);
  for (const Bone& bone : BonesOf(person, posture))
    parts.push_back(PartOf(person.name + "_" + bone.name, bone.radius * h,
                           (bone.upper_W_m - bone.lower_W_m).norm()));
  return parts;
}

std::vector<Pose> PlacesOf(const Person& person, const Posture& posture,
                           const std::vector<Pose>& before) {
  std::vector<Pose> places = {posture.X_WHead};
  if (!person.has_body) return places;
  for (const Bone& bone : BonesOf(person, posture))
    places.push_back(PlaceOf(bone, before.empty() ? nullptr : &before[places.size()]));
  return places;
}

}  // namespace prehend::physics
