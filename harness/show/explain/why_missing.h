// SPDX-License-Identifier: Apache-2.0
// Why an interval that was expected is none: the run that nearly was one and what it lacked, or
// else the first clause that failed where the condition came closest, into the rules that it refers
// to. Tested by tests/harness/show/explain/why_missing_test.cc
#pragma once

#include <functional>
#include <map>

#include "harness/show/explain/why_event.h"

namespace prehend::show {

class MissingReasons {
 public:
  explicit MissingReasons(grammar::ReplayMonitor& past)
      : past_(past), clauses_(past), events_(past) {}

  /// Of the bindings the one that came closest. `at`: where it should have been; otherwise
  /// anywhere.
  WhyMissing Explain(const std::vector<grammar::InstanceId>& instances,
                     std::optional<grammar::FrameNumber> at);

 private:
  /// The frames to look at, and the one that it is about.
  struct Window {
    grammar::FrameNumber first = 0;
    grammar::FrameNumber last = 0;
    std::optional<grammar::FrameNumber> at = std::nullopt;
  };
  struct Cause {
    Reasons reasons;
    double closeness = 0;  ///< of runs 1 to 2, of conditions less
  };
  Window Whole() { return {0, past_.frames() - 1}; }
  Window Around(grammar::FrameNumber frame);
  /// Likewise, for what stands behind something else: not beyond the moment that was asked for.
  Window Within(const Window& window, grammar::FrameNumber frame);

  Cause OfInstance(grammar::InstanceId instance, const Window& window, int depth);
  /// What became of the runs of a binding, and every `until` that nothing led to. The monitor notes
  /// none of these while something that every run needs is false.
  const grammar::CandidateLog& RunsOf(grammar::InstanceId instance);
  const grammar::CandidateOutcome* NearestRun(grammar::InstanceId instance, const Window& window);
  double RunCloseness(const grammar::CandidateOutcome& outcome);
  /// "to touching(hand, cup) ends", "without touching(hand, cup) begins"
  std::string Awaited(grammar::InstanceId instance);
  std::string HowLate(const grammar::CandidateOutcome& outcome);
  /// What became of a run, and why.
  struct Telling {
    std::string how;
    Reasons because;
  };
  Telling Unconfirmed(const grammar::CandidateOutcome& outcome, grammar::FrameNumber over,
                      int depth);
  Telling NothingBefore(const grammar::CandidateOutcome& outcome);
  Telling Tell(const grammar::CandidateOutcome& outcome, int depth,
               grammar::FrameNumber look_until);
  /// The clauses of a condition, each after this word.
  void AddClauses(const char* word, grammar::NodeId node, const Viewpoint& at, Reasons& reasons);
  std::string Lasted(const grammar::CandidateOutcome& outcome);
  /// `look_until`: what came later than that could not have helped.
  Cause OfRun(const grammar::CandidateOutcome& outcome, int depth,
              grammar::FrameNumber look_until = grammar::kNever);
  /// Clauses, and how far they are from being as they have to be, as a share of a limit; infinite
  /// where nothing was measured.
  struct Weighed {
    Reasons reasons;
    double missed = 0;
  };
  static Weighed Weigh(Reason reason);
  /// The clauses of a node. What stands in its way is first: of alternatives the one that missed by
  /// least, of what is needed together the one that missed by most.
  Weighed Weigh(grammar::NodeId node, const Viewpoint& at, bool truth,
                const std::function<Weighed(const Clauses::Clause&)>& tell);
  Reasons Requirement(const grammar::CandidateOutcome& outcome, int depth);
  Reasons EndThatNeverCame(const grammar::CandidateOutcome& outcome,
                           grammar::FrameNumber look_until, int depth);
  Reason MomentOf(grammar::InstanceId target, bool begins, const Window& run, int depth);
  Cause OfForm(grammar::InstanceId instance, const Window& window, int depth);
  Cause OfWhile(grammar::InstanceId instance, const Window& window, int depth);
  Cause OfFromTo(grammar::InstanceId instance, const Window& window, int depth);
  Cause OfUntil(grammar::InstanceId instance, const Window& window, int depth);
  std::optional<Cause> OfLaterEnd(grammar::InstanceId instance, grammar::FrameNumber at, int depth);
  Cause OfRest(grammar::InstanceId instance, const Window& window, int depth);
  Cause OfAny(grammar::InstanceId instance, const Window& window, int depth);
  std::vector<grammar::Interval> IntervalsFor(grammar::InstanceId composition, int part);
  Cause OfCompose(grammar::InstanceId instance, const Window& window, int depth);
  Cause OfFact(grammar::InstanceId instance, const Window& window);

  /// The clauses of a condition where they came closest to holding, the first failed one followed.
  Cause OfClauses(grammar::NodeId node, Viewpoint at, const Window& window, int depth);
  /// What a condition holds by that should not: references of its clauses, of `any` the bindings.
  Reasons WhyItHolds(grammar::InstanceId instance, grammar::FrameNumber frame);
  void Follow(Reason& reason, grammar::InstanceId target, grammar::FrameNumber frame,
              const Window& window, int depth);
  Reason ClosestApproach(grammar::InstanceId instance, const Window& window);
  grammar::FrameNumber Closest(grammar::NodeId node, Viewpoint at, const Window& window);
  /// The moment never came.
  Cause OfMoment(grammar::NodeId node, grammar::InstanceId instance, const Window& window,
                 int depth);
  Reason Intervals(grammar::InstanceId instance, std::string how);

  grammar::ReplayMonitor& past_;
  Clauses clauses_;
  EventReasons events_;
  std::map<grammar::InstanceId, grammar::CandidateLog> runs_until_;  ///< RunsOf() `until .. since`
};

}  // namespace prehend::show
