// SPDX-License-Identifier: Apache-2.0
// From text to events: Compile() a grammar, then feed a Monitor one Frame after another.
// Tested by tests/grammar/monitor_test.cc and the corpus in tests/grammar/corpus/
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/base/event.h"
#include "grammar/base/frame.h"
#include "grammar/compile/compile.h"

namespace prehend::grammar {

/// Evaluates a program on one episode. Allocates nothing per frame after warm-up.
class Monitor {
 public:
  /// Errors (e.g. more bindings than the limit) are reported by error().
  Monitor(std::shared_ptr<const Program> program, EntityTable entity_table);
  ~Monitor();
  Monitor(Monitor&&) noexcept;
  Monitor& operator=(Monitor&&) noexcept;

  /// Empty, or why this program cannot be evaluated on this entity table.
  const std::string& error() const;

  /// Looks at one frame and appends the events that became certain, ordered by (decided, begin,
  /// rule, roles).
  void Advance(const Frame& frame, std::vector<Event>& out);
  /// The same for a frame that is given by what is new in it; costs time for changes only. Both
  /// kinds may be mixed. Frames that bring nothing may be left out: intervals are the same, but
  /// what time alone decides is told later, with the next frame. docs/speed.md says for which
  /// grammars this is not so.
  void AdvanceBy(const FrameChanges& changes, std::vector<Event>& out);

  /// The episode ends at `end`, the first tick that no longer belongs to it: closes what is open.
  void Finish(Tick end, std::vector<Event>& out);

  /// Bindings that take memory now, of all rules.
  int instances_in_use() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prehend::grammar
