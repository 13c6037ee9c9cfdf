// SPDX-License-Identifier: Apache-2.0
// A stage for the oracle's tests: hand-made recordings without physics. What touches what is said,
// not computed.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "harness/truth/oracle/oracle.h"

namespace prehend::truth {

/// Three sensor sets: set 0 is the finger, 1 the thumb, 2 the palm. The palm is a box of 2 cm,
/// links are tiny.
inline physics::HandModel SmallHand() {
  physics::HandModel model;
  model.palm_size_m = {0.02, 0.02, 0.02};
  model.sensor_sets = {"fingers", "thumb", "palm"};
  model.palm_sensor_set = 2;
  model.links.resize(2);
  for (int i = 0; i < 2; ++i) {
    model.links[i].length_m = 0.01;
    model.links[i].sensor_set = i;
  }
  model.styles = {{.name = "wrap"}, {.name = "pinch"}};
  return model;
}

/// A table (body 0, top at z = 0), a cup (body 1, a cube of 6 cm), and what a test adds. Hand 0
/// starts out of reach and looks along x to the cup.
class Stage {
 public:
  struct Contact {
    physics::ContactSide a, b;
    Eigen::Vector3d nhat_BA_W = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d from_a_m = Eigen::Vector3d::Zero();  ///< from the origin of body a
    double impulse_n_s = 0;
  };
  static physics::ContactSide BodySide(int body) { return {.body = physics::BodyIndex(body)}; }
  static physics::ContactSide HandSide(int hand, int sensor_set) {
    return {.hand = physics::HandIndex(hand),
            .link = physics::LinkIndex(sensor_set == 2 ? -1 : sensor_set)};
  }

  /// `ticks_per_frame` is how often it is sensed; the world runs at 480 Hz.
  explicit Stage(int ticks_per_frame = 2) : ticks_per_frame_(ticks_per_frame) {
    table = AddBody("table", {1.2, 0.8, 0.04}, {0, 0, -0.02}, true);
    cup = AddBody("cup", {0.06, 0.06, 0.06}, {0.5, 0, 0.03}, false);
    AddHand("hand", {-0.5, 0, 0.03});
  }

  int AddBody(const std::string& name, const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_m,
              bool fixed) {
    scene_.bodies.push_back({.name = name,
                             .shapes = {{physics::Box{size_m}, {}}},
                             .fixed = fixed,
                             .mass_kg = fixed ? 0.0 : 0.2,
                             .X_WB = {p_m, Eigen::Quaterniond::Identity()}});
    now_.bodies.push_back({.X_WB = scene_.bodies.back().X_WB});
    return static_cast<int>(now_.bodies.size()) - 1;
  }

  int AddHand(const std::string& name, const Eigen::Vector3d& p_m) {
    scene_.hands.push_back({.name = name, .model = SmallHand()});
    physics::HandState state;
    state.palm.X_WB.p_m = p_m;
    state.X_WL.resize(2);
    now_.hands.push_back(state);
    return static_cast<int>(now_.hands.size()) - 1;
  }

  struct Moving {
    int body = 0;
    Eigen::Vector3d m_per_s;
  };

  /// Appends frames while the hand and the named bodies move steadily.
  void Play(double seconds, const Eigen::Vector3d& hand_m_per_s = Eigen::Vector3d::Zero(),
            const std::vector<Moving>& bodies = {}) {
    for (physics::BodyState& body : now_.bodies) body.v_WB_m_per_s.setZero();
    for (const Moving& moving : bodies) now_.bodies[moving.body].v_WB_m_per_s = moving.m_per_s;
    const double frame_s = ticks_per_frame_ / 480.0;
    for (long i = std::lround(seconds / frame_s); i > 0; --i) {
      hand().palm.X_WB.p_m += hand_m_per_s * frame_s;
      for (physics::Pose& link : hand().X_WL) link.p_m = hand().palm.X_WB.p_m + finger_m;
      for (physics::BodyState& body : now_.bodies) body.X_WB.p_m += body.v_WB_m_per_s * frame_s;
      Record();
    }
  }

  /// Hand and cup move together.
  void Carry(double seconds, const Eigen::Vector3d& m_per_s) {
    Play(seconds, m_per_s, {{cup, m_per_s}});
  }

  /// Brings the hand to the cup's side and grasps it, with one frame of fixation.
  void GraspCup() {
    Play(1.6, {0.6, 0, 0});
    trigger = 1;
    sets = 1;
    Play(ticks_per_frame_ / 480.0);
    sets = 2;
  }

  physics::HandState& hand(int hand = 0) { return now_.hands[static_cast<std::size_t>(hand)]; }
  physics::BodyState& body(int body) { return now_.bodies[body]; }
  grammar::Tick now() const {
    return static_cast<grammar::Tick>(frames_.size()) * ticks_per_frame_;
  }
  grammar::Timeline Truth() const { return TrueTimeline(scene_, frames_, now()); }

  int table = 0, cup = 0;
  bool cup_on_table = true;
  double trigger = 0;
  int sets = 0;  ///< how many sensor sets of hand 0 touch the cup
  Eigen::Vector3d finger_m = Eigen::Vector3d::Zero();  ///< links, from the palm
  std::vector<Contact> contacts;                       ///< further ones

 private:
  void Record() {
    physics::Snapshot frame = now_;
    frame.tick = now();
    frame.hands[0].trigger = trigger;
    std::vector<Contact> all = contacts;
    if (cup_on_table) all.push_back({BodySide(cup), BodySide(table)});
    for (int set = 0; set < sets; ++set)
      all.push_back({BodySide(cup), HandSide(0, set), Eigen::Vector3d::UnitX()});
    for (const Contact& contact : all)
      frame.contacts.push_back({.a = contact.a,
                                .b = contact.b,
                                .p_W_m = body(contact.a.body.number()).X_WB.p_m + contact.from_a_m,
                                .nhat_BA_W = contact.nhat_BA_W,
                                .normal_impulse_n_s = contact.impulse_n_s});
    frames_.push_back(frame);
  }

  int ticks_per_frame_;
  physics::Scene scene_;
  physics::Snapshot now_;
  std::vector<physics::Snapshot> frames_;
};

using Intervals = std::vector<grammar::Interval>;

inline Intervals Of(const std::string& label, const grammar::Timeline& timeline) {
  Intervals intervals;
  for (const grammar::NamedEvent& event : timeline.events)
    if (event.Label() == label) intervals.push_back(event.interval);
  return intervals;
}

/// The same number of intervals, boundaries at most `tolerance` ticks apart.
inline void ExpectNear(const Intervals& found, const Intervals& expected,
                       grammar::Tick tolerance = 2) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(found[i].begin), static_cast<double>(expected[i].begin),
                tolerance)
        << "event " << i;
    EXPECT_NEAR(static_cast<double>(found[i].end), static_cast<double>(expected[i].end), tolerance)
        << "event " << i;
  }
}

}  // namespace prehend::truth

namespace prehend::grammar {
inline void PrintTo(const Interval& interval, std::ostream* out) {
  *out << "[" << interval.begin << ", " << interval.end << ")";
}
}  // namespace prehend::grammar
