// SPDX-License-Identifier: Apache-2.0
// The part of the ScriptPlayer that looks at the world while a step is played: steps that end when
// something happens, and steps that press. Tested by tests/physics/hand/guarded_motion_test.cc
#include <algorithm>
#include <cmath>
#include <set>

#include "physics/hand/hand_clearance.h"
#include "physics/hand/script_player.h"
#include "physics/hand/step_notes.h"
#include "physics/scene/geometry.h"

namespace prehend::physics {
namespace {

/// The force is a mean over this time.
constexpr double kForce_s = 0.02;
/// A hand that presses too little goes on as if it were held back by the palm's spring and a damper
/// with this time constant,
constexpr double kPressing_s = 0.1;
/// but not faster.
constexpr double kMaxPressing_m_per_s = 0.05;
/// A hand that is to stop at a gap brakes with this, where the gap shrinks faster than it could
/// stop in time,
constexpr double kBraking_m_per_s2 = 2;
/// but it goes on at this speed.
constexpr double kCreep_m_per_s = 0.04;
/// The rate at which the gap shrinks is that of the target within this time.
constexpr double kAhead_s = 0.01;
/// A hand that closes around what stands does not push it aside: its target comes to the palm with
/// this time constant. When it has closed it stays there.
constexpr double kSoft_s = 0.05;
/// What interpolates between two equal poses is not the same to the last bit.
constexpr double kSamePlace = 1e-9;
/// A grip from here on is meant to hold something.
constexpr double kClosed = 0.5;
/// Hands that press are sent up to 4 cm into a thing; farther off, a hand did not get there.
constexpr double kNotedWay_m = 0.05;
/// A hand that reaches less than this share of the force is noted.
constexpr double kNotedForceShare = 0.8;

}  // namespace

int HandsOn(BodyIndex body, const Snapshot& now) {
  std::set<HandIndex> hands;
  for (const ContactPoint& contact : now.contacts) {
    if (contact.a.body == body && contact.b.hand != kNone) hands.insert(contact.b.hand);
    if (contact.b.body == body && contact.a.hand != kNone) hands.insert(contact.a.hand);
  }
  return static_cast<int>(hands.size());
}

bool Touches(HandIndex hand, BodyIndex body, const Snapshot& now) {
  return std::ranges::any_of(now.contacts, [&](const ContactPoint& contact) {
    return (contact.a.hand == hand && contact.b.hand == kNone && contact.b.body == body) ||
           (contact.b.hand == hand && contact.a.hand == kNone && contact.a.body == body);
  });
}

std::string Millimetres(double length_m) {
  return std::to_string(std::lround(1000 * length_m)) + " mm";
}

bool ScriptPlayer::IsTouched(HandIndex hand, BodyIndex thing, const Snapshot& now) const {
  const BodyIndex object = At(hands_, hand).object;
  const BodyIndex held =
      object != kNone && object != thing && Touches(hand, object, now) ? object : kNone;
  bool touched = false;
  ForEachContact(hand, held, thing, now, [&](const ContactPoint& contact) {
    touched |= contact.distance_m <= 0 || contact.normal_impulse_n_s > 0;
  });
  return touched;
}

double ScriptPlayer::GapTo(HandIndex hand, BodyIndex thing, const Snapshot& now) const {
  const HandClearance clearance(scene_, hand, now.hand(hand).joints);
  return clearance.To(thing, now.hand(hand).palm.X_WB, now);
}

void ScriptPlayer::WatchGuards(const Snapshot& now) {
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    HandState& hand = hands_[h];
    if (!hand.waiting || hand.waiting->met || tick_in_stage_ >= clock_.EndOf(*hand.step)) continue;
    const HandIndex index(h);
    const Until& until = hand.waiting->until;
    hand.waiting->met = Happens(until, index, now);
    if (!hand.waiting->met) {
      if (until.gap_m && until.who.empty()) Brake(h, now);
      continue;
    }
    // It stays where it is: the target is ahead of the hand, which would go on to it.
    hand.target = TargetOf(hand);
    hand.yielded.reset();
    if (const Eigen::Vector3d ahead_W = hand.target.v_m_per_s.normalized(); !ahead_W.isZero()) {
      const double ahead_m = ahead_W.dot(hand.target.X_WH.p_m - now.hands[h].palm.X_WB.p_m);
      hand.target.X_WH.p_m -= std::max(ahead_m, 0.0) * ahead_W;
    }
    hand.target.v_m_per_s.setZero();
    hand.target.w_rad_per_s.setZero();
    hand.motion = Trajectory(hand.target);
    hand.begin_tick = tick_in_stage_;
    hand.pace = 1;
    hand.behind_s = 0;
    clock_.SetEnd(*hand.step, tick_in_stage_);
  }
}

bool ScriptPlayer::Happens(const Until& until, HandIndex own, const Snapshot& now) const {
  const BodyIndex thing = FindBody(scene_, until.thing);
  const auto named = std::ranges::find(scene_.hands, until.who, &Hand::name);
  const HandIndex hand =
      named == scene_.hands.end() ? own : HandIndex(named - scene_.hands.begin());
  if (until.gap_m) return GapTo(hand, thing, now) < *until.gap_m;
  if (until.who.empty() || named != scene_.hands.end()) return IsTouched(hand, thing, now);
  const BodyIndex body = FindBody(scene_, until.who);
  const auto is_of = [&](const ContactSide& side, BodyIndex of) {
    return side.hand == kNone && side.body == of;
  };
  return std::ranges::any_of(now.AllContacts(), [&](const auto& points) {
    return std::ranges::any_of(points, [&](const ContactPoint& contact) {
      return (is_of(contact.a, body) && is_of(contact.b, thing)) ||
             (is_of(contact.b, body) && is_of(contact.a, thing));
    });
  });
}

void ScriptPlayer::WatchPersons(const Snapshot& now) {
  if (settling_ || stage_ == 0) return;
  const ScriptStage& stage = script_.stages[stage_ - 1];
  for (std::size_t i = 0; i < stage.person_steps.size(); ++i) {
    const std::optional<Until>& until = stage.person_steps[i].until;
    const std::size_t step = stage.steps.size() + i;
    if (!until || !clock_.Plays(step) || tick_in_stage_ > clock_.EndOf(step)) continue;
    const bool is_over = tick_in_stage_ == clock_.EndOf(step);
    if (Happens(*until, kNone, now))
      clock_.SetEnd(step, tick_in_stage_);
    else if (is_over && !until->or_go_on)
      Fail(kNone, "until: the step of " +
                      scene_.persons[static_cast<std::size_t>(stage.person_steps[i].person)].name +
                      " is over, and '" + until->who + "' has not " +
                      (until->gap_m ? "come so near to" : "touched") + " '" + until->thing + "'");
  }
}

void ScriptPlayer::Brake(std::size_t hand, const Snapshot& now) {
  HandState& state = hands_[hand];
  const double rate_hz = scene_.world.rate_hz, t_s = MotionTime(state);
  const HandClearance clearance(scene_, HandIndex(hand), now.hands[hand].joints);
  const auto gap_m = [&](double at_s) {
    return clearance.To(state.waiting->thing, state.motion.At(at_s).X_WH, now);
  };
  const double here_m = gap_m(t_s);
  const double shrinks_m_per_s = (here_m - gap_m(t_s + kAhead_s)) / kAhead_s;
  const double left_m = std::max(here_m - *state.waiting->until.gap_m, 0.0);
  const double most_m_per_s = std::max(std::sqrt(2 * kBraking_m_per_s2 * left_m), kCreep_m_per_s);
  state.pace = shrinks_m_per_s > most_m_per_s ? most_m_per_s / shrinks_m_per_s : 1;
  const double before_s = state.behind_s;
  state.behind_s += (1 - state.pace) / rate_hz;
  const auto later = static_cast<std::int64_t>(std::ceil(state.behind_s * rate_hz) -
                                               std::ceil(before_s * rate_hz));
  clock_.SetEnd(*state.step, clock_.EndOf(*state.step) + later);
}

void ScriptPlayer::CheckGuard(std::size_t hand, const Snapshot& now) {
  const std::optional<Waiting>& waiting = hands_[hand].waiting;
  if (!waiting || waiting->met || waiting->until.or_go_on) return;
  const HandIndex index(hand);
  if (const std::string& who = waiting->until.who; !who.empty())
    return Fail(index, "until: the step is over, and '" + who + "' has not " +
                           (waiting->until.gap_m ? "come so near to" : "touched") + " '" +
                           waiting->until.thing + "'");
  const double gap_m = GapTo(index, waiting->thing, now);
  const std::string away = gap_m >= HandClearance::kFar_m
                               ? "more than " + Millimetres(HandClearance::kFar_m)
                               : Millimetres(gap_m);
  const std::string wanted = waiting->until.gap_m
                                 ? "come nearer than " + Millimetres(*waiting->until.gap_m) + " to"
                                 : "touched";
  Fail(index, "until: the step is over, and '" + scene_.hands[hand].name + "' has not " + wanted +
                  " '" + waiting->until.thing + "': it is " + away + " away from it");
}

void ScriptPlayer::NoteTheGrip(std::size_t hand, const Snapshot& now) {
  const HandState& state = hands_[hand];
  if (!state.step || state.object == kNone) return;
  const Step& step = script_.stages[stage_ - 1].steps[*state.step];
  const auto* grip = std::get_if<TriggerStep>(&step.action);
  const bool met = state.waiting && state.waiting->met;
  if (!grip || grip->trigger < kClosed || met || !state.closes || state.let_go) return;
  std::string note = NoteAboutGrip(scene_, now, HandIndex(hand), state.object, grip->trigger);
  if (note.empty()) return;
  notes_.push_back({now.tick, HandIndex(hand), std::move(note)});
  hands_[hand].grip_note = GripNote{now.tick, state.object};
}

void ScriptPlayer::NoteTheWay(std::size_t hand, const Snapshot& now) {
  const HandState& state = hands_[hand];
  if (!state.step || (state.waiting && state.waiting->met)) return;
  const Step& step = script_.stages[stage_ - 1].steps[*state.step];
  if (!std::holds_alternative<MoveStep>(step.action) &&
      !std::holds_alternative<CarryStep>(step.action))
    return;
  const HandIndex index(hand);
  const double off_m = (TargetOf(state).X_WH.p_m - now.hand(index).palm.X_WB.p_m).norm();
  if (off_m < kNotedWay_m) return;
  std::string note = NoteAboutWay(scene_, now, index, off_m);
  notes_.push_back({now.tick, index, std::move(note)});
}

void ScriptPlayer::WithdrawNotes(const Snapshot& now) {
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    std::optional<GripNote>& grip_note = hands_[h].grip_note;
    if (!grip_note) continue;
    const HandIndex hand = HandIndex(h);
    if (hands_[h].object != grip_note->object || TargetOf(hands_[h]).trigger < kClosed) {
      grip_note.reset();
    } else if (IsHeldBySides(scene_, now, hand, grip_note->object)) {
      std::erase_if(notes_, [&](const ScriptNote& note) {
        return note.tick == grip_note->tick && note.hand == hand;
      });
      grip_note.reset();
    }
  }
}

/// Whether what a hand touches is fixed, hangs on something fixed, or touches it, directly or not.
/// What a hand lifts together is not.
bool IsHeldBack(const Scene& scene, const Snapshot& now, HandIndex hand) {
  std::vector<bool> reached(scene.bodies.size());
  bool fixed = false, more = false;
  const auto reach = [&](BodyIndex body) {
    if (reached[body.index()]) return;
    reached[body.index()] = more = true;
    fixed |= scene.body(body).fixed;
  };
  for (const ContactPoint& contact : now.contacts) {
    if (contact.a.hand == hand && contact.b.hand == kNone) reach(contact.b.body);
    if (contact.b.hand == hand && contact.a.hand == kNone) reach(contact.a.body);
  }
  const auto pass = [&](BodyIndex a, BodyIndex b) {
    if (reached[a.index()]) reach(b);
    if (reached[b.index()]) reach(a);
  };
  while (more && !fixed) {
    more = false;
    for (const Joint& joint : scene.joints) pass(joint.base, joint.body);
    for (const auto& points : now.AllContacts())
      for (const ContactPoint& contact : points)
        if (contact.a.hand == kNone && contact.b.hand == kNone)
          pass(contact.a.body, contact.b.body);
  }
  return fixed;
}

bool ScriptPlayer::Rests(const HandState& hand) const {
  if (hand.placing || hand.pressing) return false;
  const Pose now = hand.motion.At(MotionTime(hand)).X_WH, &end = hand.target.X_WH;
  return (now.p_m - end.p_m).norm() < kSamePlace &&
         (now.q.coeffs() - end.q.coeffs()).norm() < kSamePlace;
}

bool ScriptPlayer::Grips(const HandState& hand) const {
  if (!hand.step || settling_) return false;
  return std::holds_alternative<TriggerStep>(script_.stages[stage_ - 1].steps[*hand.step].action);
}

void ScriptPlayer::GiveWay(const Snapshot& now) {
  // The two engines of the plane hold by different contacts, and would no longer lift alike.
  if (scene_.world.planar) return;
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    HandState& hand = hands_[h];
    hand.yields_m_per_s.setZero();
    hand.yields_rad_per_s.setZero();
    hand.lets_go = hand.placing && hand.placing->Stands();
    if (!Rests(hand)) continue;
    if (hand.took && hand.closes) KeepStanding(h, now);
    if (!IsHeldBack(scene_, now, HandIndex(h))) continue;
    hand.lets_go = Grips(hand) && !hand.closes;
    const HandModel& model = scene_.hands[h].model;
    const Pose &target = TargetOf(hand).X_WH, &palm = now.hands[h].palm.X_WB;
    const auto share = [&](const PidGains& gains) {
      return gains.integral / (gains.proportional * scene_.world.rate_hz);
    };
    Pose by = hand.yielded.value_or(Pose{});
    Eigen::Vector3d shares = Eigen::Vector3d::Constant(share(model.translation));
    if (hand.took && hand.closes)
      shares.head<2>().setConstant(Grips(hand) ? 1 / (kSoft_s * scene_.world.rate_hz) : 0);
    by.p_m += shares.cwiseProduct(palm.p_m - target.p_m);
    const Eigen::Vector3d turn =
        share(model.rotation) * RotationVector(palm.q * target.q.conjugate());
    const Eigen::Vector3d half = turn / 2;
    by.q = (Eigen::Quaterniond(1, half.x(), half.y(), half.z()) * by.q).normalized();
    hand.yielded = by;
  }
}

/// Follows the force.
void ScriptPlayer::Press(const Snapshot& now) {
  const double rate_hz = scene_.world.rate_hz;
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    if (!hands_[h].pressing) continue;
    Pressing& pressing = *hands_[h].pressing;
    const HandIndex hand(h);
    const BodyIndex object = hands_[h].object;
    const bool holds = object != kNone && object != pressing.against && Touches(hand, object, now);
    double impulse_n_s = 0;
    ForEachContact(hand, holds ? object : kNone, pressing.against, now,
                   [&](const ContactPoint& contact) { impulse_n_s += contact.normal_impulse_n_s; });
    const double share = std::min(1 / (kForce_s * rate_hz), 1.0);
    pressing.present_n += share * (impulse_n_s * rate_hz - pressing.present_n);
    const double stiffness_n_per_m = std::max(scene_.hands[h].model.translation.proportional, 1.0);
    const double speed_m_per_s =
        std::clamp((pressing.force_n - pressing.present_n) / (stiffness_n_per_m * kPressing_s),
                   -kMaxPressing_m_per_s, kMaxPressing_m_per_s);
    pressing.depth_m = std::max(pressing.depth_m + speed_m_per_s / rate_hz, 0.0);
    if (tick_in_stage_ + 1 == PlannedEnd(hands_[h]) &&
        pressing.present_n < kNotedForceShare * pressing.force_n) {
      notes_.push_back({now.tick, hand,
                        "presses with " + std::to_string(std::lround(pressing.present_n)) +
                            " N against " + scene_.body(pressing.against).name + ", not with " +
                            std::to_string(std::lround(pressing.force_n)) + " N"});
    }
  }
}

}  // namespace prehend::physics
