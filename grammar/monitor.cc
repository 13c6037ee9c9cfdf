// SPDX-License-Identifier: Apache-2.0
// The facade: everything is done by the engine.
#include "grammar/monitor.h"

#include "grammar/engine/engine.h"

namespace prehend::grammar {

struct Monitor::State {
  Engine engine;
};

// The engine refers to its own members, so it lives where it was made.
Monitor::Monitor(std::shared_ptr<const Program> program, EntityTable entity_table)
    : state_(new State{Engine(std::move(program), std::move(entity_table))}) {}
Monitor::~Monitor() = default;
Monitor::Monitor(Monitor&&) noexcept = default;
Monitor& Monitor::operator=(Monitor&&) noexcept = default;

const std::string& Monitor::error() const { return state_->engine.error(); }
void Monitor::Advance(const Frame& frame, std::vector<Event>& out) {
  state_->engine.Advance(frame, out);
}
void Monitor::AdvanceBy(const FrameChanges& changes, std::vector<Event>& out) {
  state_->engine.AdvanceBy(changes, out);
}
void Monitor::Finish(Tick end, std::vector<Event>& out) { state_->engine.Finish(end, out); }
int Monitor::instances_in_use() const { return state_->engine.instances_in_use(); }

}  // namespace prehend::grammar
