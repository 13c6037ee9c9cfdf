// SPDX-License-Identifier: Apache-2.0
#include "harness/oracle/recording.h"

#include <array>
#include <bit>
#include <cstdint>

namespace prehend::harness::oracle {

double Recording::Seconds(int from_frame, int to_frame) const {
  return static_cast<double>(ticks[to_frame] - ticks[from_frame]) / scene.world.rate_hz;
}

double Recording::Lasts_s(Span span) const {
  const grammar::Tick end = span.end < size() ? ticks[span.end] : ticks.back() + 1;
  return static_cast<double>(end - ticks[span.begin]) / scene.world.rate_hz;
}

const std::string& Recording::name(int entity) const {
  return entity < body_count() ? scene.bodies[entity].name
                               : scene.hands[entity - body_count()].name;
}

Recording MakeRecording(const physics::Scene& scene, std::span<const physics::Snapshot> frames) {
  Recording recording{scene, frames, {}};
  for (const physics::Snapshot& frame : frames) recording.ticks.push_back(frame.tick);
  return recording;
}

Eigen::Vector3d VelocityAt(const physics::BodyState& body, const Eigen::Vector3d& p_W_m) {
  return body.v_WB_m_per_s + body.w_WB_rad_per_s.cross(p_W_m - body.X_WB.p_m);
}

Eigen::Vector3d RelativeVelocity(const physics::BodyState& object,
                                 const physics::BodyState& support) {
  return object.v_WB_m_per_s - VelocityAt(support, object.X_WB.p_m);
}

namespace {

/// In which frames something holds, for every pair of which it ever holds.
using Flags = std::map<Pair, std::vector<bool>>;

struct RawTouches {
  Flags touching, gripped;  ///< gripped: (hand index, body)
  Flags borne, at_rest;     ///< (object, support); at rest: it moves neither up nor down on it
};

/// How two bodies bear on each other in one frame. Of a touch that does not push, all points count
/// alike.
struct Bearing {
  Eigen::Vector3d places = Eigen::Vector3d::Zero(), loaded = Eigen::Vector3d::Zero();
  double level = 0, load_n_s = 0;

  void Add(const physics::ContactPoint& point) {
    const double upright = std::abs(point.nhat_BA_W.z());
    level += upright;
    places += upright * point.p_W_m;
    load_n_s += upright * point.normal_impulse_n_s;
    loaded += upright * point.normal_impulse_n_s * point.p_W_m;
  }
  Eigen::Vector3d Centre() const {
    if (load_n_s > 0) return loaded / load_n_s;
    return places / level;
  }
};

class TouchReader {
 public:
  TouchReader(const Recording& recording, const OracleSettings& settings)
      : recording_(recording), settings_(settings) {}

  RawTouches Read() {
    for (int frame = 0; frame < recording_.size(); ++frame) {
      std::map<Pair, std::uint32_t> sensor_sets;  // of (hand, body)
      std::map<Pair, Bearing> bearings;           // of (object, support)
      for (const auto& points : recording_.frames[frame].AllContacts())
        for (const physics::ContactPoint& point : points)
          ReadPoint(point, frame, sensor_sets, bearings);
      for (const auto& [pair, bearing] : bearings)
        if (BearsAt(pair, frame) && RestsAt(pair, bearing, frame)) Mark(raw_.at_rest, pair, frame);
      for (const auto& [pair, sets] : sensor_sets)
        if (std::popcount(sets) >= settings_.grasp_sensor_sets) Mark(raw_.gripped, pair, frame);
    }
    return raw_;
  }

 private:
  void ReadPoint(const physics::ContactPoint& point, int frame,
                 std::map<Pair, std::uint32_t>& sensor_sets, std::map<Pair, Bearing>& bearings) {
    const int a = Entity(point.a), b = Entity(point.b);
    if (a == b) return;
    Mark(raw_.touching, std::minmax(a, b), frame);
    if (IsBody(a) && IsBody(b)) {
      if (Bears(point.nhat_BA_W.z(), {a, b})) Mark(raw_.borne, {a, b}, frame);
      if (Bears(-point.nhat_BA_W.z(), {b, a})) Mark(raw_.borne, {b, a}, frame);
      bearings[{a, b}].Add(point);
      bearings[{b, a}].Add(point);
    } else if (IsBody(a) || IsBody(b)) {
      const physics::ContactSide& hand = IsBody(a) ? point.b : point.a;
      sensor_sets[{hand.hand, IsBody(a) ? a : b}] |= 1u << SensorSet(hand);
    }
  }
  bool IsBody(int entity) const { return entity < recording_.body_count(); }

  int Entity(const physics::ContactSide& side) const {
    return side.hand >= 0 ? recording_.body_count() + side.hand : side.body;
  }

  int SensorSet(const physics::ContactSide& side) const {
    const physics::HandModel& model = recording_.scene.hands[side.hand].model;
    return side.link < 0 ? model.palm_sensor_set : model.links[side.link].sensor_set;
  }

  /// `up`: of the normal on the object, (object, support).
  bool Bears(double up, Pair pair) const {
    const auto& [object, support] = pair;
    return up >= settings_.support_up && physics::MovesFreely(recording_.scene, object) &&
           physics::IsThing(recording_.scene.bodies[static_cast<std::size_t>(support)]);
  }

  bool BearsAt(Pair pair, int frame) const {
    const auto frames = raw_.borne.find(pair);
    return frames != raw_.borne.end() && frames->second[frame];
  }

  /// Where the load is borne, or in its middle, the object moves neither up nor down on the
  /// support.
  bool RestsAt(Pair pair, const Bearing& bearing, int frame) const {
    const physics::BodyState &held = recording_.body(pair.first, frame),
                             &by = recording_.body(pair.second, frame);
    return std::ranges::any_of(
        std::array{bearing.Centre(), held.X_WB.p_m}, [&](const Eigen::Vector3d& p_W_m) {
          return std::abs((VelocityAt(held, p_W_m) - VelocityAt(by, p_W_m)).z()) <=
                 settings_.support_speed_m_per_s;
        });
  }

  void Mark(Flags& flags, Pair pair, int frame) const {
    std::vector<bool>& frames = flags[pair];
    frames.resize(recording_.size());
    frames[frame] = true;
  }

  const Recording& recording_;
  const OracleSettings& settings_;
  RawTouches raw_;
};

std::map<Pair, Spans> BridgeAll(const Recording& recording, const Flags& flags, double bridge_s) {
  std::map<Pair, Spans> spans;
  for (const auto& [pair, frames] : flags)
    spans[pair] = Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(bridge_s));
  return spans;
}

/// From where it is at rest on what bears it until that does no more: it may tip or roll in
/// between. What is over in a moment was a blow.
std::map<Pair, Spans> SupportsOf(const Recording& recording, const RawTouches& raw,
                                 const OracleSettings& settings) {
  std::map<Pair, Spans> supports;
  for (const auto& [pair, at_rest] : raw.at_rest) {
    Spans spans;
    for (Span span : WhereTrue(raw.borne.at(pair))) {
      while (!span.empty() && !at_rest[span.begin]) ++span.begin;
      if (!span.empty()) spans.push_back(span);
    }
    spans = Bridged(spans, recording.ticks, recording.Ticks(settings.contact_bridge_s));
    std::erase_if(spans, [&](const Span& span) {
      return recording.Lasts_s(span) < settings.support_minimum_s;
    });
    supports[pair] = spans;
  }
  return supports;
}

Spans WhereGripIsCommanded(const Recording& recording, const OracleSettings& settings, int hand) {
  std::vector<bool> commanded;
  for (int frame = 0; frame < recording.size(); ++frame)
    commanded.push_back(recording.hand(hand, frame).trigger >= settings.commanded_trigger);
  return WhereTrue(commanded);
}

void SayHowLongTheyTouched(const Recording& recording, Touches& touches) {
  const Grasp* before = nullptr;
  for (Grasp& grasp : touches.grasps) {
    for (const Span& contact :
         touches.contacts.at({grasp.body, recording.body_count() + grasp.hand}))
      if (contact.Contains(grasp.span.begin)) grasp.touched_since = contact.begin;
    const bool again = before && before->hand == grasp.hand && before->body == grasp.body;
    if (again) grasp.touched_since = std::max(grasp.touched_since, before->span.end);
    before = &grasp;
  }
}

}  // namespace

Touches FindTouches(const Recording& recording, const OracleSettings& settings) {
  const RawTouches raw = TouchReader(recording, settings).Read();
  Touches touches;
  touches.contacts = BridgeAll(recording, raw.touching, settings.contact_bridge_s);
  touches.supports = SupportsOf(recording, raw, settings);
  for (const auto& [pair, frames] : raw.gripped) {
    const auto& [hand, body] = pair;
    const Spans tight =
        Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(settings.grasp_bridge_s));
    // Letting go ends a grasp at once, and none begins before the hand feels the object again.
    for (const Span& squeeze : WhereGripIsCommanded(recording, settings, hand)) {
      for (Span span : Within(tight, squeeze)) {
        while (!span.empty() && !frames[span.begin]) ++span.begin;
        if (!span.empty()) touches.grasps.push_back({hand, body, span, span.begin});
      }
    }
  }
  SayHowLongTheyTouched(recording, touches);
  return touches;
}

}  // namespace prehend::harness::oracle
