// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/truth/oracle/oracle_test.cc
#include "harness/truth/oracle/evidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace prehend::truth {
namespace {

using Eigen::Vector3d;

/// A contact that does not push for longer than this is over (docs/physics.md).
constexpr grammar::Tick kReleaseTicks = 4;
/// The impulse of a resting contact flickers; its mean over so many ticks does not.
constexpr grammar::Tick kAsleepTicks = 48;

/// The points between two bodies in one frame, as they act on the first. Of a touch without known
/// forces, all points count alike.
struct Push {
  int frame = 0;
  Vector3d impulse_n_s = Vector3d::Zero();
  Vector3d centre_W_m = Vector3d::Zero();  ///< weighted sum of the points
  double weight = 0;

  void Add(const Vector3d& nhat_W, const Vector3d& p_W_m, double impulse) {
    impulse_n_s += impulse * nhat_W;
    centre_W_m += impulse * p_W_m;
    weight += impulse;
  }
};

class EvidenceReader {
 public:
  EvidenceReader(const Recording& recording, Evidence& evidence)
      : recording_(recording), evidence_(evidence), has_forces_(HasForces()) {}

  void Read() {
    for (int frame = 0; frame < recording_.size(); ++frame) {
      std::map<Pair, std::uint32_t> sets;  // of (hand, body)
      for (const auto& points : recording_.frames[frame].AllContacts())
        for (const physics::ContactPoint& point : points) ReadPoint(point, frame, sets);
      for (const auto& [pair, bits] : sets) {
        evidence_.sensor_sets[pair].resize(recording_.size());
        evidence_.sensor_sets[pair][frame] = bits;
      }
    }
    for (const auto& [pair, pushes] : pushes_) ReadBearing(pair, pushes);
  }

 private:
  bool HasForces() const {
    for (const physics::Snapshot& frame : recording_.frames)
      for (const auto& points : frame.AllContacts())
        for (const physics::ContactPoint& point : points)
          if (point.normal_impulse_n_s > 0) return true;
    return false;
  }

  void ReadPoint(const physics::ContactPoint& point, int frame,
                 std::map<Pair, std::uint32_t>& sets) {
    const int a = Entity(point.a), b = Entity(point.b);
    if (a == b) return;
    std::vector<bool>& touching = evidence_.touching[std::minmax(a, b)];
    touching.resize(recording_.size());
    touching[frame] = true;
    if (IsBody(a) && IsBody(b)) {
      AddPush({a, b}, point, frame, point.nhat_BA_W);
      AddPush({b, a}, point, frame, -point.nhat_BA_W);
    } else if (IsBody(a) || IsBody(b)) {
      const physics::ContactSide& hand = IsBody(a) ? point.b : point.a;
      const Pair pair{hand.hand.number(), IsBody(a) ? a : b};
      sets[pair] |= 1u << SensorSet(hand);
      std::vector<double>& forces_n = evidence_.forces_n[pair];
      forces_n.resize(recording_.size());
      forces_n[frame] += point.normal_impulse_n_s * recording_.scene.world.rate_hz;
    }
  }

  void AddPush(Pair pair, const physics::ContactPoint& point, int frame, const Vector3d& nhat_W) {
    if (!physics::MovesFreely(recording_.scene, physics::BodyIndex(pair.first)) ||
        !physics::IsThing(recording_.scene.body(physics::BodyIndex(pair.second))))
      return;
    std::vector<Push>& pushes = pushes_[pair];
    if (pushes.empty() || pushes.back().frame != frame) pushes.push_back({.frame = frame});
    pushes.back().Add(nhat_W, point.p_W_m, has_forces_ ? point.normal_impulse_n_s : 1.0);
  }

  /// What pushed in the last ticks still bears: contacts of a body at rest flicker.
  void ReadBearing(Pair pair, const std::vector<Push>& pushes) {
    const auto& [object, support] = pair;
    std::vector<Bearing>& bearings = evidence_.bearings[pair];
    bearings.resize(recording_.size());
    Vector3d nhat_S = Vector3d::UnitZ();
    std::size_t first = 0, next = 0;  // the pushes of the last ticks: [first, next)
    int first_frame = 0;              // of the last ticks
    for (int frame = 0; frame < recording_.size(); ++frame) {
      Bearing& bearing = bearings[frame];
      if (next < pushes.size() && pushes[next].frame == frame) {
        bearing.touching = true;
        ++next;
      }
      while (first < next &&
             recording_.ticks[frame] - recording_.ticks[pushes[first].frame] > kReleaseTicks)
        ++first;
      while (recording_.ticks[frame] - recording_.ticks[first_frame] > kReleaseTicks) ++first_frame;
      Push sum;
      for (std::size_t i = first; i < next; ++i) {
        sum.impulse_n_s += pushes[i].impulse_n_s;
        sum.centre_W_m += pushes[i].centre_W_m;
        sum.weight += pushes[i].weight;
      }
      const physics::BodyState &held = recording_.body(object, frame),
                               &by = recording_.body(support, frame);
      Vector3d centre_W_m = held.X_WB.p_m;
      if (sum.weight > 0) {
        centre_W_m = sum.centre_W_m / sum.weight;
        bearing.share = ShareOf(object, sum.impulse_n_s.z() / (frame - first_frame + 1));
      }
      if (const double force = sum.impulse_n_s.norm(); force > 0) {
        bearing.up = sum.impulse_n_s.z() / force;
        nhat_S = by.X_WB.q.inverse() * (sum.impulse_n_s / force);
      } else if (bearing.touching && frame > 0) {
        bearing.up = bearings[frame - 1].up;  // no force passes, and they have not parted yet
      }
      // Of a contact that rests, a snapshot repeats the last tick, whose impulse may be next to
      // none: what sleeps is borne as it was before it fell asleep.
      if (frame > 0 && held.asleep && bearing.touching && bearings[frame - 1].touching) {
        const bool falls_asleep = !recording_.body(object, frame - 1).asleep;
        bearing.up = bearings[frame - 1].up;
        bearing.share = falls_asleep ? MeanShareBefore(bearings, frame) : bearings[frame - 1].share;
      }
      const auto relative_at = [&](const Vector3d& p_W_m) {
        return Vector3d(VelocityAt(held, p_W_m) - VelocityAt(by, p_W_m));
      };
      if (bearing.touching)
        bearing.vertical_m_per_s = std::min(std::abs(relative_at(centre_W_m).z()),
                                            std::abs(relative_at(held.X_WB.p_m).z()));
      const Vector3d nhat_W = by.X_WB.q * nhat_S;
      const double off_m = (held.X_WB.p_m - centre_W_m).dot(nhat_W);
      bearing.along_m_per_s = std::numeric_limits<double>::infinity();
      for (const int middle : {0, 1}) {
        const Vector3d v = relative_at(middle ? held.X_WB.p_m - off_m * nhat_W : centre_W_m);
        const Vector3d along = v - v.dot(nhat_W) * nhat_W;
        bearing.along_m_per_s = std::min(bearing.along_m_per_s, along.norm());
        if (frame > 0)
          bearing.along_m[middle] =
              bearings[frame - 1].along_m[middle] +
              by.X_WB.q.inverse() * along * recording_.Seconds(frame - 1, frame);
      }
    }
  }

  /// In the last ticks before a frame, the first of which may be before the recording.
  double MeanShareBefore(const std::vector<Bearing>& bearings, int frame) const {
    double sum = 0;
    int first = frame;
    while (first > 0 && recording_.ticks[frame] - recording_.ticks[first - 1] <= kAsleepTicks)
      sum += bearings[--first].share;
    return sum / std::max(frame - first, 1);
  }

  /// `impulse_n_s`: per tick.
  double ShareOf(int object, double impulse_n_s) const {
    if (!has_forces_) return std::numeric_limits<double>::infinity();
    const double weight_n = recording_.scene.body(physics::BodyIndex(object)).mass_kg *
                            recording_.scene.world.gravity_m_per_s2;
    if (weight_n <= 0) return std::numeric_limits<double>::infinity();
    return impulse_n_s * recording_.scene.world.rate_hz / weight_n;
  }

  bool IsBody(int entity) const { return entity < recording_.body_count(); }

  int Entity(const physics::ContactSide& side) const {
    return side.hand != physics::kNone ? recording_.body_count() + side.hand.number()
                                       : side.body.number();
  }

  int SensorSet(const physics::ContactSide& side) const {
    const physics::HandModel& model = recording_.scene.hand(side.hand).model;
    return side.link == physics::kNone ? model.palm_sensor_set : model.link(side.link).sensor_set;
  }

  const Recording& recording_;
  Evidence& evidence_;
  const bool has_forces_;
  std::map<Pair, std::vector<Push>> pushes_;
};

/// The farthest that palm or a finger is in one state from where it is in the other.
double Farthest_m(const physics::HandState& a, const physics::HandState& b) {
  double farthest_m = (a.palm.X_WB.p_m - b.palm.X_WB.p_m).norm();
  for (std::size_t i = 0; i < a.X_WL.size(); ++i)
    farthest_m = std::max(farthest_m, (a.X_WL[i].p_m - b.X_WL[i].p_m).norm());
  return farthest_m;
}

constexpr double kUnknown = -1;

/// The value of a frame, computed when it is first asked for.
template <class Compute>
double Cached(std::vector<double>& values, int size, int frame, const Compute& compute) {
  values.resize(size, kUnknown);
  if (values[frame] == kUnknown) values[frame] = compute();
  return values[frame];
}

// Distances between convex shapes are found by alternating projections (Cheney & Goldstein 1959):
// the nearest point of one shape to the nearest point of the other to ... converges to a nearest
// pair. It needs nothing but the nearest point of a shape, and a hundredth of a millimetre is
// plenty here.

constexpr int kMaxProjections = 200;
constexpr double kProjectionAccuracy_m = 1e-5;

Vector3d PulledInto(double radius, const Vector3d& centre, const Vector3d& p) {
  const Vector3d out = p - centre;
  const double distance = out.norm();
  return distance > radius ? Vector3d(centre + out * (radius / distance)) : p;
}

/// The nearest point of a solid shape to p, all in the shape's frame.
struct Nearest {
  Vector3d p;

  Vector3d operator()(const physics::Box& box) const {
    return p.cwiseMax(-box.size_m / 2).cwiseMin(box.size_m / 2);
  }
  Vector3d operator()(const physics::Sphere& sphere) const {
    return PulledInto(sphere.radius_m, Vector3d::Zero(), p);
  }
  Vector3d operator()(const physics::Cylinder& cylinder) const {
    const double half = cylinder.length_m / 2;
    Vector3d near = PulledInto(cylinder.radius_m, {0, 0, p.z()}, p);
    near.z() = std::clamp(p.z(), -half, half);
    return near;
  }
  Vector3d operator()(const physics::Capsule& capsule) const {
    const double half = capsule.length_m / 2;
    return PulledInto(capsule.radius_m, {0, 0, std::clamp(p.z(), -half, half)}, p);
  }
  Vector3d operator()(const physics::Hull& hull) const { return physics::NearestIn(hull, p); }
};

struct Solid {
  physics::Shape shape;
  physics::Pose X_WS;

  Vector3d NearestTo(const Vector3d& p_W) const {
    return X_WS * std::visit(Nearest{X_WS.inverse() * p_W}, shape);
  }
};

double Distance(const Solid& a, const Solid& b) {
  Vector3d on_b = b.X_WS.p_m;
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxProjections; ++i) {
    const Vector3d on_a = a.NearestTo(on_b);
    on_b = b.NearestTo(on_a);
    const double closer = (on_a - on_b).norm();
    if (distance - closer < kProjectionAccuracy_m) return closer;
    distance = closer;
  }
  return distance;
}

std::vector<Solid> PartsOf(const physics::HandModel& model, const physics::HandState& hand) {
  std::vector<Solid> parts = {{physics::Box{model.palm_size_m}, hand.palm.X_WB}};
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    const Vector3d size(link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m);
    parts.push_back({physics::Box{size}, hand.X_WL[i]});
  }
  return parts;
}

/// From where it is at rest on what bears its weight until they part or that is no longer below: it
/// may tip or roll in between, and a hand may take the weight. What is over in a moment was a blow.
Spans SupportsOf(const std::vector<Bearing>& bearings, const Recording& recording,
                 const TouchSettings& settings) {
  std::vector<bool> borne;
  for (const Bearing& bearing : bearings) {
    const bool bears = bearing.share >= settings.support_share || (!borne.empty() && borne.back());
    borne.push_back(bearing.touching && bearing.up >= settings.support_up && bears);
  }
  Spans spans;
  for (Span span : WhereTrue(borne)) {
    while (!span.empty() && bearings[span.begin].vertical_m_per_s > settings.support_speed_m_per_s)
      ++span.begin;
    if (!span.empty()) spans.push_back(span);
  }
  spans = Bridged(spans, recording.ticks, recording.Ticks(settings.contact_bridge_s));
  std::erase_if(spans, [&](const Span& span) {
    return recording.Lasts_s(span) < settings.support_minimum_s;
  });
  return spans;
}

Spans WhereGripIsCommanded(const Recording& recording, const TouchSettings& settings, int hand) {
  std::vector<bool> commanded;
  for (int frame = 0; frame < recording.size(); ++frame)
    commanded.push_back(recording.hand(hand, frame).trigger >= settings.commanded_trigger);
  return WhereTrue(commanded);
}

/// Whether the grip opens, in the 10 ms around each frame.
std::vector<bool> WhereGripOpens(const Recording& recording, const TouchSettings& settings,
                                 int hand) {
  constexpr double kWindow_s = 0.02;
  std::vector<bool> opens(recording.size());
  for (int frame = 0; frame < recording.size(); ++frame) {
    int before = frame, after = frame;
    while (before > 0 && recording.Seconds(before, frame) < kWindow_s / 2) --before;
    while (after + 1 < recording.size() && recording.Seconds(frame, after) < kWindow_s / 2) ++after;
    const double change =
        recording.hand(hand, after).trigger - recording.hand(hand, before).trigger;
    opens[frame] =
        after > before && change <= -settings.opening_per_s * recording.Seconds(before, after);
  }
  return opens;
}

/// Held with one sensor set that bears force, without slipping out of the hand, as a bar in a hook.
bool HangsOn(const Evidence& evidence, const TouchSettings& settings, Pair pair, int frame) {
  if (evidence.forces_n.at(pair)[frame] < settings.hook_force_n) return false;
  const physics::BodyState& body = evidence.recording.body(pair.second, frame);
  const physics::BodyState& palm = evidence.recording.hand(pair.first, frame).palm;
  const Eigen::Vector3d slip_m_per_s = body.v_WB_m_per_s - VelocityAt(palm, body.X_WB.p_m);
  return slip_m_per_s.norm() <= settings.hook_slip_m_per_s;
}

/// What a hand does with a body that it does not hold alone: its grip is open, or one sensor set
/// touches.
class Helpers {
 public:
  Helpers(const Evidence& evidence, const TouchSettings& settings)
      : evidence_(evidence), settings_(settings) {
    for (const auto& [pair, forces_n] : evidence.forces_n)
      for (int frame = 0; frame < evidence.recording.size(); ++frame)
        presses_[pair].push_back(forces_n[frame] >= settings.press_force_n &&
                                 !HoldsAlone(pair, frame));
  }

  /// Of (hand index, body): by frame.
  const std::vector<bool>& WherePressed(Pair pair) const { return presses_.at(pair); }

  /// Another hand presses on the other side, with a palm that faces this one's. `pair` presses.
  bool IsPressedBetween(Pair pair, int frame) const {
    for (const auto& [other, presses] : presses_) {
      if (other.second != pair.second || other.first == pair.first || !presses[frame]) continue;
      const double cosine = Back(pair.first, frame).dot(Back(other.first, frame));
      if (cosine <= std::cos(settings_.press_facing_rad)) return true;
    }
    return false;
  }

  /// It is held against another thing that the hand presses from the other side: of thumb and
  /// fingers one side touches this one and the other side that one. `pair` presses.
  bool IsSqueezedWithAnother(Pair pair, int frame) const {
    if (!Moves(pair.second)) return false;
    for (const auto& [other, presses] : presses_) {
      if (other.first != pair.first || other.second == pair.second || !presses[frame] ||
          !Moves(other.second) ||
          IsTouchedByFirstSet(pair, frame) == IsTouchedByFirstSet(other, frame))
        continue;
      const auto touching = evidence_.touching.find(std::minmax(pair.second, other.second));
      if (touching != evidence_.touching.end() && touching->second[frame]) return true;
    }
    return false;
  }

 private:
  std::uint32_t Sets(Pair pair, int frame) const { return evidence_.sensor_sets.at(pair)[frame]; }
  /// The fingers of a hand, one jaw of a gripper.
  bool IsTouchedByFirstSet(Pair pair, int frame) const { return (Sets(pair, frame) & 1) != 0; }
  bool Moves(int body) const {
    return physics::MovesFreely(evidence_.recording.scene, physics::BodyIndex(body));
  }
  Eigen::Vector3d Back(int hand, int frame) const {
    return evidence_.recording.hand(hand, frame).palm.X_WB.q * Eigen::Vector3d::UnitZ();
  }
  bool HoldsAlone(Pair pair, int frame) const {
    return std::popcount(Sets(pair, frame)) >= settings_.grasp_sensor_sets &&
           evidence_.recording.hand(pair.first, frame).trigger >= settings_.commanded_trigger;
  }

  const Evidence& evidence_;
  const TouchSettings& settings_;
  std::map<Pair, std::vector<bool>> presses_;
};

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

Evidence::Evidence(const Recording& read) : recording(read) {
  EvidenceReader(recording, *this).Read();
}

double Evidence::Distance_m(int hand, int body, int frame) const {
  return Cached(distances_[{hand, body}], recording.size(), frame, [&] {
    return SurfaceDistance(recording.scene.hands[hand].model, recording.hand(hand, frame),
                           recording.scene.bodies[body], recording.body(body, frame));
  });
}

double Evidence::Motion_m_per_s(int hand, int frame) const {
  return Cached(motions_[hand], recording.size(), frame, [&] {
    return Farthest_m(recording.hand(hand, frame), recording.hand(hand, frame - 1)) /
           recording.Seconds(frame - 1, frame);
  });
}

double Evidence::Apart_m(int hand, int frame, int other) const {
  return Farthest_m(recording.hand(hand, frame), recording.hand(hand, other));
}

bool Evidence::Leaves(int hand, int frame, double distance_m, double window_s, int end) const {
  const auto begin = recording.ticks.begin(), now = begin + frame;
  const auto is_near = [&](grammar::Tick from, grammar::Tick to) {
    return static_cast<double>(to - from) / recording.scene.world.rate_hz <= window_s / 2;
  };
  const auto leaves = [&] {
    const auto first_near =
        std::partition_point(begin, now, [&](grammar::Tick t) { return !is_near(t, *now); });
    const auto past = std::partition_point(now, begin + std::max(end, frame),
                                           [&](grammar::Tick t) { return is_near(*now, t); });
    const int first = static_cast<int>(first_near - begin);
    const int last = static_cast<int>(past - begin) - 1;
    // What moves is farthest at the ends.
    for (int i = first; i < frame; ++i)
      if (Apart_m(hand, frame, i) > distance_m) return true;
    for (int i = last; i > frame; --i)
      if (Apart_m(hand, frame, i) > distance_m) return true;
    return false;
  };
  // A hand that trembles in its place is compared with the whole window; for each choice of the
  // other numbers it is the same. Near the end the window is another one for each end.
  if (end <= frame || is_near(*now, *(begin + end - 1))) return leaves();
  return Cached(leaves_[{hand, distance_m, window_s}], recording.size(), frame, leaves) != 0;
}

bool InReachRegion(const Recording& recording, int hand, int body, int frame, double radius_m) {
  const Vector3d centre_W_m = recording.hand(hand, frame).palm.X_WB *
                              Vector3d(radius_m * recording.scene.hands[hand].model.ahead);
  return PointDistance(centre_W_m, recording.scene.bodies[body], recording.body(body, frame)) <=
         radius_m;
}

double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Solid& part : PartsOf(model, hand))
    for (const physics::PlacedShape& placed : body.shapes)
      distance = std::min(distance, Distance(part, {placed.shape, state.X_WB * placed.X_BS}));
  return distance;
}

double PointDistance(const Vector3d& p_W_m, const physics::Body& body,
                     const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  for (const physics::PlacedShape& placed : body.shapes) {
    const Solid solid{placed.shape, state.X_WB * placed.X_BS};
    distance = std::min(distance, (p_W_m - solid.NearestTo(p_W_m)).norm());
  }
  return distance;
}

Touches FindTouches(const Evidence& evidence, const TouchSettings& settings) {
  const Recording& recording = evidence.recording;
  Touches touches;
  for (const auto& [pair, frames] : evidence.touching)
    touches.contacts[pair] =
        Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(settings.contact_bridge_s));
  for (const auto& [pair, bearings] : evidence.bearings)
    touches.supports[pair] = SupportsOf(bearings, recording, settings);
  const Helpers helpers(evidence, settings);
  const auto bridged = [&](const std::vector<bool>& frames) {
    return Bridged(WhereTrue(frames), recording.ticks, recording.Ticks(settings.grasp_bridge_s));
  };
  std::map<int, std::vector<bool>> grip_opens;
  std::map<int, Spans> commanded;
  for (const auto& [pair, sets] : evidence.sensor_sets) {
    const auto& [hand, body] = pair;
    if (!commanded.contains(hand)) {
      commanded[hand] = WhereGripIsCommanded(recording, settings, hand);
      grip_opens[hand] = WhereGripOpens(recording, settings, hand);
    }
    const std::vector<bool>&opens = grip_opens[hand], &presses = helpers.WherePressed(pair);
    // A grasp begins where it is gripped, and lasts while held.
    std::vector<bool> gripped(recording.size()), held = gripped, between = gripped;
    for (int frame = 0; frame < recording.size(); ++frame) {
      if (sets[frame] == 0) continue;
      const bool has_sets = std::popcount(sets[frame]) >= settings.grasp_sensor_sets ||
                            (presses[frame] && helpers.IsSqueezedWithAnother(pair, frame));
      between[frame] = presses[frame] && helpers.IsPressedBetween(pair, frame);
      gripped[frame] = (has_sets && !opens[frame]) || between[frame];
      held[frame] =
          has_sets || between[frame] || (!opens[frame] && HangsOn(evidence, settings, pair, frame));
    }
    const Spans tight = bridged(held);
    // Letting go ends a grasp at once, and none begins before the hand feels the object again.
    for (const Span& squeeze : Union(commanded[hand], bridged(between))) {
      for (Span span : Within(tight, squeeze)) {
        while (!span.empty() && !gripped[span.begin]) ++span.begin;
        if (recording.Lasts_s(span) >= settings.grasp_minimum_s)
          touches.grasps.push_back({hand, body, span, span.begin});
      }
    }
  }
  SayHowLongTheyTouched(recording, touches);
  return touches;
}

}  // namespace prehend::truth
