// SPDX-License-Identifier: Apache-2.0
// Why an interval has its boundaries, counts, and was decided when it was: from the form of its
// rule and the clauses that turned, into the rules that those refer to. Tested by
// tests/harness/explain/explain_test.cc
#pragma once

#include "harness/explain/clauses.h"

namespace prehend::harness::explain {

class EventReasons {
 public:
  explicit EventReasons(grammar::Hindsight& past) : past_(past), clauses_(past) {}

  /// Everything about one interval of a binding. `brief`: only what turned, for one line per event.
  WhyEvent Explain(int lane, const grammar::Fate& fate, bool brief = false);

  Reasons Begin(int lane, const grammar::Fate& fate, int depth = 0);
  Reasons End(int lane, const grammar::Fate& fate, int depth = 0);

 private:
  Reasons BeginOfWalk(int lane, const grammar::Fate& fate, int depth);
  Reasons BeginOrEndOfRest(int lane, grammar::FrameNumber frame, bool begins, int depth);
  Reasons BeginOrEndOfAny(int lane, grammar::FrameNumber frame, bool end, int depth);
  Reasons Parts(int lane, const grammar::Fate& fate, int depth);
  bool ChooseParts(int lane, const grammar::Fate& whole, std::vector<const grammar::Fate*>& chosen);
  Reasons Counted(int lane, const grammar::Fate& fate);
  Reasons Waited(int lane, const grammar::Fate& fate, int depth);
  Reasons WaitedFor(int lane, const grammar::Fate& fate, int depth);
  double LooksBack_s(int lane);
  Reasons Change(int node, const Moment& at, bool truth, int depth);
  Clauses::Follow FollowFrom(int depth);
  const grammar::Node& NodeAt(int node) const { return past_.program().nodes[node]; }
  std::string Seconds(double seconds) const;

  grammar::Hindsight& past_;
  Clauses clauses_;
  bool brief_ = false;
};

}  // namespace prehend::harness::explain
