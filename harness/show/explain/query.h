// SPDX-License-Identifier: Apache-2.0
// What somebody asks to have explained, as typed: "reaching@1.24s", "sliding right_hand milk
// @2.0s", "supported_by(milk, table) @ 900 ms", "sliding object=milk". Plays an episode and
// remembers all of it. Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/program/program.h"
#include "grammar/replay_monitor.h"
#include "harness/base/base/result.h"
#include "harness/episode/episode/episode.h"

namespace prehend::show {

struct Ask {
  grammar::RuleId rule;
  grammar::Binding entities = grammar::kUnbound;  ///< kNone: whoever
  std::optional<double> time_s;
};

/// Complains about names, classes and times with the place in the text, which is called `option`.
/// Roles come in the order of the rule's head or as role=entity; `any`, or none at all, leaves them
/// open.
Result<Ask> ParseAsk(const std::string& option, const std::string& text,
                     const grammar::Program& program, const grammar::EntityTable& entity_table);

// The bindings of a rule that could be meant where some of its roles are left open.
// Tested by tests/harness/show/explain/explain_test.cc

inline constexpr std::size_t kMaxBindings = 64;

/// Those that were looked at while the episode went on; if there is none, those that could have
/// been. At most kMaxBindings. `wanted`: kNone for whoever.
std::vector<grammar::InstanceId> BindingsThatFit(grammar::ReplayMonitor& past, grammar::RuleId rule,
                                                 const grammar::Binding& wanted);

/// More would take too much memory: at 240 frames per second, seven minutes.
inline constexpr grammar::FrameNumber kMaxFrames = 100'000;

struct Watched {
  std::unique_ptr<grammar::ReplayMonitor> past;
  std::string failure;  ///< empty, or why the simulation ended early
  std::string problem;  ///< empty, or why the grammar cannot watch this; then nothing may be asked
};

/// Calls its argument with every frame of an episode.
using PlayFrames =
    std::function<episode::Episode::End(const std::function<void(const grammar::Frame&)>&)>;

Watched Watch(const std::shared_ptr<const grammar::Program>& program,
              const grammar::EntityTable& entities, const PlayFrames& play);
Watched Watch(episode::Episode& episode);

}  // namespace prehend::show
