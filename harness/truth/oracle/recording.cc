// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/recording.h"

namespace prehend::truth {

bool Covers(const Spans& spans, int frame) {
  return std::ranges::any_of(spans, [&](const Span& span) { return span.Contains(frame); });
}

Spans Within(const Spans& spans, Span window) {
  Spans parts;
  for (const Span& span : spans)
    if (const Span part = Common(span, window); !part.empty()) parts.push_back(part);
  return parts;
}

Spans Rest(const Spans& spans, Span window) {
  Spans rest;
  int covered_to = window.begin;
  for (const Span& span : Within(spans, window)) {
    if (covered_to < span.begin) rest.push_back({covered_to, span.begin});
    covered_to = span.end;
  }
  if (covered_to < window.end) rest.push_back({covered_to, window.end});
  return rest;
}

Spans Union(const Spans& a, const Spans& b) {
  Spans all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::ranges::sort(all, {}, &Span::begin);
  Spans joined;
  for (const Span& span : all) {
    if (!joined.empty() && span.begin <= joined.back().end)
      joined.back().end = std::max(joined.back().end, span.end);
    else
      joined.push_back(span);
  }
  return joined;
}

Spans WhereTrue(const std::vector<bool>& flags) {
  Spans spans;
  for (int i = 0; i < static_cast<int>(flags.size()); ++i) {
    if (!flags[i]) continue;
    if (spans.empty() || spans.back().end < i) spans.push_back({i, i});
    spans.back().end = i + 1;
  }
  return spans;
}

Spans Bridged(const Spans& spans, const std::vector<grammar::Tick>& frame_ticks, double ticks) {
  Spans joined;
  for (const Span& span : spans) {
    if (!joined.empty() &&
        static_cast<double>(frame_ticks[span.begin] - frame_ticks[joined.back().end]) <= ticks)
      joined.back().end = span.end;
    else
      joined.push_back(span);
  }
  return joined;
}

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

}  // namespace prehend::truth
