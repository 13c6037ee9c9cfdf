// SPDX-License-Identifier: Apache-2.0
// What a compiled grammar recognises and what it costs: its events and parameters, how late each
// event can be decided, and how much of the past is kept. Tested by tests/grammar/describe_test.cc
#pragma once

#include <set>
#include <string>
#include <vector>

#include "grammar/program/program.h"

namespace prehend::grammar {

/// An upper bound for something that is waited for: this long, and until the named events have
/// ended.
struct Wait {
  double seconds = 0;
  std::set<std::string> until_end_of;
};

struct RuleDescription {
  std::string name;  ///< "waving"
  std::string head;  ///< "event waving(hand: Hand)"
  bool printed = false;
  Wait latency;  ///< from an interval's end to its decision, besides a frame for each of the waits
  std::string watched;  ///< which bindings cost time: "pairs that touch", "every hand and object"
  std::size_t bytes_per_binding = 0;   ///< at most, besides its intervals
  std::size_t bytes_per_interval = 0;  ///< kept for as long as poses are, if others ask for them
  std::size_t bytes_per_begin = 0;     ///< of `from each`: per begin that waits for an end
  std::size_t bytes_per_part = 0;      ///< of a composition: per interval that waits for others
};

struct LawDescription {
  std::string head;  ///< "law slides_are_supported(hand: Hand, object: Movable)"
  std::string says;  ///< "sliding(hand, object) lies inside supported_by(object, any)"
};

struct GrammarDescription {
  std::string name;
  std::vector<RuleDescription> rules;  ///< in the order of the files; no hidden ones
  std::vector<LawDescription> laws;
  std::vector<ProgramParam> params;
  double history_s = 0;              ///< how long poses are kept
  std::size_t bytes_per_pose = 0;    ///< kept per frame and entity that is awake
  std::size_t bytes_per_feeler = 0;  ///< kept per frame and collision sphere of a hand
};

GrammarDescription Describe(const Program& program);

/// As `prehend validate --grammar` prints it.
std::string Text(const GrammarDescription& description);

}  // namespace prehend::grammar
