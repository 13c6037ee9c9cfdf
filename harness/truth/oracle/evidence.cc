// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/truth/oracle/oracle_test.cc
#include "harness/truth/oracle/evidence.h"

#include <algorithm>
#include <cmath>

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
    Vector3d along_m = Vector3d::Zero(), nhat_S = Vector3d::UnitZ();
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
      const Vector3d where_they_touch = relative_at(centre_W_m);
      if (bearing.touching)
        bearing.vertical_m_per_s =
            std::min(std::abs(where_they_touch.z()), std::abs(relative_at(held.X_WB.p_m).z()));
      const Vector3d nhat_W = by.X_WB.q * nhat_S;
      const Vector3d along = where_they_touch - where_they_touch.dot(nhat_W) * nhat_W;
      bearing.along_m_per_s = along.norm();
      if (frame > 0) along_m += by.X_WB.q.inverse() * along * recording_.Seconds(frame - 1, frame);
      bearing.along_m = along_m;
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

}  // namespace prehend::truth
