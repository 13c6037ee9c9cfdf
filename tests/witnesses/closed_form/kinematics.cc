// SPDX-License-Identifier: Apache-2.0
// Tested by tests/witnesses/closed_form/read_closed_form_test.cc
#include "tests/witnesses/closed_form/kinematics.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace prehend::witnesses {
namespace {

using Eigen::Vector3d;
using physics::Pose;

/// Over which velocities are taken. Rounding of poses then costs 1e-10 m/s, a bend of 10 m/s^2
/// 1e-5 m/s.
constexpr double kMoment_s = 1e-6;
constexpr double kGravity_m_per_s2 = 9.81;

bool IsGiven(const LocatedVector& formulas) { return formulas[0].value.has_value(); }

/// The state of a body that came from `before` in a moment.
physics::BodyState Moving(const Pose& before, const Pose& now) {
  return {.X_WB = now,
          .v_WB_m_per_s = (now.p_m - before.p_m) / kMoment_s,
          .w_WB_rad_per_s = physics::RotationVector(now.q * before.q.conjugate()) / kMoment_s};
}

double WeightOf(const physics::Body& body) { return body.mass_kg * kGravity_m_per_s2; }

}  // namespace

physics::Snapshot Kinematics::At(grammar::Tick tick) {
  const double t_s = static_cast<double>(tick) / scene_.world.rate_hz;
  SetTime(t_s - kMoment_s);
  std::vector<Pose> bodies, palms;
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) bodies.push_back(BodyPose(i));
  for (std::size_t i = 0; i < scene_.hands.size(); ++i) palms.push_back(PalmPose(i));
  SetTime(t_s);
  physics::Snapshot snapshot{.tick = tick};
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
    snapshot.bodies.push_back(Moving(bodies[i], BodyPose(i)));
  for (std::size_t i = 0; i < scene_.hands.size(); ++i) {
    snapshot.hands.push_back(HandNow(i));
    physics::BodyState& palm = snapshot.hands.back().palm;
    palm = Moving(palms[i], palm.X_WB);
  }
  AddTouches(snapshot);
  return snapshot;
}

void Kinematics::SetTime(double t_s) {
  *formulas_.t_s = t_s;
  for (const WorldFormulas::Curve& curve : formulas_.curves) *curve.value = Value(curve.formula);
}

double Kinematics::Value(const LocatedFormula& formula) {
  const double value = formula.value->Value();
  if (std::isfinite(value)) return value;
  if (!no_number_) no_number_ = {formula.where, *formulas_.t_s};
  return 0;
}

Vector3d Kinematics::Vector(const LocatedVector& formulas, const Vector3d& otherwise) {
  if (!IsGiven(formulas)) return otherwise;
  return {Value(formulas[0]), Value(formulas[1]), Value(formulas[2])};
}

Pose Kinematics::BodyPose(std::size_t body) {
  const WorldFormulas::BodyMotion& motion = formulas_.bodies[body];
  Pose pose = scene_.bodies[body].X_WB;
  pose.p_m += Vector(motion.by_m, Vector3d::Zero());
  if (IsGiven(motion.rpy_deg))
    pose.q = physics::FromRollPitchYaw(Vector(motion.rpy_deg, Vector3d::Zero()));
  return pose;
}

Pose Kinematics::PalmPose(std::size_t hand) {
  const WorldFormulas::HandMotion& motion = formulas_.hands[hand];
  return {Vector(motion.at_m, Vector3d::Zero()),
          physics::FromRollPitchYaw(Vector(motion.rpy_deg, Vector3d::Zero()))};
}

physics::HandState Kinematics::HandNow(std::size_t hand) {
  const WorldFormulas::HandMotion& motion = formulas_.hands[hand];
  physics::HandState state;
  state.palm.X_WB = PalmPose(hand);
  for (const LocatedVector& side : motion.sides_m)
    state.X_WL.push_back(state.palm.X_WB * Pose{Vector(side, Vector3d::Zero()), {1, 0, 0, 0}});
  state.joints.resize(motion.sides_m.size());
  state.X_WTarget = state.palm.X_WB;
  if (motion.trigger.value) state.trigger = std::clamp(Value(motion.trigger), 0.0, 1.0);
  return state;
}

void Kinematics::AddTouches(physics::Snapshot& snapshot) {
  for (const WorldFormulas::Touch& touch : formulas_.touches) {
    if (Value(touch.during) == 0) continue;
    const bool hand = touch.a.hand != physics::kNone;
    const Vector3d place =
        (hand ? snapshot.hand(touch.a.hand).palm : snapshot.body(touch.a.body)).X_WB.p_m;
    const double weight_n = hand ? 1 : WeightOf(scene_.body(touch.a.body));
    physics::ContactPoint point{.a = touch.a,
                                .b = touch.b,
                                .p_W_m = Vector(touch.at_m, place),
                                .nhat_BA_W = Vector(touch.normal, Vector3d::UnitZ()).normalized()};
    point.normal_impulse_n_s =
        (touch.force_n.value ? Value(touch.force_n) : weight_n) / scene_.world.rate_hz;
    if (point.b < point.a) {
      std::swap(point.a, point.b);
      point.nhat_BA_W = -point.nhat_BA_W;
    }
    snapshot.contacts.push_back(point);
  }
  const auto key = [](const physics::ContactPoint& point) {
    return std::tuple(point.a, point.b, point.p_W_m.x(), point.p_W_m.y(), point.p_W_m.z());
  };
  std::ranges::stable_sort(snapshot.contacts, {}, key);
}

}  // namespace prehend::witnesses
