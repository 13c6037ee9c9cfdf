// SPDX-License-Identifier: Apache-2.0
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
/// So long before two bodies first touch, nothing asks how one moves along the other.
constexpr double kBeforeTouch_s = 1;

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

/// How one body bears on another, read frame by frame.
struct BearingRead {
  Bearings& bearings;
  std::vector<Push> pushes;  ///< of the last ticks: contacts of a body at rest flicker
  std::size_t repeated = 0;  ///< so many of them, up to the last one, are as the one before
  bool still = false;        ///< in the last frame, neither load nor middle moved along
  Vector3d nhat_S = Vector3d::UnitZ();
};

class EvidenceReader {
 public:
  EvidenceReader(const Recording& recording, Evidence& evidence)
      : recording_(recording), evidence_(evidence), has_forces_(HasForces()) {}

  void Read() {
    for (int frame = 0, first = 0; frame < recording_.size(); ++frame) {
      while (recording_.ticks[frame] - recording_.ticks[first] > kReleaseTicks) ++first;
      lasting_.push_back(frame - first + 1);
      std::map<Pair, std::uint32_t> sets;  // of (hand, body)
      const physics::Snapshot& now = recording_.frames[frame];
      ReadResting(now.resting.get(), frame, sets);
      for (const physics::ContactPoint& point : now.contacts) ReadPoint(point, frame, sets);
      for (const auto& [pair, bits] : sets) {
        evidence_.sensor_sets[pair].resize(recording_.size());
        evidence_.sensor_sets[pair][frame] = bits;
      }
      for (auto& [pair, read] : reads_) ReadBearing(pair, frame, read);
    }
  }

 private:
  bool HasForces() const {
    for (const physics::Snapshot& frame : recording_.frames)
      for (const auto& points : frame.AllContacts())
        for (const physics::ContactPoint& point : points)
          if (point.normal_impulse_n_s > 0) return true;
    return false;
  }

  /// Frames share the points between bodies at rest until one falls asleep or wakes.
  void ReadResting(const std::vector<physics::ContactPoint>* points, int frame,
                   std::map<Pair, std::uint32_t>& sets) {
    if (points == resting_) {
      for (Spans* touching : resting_touching_) touching->back().end = frame + 1;
      for (BearingRead* read : resting_reads_) {
        read->pushes.push_back(read->pushes.back());
        read->pushes.back().frame = frame;
        ++read->repeated;
      }
      return;
    }
    resting_ = points;
    resting_touching_.clear();
    resting_reads_.clear();
    if (!points) return;
    for (const physics::ContactPoint& point : *points) ReadPoint(point, frame, sets);
    for (auto& [pair, touching] : evidence_.touching)
      if (touching.back().end > frame) resting_touching_.push_back(&touching);
    for (auto& [pair, read] : reads_)
      if (IsPushed(read, frame)) resting_reads_.push_back(&read);
  }

  void ReadPoint(const physics::ContactPoint& point, int frame,
                 std::map<Pair, std::uint32_t>& sets) {
    const int a = Entity(point.a), b = Entity(point.b);
    if (a == b) return;
    Spans& touching = evidence_.touching[std::minmax(a, b)];
    if (touching.empty() || touching.back().end < frame) touching.push_back({frame, frame});
    touching.back().end = frame + 1;
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
    const auto [at, is_new] = reads_.try_emplace(pair, evidence_.bearings[pair]);
    BearingRead& read = at->second;
    if (is_new) {
      int before = frame;
      while (before > 0 && recording_.Seconds(before - 1, frame) <= kBeforeTouch_s) --before;
      read.bearings.kept.emplace_back();
      read.bearings.which.resize(before);
      for (; before < frame; ++before) ReadBearing(pair, before, read);
    }
    if (!IsPushed(read, frame)) {
      read.pushes.push_back({.frame = frame});
      read.repeated = 0;
    }
    read.pushes.back().Add(nhat_W, point.p_W_m, has_forces_ ? point.normal_impulse_n_s : 1.0);
  }

  static bool IsPushed(const BearingRead& read, int frame) {
    return !read.pushes.empty() && read.pushes.back().frame == frame;
  }

  void ReadBearing(Pair pair, int frame, BearingRead& read) {
    const auto& [object, support] = pair;
    auto& [bearings, pushes, repeated, still, nhat_S] = read;
    const bool touching = IsPushed(read, frame);
    const std::size_t all = pushes.size(),
                      gone = std::erase_if(pushes, [&](const Push&push) {
                        return recording_.ticks[frame] - recording_.ticks[push.frame] >
                               kReleaseTicks;
                      });
    const bool repeats = repeated + 1 >= all && gone == (touching ? 1u : 0u) && still &&
                         Rest(object, support, frame) && bearings[frame - 1].touching == touching &&
                         lasting_[frame] == lasting_[frame - 1];
    if (!repeats) bearings.kept.emplace_back();
    bearings.which.push_back(bearings.kept.size() - 1);
    if (repeats) return;
    Bearing& bearing = bearings.kept.back();
    bearing.touching = touching;
    Push sum;
    for (const Push& push : pushes) {
      sum.impulse_n_s += push.impulse_n_s;
      sum.centre_W_m += push.centre_W_m;
      sum.weight += push.weight;
    }
    const physics::BodyState &held = recording_.body(object, frame),
                             &by = recording_.body(support, frame);
    Vector3d centre_W_m = held.X_WB.p_m;
    if (sum.weight > 0) {
      centre_W_m = sum.centre_W_m / sum.weight;
      bearing.share = ShareOf(object, sum.impulse_n_s.z() / lasting_[frame]);
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
      bearing.vertical_m_per_s =
          std::min(std::abs(relative_at(centre_W_m).z()), std::abs(relative_at(held.X_WB.p_m).z()));
    const Vector3d nhat_W = by.X_WB.q * nhat_S;
    const double off_m = (held.X_WB.p_m - centre_W_m).dot(nhat_W);
    bearing.along_m_per_s = std::numeric_limits<double>::infinity();
    still = true;
    Vector3d along;
    for (const int middle : {0, 1}) {
      if (middle == 0 || sum.weight > 0) {  // else both are in one place
        const Vector3d v = relative_at(middle ? held.X_WB.p_m - off_m * nhat_W : centre_W_m);
        along = v - v.dot(nhat_W) * nhat_W;
        bearing.along_m_per_s = std::min(bearing.along_m_per_s, along.norm());
        still = still && along.isZero(0);
      }
      if (frame > 0)
        bearing.along_m[middle] =
            bearings[frame - 1].along_m[middle] +
            by.X_WB.q.inverse() * along * recording_.Seconds(frame - 1, frame);
    }
  }

  /// Whether both are as they were in the frame before.
  bool Rest(int object, int support, int frame) const {
    if (frame == 0) return false;
    const physics::Snapshot &now = recording_.frames[frame], &before = recording_.frames[frame - 1];
    return !now.MayHaveMoved(object, before.tick) && !now.MayHaveMoved(support, before.tick) &&
           now.bodies[object].asleep == before.bodies[object].asleep;
  }

  /// In the last ticks before a frame, the first of which may be before the recording.
  double MeanShareBefore(const Bearings& bearings, int frame) const {
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
  std::map<Pair, BearingRead> reads_;
  std::vector<int> lasting_;  ///< by frame: how many the last ticks are, with itself
  const std::vector<physics::ContactPoint>* resting_ = nullptr;  ///< of the frame before
  std::vector<Spans*> resting_touching_;                         ///< those of resting_
  std::vector<BearingRead*> resting_reads_;
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

Vector3d NearestIn(const physics::Shape& shape, const physics::Pose& X_WS, const Vector3d& p_W) {
  return X_WS * std::visit(Nearest{X_WS.inverse() * p_W}, shape);
}

struct Solid {
  physics::Shape shape;
  physics::Pose X_WS;

  Vector3d NearestTo(const Vector3d& p_W) const { return NearestIn(shape, X_WS, p_W); }
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
Spans SupportsOf(const Spans& touching, const Bearings& bearings, const Recording& recording,
                 const SupportSettings& settings) {
  int borne_until = -1;
  const Spans where_borne = Where(touching, [&](int frame) {
    const Bearing& bearing = bearings[frame];
    const bool borne = bearing.up >= settings.support_up &&
                       (borne_until == frame || bearing.share >= settings.support_share);
    if (borne) borne_until = frame + 1;
    return borne;
  });
  Spans spans;
  for (Span span : where_borne) {
    while (!span.empty() && bearings[span.begin].vertical_m_per_s > settings.support_speed_m_per_s)
      ++span.begin;
    if (!span.empty()) spans.push_back(span);
  }
  spans = recording.Bridged(spans, settings.contact_bridge_s);
  std::erase_if(spans, [&](const Span& span) {
    return recording.Lasts_s(span) < settings.support_minimum_s;
  });
  return spans;
}

/// Whether the grip opens, in the 10 ms around the frame.
bool GripOpens(const Recording& recording, const GraspSettings& settings, int hand, int frame) {
  constexpr double kWindow_s = 0.02;
  int before = frame, after = frame;
  while (before > 0 && recording.Seconds(before, frame) < kWindow_s / 2) --before;
  while (after + 1 < recording.size() && recording.Seconds(frame, after) < kWindow_s / 2) ++after;
  const double change = recording.hand(hand, after).trigger - recording.hand(hand, before).trigger;
  return after > before && change <= -settings.opening_per_s * recording.Seconds(before, after);
}

/// Held with one sensor set that bears force, without slipping out of the hand, as a bar in a hook.
bool HangsOn(const Evidence& evidence, const GraspSettings& settings, Pair pair, int frame) {
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
  Helpers(const Evidence& evidence, const GraspSettings& settings)
      : evidence_(evidence), settings_(settings) {}

  /// `pair` is a hand's index and a body.
  bool Presses(Pair pair, int frame) const {
    return evidence_.forces_n.at(pair)[frame] >= settings_.press_force_n &&
           !HoldsAlone(pair, frame);
  }

  /// Another hand presses on the other side, with a palm that faces this one's. `pair` presses.
  bool IsPressedBetween(Pair pair, int frame) const {
    for (const auto& [other, forces_n] : evidence_.forces_n) {
      if (other.second != pair.second || other.first == pair.first || !Presses(other, frame))
        continue;
      const double cosine = Back(pair.first, frame).dot(Back(other.first, frame));
      if (cosine <= std::cos(settings_.press_facing_rad)) return true;
    }
    return false;
  }

  /// It is held against another thing that the hand presses from the other side: of thumb and
  /// fingers one side touches this one and the other side that one.
  bool IsSqueezedWithAnother(Pair pair, int frame) const {
    if (!Moves(pair.second) || !Presses(pair, frame)) return false;
    for (const auto& [other, forces_n] : evidence_.forces_n) {
      if (other.first != pair.first || other.second == pair.second || !Presses(other, frame) ||
          !Moves(other.second) ||
          IsTouchedByFirstSet(pair, frame) == IsTouchedByFirstSet(other, frame))
        continue;
      const auto touching = evidence_.touching.find(std::minmax(pair.second, other.second));
      if (touching != evidence_.touching.end() && Covers(touching->second, frame)) return true;
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
  const GraspSettings& settings_;
};

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

bool Evidence::InReachRegion(int hand, int body, int frame, double radius_m) const {
  return Cached(in_reach_[{hand, body, radius_m}], recording.size(), frame, [&] {
           const Vector3d centre_W_m = recording.hand(hand, frame).palm.X_WB *
                                       Vector3d(radius_m * recording.scene.hands[hand].model.ahead);
           return PointDistance(centre_W_m, recording.scene.bodies[body],
                                recording.body(body, frame)) <= radius_m;
         }) != 0;
}

double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  const std::vector<Solid> parts = PartsOf(model, hand);
  std::vector<std::pair<double, const Solid*>> at_least;  // no part is nearer than that
  for (const physics::PlacedShape& placed : body.shapes) {
    const Solid solid{placed.shape, state.X_WB * placed.X_BS};
    const physics::Pose X_SW = solid.X_WS.inverse();
    at_least.clear();
    for (const Solid& part : parts) {
      const double radius_m = std::get<physics::Box>(part.shape).size_m.norm() / 2;
      const Vector3d p_S = X_SW * part.X_WS.p_m, near_S = std::visit(Nearest{p_S}, placed.shape);
      at_least.emplace_back((near_S - p_S).norm() - radius_m, &part);
    }
    std::ranges::sort(at_least);
    for (const auto& [least, part] : at_least)
      if (least < distance) distance = std::min(distance, Distance(*part, solid));
  }
  return distance;
}

double PointDistance(const Vector3d& p_W_m, const physics::Body& body,
                     const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  for (const physics::PlacedShape& placed : body.shapes)
    distance = std::min(distance,
                        (p_W_m - NearestIn(placed.shape, state.X_WB * placed.X_BS, p_W_m)).norm());
  return distance;
}

Touches FindTouches(const Evidence& evidence, const SupportSettings& settings) {
  const Recording& recording = evidence.recording;
  Touches touches;
  for (const auto& [pair, spans] : evidence.touching)
    touches.contacts[pair] = recording.Bridged(spans, settings.contact_bridge_s);
  for (const auto& [pair, bearings] : evidence.bearings)
    touches.supports[pair] = SupportsOf(evidence.touching.at(std::minmax(pair.first, pair.second)),
                                        bearings, recording, settings);
  return touches;
}

std::vector<Grasp> FindGrasps(const Evidence& evidence, const GraspSettings& settings) {
  const Recording& recording = evidence.recording;
  std::vector<Grasp> grasps;
  const Helpers helpers(evidence, settings);
  std::map<int, Spans> commanded;
  for (const auto& [pair, sets] : evidence.sensor_sets) {
    const auto& [hand, body] = pair;
    if (!commanded.contains(hand))
      commanded[hand] = Where({{0, recording.size()}}, [&, of = hand](int frame) {
        return recording.hand(of, frame).trigger >= settings.commanded_trigger;
      });
    // A grasp begins where it is gripped, and lasts while held.
    const auto opens = [&](int frame) { return GripOpens(recording, settings, pair.first, frame); };
    const auto has_sets = [&](int frame) {
      return std::popcount(sets[frame]) >= settings.grasp_sensor_sets ||
             (!opens(frame) && helpers.IsSqueezedWithAnother(pair, frame));
    };
    const auto between = [&](int frame) {
      return helpers.Presses(pair, frame) && helpers.IsPressedBetween(pair, frame);
    };
    const auto gripped = [&](int frame) {
      return (has_sets(frame) && !opens(frame)) || between(frame);
    };
    const auto held = [&](int frame) {
      return has_sets(frame) || between(frame) ||
             (HangsOn(evidence, settings, pair, frame) && !opens(frame));
    };
    const Spans& touching = evidence.touching.at({body, recording.body_count() + hand});
    const Spans tight = recording.Bridged(Where(touching, held), settings.grasp_bridge_s);
    // Letting go ends a grasp at once, and none begins before the hand feels the object again.
    const Spans pressed = recording.Bridged(Where(touching, between), settings.grasp_bridge_s);
    for (const Span& squeeze : Union(commanded[hand], pressed)) {
      for (Span span : Within(tight, squeeze)) {
        while (!span.empty() && !gripped(span.begin)) ++span.begin;
        if (recording.Lasts_s(span) >= settings.grasp_minimum_s)
          grasps.push_back({hand, body, span, span.begin});
      }
    }
  }
  return grasps;
}

}  // namespace prehend::truth
