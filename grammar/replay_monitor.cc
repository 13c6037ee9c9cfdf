// SPDX-License-Identifier: Apache-2.0
#include "grammar/replay_monitor.h"

#include <algorithm>

namespace prehend::grammar {

ReplayMonitor::ReplayMonitor(std::shared_ptr<const Program> program, EntityTable entity_table)
    : engine_(std::move(program), std::move(entity_table)) {
  engine_.Remember(log_);
}

void ReplayMonitor::Finish(Tick end) {
  engine_.Finish(end, events_);
  end_tick_ = frames() == 0 ? end : std::max(end, engine_.history().At(frames() - 1).tick + 1);
  by_instance_.resize(engine_.instances().size());
  // The fact has no outcomes: its intervals are what was seen.
  for (int instance = 0; instance < engine_.instances().size(); ++instance) {
    if (At(instance).rule != kTouchingRule) continue;
    const RingBuffer<Span>& past = At(instance).past;
    for (std::size_t i = 0; i < past.size(); ++i) {
      by_instance_[instance].push_back(
          {.instance = instance, .span = past[i], .decided = past[i].end.tick});
    }
  }
  for (CandidateOutcome& outcome : log_) {
    if (outcome.kind == CandidateOutcome::Kind::kWalkedBack) {
      by_instance_[outcome.instance].push_back(outcome);
      continue;
    }
    // What became of a walk back takes its place.
    std::vector<CandidateOutcome>& outcomes = by_instance_[outcome.instance];
    const auto same = [&](const CandidateOutcome& other) {
      return other.kind == CandidateOutcome::Kind::kWalkedBack &&
             other.span.end.frame == outcome.span.end.frame;
    };
    if (const auto walk = std::find_if(outcomes.begin(), outcomes.end(), same);
        walk != outcomes.end())
      outcome.walk = walk->walk;
    std::erase_if(outcomes, same);
    outcomes.push_back(outcome);
  }
  for (std::vector<CandidateOutcome>& outcomes : by_instance_) {
    std::erase_if(outcomes, [](const CandidateOutcome& outcome) {
      return outcome.kind == CandidateOutcome::Kind::kWalkedBack;
    });
    std::stable_sort(outcomes.begin(), outcomes.end(),
                     [](const CandidateOutcome& a, const CandidateOutcome& b) {
                       return a.span.end.tick < b.span.end.tick;
                     });
  }
}

Tick ReplayMonitor::TickOf(FrameNumber frame) const {
  return frame < frames() ? engine_.history().At(std::max<FrameNumber>(frame, 0)).tick : end_tick_;
}

FrameNumber ReplayMonitor::FrameAt(Tick tick) const {
  return std::clamp<FrameNumber>(engine_.history().LastNotAfter(tick), 0,
                                 std::max<FrameNumber>(frames() - 1, 0));
}

std::vector<int> ReplayMonitor::InstancesOf(int rule) {
  std::vector<int> instances;
  for (int instance = 0; instance < engine_.instances().size(); ++instance) {
    if (At(instance).rule == rule) instances.push_back(instance);
  }
  std::sort(instances.begin(), instances.end(),
            [&](int a, int b) { return At(a).entities < At(b).entities; });
  return instances;
}

std::vector<int> ReplayMonitor::MembersOf(int instance) {
  const auto* any = At(instance).If<AnyState>();
  return any != nullptr ? any->members : std::vector<int>();
}

const std::vector<CandidateOutcome>& ReplayMonitor::OutcomesOf(int instance) const {
  static const std::vector<CandidateOutcome> kNoOutcomes;
  return instance >= 0 && instance < static_cast<int>(by_instance_.size()) ? by_instance_[instance]
                                                                           : kNoOutcomes;
}

const CandidateOutcome* ReplayMonitor::LastBegun(int instance, FrameNumber frame) const {
  const CandidateOutcome* last = nullptr;
  for (const CandidateOutcome& outcome : OutcomesOf(instance)) {
    if (outcome.kind == CandidateOutcome::Kind::kInterval && outcome.span.begin.frame <= frame)
      last = &outcome;
  }
  return last;
}

const CandidateOutcome* ReplayMonitor::Covering(int instance, FrameNumber frame) const {
  const CandidateOutcome* last = LastBegun(instance, frame);
  return last != nullptr && frame < last->span.end.frame ? last : nullptr;
}

Evaluator::View ReplayMonitor::View(const Moment& at) {
  RuleInstance& instance = engine_.instances()[at.instance];
  const FrameNumber last = frames() - 1;
  // After the episode every value is known.
  if (at.begin)
    static_cast<void>(engine_.evaluator().CaptureAnchors(instance, std::min(*at.begin, last)));
  Evaluator::View view{.instance = instance, .frame = std::min(at.frame, last)};
  if (at.end) view.end = std::min(*at.end, last);
  return view;
}

bool ReplayMonitor::Truth(int node, const Moment& at) {
  return engine_.evaluator().Truth(node, View(at)) == Kleene::kTrue;
}

std::optional<double> ReplayMonitor::Number(int node, const Moment& at) {
  return engine_.evaluator().Number(node, View(at));
}

std::optional<Evaluator::Reach> ReplayMonitor::ReachOf(int node, const Moment& at) {
  return engine_.evaluator().ReachOf(program().nodes[node], View(at));
}

}  // namespace prehend::grammar
