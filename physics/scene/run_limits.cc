// SPDX-License-Identifier: Apache-2.0
// Limits of speed, distance and penetration depth, and the advice for each.
#include "physics/scene/run_limits.h"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace prehend::physics {
namespace {

/// No object thrown by a hand is faster; one ejected by an unstable contact is.
constexpr double kMaxSpeed_m_per_s = 50;
/// Touching bodies overlap by tenths of a millimetre; this much means tunnelling or overlapping
/// initial poses.
constexpr double kMaxPenetration_m = 0.02;

std::string Say(const char* format, double value) {
  char text[128];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::optional<RunProblem> CheckState(const std::string& name, const BodyState& state,
                                     bool of_person = false) {
  const bool finite = state.X_WB.p_m.allFinite() && state.X_WB.q.coeffs().allFinite() &&
                      state.v_WB_m_per_s.allFinite() && state.w_WB_rad_per_s.allFinite();
  if (!finite)
    return RunProblem{name, "its state is not finite",
                      "look for zero sizes, extreme masses or gains just before this tick"};
  if (const double speed = state.v_WB_m_per_s.norm(); speed > kMaxSpeed_m_per_s)
    return RunProblem{
        name, Say("it moves at %.0f m/s", speed),
        of_person ? "a person goes where her script says: give the step more time "
                    "('over_s', 'wait_s', 'join_s'); an arm or a leg whose end passes its own "
                    "shoulder or hip closely bends the other way there: lead it around"
                  : "it was probably squeezed or started inside another body; give it room "
                    "or lower the strength"};
  if (const double distance = state.X_WB.p_m.norm(); distance > kMaxDistance_m)
    return RunProblem{name, Say("it is %.0f m from the origin", distance),
                      "it left the world; put a floor under it or end the script earlier"};
  return std::nullopt;
}

double MassOf(const Scene& scene, const ContactSide& side) {
  if (side.hand != kNone) return 0;
  const Body& body = scene.body(side.body);
  return body.fixed ? 0 : body.mass_kg;
}

/// Between a person and what is fixed: she goes where her script says.
bool IsOfFixed(const Scene& scene, const ContactPoint& contact) {
  const auto stays = [&](const ContactSide& side) {
    return side.hand == kNone && (scene.body(side.body).fixed || scene.body(side.body).kinematic);
  };
  return stays(contact.a) && stays(contact.b);
}

/// The advice for two bodies that overlap deeply.
std::string AdviceFor(const Scene& scene, const Snapshot& snapshot, const ContactPoint& deep) {
  if (const double ratio = MassRatioAt(scene, snapshot, deep); ratio > kMaxMassRatio)
    return Say("a mass presses on one that is %.0f times smaller; make them more similar", ratio);
  return scene.hands.empty() ? "start them apart, or let them meet more slowly"
                             : "start them apart, or let the hand come more slowly";
}

}  // namespace

double MassRatioAt(const Scene& scene, const Snapshot& snapshot, const ContactPoint& contact) {
  double least_kg = std::numeric_limits<double>::infinity(), most_kg = 0;
  for (const ContactPoint& other : snapshot.contacts) {
    // What is fixed, as a table is, passes no load on to what else stands on it.
    const auto meets = [&](const ContactSide& side) {
      return MassOf(scene, side) > 0 && (other.a == side || other.b == side);
    };
    const bool is_near = meets(contact.a) || meets(contact.b);
    for (const ContactSide& side : {other.a, other.b}) {
      const double mass_kg = MassOf(scene, side);
      if (!is_near || mass_kg <= 0) continue;
      least_kg = std::min(least_kg, mass_kg);
      most_kg = std::max(most_kg, mass_kg);
    }
  }
  return most_kg > 0 ? most_kg / least_kg : 1;
}

const std::string& NameOf(const Scene& scene, const ContactSide& side) {
  return side.hand != kNone ? scene.hand(side.hand).name : scene.body(side.body).name;
}

std::string LimitOf(const std::string& note) {
  if (!note.starts_with(kLimitNote)) return "";
  const std::string what =
      note.substr(kLimitNote.size(), note.find(": ", kLimitNote.size()) - kLimitNote.size());
  for (const auto& [words, name] :
       {std::pair{kGoesThrough, "goes_through"}, std::pair{kSinksInto, "sinks_into"}}) {
    const std::size_t at = what.find(words);
    if (at == std::string::npos) continue;
    return std::string(name) + "(" + what.substr(0, at) + ", " + what.substr(at + words.size()) +
           ")";
  }
  return "";
}

std::optional<RunProblem> CheckSnapshot(const Scene& scene, const Snapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
    if (!snapshot.MayHaveMoved(i, snapshot.tick - 1))
      continue;  // it was checked when it last moved
    const Body& body = scene.bodies[i];
    if (auto problem = CheckState(body.name, snapshot.bodies[i], body.kinematic)) return problem;
  }
  for (std::size_t i = 0; i < snapshot.hands.size(); ++i) {
    if (auto problem = CheckState(scene.hands[i].name, snapshot.hands[i].palm)) return problem;
  }
  for (const ContactPoint& contact : snapshot.contacts) {
    if (contact.distance_m > -kMaxPenetration_m || IsOfFixed(scene, contact)) continue;
    return RunProblem{
        NameOf(scene, contact.a),
        Say("it is %.0f mm deep", -1000 * contact.distance_m) + " in " + NameOf(scene, contact.b),
        AdviceFor(scene, snapshot, contact)};
  }
  return std::nullopt;
}

}  // namespace prehend::physics
