// SPDX-License-Identifier: Apache-2.0
#include "physics/step_watch.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "physics/hand/hand_clearance.h"
#include "physics/person/skeleton.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"

namespace prehend::physics {
namespace {

/// A limb that ends farther before its goal is noted.
constexpr double kNotedLimb_m = 0.03;
/// So is a head that a recording leads farther from its neck.
constexpr double kNotedHead_m = 0.05;
/// A joint is noted that misses more than this share of its way,
constexpr double kNotedJointShare = 0.25;
/// and more than this, metres or radians.
constexpr double kNotedSlider_m = 0.005, kNotedHinge_rad = 0.05;
/// A thing that an arm moves by less stays where it is, as notes round lengths to millimetres.
constexpr double kMoved_m = 0.001;

/// A part that goes deeper into a fixed thing is noted;
constexpr double kInto_m = 0.01;
/// it has come out behind it if the way out is so far from the one where it entered (a cosine).
constexpr double kBehind = -0.5;

const char* NameOf(LimbEnd end) {
  switch (end) {
    case LimbEnd::kRightElbow:
      return "right_elbow";
    case LimbEnd::kLeftElbow:
      return "left_elbow";
    case LimbEnd::kRightWrist:
      return "right_wrist";
    case LimbEnd::kLeftWrist:
      return "left_wrist";
    case LimbEnd::kRightFoot:
      return "right_foot";
    case LimbEnd::kLeftFoot:
      return "left_foot";
  }
  return "";
}

/// "12 mm" of a slider, "12 degrees" of a hinge.
std::string PositionText(const Joint& joint, double position) {
  if (joint.kind == JointKind::kSlider) return Millimetres(position);
  return std::to_string(std::lround(position * 180 / M_PI)) + " degrees";
}

bool TouchesJoint(const Scene& scene, HandIndex hand, int joint, const Snapshot& now) {
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    const BodyIndex index(body);
    if (JointThatMoves(scene, index) == joint && Touches(hand, index, now)) return true;
  }
  return false;
}

}  // namespace

StepWatch::StepWatch(const Scene& scene, const Script& script)
    : scene_(scene), script_(script), limbs_(scene.persons.size()), heads_(scene.persons.size()) {}

void StepWatch::Begin(const std::vector<BegunSteps>& begun, const Snapshot& now) {
  for (const BegunSteps& steps : begun) {
    for (const std::size_t index : steps.steps) {
      const Step& step = script_.stages[steps.stage].steps[index];
      const auto* follow = std::get_if<FollowJointStep>(&step.action);
      if (!follow) continue;
      const int joint = JointThatMoves(scene_, FindBody(scene_, follow->entity));
      if (joint < 0) continue;  // the run fails
      const Joint& led = scene_.joints[static_cast<std::size_t>(joint)];
      leading_.push_back({.hand = step.hand,
                          .joint = joint,
                          .from = now.joints[static_cast<std::size_t>(joint)].position,
                          .to = led.lower + follow->to * (led.upper - led.lower),
                          .end_tick = now.tick + std::llround((step.delay_s + step.over_s) *
                                                              scene_.world.rate_hz)});
    }
  }
}

void StepWatch::See(const Snapshot& now, const std::vector<PersonPlayer>& persons) {
  SeeJoints(now);
  SeeArms(now, persons);
  for (std::size_t i = 0; i < persons.size(); ++i) SeeFixed(i, persons[i].touches(), now.tick);
}

void StepWatch::SeeFixed(std::size_t person, const std::vector<FixedTouch>& touches,
                         std::int64_t tick) {
  for (const FixedTouch& touch : touches) {
    Entered& entered = entered_[{person, touch.thing}];
    const Eigen::Vector3d& first_W =
        entered.first_W.try_emplace(touch.part, touch.nhat_W).first->second;
    entered.is_through |= first_W.dot(touch.nhat_W) < kBehind && entered.deepest.depth_m > kInto_m;
    if (touch.depth_m <= entered.deepest.depth_m) continue;
    entered.deepest = touch;
    entered.tick = tick;
  }
}

void StepWatch::NoteFixed(std::vector<ScriptNote>& notes) const {
  for (const auto& [who, entered] : entered_) {
    if (entered.deepest.depth_m <= kInto_m) continue;
    const Person& person = scene_.persons[who.first];
    const int part = entered.deepest.part;
    const bool starts = entered.tick <= 1;
    bool follows_hand = false;
    for (int limb = 0; limb < 4; ++limb) {
      const PartRange parts = PartsOfLimb(person, limb);
      follows_hand |= part >= parts.begin && part < parts.end && HandAt(limb, person) != kNone;
    }
    notes.push_back({entered.tick, kNone,
                     scene_.body(person.head + part).name + (starts ? " starts " : " goes ") +
                         Millimetres(entered.deepest.depth_m) + (starts ? " in " : " into ") +
                         scene_.body(who.second).name + ", which is fixed" +
                         (entered.is_through ? ", and comes out on another side of it" : "") +
                         (starts         ? "; let her start elsewhere"
                          : follows_hand ? "; lead its hand another way, or let her stand elsewhere"
                                         : "; walking, and a limb that moves, stop before it with "
                                           "'max_force_n'; or lead her around it")});
  }
}

void StepWatch::SeeJoints(const Snapshot& now) {
  for (Leading& leading : leading_) {
    const bool touches = TouchesJoint(scene_, leading.hand, leading.joint, now);
    leading.has_touched |= touches;
    if (now.tick != leading.end_tick) continue;
    const Joint& joint = scene_.joints[static_cast<std::size_t>(leading.joint)];
    const double position = now.joints[static_cast<std::size_t>(leading.joint)].position;
    const double missing = std::abs(leading.to - position);
    const double least = joint.kind == JointKind::kSlider ? kNotedSlider_m : kNotedHinge_rad;
    if (missing <= std::max(kNotedJointShare * std::abs(leading.to - leading.from), least))
      continue;
    const std::string& name = scene_.body(joint.body).name;
    const std::string remedy =
        touches ? "it touches " + name +
                      ", which stays behind: close the hand around its handle, or take more time "
                      "('over_s')"
        : leading.has_touched
            ? "it has slipped off " + name +
                  ", which it touched on the way: take more time ('over_s'), or another style"
            : "it does not touch " + name + ": reach for its handle and 'close_to: 1' first";
    notes_.push_back({now.tick, leading.hand,
                      "follow_joint: " + name + " is at " + PositionText(joint, position) +
                          " of its joint, not at " + PositionText(joint, leading.to) + "; " +
                          remedy});
  }
  std::erase_if(leading_, [&](const Leading& leading) { return now.tick >= leading.end_tick; });
}

void StepWatch::SeeArms(const Snapshot& now, const std::vector<PersonPlayer>& persons) {
  for (std::size_t i = 0; i < persons.size(); ++i) {
    const Person& person = scene_.persons[i];
    for (int limb = 0; limb < 4; ++limb) {
      Short& farthest = limbs_[i][static_cast<std::size_t>(limb)];
      const double by_m = persons[i].LimbIsShortBy(limb);
      if (by_m > farthest.by_m)
        farthest = {now.tick, by_m, persons[i].targets().limbs[static_cast<std::size_t>(limb)].end};
    }
    if (!person.has_body) continue;
    if (const double by_m = persons[i].HeadIsOffBy(); by_m > heads_[i].by_m)
      heads_[i] = {.tick = now.tick, .by_m = by_m};
    for (const bool right : {true, false}) {
      const HandIndex hand = right ? person.right_hand : person.left_hand;
      const PartRange parts = PartsOfLimb(person, right ? 0 : 1);
      if (hand != kNone) SeeContacts(hand, person.head + parts.begin, person.head + parts.end, now);
    }
  }
}

void StepWatch::SeeContacts(HandIndex hand, BodyIndex begin, BodyIndex end, const Snapshot& now) {
  const auto is_part = [&](const ContactSide& side) {
    return side.hand == kNone && side.body >= begin && side.body < end;
  };
  for (const ContactPoint& contact : now.contacts) {
    const bool a_is_part = is_part(contact.a);
    if (a_is_part == is_part(contact.b)) continue;
    const ContactSide &part = a_is_part ? contact.a : contact.b,
                      &thing = a_is_part ? contact.b : contact.a;
    if (thing.hand != kNone || Touches(hand, thing.body, now)) continue;
    const Body& body = scene_.body(thing.body);
    if (body.fixed || body.kinematic) continue;
    const Eigen::Vector3d& p_W_m = now.body(thing.body).X_WB.p_m;
    const auto [entry, is_new] = met_.try_emplace({hand, part.body, thing.body});
    Met& met = entry->second;
    if (is_new) met.tick = now.tick;
    if (!is_new && met.last_tick + 1 == now.tick) met.moved_m += (p_W_m - met.p_W_m).norm();
    met.last_tick = now.tick;
    met.p_W_m = p_W_m;
  }
}

std::vector<ScriptNote> StepWatch::Notes() const {
  std::vector<ScriptNote> notes = notes_;
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    const Person& person = scene_.persons[i];
    if (heads_[i].by_m > kNotedHead_m)
      notes.push_back({heads_[i].tick, kNone,
                       person.name + ": recording: her head is " + Millimetres(heads_[i].by_m) +
                           " from her neck, as a recorded head does not move her body: let her "
                           "stand, walk or lean below it, or write 'person: head'"});
    for (int limb = 0; limb < 4; ++limb) {
      const Short& farthest = limbs_[i][static_cast<std::size_t>(limb)];
      if (farthest.by_m <= kNotedLimb_m) continue;
      const HandIndex hand = HandAt(limb, person);
      const std::string away = Millimetres(farthest.by_m) + " before ";
      if (hand != kNone)
        notes.push_back({farthest.tick, hand,
                         "it is out of reach: the arm of " + person.name + " ends " + away +
                             "it; let her stand nearer, walk, turn or lean"});
      else
        notes.push_back(
            {farthest.tick, kNone,
             person.name + ": move_limb: her " + NameOf(farthest.end) + " ends " + away +
                 "its to_m, which is out of reach; let her stand nearer, walk, turn or lean"});
    }
  }
  for (const auto& [who, met] : met_) {
    const auto& [hand, part, thing] = who;
    const std::string& name = scene_.body(thing).name;
    notes.push_back(
        {met.tick, hand,
         "on its way " + scene_.body(part).name + " touches " + name +
             (met.moved_m < kMoved_m ? "" : " and moves it by " + Millimetres(met.moved_m)) +
             "; let her stand elsewhere, go another way, or make room"});
  }
  NoteFixed(notes);
  std::ranges::stable_sort(notes, {}, &ScriptNote::tick);
  return notes;
}

}  // namespace prehend::physics
