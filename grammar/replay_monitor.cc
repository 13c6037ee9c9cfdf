// SPDX-License-Identifier: Apache-2.0
// The engine with its log of candidates, sorted by instance when the episode is over.
#include "grammar/replay_monitor.h"

#include <algorithm>

#include "grammar/engine/engine.h"

namespace prehend::grammar {

struct ReplayMonitor::State {
  State(std::shared_ptr<const Program> program, EntityTable entity_table)
      : engine(std::move(program), std::move(entity_table)) {
    engine.Remember(log);
  }
  const RuleInstance& At(InstanceId instance) { return engine.instances()[instance]; }
  Evaluator::View View(const Viewpoint& at);

  CandidateLog log;
  Engine engine;
  std::vector<Event> events;
  Tick end_tick = 0;
  IdVector<InstanceId, CandidateLog> by_instance;
};

ReplayMonitor::ReplayMonitor(std::shared_ptr<const Program> program, EntityTable entity_table)
    : state_(std::make_unique<State>(std::move(program), std::move(entity_table))) {}
ReplayMonitor::~ReplayMonitor() = default;

const std::string& ReplayMonitor::error() const { return state_->engine.error(); }
void ReplayMonitor::Advance(const Frame& frame) { state_->engine.Advance(frame, state_->events); }

void ReplayMonitor::Finish(Tick end) {
  Engine& engine = state_->engine;
  IdVector<InstanceId, CandidateLog>& by_instance = state_->by_instance;
  engine.Finish(end, state_->events);
  state_->end_tick =
      frames() == 0 ? end : std::max(end, engine.history().At(frames() - 1).tick + 1);
  by_instance.resize(engine.instances().end_id().index());
  // The fact has no outcomes: its intervals are what was seen.
  for (const InstanceId id : IdsOf(by_instance)) {
    if (state_->At(id).rule != kTouchingRule) continue;
    const RingBuffer<Span>& past = state_->At(id).past;
    for (std::size_t i = 0; i < past.size(); ++i) {
      by_instance[id].push_back({.instance = id, .span = past[i], .decided = past[i].end.tick});
    }
  }
  for (CandidateOutcome& outcome : state_->log) {
    CandidateLog& outcomes = by_instance[outcome.instance];
    if (outcome.If<fate::WalkedBack>() == nullptr) {
      // It takes the place of the walk back to which it belongs.
      const auto same = [&](const CandidateOutcome& other) {
        return other.If<fate::WalkedBack>() != nullptr &&
               other.span.end.frame == outcome.span.end.frame;
      };
      const auto walk = std::ranges::find_if(outcomes, same);
      if (walk != outcomes.end()) outcome.walk = walk->walk;
      std::erase_if(outcomes, same);
    }
    outcomes.push_back(outcome);
  }
  for (CandidateLog& outcomes : by_instance) {
    std::erase_if(outcomes, [](const CandidateOutcome& outcome) {
      return outcome.If<fate::WalkedBack>() != nullptr;
    });
    std::ranges::stable_sort(outcomes, {},
                             [](const CandidateOutcome& outcome) { return outcome.span.end.tick; });
  }
}

const Program& ReplayMonitor::program() const { return state_->engine.program(); }
const EntityTable& ReplayMonitor::entity_table() const { return state_->engine.entity_table(); }
const std::vector<Event>& ReplayMonitor::events() const { return state_->events; }

FrameNumber ReplayMonitor::frames() const { return state_->engine.history().now() + 1; }

Tick ReplayMonitor::TickOf(FrameNumber frame) const {
  return frame < frames() ? state_->engine.history().At(std::max<FrameNumber>(frame, 0)).tick
                          : state_->end_tick;
}

FrameNumber ReplayMonitor::FrameAt(Tick tick) const {
  return std::clamp<FrameNumber>(state_->engine.history().LastNotAfter(tick), 0,
                                 std::max<FrameNumber>(frames() - 1, 0));
}

Tick ReplayMonitor::AtMostTicks(double seconds) const {
  return state_->engine.history().AtMostTicks(seconds);
}

InstanceId ReplayMonitor::InstanceOf(RuleId rule, const Binding& entities) {
  return state_->engine.instances().Ensure(rule, entities);
}

InstanceId ReplayMonitor::Referred(InstanceId instance, int slot) {
  RuleInstances& instances = state_->engine.instances();
  return instances.Resolve(instances[instance], slot);
}

std::vector<InstanceId> ReplayMonitor::InstancesOf(RuleId rule) const {
  std::vector<InstanceId> instances;
  const InstanceId end = state_->engine.instances().end_id();
  for (InstanceId instance(0); instance < end; ++instance) {
    if (state_->At(instance).rule == rule) instances.push_back(instance);
  }
  std::ranges::sort(instances, {}, [&](InstanceId instance) { return EntitiesOf(instance); });
  return instances;
}

const Rule& ReplayMonitor::RuleOf(InstanceId instance) const {
  return program().rules[state_->At(instance).rule];
}

const Binding& ReplayMonitor::EntitiesOf(InstanceId instance) const {
  return state_->At(instance).entities;
}

std::vector<InstanceId> ReplayMonitor::MembersOf(InstanceId instance) const {
  const auto* any = state_->At(instance).If<AnyState>();
  return any != nullptr ? any->members : std::vector<InstanceId>();
}

// A binding that was made after the end has none.
const CandidateLog& ReplayMonitor::OutcomesOf(InstanceId instance) const {
  static const CandidateLog kNoOutcomes;
  const bool is_known = instance != kNone && instance < state_->by_instance.end_id();
  return is_known ? state_->by_instance[instance] : kNoOutcomes;
}

const CandidateOutcome* ReplayMonitor::LastBegun(InstanceId instance, FrameNumber frame) const {
  const CandidateOutcome* last = nullptr;
  for (const CandidateOutcome& outcome : OutcomesOf(instance)) {
    if (outcome.IsInterval() && outcome.span.begin.frame <= frame) last = &outcome;
  }
  return last;
}

const CandidateOutcome* ReplayMonitor::Covering(InstanceId instance, FrameNumber frame) const {
  const CandidateOutcome* last = LastBegun(instance, frame);
  return last != nullptr && frame < last->span.end.frame ? last : nullptr;
}

Evaluator::View ReplayMonitor::State::View(const Viewpoint& at) {
  RuleInstance& instance = engine.instances()[at.instance];
  const FrameNumber last = engine.history().now();
  // After the episode every value is known.
  if (at.begin)
    static_cast<void>(engine.evaluator().CaptureAnchors(instance, std::min(*at.begin, last)));
  Evaluator::View view{.instance = instance, .frame = std::min(at.frame, last)};
  if (at.end) view.end = std::min(*at.end, last);
  return view;
}

bool ReplayMonitor::Is(bool truth, NodeId node, const Viewpoint& at) {
  Evaluator::View view = state_->View(at);
  view.negated = !truth;
  return (state_->engine.evaluator().Truth(node, view) == Kleene::kTrue) == truth;
}

std::optional<double> ReplayMonitor::Number(NodeId node, const Viewpoint& at) {
  return state_->engine.evaluator().Number(node, state_->View(at));
}

std::optional<Reach> ReplayMonitor::ReachOf(NodeId node, const Viewpoint& at) {
  return state_->engine.evaluator().ReachOf(program().nodes[node], state_->View(at));
}

}  // namespace prehend::grammar
