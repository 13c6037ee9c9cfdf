// SPDX-License-Identifier: Apache-2.0
// The recording as the oracle reads it: frames by index, time in ticks. Entities are the scene's
// bodies, then its hands. Tested by tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::truth {

// Intervals of frames and what can be done with them. Tested by
// tests/harness/truth/oracle/oracle_test.cc

/// Half-open, indices into the recording. `end` may be the number of frames: then it never ended.
struct Span {
  int begin = 0;
  int end = 0;
  bool empty() const { return begin >= end; }
  bool Contains(int frame) const { return begin <= frame && frame < end; }
  auto operator<=>(const Span&) const = default;
};
using Spans = std::vector<Span>;  ///< sorted, disjoint, none empty

inline Span Common(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

/// Whether one of the spans contains the frame.
bool Covers(const Spans& spans, int frame);

/// The parts of the spans that lie in `window`.
Spans Within(const Spans& spans, Span window);

/// What the spans leave uncovered of `window`.
Spans Rest(const Spans& spans, Span window);

/// Everything that is covered by one or the other.
Spans Union(const Spans& a, const Spans& b);

/// Maximal intervals of true frames.
Spans WhereTrue(const std::vector<bool>& flags);

/// Joins spans whose gap lasts `ticks` or less; `frame_ticks[i]` is the tick of frame i.
Spans Bridged(const Spans& spans, const std::vector<grammar::Tick>& frame_ticks, double ticks);

struct Recording {
  const physics::Scene& scene;
  std::span<const physics::Snapshot> frames;
  std::vector<grammar::Tick> ticks;  ///< one per frame

  int size() const { return static_cast<int>(frames.size()); }
  int body_count() const { return static_cast<int>(scene.bodies.size()); }
  double Ticks(double seconds) const { return seconds * scene.world.rate_hz; }
  double Seconds(int from_frame, int to_frame) const;
  double Lasts_s(Span span) const;

  const physics::BodyState& body(int body, int frame) const { return frames[frame].bodies[body]; }
  const physics::HandState& hand(int hand, int frame) const { return frames[frame].hands[hand]; }
  const Eigen::Vector3d& place(int body, int frame) const {
    return frames[frame].bodies[body].X_WB.p_m;
  }
  const std::string& name(int entity) const;
};

Recording MakeRecording(const physics::Scene& scene, std::span<const physics::Snapshot> frames);

/// Velocity of the body's material at a point.
Eigen::Vector3d VelocityAt(const physics::BodyState& body, const Eigen::Vector3d& p_W_m);

/// Two entities in the order in which the fact names them.
using Pair = std::pair<int, int>;

}  // namespace prehend::truth
