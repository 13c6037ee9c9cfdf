// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/furniture.h"

#include <algorithm>
#include <map>

#include "physics/scene/joint.h"

namespace prehend::truth {

namespace {

using Fractions = std::vector<double>;  ///< of a joint's range, by frame

/// Which of the four states holds in each frame. A part that comes back over a limit goes a little
/// farther until it counts.
std::array<Spans, 4> StatesOf(const Fractions& fractions) {
  constexpr std::array kLimits = {0.1, 0.5, 0.9};
  constexpr double kBack = 0.02;
  std::vector<std::size_t> state_at;
  std::size_t state = 0;
  for (const double fraction : fractions) {
    while (state < kLimits.size() && fraction >= kLimits[state]) ++state;
    while (state > 0 && fraction < kLimits[state - 1] - kBack) --state;
    state_at.push_back(state);
  }
  const Spans all{{0, static_cast<int>(state_at.size())}};
  std::array<Spans, 4> states;
  for (std::size_t i = 0; i < states.size(); ++i)
    states[i] = Where(all, [&](int frame) { return state_at[frame] == i; });
  return states;
}

/// Finds where something grows.
class Growth {
 public:
  Growth(const Recording& recording, const Fractions& values, const FurnitureSettings& settings)
      : recording_(recording), values_(values), settings_(settings) {}

  Spans Find() const {
    Spans grown;
    for (const Move& move : WithoutHalts())
      if (Way(move.dated) >= settings_.part_way) grown.push_back(move.dated);
    return grown;
  }

  double Way(Span span) const {
    return values_[std::min(span.end, recording_.size() - 1)] - values_[span.begin];
  }

 private:
  struct Move {
    Span dated;
    double from = 0, to = 0;  ///< values
  };

  /// Frames of windows over which it grows fast enough, from the lowest to the highest value: what
  /// stands still at an end of a window, or goes the other way, is no part of it.
  Spans WhereFast() const {
    std::vector<bool> fast(values_.size());
    const int size = recording_.size();
    for (int from = 0, to = 0; from < size; ++from) {
      while (to + 1 < size && recording_.Seconds(from, to) < settings_.part_window_s) ++to;
      const double lasts_s = recording_.Seconds(from, to);
      if (lasts_s < settings_.part_window_s) break;
      if (values_[to] - values_[from] < settings_.part_speed_per_s * lasts_s) continue;
      int low = from;
      for (int at = from; at <= to; ++at)
        if (values_[at] <= values_[low]) low = at;
      int high = low;
      for (int at = low; at <= to; ++at)
        if (values_[at] > values_[high]) high = at;
      std::fill(fast.begin() + low, fast.begin() + high + 1, true);
    }
    return Where({{0, size}}, [&](int frame) { return fast[frame]; });
  }

  /// After a short halt it goes on if it gets farther than before; else it trembles. If it has lost
  /// all by then, it begins anew. A way back of the size of a motion is no halt.
  std::vector<Move> WithoutHalts() const {
    const double onset = settings_.part_onset;
    std::vector<Move> joined;
    for (const Span& span : WhereFast()) {
      const Move move{Dated(span), values_[span.begin], values_[span.end - 1]};
      if (move.dated.empty()) continue;
      if (joined.empty() ||
          recording_.Seconds(joined.back().dated.end, move.dated.begin) >= settings_.part_halt_s ||
          joined.back().to - move.from >= settings_.part_way) {
        joined.push_back(move);
      } else if (move.from < joined.back().from + onset) {
        joined.back() = move;
      } else if (move.to >= joined.back().to + onset) {
        joined.back().dated.end = move.dated.end;
        joined.back().to = move.to;
      }
    }
    return joined;
  }

  /// From where it has grown a little to where it will only grow as little. The end of a recording
  /// does not stop what grows fast enough until then.
  Span Dated(Span span) const {
    const int last = span.end - 1;
    Span dated{span.begin, last};
    while (dated.begin < last && values_[dated.begin] < values_[span.begin] + settings_.part_onset)
      ++dated.begin;
    while (dated.end > dated.begin && values_[dated.end] > values_[last] - settings_.part_onset)
      --dated.end;
    if (span.end == recording_.size() &&
        recording_.Seconds(dated.end, last) <= settings_.part_onset / settings_.part_speed_per_s)
      dated.end = recording_.size();
    return dated;
  }

  const Recording& recording_;
  const Fractions& values_;
  const FurnitureSettings& settings_;
};

/// Who ever touches the part or what is fixed to it: hands and parts of persons; and when.
std::map<int, Spans> TouchesOf(const Evidence& evidence, physics::BodyIndex part) {
  const Recording& recording = evidence.recording;
  const auto belongs = [&](int entity) {
    return entity < recording.body_count() &&
           physics::RootOf(recording.scene, physics::BodyIndex(entity)) == part;
  };
  const auto acts = [&](int entity) {
    return entity >= recording.body_count() || recording.scene.bodies[entity].kinematic;
  };
  std::map<int, Spans> touches;
  for (const auto& [pair, spans] : evidence.touching)
    for (const auto& [touched, agent] : {pair, Pair(pair.second, pair.first)})
      if (belongs(touched) && acts(agent)) touches[agent] = Union(touches[agent], spans);
  return touches;
}

}  // namespace

std::vector<Part> FindParts(const Evidence& evidence, const FurnitureSettings& settings,
                            double contact_bridge_s) {
  const Recording& recording = evidence.recording;
  std::vector<Part> parts;
  for (const physics::Joint& joint : recording.scene.joints) {
    if (joint.kind != physics::JointKind::kSlider && joint.kind != physics::JointKind::kHinge)
      continue;
    const int body = joint.body.number(), base = joint.base.number();
    Fractions fractions, backwards;
    for (int frame = 0; frame < recording.size(); ++frame) {
      fractions.push_back(physics::StateOf(recording.scene, joint, recording.body(base, frame).X_WB,
                                           recording.body(body, frame).X_WB)
                              .fraction);
      backwards.push_back(-fractions.back());
    }
    Part& part = parts.emplace_back(Part{.body = body, .states = StatesOf(fractions)});
    for (const bool opens : {true, false}) {
      const Growth growth(recording, opens ? fractions : backwards, settings);
      for (const Span& span : growth.Find())
        part.motions.push_back({.opens = opens, .span = span, .way = growth.Way(span)});
    }
    for (const auto& [agent, spans] : TouchesOf(evidence, joint.body)) {
      const Spans touches = recording.Bridged(spans, contact_bridge_s);
      for (PartMotion& motion : part.motions)
        for (const Span& touch : Within(touches, motion.span))
          if (touch.begin == motion.span.begin || recording.Lasts_s(touch) >= settings.part_touch_s)
            motion.by.emplace_back(agent, touch);
    }
  }
  return parts;
}

}  // namespace prehend::truth
