// SPDX-License-Identifier: Apache-2.0
#include "harness/oracle/approach.h"

namespace prehend::harness::oracle {

namespace {

/// The frame at which the hand last stopped idling, or `earliest`: where it began to move, slowly
/// at first.
int LastIdleEnd(const Evidence& evidence, const OracleSettings& settings, int hand, int earliest,
                int touch) {
  const Recording& recording = evidence.recording;
  int idle_end = earliest;
  int still_since = earliest;
  for (int frame = earliest + 1; frame < touch; ++frame) {
    if (evidence.Motion_m_per_s(hand, frame) >= settings.idle_speed_m_per_s) still_since = frame;
    if (recording.Seconds(still_since, frame) > settings.reach_idle_s) idle_end = frame;
  }
  while (idle_end > earliest &&
         evidence.Motion_m_per_s(hand, idle_end) > settings.onset_speed_m_per_s)
    --idle_end;
  return idle_end;
}

}  // namespace

int ApproachBegin(std::span<const DistanceAt> path, double dead_band_m,
                  const OracleSettings& settings) {
  const auto away_m = [&](int from, int to) { return path[to].distance_m - path[from].distance_m; };
  const auto duration_s = [&](int from, int to) { return path[to].t_s - path[from].t_s; };
  const int last = static_cast<int>(path.size()) - 1;
  int turn = last, retreat = last;
  while (retreat >= 0 && away_m(retreat, turn) <= dead_band_m) {
    if (away_m(retreat, turn) < 0) turn = retreat;
    --retreat;
  }
  if (retreat < 0) return 0;
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

int ReachBegin(const Evidence& evidence, const OracleSettings& settings, int hand, int body,
               int earliest, int touch) {
  const Recording& recording = evidence.recording;
  int begin = touch;
  while (begin > earliest &&
         InReachRegion(recording, hand, body, begin - 1, settings.reach_radius_m))
    --begin;
  begin = LastIdleEnd(evidence, settings, hand, begin, touch);
  std::vector<DistanceAt> path;
  for (int frame = begin; frame < touch; ++frame)
    path.push_back({recording.Seconds(begin, frame), evidence.Distance_m(hand, body, frame)});
  begin += ApproachBegin(path, settings.reach_dead_band_m, settings);
  // Standing still is no reach yet, nor is what settles before the hand moves: it begins with the
  // movement, slowly at first.
  const auto motion_m_per_s = [&](int frame) { return evidence.Motion_m_per_s(hand, frame); };
  int moves = begin;
  while (moves < touch && motion_m_per_s(moves + 1) < settings.idle_speed_m_per_s) ++moves;
  while (moves > begin && motion_m_per_s(moves) > settings.onset_speed_m_per_s) --moves;
  begin = moves;
  return begin;
}

}  // namespace prehend::harness::oracle
