// SPDX-License-Identifier: Apache-2.0
// Watches an episode and forgets nothing. Afterwards, every clause of a grammar can be asked for
// its value at every frame, and every run for what became of it. The values come from the engine's
// own evaluator, the intervals from the engine itself, so an explanation cannot say anything else
// than the monitor does. It takes memory for every frame of what moves: it is for explanations and
// plots, not for watching. Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/candidate_log.h"
#include "grammar/base/event.h"
#include "grammar/base/solid.h"
#include "grammar/base/span.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

class ReplayMonitor {
 public:
  ReplayMonitor(std::shared_ptr<const Program> program, EntityTable entity_table);
  ~ReplayMonitor();
  ReplayMonitor(const ReplayMonitor&) = delete;
  ReplayMonitor& operator=(const ReplayMonitor&) = delete;

  /// Empty, or why this program cannot be evaluated on this entity table or these frames.
  const std::string& error() const;
  void Advance(const Frame& frame);
  /// As Monitor::Finish(). Before, nothing below may be asked for, and after, nothing be added.
  void Finish(Tick end);

  const Program& program() const;
  const EntityTable& entity_table() const;
  const std::vector<Event>& events() const;

  /// Frames are numbered from 0; number frames() is the end of the episode.
  FrameNumber frames() const;
  Tick TickOf(FrameNumber frame) const;
  /// The last frame at or before the tick; the first one if there is none.
  FrameNumber FrameAt(Tick tick) const;
  /// So many seconds in whole ticks, rounded down.
  Tick AtMostTicks(double seconds) const;

  /// The binding of a rule, whether or not anything ever happened to it; kNone if an entity's class
  /// does not fit.
  InstanceId InstanceOf(RuleId rule, const Binding& entities);
  /// The binding that a reference of this one means, likewise.
  InstanceId Referred(InstanceId instance, int slot);
  /// All bindings of a rule that were ever looked at, by entities.
  std::vector<InstanceId> InstancesOf(RuleId rule) const;
  const Rule& RuleOf(InstanceId instance) const;
  /// By role.
  const Binding& EntitiesOf(InstanceId instance) const;
  /// Of a binding made for an `any`: the bindings of which one must hold. None for other rules.
  std::vector<InstanceId> MembersOf(InstanceId instance) const;

  /// What became of the runs of a binding, in the order of their ends.
  const CandidateLog& OutcomesOf(InstanceId instance) const;
  /// The last of its intervals that begins at or before the frame; null if there is none.
  const CandidateOutcome* LastBegun(InstanceId instance, FrameNumber frame) const;
  /// The interval that contains the frame; null if there is none.
  const CandidateOutcome* Covering(InstanceId instance, FrameNumber frame) const;

  /// A binding at a frame, with the boundaries of the interval that it is asked for, as far as the
  /// clause needs them.
  struct Viewpoint {
    InstanceId instance;
    FrameNumber frame = 0;
    std::optional<FrameNumber> begin = std::nullopt;
    std::optional<FrameNumber> end = std::nullopt;
  };
  bool Truth(NodeId node, const Viewpoint& at) { return Is(true, node, at); }
  /// Whether the node is true, or is not. Of what is not tracked, it is neither.
  bool Is(bool truth, NodeId node, const Viewpoint& at);
  std::optional<double> Number(NodeId node, const Viewpoint& at);
  std::optional<Reach> ReachOf(NodeId node, const Viewpoint& at);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prehend::grammar
