// SPDX-License-Identifier: Apache-2.0
#include "physics/hand/step_notes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/hand/hand_clearance.h"

namespace prehend::physics {
namespace {

/// The open hand is approximated by spheres, which protrude by less than this.
constexpr double kNotedTouch_m = 0.005;
/// An excess width below this is ignored, because notes round lengths to millimetres.
constexpr double kNotedWidth_m = 0.0005;

/// A thing that is nearer to a half closed hand would be held by a closed one.
constexpr double kNearlyThere_m = 0.02;

/// "0.50".
std::string TwoDigits(double share) {
  const long hundredths = std::lround(100 * share);
  return std::to_string(hundredths / 100) + "." + std::to_string(hundredths % 100 / 10) +
         std::to_string(hundredths % 10);
}

/// The sensor sets of a hand that touch a body.
std::set<std::string> SidesThatTouch(const Scene& scene, const Snapshot& now, HandIndex hand,
                                     BodyIndex object) {
  const HandModel& model = scene.hand(hand).model;
  std::set<std::string> sides;
  ForEachContact(hand, kNone, object, now, [&](const ContactPoint& contact) {
    const LinkIndex link = contact.a.hand == hand ? contact.a.link : contact.b.link;
    const int set = link == kNone ? model.palm_sensor_set : model.link(link).sensor_set;
    sides.insert(model.sensor_sets[static_cast<std::size_t>(set)]);
  });
  return sides;
}

/// Or what that body touches: two things may be squeezed together.
std::set<std::string> SidesThatSqueeze(const Scene& scene, const Snapshot& now, HandIndex hand,
                                       BodyIndex object) {
  std::set<std::string> sides = SidesThatTouch(scene, now, hand, object);
  if (sides.empty()) return sides;
  for (const ContactPoint& contact : now.contacts) {
    const BodyIndex other = contact.a.body == object ? contact.b.body : contact.a.body;
    const bool touches = contact.a.body == object || contact.b.body == object;
    if (touches && other != kNone && MovesFreely(scene, other))
      sides.merge(SidesThatTouch(scene, now, hand, other));
  }
  return sides;
}

/// "" if nothing is in the way, other than a thing that is too wide for the style.
std::string NoteAboutObstacle(const Scene& scene, const Snapshot& now, const ReachQuery& query,
                              const ReachPlan& plan, bool too_wide) {
  const HandModel& model = scene.hand(query.hand).model;
  const GraspStyle& style = model.styles[static_cast<std::size_t>(query.style)];
  const std::string& object = scene.body(query.object).name;
  const auto nearest_at = [&](double trigger) {
    return HandClearance(scene, query.hand, JointTargets(style, trigger))
        .NearestAlong(plan.segment, now, too_wide ? query.object : kNone);
  };
  const HandClearance::Nearest worst = nearest_at(query.from.trigger);
  if (worst.distance_m >= -kNotedTouch_m) return "";
  const std::string& obstacle = scene.body(worst.body).name;
  if (query.from.trigger > 0 && nearest_at(0).distance_m >= -kNotedTouch_m)
    return "it comes with its grip at " + TwoDigits(query.from.trigger) + ", so its fingers push " +
           Millimetres(-worst.distance_m) + " into " + obstacle +
           " on the way: write 'open_to: 0' before the reach";
  return "no way to grasp " + object + " keeps clear of everything: the open hand will push " +
         Millimetres(-worst.distance_m) + " into " + obstacle + "; try " +
         (query.approach == Approach::kAbove  ? "'from: side'"
          : query.approach == Approach::kSide ? "'from: above'"
                                              : "'from: above' or 'from: side'") +
         ", another style or" + (query.point_m ? " another" : "") + " 'point_m', or make room";
}

}  // namespace

std::string NoteAboutReach(const Scene& scene, const Snapshot& now, const ReachQuery& query,
                           const ReachPlan& plan) {
  const HandModel& model = scene.hand(query.hand).model;
  const GraspStyle& style = model.styles[static_cast<std::size_t>(query.style)];
  const std::string& object = scene.body(query.object).name;
  std::string notes;
  const auto add = [&](const std::string& note) { notes += (notes.empty() ? "" : "; ") + note; };
  if (plan.beside_m > kAtPoint_m)
    add("no grip of " + object + " in style " + style.name + " is at point_m: the nearest is " +
        Millimetres(plan.beside_m) + " beside it");
  const bool too_wide = plan.width_m > style.opening_m + kNotedWidth_m && query.offset_m.isZero();
  if (too_wide)
    add("style " + style.name + " opens " + Millimetres(style.opening_m) + ", and " + object +
        " is " + Millimetres(plan.width_m) + " wide there: the hand will not close around it; " +
        "take it at a narrower part with 'point_m', in another style, or with two hands");
  if (plan.found || plan.clearance_m >= -kNotedTouch_m) return notes;
  const std::string obstacle = NoteAboutObstacle(scene, now, query, plan, too_wide);
  if (!obstacle.empty()) add(obstacle);
  return notes;
}

bool IsHeldBySides(const Scene& scene, const Snapshot& now, HandIndex hand, BodyIndex object) {
  return SidesThatTouch(scene, now, hand, object).size() >= 2;
}

std::string NoteAboutGrip(const Scene& scene, const Snapshot& now, HandIndex hand, BodyIndex object,
                          double closes_to) {
  const std::set<std::string> sides = SidesThatSqueeze(scene, now, hand, object);
  if (sides.size() >= 2) return "";
  if (sides.size() == 1)
    return "it has closed and touches " + scene.body(object).name + " with its " + *sides.begin() +
           " only, which by itself is no grasp: " +
           (closes_to < 1 ? "close it farther ('close_to: 1'), or " : "") +
           "reach for it from another side";
  const HandState& state = now.hand(hand);
  const HandClearance clearance(scene, hand, state.joints);
  const double away_m = clearance.To(object, state.palm.X_WB, now);
  const std::string& name = scene.body(object).name;
  if (closes_to < 1 && away_m < kNearlyThere_m)
    return "it has closed to " + TwoDigits(closes_to) + " and does not touch " + name +
           ", which is " + Millimetres(std::max(away_m, 0.0)) + " away: close it farther";
  const std::string how_far = away_m >= HandClearance::kFar_m
                                  ? "more than " + Millimetres(HandClearance::kFar_m)
                                  : Millimetres(std::max(away_m, 0.0));
  return "it has closed and does not hold " + name + ", which is " + how_far +
         " away: is the reach's 'offset_m' too large, has " + name +
         " moved, or is it too thin or too wide for this style?";
}

std::string NoteAboutWay(const Scene& scene, const Snapshot& now, HandIndex hand, double off_m) {
  std::set<std::string> touched;
  for (const ContactPoint& contact : now.contacts) {
    if (contact.a.hand == hand && contact.b.body != kNone)
      touched.insert(scene.body(contact.b.body).name);
    if (contact.b.hand == hand && contact.a.body != kNone)
      touched.insert(scene.body(contact.a.body).name);
  }
  std::string names;
  for (const std::string& name : touched) names += (names.empty() ? "" : ", ") + name;
  return "the move ends with the hand " + Millimetres(off_m) + " away from where it was to go" +
         (names.empty() ? "" : ", at " + names) +
         "; the next step goes on from where it was to go, not from where it is";
}

}  // namespace prehend::physics
