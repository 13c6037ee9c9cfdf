// SPDX-License-Identifier: Apache-2.0
// The part of the ScriptPlayer that looks at what is put down until it stands. Tested by
// tests/physics/hand/script_player_test.cc
#include <algorithm>
#include <cmath>

#include "physics/hand/hand_clearance.h"
#include "physics/hand/script_player.h"
#include "physics/scene/geometry.h"
#include "physics/scene/landing.h"

namespace prehend::physics {
namespace {

/// A thing stands when others than hands bear this share of its weight, on average over kBearing_s.
constexpr double kBorneShare = 0.5;
constexpr double kBearing_s = 0.02;
/// If it does not stand when the stage should be over, the target goes on down at this speed,
constexpr double kSeek_m_per_s = 0.02;
/// and the stage lasts at most so much longer.
constexpr double kSeek_s = 1;
/// A hand that closes takes back what it lifts or tilts with this time constant,
constexpr double kTakesBack_s = 0.02;
/// up to this height.
constexpr double kMostRise_m = 0.01;
/// It goes down, at most so fast, if less than this share of the weight is left to others to bear.
constexpr double kMostLowering_m_per_s = 0.06;
constexpr double kLeftToBear = 0.7;
/// What is faster does not stand.
constexpr double kStill_rad_per_s = 0.1, kStill_m_per_s = 0.02;

/// Upward force on a body from others than hands, newtons.
double BorneBy(BodyIndex body, const Snapshot& now, double rate_hz) {
  double impulse_n_s = 0;
  for (const auto& points : now.AllContacts()) {
    for (const ContactPoint& contact : points) {
      if (contact.a.hand != kNone || contact.b.hand != kNone) continue;
      const double up = contact.nhat_BA_W.z() * contact.normal_impulse_n_s;
      if (contact.a.body == body) impulse_n_s += std::max(up, 0.0);
      if (contact.b.body == body) impulse_n_s += std::max(-up, 0.0);
    }
  }
  return impulse_n_s * rate_hz;
}

/// Whether the body touches others than hands.
bool TouchesAnything(BodyIndex body, const Snapshot& now) {
  for (const auto& points : now.AllContacts()) {
    for (const ContactPoint& contact : points) {
      if (contact.a.hand == kNone && contact.b.hand == kNone &&
          (contact.a.body == body || contact.b.body == body))
        return true;
    }
  }
  return false;
}

}  // namespace

bool ScriptPlayer::Placing::Stands() const { return touches && borne_n >= kBorneShare * weight_n; }

/// Looks whether what is put down stands, and lowers it if not.
void ScriptPlayer::Watch(const Snapshot& now) {
  const double rate_hz = scene_.world.rate_hz;
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    if (!hands_[h].placing) continue;
    Placing& placing = *hands_[h].placing;
    const double share = std::min(1 / (kBearing_s * rate_hz), 1.0);
    // A blow counts as no more than standing.
    const double borne_n = std::min(BorneBy(placing.body, now, rate_hz), placing.weight_n);
    placing.borne_n += share * (borne_n - placing.borne_n);
    placing.touches = borne_n > 0;
    if (placing.touches)
      placing.lowest_m = std::min(placing.lowest_m, now.hands[h].palm.X_WB.p_m.z());
    else
      placing.lifted_off |= placing.lowest_m < HUGE_VAL && !TouchesAnything(placing.body, now);
    if (tick_in_stage_ >= PlannedEnd(hands_[h]) && !placing.Stands())
      placing.lowered_m += kSeek_m_per_s / rate_hz;
  }
}

bool ScriptPlayer::Waits(std::size_t hand, std::int64_t late_ticks) const {
  const std::optional<TrackerSettings>& tracking = scene_.hands[hand].tracking;
  const double late_s = static_cast<double>(late_ticks) / scene_.world.rate_hz;
  const std::optional<Placing>& placing = hands_[hand].placing;
  return placing && !placing->Stands() && late_s < kSeek_s + (tracking ? tracking->latency_s : 0);
}

/// What the hand has lost is not its problem.
void ScriptPlayer::CheckThatItStands(std::size_t hand, const Snapshot& now) {
  const std::optional<Placing>& placing = hands_[hand].placing;
  const HandIndex index(hand);
  if (!placing || placing->Stands() || !Touches(index, placing->body, now)) return;
  const Body &held = scene_.body(placing->body), &below = scene_.body(placing->support);
  const Pose& X_WHeld = now.body(placing->body).X_WB;
  std::string problem = "place_on: '" + held.name + "' does not stand on '" + below.name + "'";
  if (const auto landing_m = LandingHeight(below, now.body(placing->support).X_WB, held, X_WHeld)) {
    const double above_m = WorldBounds(held, X_WHeld).min().z() - *landing_m;
    problem += std::lround(1000 * above_m) > 0
                   ? ", but is held " + Millimetres(above_m) + " above it"
                   : ", but is held as it touches it: '" + below.name +
                         "' bears less than half of its weight, or gives way";
  }
  Fail(index, problem);
}

void ScriptPlayer::KeepStanding(std::size_t hand, const Snapshot& now) {
  HandState& state = hands_[hand];
  const Body& body = scene_.body(state.object);
  const Standing& stood = *At(stood_, state.object);
  const Pose& X_WB = now.body(state.object).X_WB;
  const double rise_m = WorldBounds(body, X_WB).min().z() - stood.low_m;
  const Eigen::Vector3d up_W = X_WB.q * stood.up_B;
  // All that touch it move with it, so several take back as one would.
  int keep = 0;
  for (std::size_t h = 0; h < hands_.size(); ++h)
    keep += hands_[h].object == state.object && hands_[h].took && hands_[h].closes &&
            Rests(hands_[h]) && Touches(HandIndex(h), state.object, now);
  if (keep != HandsOn(state.object, now) || !Touches(HandIndex(hand), state.object, now) ||
      rise_m > kMostRise_m || up_W.z() < kCosMostLean)
    return;
  const double dt_s = 1.0 / scene_.world.rate_hz;
  const bool round = std::holds_alternative<Sphere>(body.shapes.front().shape);
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  if (!round) turn = up_W.cross(Eigen::Vector3d::UnitZ());
  // About the body, so the palm moves, too.
  state.yields_rad_per_s = turn / kTakesBack_s;
  state.yields_m_per_s = state.yields_rad_per_s.cross(now.hands[hand].palm.X_WB.p_m - X_WB.p_m);
  const double weight_n = body.mass_kg * scene_.world.gravity_m_per_s2;
  const double borne_n = BorneBy(state.object, now, scene_.world.rate_hz);
  state.yields_m_per_s.z() -=
      std::max(rise_m, 0.0) / kTakesBack_s +
      kMostLowering_m_per_s * std::max(1 - borne_n / (kLeftToBear * weight_n), 0.0);
  Pose by = state.yielded.value_or(Pose{});
  by.p_m += dt_s * state.yields_m_per_s;
  const Eigen::Vector3d half = dt_s / 2 * state.yields_rad_per_s;
  by.q = (Eigen::Quaterniond(1, half.x(), half.y(), half.z()) * by.q).normalized();
  state.yielded = by;
}

void ScriptPlayer::RememberHowItStands(HandState& hand, const Snapshot& now) {
  hand.took = hand.object != kNone && TouchesAnything(hand.object, now);
  if (!hand.took) return;
  const BodyState& state = now.body(hand.object);
  const bool falls =
      state.w_WB_rad_per_s.norm() > kStill_rad_per_s || state.v_WB_m_per_s.norm() > kStill_m_per_s;
  // What the hand has knocked over on its way stood before.
  if (!falls)
    At(stood_, hand.object) =
        Standing{.up_B = state.X_WB.q.conjugate() * Eigen::Vector3d::UnitZ(),
                 .low_m = WorldBounds(scene_.body(hand.object), state.X_WB).min().z()};
  hand.took = At(stood_, hand.object).has_value();
}

}  // namespace prehend::physics
