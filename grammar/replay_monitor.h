// SPDX-License-Identifier: Apache-2.0
// An episode watched with nothing forgotten: afterwards, every clause of a grammar can be asked for
// its value at every frame, and every run for what became of it. The values come from the engine's
// own evaluator, the intervals from the engine itself, so an explanation cannot say anything else
// than the monitor does. Takes memory for every frame of what moves: for explanations and plots,
// not for watching. Tested by tests/harness/explain/explain_test.cc
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/engine/engine.h"

namespace prehend::grammar {

class ReplayMonitor {
 public:
  ReplayMonitor(std::shared_ptr<const Program> program, EntityTable entity_table);

  /// Empty, or why this program can't watch this entity table or these frames.
  const std::string& error() const { return engine_.error(); }
  void Advance(const Frame& frame) { engine_.Advance(frame, events_); }
  /// As Monitor::Finish(). Before, nothing below may be asked for, and after, nothing be added.
  void Finish(Tick end);

  const Program& program() const { return engine_.program(); }
  const EntityTable& entity_table() const { return engine_.entity_table(); }
  const std::vector<Event>& events() const { return events_; }

  /// Frames are numbered from 0; number frames() is the end of the episode.
  FrameNumber frames() const { return engine_.history().now() + 1; }
  Tick TickOf(FrameNumber frame) const;
  /// The last frame at or before the tick; the first one if there is none.
  FrameNumber FrameAt(Tick tick) const;
  /// So many seconds in whole ticks, rounded down.
  Tick AtMostTicks(double seconds) const { return engine_.history().AtMostTicks(seconds); }

  /// The binding of a rule, whether or not anything ever happened to it; kNone if an entity's class
  /// does not fit.
  int InstanceOf(int rule, const Binding& entities) {
    return engine_.instances().Ensure(rule, entities);
  }
  /// The binding that a reference of this one means, likewise.
  int Referred(int instance, int slot) {
    return engine_.instances().Resolve(engine_.instances()[instance], slot);
  }
  const RuleInstance& At(int instance) { return engine_.instances()[instance]; }
  /// Of a binding made for an `any`: the bindings of which one must hold. None for other rules.
  std::vector<int> MembersOf(int instance);
  const Rule& RuleOf(int instance) { return program().rules[At(instance).rule]; }
  /// All bindings of a rule that were ever looked at, by entities.
  std::vector<int> InstancesOf(int rule);

  /// What became of the runs of a binding, in the order of their ends.
  const std::vector<CandidateOutcome>& OutcomesOf(int instance) const;
  /// The last of its intervals that begins at or before the frame; null if there is none.
  const CandidateOutcome* LastBegun(int instance, FrameNumber frame) const;
  /// The interval that contains the frame; null if there is none.
  const CandidateOutcome* Covering(int instance, FrameNumber frame) const;

  /// A binding at a frame, with the boundaries of the interval that it is asked for, as far as the
  /// clause needs them.
  struct Moment {
    int instance = kNone;
    FrameNumber frame = 0;
    std::optional<FrameNumber> begin = std::nullopt;
    std::optional<FrameNumber> end = std::nullopt;
  };
  bool Truth(int node, const Moment& at);
  std::optional<double> Number(int node, const Moment& at);
  std::optional<Evaluator::Reach> ReachOf(int node, const Moment& at);

 private:
  Evaluator::View View(const Moment& at);

  CandidateLog log_;
  Engine engine_;
  std::vector<Event> events_;
  Tick end_tick_ = 0;
  std::vector<std::vector<CandidateOutcome>> by_instance_;
};

}  // namespace prehend::grammar
