// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <vector>

#include "harness/truth/oracle/touches.h"

namespace prehend::truth {

namespace {

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
  const int size = static_cast<int>(path.size());
  for (int at = 0; at < size; ++at) {
    int reach = 0;
    while (at - reach > 0 && at + reach + 1 < size &&
           path[at].t_s - path[at - reach - 1].t_s <= window_s / 2 &&
           path[at + reach + 1].t_s - path[at].t_s <= window_s / 2)
      ++reach;
    std::vector<double> distances_m;
    for (int i = at - reach; i <= at + reach; ++i) distances_m.push_back(path[i].distance_m);
    std::ranges::nth_element(distances_m, distances_m.begin() + reach);
    medians.push_back({path[at].t_s, distances_m[reach]});
  }
  return medians;
}

}  // namespace

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
         InReachRegion(recording, hand, body, begin - 1, settings.reach_radius_m))
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
