// SPDX-License-Identifier: Apache-2.0
#include "grammar/replay_monitor.h"

#include <algorithm>

namespace prehend::grammar {

Hindsight::Hindsight(std::shared_ptr<const Program> program, EntityTable entity_table)
    : engine_(std::move(program), std::move(entity_table)) {
  engine_.Remember(fates_);
}

void Hindsight::Finish(Tick end) {
  engine_.Finish(end, events_);
  end_tick_ = frames() == 0 ? end : std::max(end, engine_.history().At(frames() - 1).tick + 1);
  by_lane_.resize(engine_.lanes().size());
  // The fact has no fates: its intervals are what was seen.
  for (int lane = 0; lane < engine_.lanes().size(); ++lane) {
    if (At(lane).rule != kTouchingRule) continue;
    const Ring<Span>& past = At(lane).past;
    for (std::size_t i = 0; i < past.size(); ++i) {
      by_lane_[lane].push_back({.lane = lane, .span = past[i], .decided = past[i].end.tick});
    }
  }
  for (Fate& fate : fates_) {
    if (fate.kind == Fate::Kind::kWalkedBack) {
      by_lane_[fate.lane].push_back(fate);
      continue;
    }
    // What became of a walk back takes its place.
    std::vector<Fate>& fates = by_lane_[fate.lane];
    const auto same = [&](const Fate& other) {
      return other.kind == Fate::Kind::kWalkedBack && other.span.end.frame == fate.span.end.frame;
    };
    if (const auto walk = std::find_if(fates.begin(), fates.end(), same); walk != fates.end())
      fate.walk = walk->walk;
    std::erase_if(fates, same);
    fates.push_back(fate);
  }
  for (std::vector<Fate>& fates : by_lane_) {
    std::erase_if(fates, [](const Fate& fate) { return fate.kind == Fate::Kind::kWalkedBack; });
    std::stable_sort(fates.begin(), fates.end(), [](const Fate& a, const Fate& b) {
      return a.span.end.tick < b.span.end.tick;
    });
  }
}

Tick Hindsight::TickOf(FrameNumber frame) const {
  return frame < frames() ? engine_.history().At(std::max<FrameNumber>(frame, 0)).tick : end_tick_;
}

FrameNumber Hindsight::FrameAt(Tick tick) const {
  return std::clamp<FrameNumber>(engine_.history().LastNotAfter(tick), 0,
                                 std::max<FrameNumber>(frames() - 1, 0));
}

std::vector<int> Hindsight::LanesOf(int rule) {
  std::vector<int> lanes;
  for (int lane = 0; lane < engine_.lanes().size(); ++lane) {
    if (At(lane).rule == rule) lanes.push_back(lane);
  }
  std::sort(lanes.begin(), lanes.end(),
            [&](int a, int b) { return At(a).entities < At(b).entities; });
  return lanes;
}

const std::vector<Fate>& Hindsight::FatesOf(int lane) const {
  static const std::vector<Fate> kNoFates;
  return lane >= 0 && lane < static_cast<int>(by_lane_.size()) ? by_lane_[lane] : kNoFates;
}

const Fate* Hindsight::LastBegun(int lane, FrameNumber frame) const {
  const Fate* last = nullptr;
  for (const Fate& fate : FatesOf(lane)) {
    if (fate.kind == Fate::Kind::kInterval && fate.span.begin.frame <= frame) last = &fate;
  }
  return last;
}

const Fate* Hindsight::Covering(int lane, FrameNumber frame) const {
  const Fate* last = LastBegun(lane, frame);
  return last != nullptr && frame < last->span.end.frame ? last : nullptr;
}

Evaluator::View Hindsight::View(const Moment& at) {
  Lane& lane = engine_.lanes()[at.lane];
  const FrameNumber last = frames() - 1;
  // After the episode every value is known.
  if (at.begin)
    static_cast<void>(engine_.evaluator().CaptureAnchors(lane, std::min(*at.begin, last)));
  Evaluator::View view{.lane = lane, .frame = std::min(at.frame, last)};
  if (at.end) view.end = std::min(*at.end, last);
  return view;
}

bool Hindsight::Truth(int node, const Moment& at) {
  return engine_.evaluator().Truth(node, View(at)) == Kleene::kTrue;
}

std::optional<double> Hindsight::Number(int node, const Moment& at) {
  return engine_.evaluator().Number(node, View(at));
}

std::optional<Evaluator::Reach> Hindsight::ReachOf(int node, const Moment& at) {
  return engine_.evaluator().ReachOf(program().nodes[node], View(at));
}

}  // namespace prehend::grammar
