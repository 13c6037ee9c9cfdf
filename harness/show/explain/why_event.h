// SPDX-License-Identifier: Apache-2.0
// Why an interval has its boundaries, counts, and was decided when it was: from the form of its
// rule and the clauses that turned, into the rules that those refer to. Tested by
// tests/harness/show/explain/explain_test.cc
#pragma once

#include <functional>
#include <memory>
#include <set>

#include "grammar/base/timeline.h"
#include "harness/show/explain/clauses.h"
#include "harness/show/explain/query.h"

namespace prehend::show {

inline constexpr int kMaxDepth = 8;  ///< rules behind rules

class EventReasons {
 public:
  explicit EventReasons(grammar::ReplayMonitor& past) : past_(past), clauses_(past) {}

  /// Everything about one interval of a binding. `brief`: only what turned, for one line per event.
  WhyEvent Explain(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome,
                   bool brief = false);

  Reasons Begin(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome,
                int depth = 0);
  Reasons End(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome,
              int depth = 0);

  /// Of an interval that looks back along an approach: the turn or the pause before which it cannot
  /// begin; nothing if it is cut by something else.
  Reasons CutOfWalk(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome);

 private:
  Reasons BeginOfWalk(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome,
                      int depth);
  Reasons BeginOrEndOfRest(grammar::InstanceId instance, grammar::FrameNumber frame, bool begins,
                           int depth);
  Reasons BeginOrEndOfAny(grammar::InstanceId instance, grammar::FrameNumber frame, bool end,
                          int depth);
  Reasons Parts(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome, int depth);
  std::string TurnText(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome);
  std::string PauseText(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome);
  bool ChooseParts(grammar::InstanceId instance, const grammar::CandidateOutcome& whole,
                   std::vector<const grammar::CandidateOutcome*>& chosen);
  static bool Spans(const std::vector<const grammar::CandidateOutcome*>& chosen,
                    const grammar::CandidateOutcome& whole);
  bool AllInside(grammar::InstanceId instance, const grammar::CandidateOutcome& whole,
                 std::vector<const grammar::CandidateOutcome*>& chosen);
  Reasons Counted(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome);
  Reasons Waited(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome, int depth);
  Reasons WaitedFor(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome,
                    int depth);
  double LooksBack_s(grammar::InstanceId instance);
  Reasons Change(grammar::NodeId node, const Viewpoint& at, bool truth, int depth);
  Clauses::Follow FollowFrom(int depth);
  const grammar::Node& NodeAt(grammar::NodeId node) const { return past_.program().nodes[node]; }
  std::string Seconds(double seconds) const;

  grammar::ReplayMonitor& past_;
  Clauses clauses_;
  bool brief_ = false;
  std::set<grammar::InstanceId> told_;  ///< waited for, and said so already
};

// The decisive clause: the one whose number, changed by the smallest share, makes an event happen
// that did not, or not happen that did. Found by trying: the grammar is compiled with other
// numbers, and the episode watched again. Tested by tests/harness/show/explain/decisive_test.cc

/// What a program recognises in the episode; nothing if it cannot.
using Recognise =
    std::function<std::optional<grammar::Timeline>(const std::shared_ptr<const grammar::Program>&)>;

/// Whether an event is an answer to the question: name, entities, moment.
bool Answers(const Ask& ask, const grammar::Program& program, const grammar::EntityTable& entities,
             const grammar::NamedEvent& event);

/// Sets `decisive`. With no such clause, what it says is empty. What is missing is explained of
/// those whom it would have happened to.
void FindDecisive(grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyMissing& why);
void FindDecisive(const grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyEvent& why);

}  // namespace prehend::show
