// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "harness/truth/oracle/evidence.h"

namespace prehend::truth {
namespace {

using Eigen::Vector3d;

/// An upright cylinder around the place where something happened to an object.
struct Region {
  Vector3d anchor;
  double radius_m = 0;
  double height_m = 0;

  bool Contains(const Vector3d& p) const {
    return IsAboveOrBelow(p) && std::abs(p.z() - anchor.z()) <= height_m;
  }
  bool IsAboveOrBelow(const Vector3d& p) const { return (p - anchor).head<2>().norm() <= radius_m; }
};

class Carrier {
 public:
  Carrier(const Evidence& evidence, const OracleSettings& settings, const Grasp& grasp,
          const std::map<int, Spans>& supports)
      : evidence_(evidence),
        recording_(evidence.recording),
        settings_(settings),
        grasp_(grasp),
        supports_(supports) {}

  Carrying Find() {
    Spans supported;
    for (const auto& [support, spans] : supports_) supported = Union(supported, spans);
    for (const Span& span : supported) FindSlides(Common(span, grasp_.span));
    for (const Span& span : Rest(supported, grasp_.span)) {
      if (Hovers(supported, span))
        found_.hovers.push_back(span);
      else
        DivideUnsupported(span, SupportLoss(supported, span.begin), Lands(supported, span.end));
    }
    return found_;
  }

 private:
  const Vector3d& place(int frame) const { return recording_.place(grasp_.body, frame); }

  /// How the object bears on one of its supports, by frame.
  const Bearings& On(int support) const { return evidence_.bearings.at({grasp_.body, support}); }

  /// Whether the object moves along something that supports it. Its velocity must say so and it
  /// must get somewhere: a squeezed object trembles faster than it slides. Where it gets is asked
  /// of the frames before and after, supported or not.
  bool Slides(int frame) const {
    for (const auto& [support, spans] : supports_) {
      if (!Covers(spans, frame) ||
          On(support)[frame].along_m_per_s <= settings_.slide_speed_m_per_s)
        continue;
      int before = frame, after = frame;
      while (before > 0 && recording_.Seconds(before, frame) < settings_.slide_window_s / 2)
        --before;
      while (after + 1 < recording_.size() &&
             recording_.Seconds(frame, after) < settings_.slide_window_s / 2)
        ++after;
      if (WayAlong(support, before, after) >
          settings_.slide_speed_m_per_s * recording_.Seconds(before, after))
        return true;
    }
    return false;
  }

  /// How far the object got along a support between two frames, its load and its middle.
  double WayAlong(int support, int from, int to) const {
    const auto way = [&](int of) {
      return (On(support)[to].along_m[of] - On(support)[from].along_m[of]).norm();
    };
    return std::min(way(0), way(1));
  }

  /// How far the object got along what supported it at the span's begin, from where it was then.
  double Displacement(Span span) const {
    double farthest = 0;
    for (const auto& [support, spans] : supports_) {
      if (!Covers(spans, span.begin)) continue;
      for (int frame = span.begin; frame < span.end; ++frame)
        farthest = std::max(farthest, WayAlong(support, span.begin, frame));
    }
    return farthest;
  }

  /// `held`: it is grasped and supported.
  void FindSlides(Span held) {
    const Spans moving = Where({held}, [&](int frame) { return Slides(frame); });
    Spans motions = recording_.Bridged(moving, settings_.slide_moment_s);
    // The jerk of a grip or of a lift that begins is none.
    std::erase_if(motions, [&](const Span& motion) {
      return recording_.Lasts_s(motion) < settings_.slide_moment_s;
    });
    for (const Span& slide : recording_.Bridged(motions, settings_.slide_pause_s))
      if (Displacement(slide) >= settings_.slide_displacement_m) found_.slides.push_back(slide);
  }

  /// The frame in which it lost the support that this hand took it from; no value: it was caught,
  /// or taken over in the air.
  std::optional<int> SupportLoss(const Spans& supported, int unsupported_since) const {
    std::optional<int> loss;
    for (const Span& span : supported)
      if (span.end <= unsupported_since) loss = span.end;
    if (!loss || *loss == unsupported_since) return loss;
    // A hand that closes may lift what it only touches yet: if it did not get far, that is part of
    // it.
    const Region region = PickUpRegion(*loss);
    bool near = *loss >= grasp_.touched_since;
    for (int frame = *loss; near && frame < unsupported_since; ++frame)
      near = region.Contains(place(frame));
    return near ? loss : std::nullopt;
  }

  /// Whether it is supported, be it soon after it was let go.
  bool Lands(const Spans& supported, int end) const {
    if (Covers(supported, end)) return true;
    if (end != grasp_.span.end || end >= recording_.size()) return false;
    return std::ranges::any_of(supported, [&](const Span& span) {
      return span.begin > end && recording_.Seconds(end, span.begin) <= settings_.put_down_slip_s;
    });
  }

  /// Whether it gets nowhere between two supports.
  bool Hovers(const Spans& supported, Span unsupported) const {
    int begin = -1, end = -1;
    for (const Span& span : supported) {
      if (span.end <= unsupported.begin) begin = span.end;
      if (span.begin >= unsupported.end && end < 0) end = span.begin;
    }
    if (begin < 0 || end < 0) return false;
    for (int frame = begin; frame < end; ++frame)
      if ((place(frame) - place(begin)).norm() >= settings_.carry_way_m) return false;
    return true;
  }

  Region PickUpRegion(int loss) const {
    return {place(loss), settings_.pick_up_radius_m, settings_.pick_up_height_m};
  }

  double Highest(Span span) const {
    double highest = place(span.begin).z();
    for (int frame = span.begin; frame < span.end; ++frame)
      highest = std::max(highest, place(frame).z());
    return highest;
  }

  /// In the air, as long as it does not leave the region around the place of the loss.
  Span NearLoss(Span unsupported, int loss) const {
    const Region region = PickUpRegion(loss);
    int end = unsupported.begin;
    while (end < unsupported.end && region.Contains(place(end))) ++end;
    return Span{unsupported.begin, end};
  }

  /// High enough, and above where it was lost. The frame after the pick-up tells, too: what leaves
  /// the region upwards was that high.
  bool Rises(Span pick_up, int loss) const {
    const double floor_m = place(loss).z() + settings_.pick_up_rise_m;
    bool rises = false;
    for (int frame = loss; frame < std::min(pick_up.end + 1, recording_.size()); ++frame)
      rises =
          rises || (place(frame).z() >= floor_m && PickUpRegion(loss).IsAboveOrBelow(place(frame)));
    return rises;
  }

  /// From the begin of the last uninterrupted approach from above to the landing.
  std::optional<Span> PutDown(Span unsupported) const {
    const int landing = unsupported.end;
    const Region region{place(landing), settings_.put_down_radius_m, settings_.put_down_height_m};
    int near = landing;
    while (near > unsupported.begin && region.Contains(place(near - 1)) &&
           recording_.Seconds(near - 1, landing) <= settings_.put_down_look_back_s)
      --near;
    std::vector<DistanceAt> path;
    for (int frame = near; frame < landing; ++frame)
      path.push_back({recording_.Seconds(near, frame), (place(frame) - region.anchor).norm()});
    const int begin = near + LandingApproachBegin(path, settings_);
    // How high it was before it last moved away does not make this approach one from above.
    if (Highest({begin, landing}) - region.anchor.z() < settings_.put_down_drop_m)
      return std::nullopt;
    return Span{begin, landing};
  }

  /// `loss`: where it lost the support that it was taken from, if it was taken from one. `lands`:
  /// it is supported after, be it in the very frame in which it is let go. Otherwise it was
  /// dropped, or held to the end.
  void DivideUnsupported(Span unsupported, std::optional<int> loss, bool lands) {
    Span transport = unsupported;
    if (const auto put_down = lands ? PutDown(unsupported) : std::nullopt) {
      found_.put_downs.push_back(*put_down);
      transport.end = put_down->begin;
    }
    const Span pick_up = loss ? Common(NearLoss(unsupported, *loss), transport) : Span{};
    if (!pick_up.empty() && Rises(pick_up, *loss)) {
      found_.pick_ups.push_back(pick_up);
      transport.begin = pick_up.end;
    }
    if (!transport.empty()) found_.transports.push_back(transport);
  }

  const Evidence& evidence_;
  const Recording& recording_;
  const OracleSettings& settings_;
  const Grasp& grasp_;
  const std::map<int, Spans>& supports_;
  Carrying found_;
};

/// The motion of a hand up to a touch. It moves when some part of it is fast and some part of it
/// gets somewhere; otherwise it idles, be it that it trembles.
class HandMotion {
 public:
  HandMotion(const Evidence& evidence, const OracleSettings& settings, int hand, int touch)
      : evidence_(evidence), settings_(settings), hand_(hand), touch_(touch) {}

  bool Moves(int frame) const {
    return evidence_.Motion_m_per_s(hand_, frame) >= settings_.idle_speed_m_per_s &&
           evidence_.Leaves(hand_, frame, settings_.idle_excursion_m, settings_.idle_window_s,
                            touch_ + 1);
  }

  /// Where a movement begins that was noticed at `frame`, not before `earliest`: where the hand
  /// leaves its place, and before that as long as it speeds up.
  int Begin(int frame, int earliest) const {
    int begin = frame;
    while (begin + 1 < touch_ &&
           evidence_.Apart_m(hand_, frame, begin + 1) <= settings_.idle_excursion_m)
      ++begin;
    const auto speeds_up_at = [&](int at) {
      constexpr double kSteady = 1.1;  // a steady speed counts, errors of sampling included
      const double speed_m_per_s = evidence_.Motion_m_per_s(hand_, at);
      return speed_m_per_s >= settings_.onset_speed_m_per_s &&
             (at == touch_ || speed_m_per_s <= kSteady * evidence_.Motion_m_per_s(hand_, at + 1));
    };
    while (begin > earliest && speeds_up_at(begin)) --begin;
    return begin;
  }

 private:
  const Evidence& evidence_;
  const OracleSettings& settings_;
  int hand_, touch_;
};

/// The frame at which the hand last stopped idling, or `earliest`: where it began to move, slowly
/// at first.
int LastIdleEnd(const Recording& recording, const HandMotion& motion,
                const OracleSettings& settings, int earliest, int touch) {
  int idle_end = earliest;
  int still_since = earliest;
  for (int frame = earliest + 1; frame < touch; ++frame) {
    if (motion.Moves(frame)) still_since = frame;
    if (recording.Seconds(still_since, frame) > settings.reach_idle_s) idle_end = frame;
  }
  return idle_end > earliest ? motion.Begin(idle_end, earliest) : earliest;
}

/// Where a retreat beyond the dead-band ended last: an index; none if there was no such retreat.
std::optional<int> LastTurn(std::span<const DistanceAt> path, double dead_band_m) {
  const auto away_m = [&](int from, int to) { return path[to].distance_m - path[from].distance_m; };
  int turn = static_cast<int>(path.size()) - 1, retreat = turn;
  while (retreat >= 0 && away_m(retreat, turn) <= dead_band_m) {
    if (away_m(retreat, turn) < 0) turn = retreat;
    --retreat;
  }
  return retreat < 0 ? std::nullopt : std::optional(turn);
}

/// The median distance over a window around each place of the path, of as many places before as
/// after.
std::vector<DistanceAt> MediansOver(double window_s, std::span<const DistanceAt> path) {
  std::vector<DistanceAt> medians;
  std::vector<double> distances_m;
  const int size = static_cast<int>(path.size());
  for (int at = 0; at < size; ++at) {
    int reach = 0;
    while (at - reach > 0 && at + reach + 1 < size &&
           path[at].t_s - path[at - reach - 1].t_s <= window_s / 2 &&
           path[at + reach + 1].t_s - path[at].t_s <= window_s / 2)
      ++reach;
    distances_m.clear();
    for (int i = at - reach; i <= at + reach; ++i) distances_m.push_back(path[i].distance_m);
    std::ranges::nth_element(distances_m, distances_m.begin() + reach);
    medians.push_back({path[at].t_s, distances_m[reach]});
  }
  return medians;
}

}  // namespace

Carrying FindCarrying(const Evidence& evidence, const OracleSettings& settings, const Grasp& grasp,
                      const std::map<int, Spans>& supports) {
  if (!physics::MovesFreely(evidence.recording.scene, physics::BodyIndex(grasp.body))) return {};
  return Carrier(evidence, settings, grasp, supports).Find();
}

int ApproachBegin(std::span<const DistanceAt> path, double dead_band_m,
                  const OracleSettings& settings) {
  const auto away_m = [&](int from, int to) { return path[to].distance_m - path[from].distance_m; };
  const auto duration_s = [&](int from, int to) { return path[to].t_s - path[from].t_s; };
  const int last = static_cast<int>(path.size()) - 1;
  const std::optional<int> turned = LastTurn(path, dead_band_m);
  if (!turned) return 0;
  const int turn = *turned;
  int back = turn;
  while (back < last &&
         away_m(back + 1, back) <= settings.idle_speed_m_per_s * duration_s(back, back + 1))
    ++back;
  if (duration_s(turn, back) <= settings.turn_pause_s) return turn;
  while (back > turn &&
         away_m(back, back - 1) > settings.onset_speed_m_per_s * duration_s(back - 1, back))
    --back;
  return back;
}

int LandingApproachBegin(std::span<const DistanceAt> path, const OracleSettings& settings) {
  const double dead_band_m = settings.put_down_dead_band_m;
  const std::vector<DistanceAt> smooth = MediansOver(settings.put_down_window_s, path);
  const std::optional<int> turn = LastTurn(smooth, dead_band_m);
  if (!turn) return 0;
  int leaves = static_cast<int>(smooth.size()) - 1;
  while (leaves > *turn && smooth[leaves].distance_m < smooth[*turn].distance_m - dead_band_m)
    --leaves;
  // The slow start is seen in the distances themselves: medians round a sharp turn.
  const auto nearing_m_per_s = [&](int to) {
    return (path[to - 1].distance_m - path[to].distance_m) / (path[to].t_s - path[to - 1].t_s);
  };
  while (leaves > 0 && nearing_m_per_s(leaves) > settings.onset_speed_m_per_s) --leaves;
  return leaves;
}

int ReachBegin(const Evidence& evidence, const OracleSettings& settings, int hand, int body,
               int earliest, int touch) {
  const Recording& recording = evidence.recording;
  int begin = touch;
  while (begin > earliest && recording.Seconds(begin - 1, touch) <= settings.reach_look_back_s &&
         evidence.InReachRegion(hand, body, begin - 1, settings.reach_radius_m))
    --begin;
  const HandMotion motion(evidence, settings, hand, touch);
  begin = LastIdleEnd(recording, motion, settings, begin, touch);
  std::vector<DistanceAt> path;
  for (int frame = begin; frame < touch; ++frame)
    path.push_back({recording.Seconds(begin, frame), evidence.Distance_m(hand, body, frame)});
  begin += ApproachBegin(path, settings.reach_dead_band_m, settings);
  // Standing still is no reach yet, nor is what settles before the hand moves: it begins with the
  // movement, slowly at first.
  int moves = begin;
  while (moves < touch && !motion.Moves(moves + 1)) ++moves;
  if (moves > begin) begin = motion.Begin(moves, begin);
  return begin;
}

}  // namespace prehend::truth
