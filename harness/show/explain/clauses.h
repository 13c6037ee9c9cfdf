// SPDX-License-Identifier: Apache-2.0
// The clauses of a condition at a frame: which of them made it true or false, with what they
// measured. Knows the forms of the language, no rule. An explanation as a value: clauses with what
// was measured, each with what stands behind it. Tested by
// tests/harness/show/explain/explain_test.cc
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/replay_monitor.h"

namespace prehend::show {

/// What a comparison or a region saw at one frame, SI units.
struct Reading {
  double value = 0;
  double limit = 0;
  std::string unit;  ///< of both, SI: "m", "m/s"; empty for a plain number
  struct Sample {
    grammar::Tick tick = 0;
    double value = 0, limit = 0;
  };
  std::vector<Sample> course;  ///< around that frame, where it decided something; else empty
};

struct Reason {
  enum class Mark {
    kTurned,  ///< became so at this moment
    kHeld,    ///< was so already
    kFailed,  ///< was not as it had to be
    kNote,    ///< says more about what stands above it
  };
  Mark mark = Mark::kNote;
  std::string what;                   ///< the clause: "grasping(right_hand, milk)"
  std::string how;                    ///< "rose to 31 mm, above 20 mm"
  std::string where;                  ///< of a rule: "pick_and_place.grammar:57"
  std::optional<grammar::Tick> tick;  ///< when
  std::optional<Reading> reading;
  std::vector<Reason> because;
  bool impossible = false;  ///< by the classes of the entities, whatever happens
};
using Reasons = std::vector<Reason>;

/// The clause whose number, changed by the smallest share, makes the difference. SI units.
struct Decisive {
  std::string clause;  ///< empty: no single number makes it
  std::string rule;    ///< in which it stands
  std::string where;   ///< "pick_and_place.grammar:57"
  double limit = 0;
  double instead = 0;  ///< would have been enough
  grammar::Dimension dimension;
  double share = 0;        ///< of the larger of the two, before `instead` was rounded
  std::string param = {};  ///< that the limit is, if it stands elsewhere, too
  std::vector<std::string> elsewhere = {};  ///< where it does, and was not changed
};

/// Why an event that happened began, ended, counted and was known as late as it was.
struct WhyEvent {
  std::string event;  ///< "reaching(right_hand, milk)"
  std::string where;
  grammar::Interval interval;
  grammar::Tick decided = 0;
  bool open_end = false;
  Reasons began;
  Reasons ended;
  Reasons counted;
  Reasons waited;
  std::optional<Decisive> decisive = std::nullopt;
};

/// Why an event that was expected did not happen.
struct WhyMissing {
  std::string event;
  std::string where;
  std::optional<grammar::Tick> expected_at;
  std::string because;  ///< the first clause that failed, in one sentence
  Reasons reasons;
  std::optional<Decisive> decisive = std::nullopt;
  std::vector<WhyEvent>
      nearest;  ///< of the same name and entities, at other times; without reasons
};

/// By how much a value missed its limit, 0 to 1: as a share of the larger of the two, of values on
/// the other side of 0 by the distance.
double Missed(double value, double limit);

using Viewpoint = grammar::ReplayMonitor::Viewpoint;

class Clauses {
 public:
  /// Reasons that stand behind a boundary of another rule's interval: (binding, interval, its end).
  using Follow = std::function<Reasons(grammar::InstanceId instance,
                                       const grammar::CandidateOutcome& outcome, bool end)>;

  explicit Clauses(grammar::ReplayMonitor& past) : past_(past) {}

  /// The clauses that make the node what it is at the frame: true, or false. What became so at this
  /// very frame is followed. `brief` leaves out what was so already.
  Reasons Change(grammar::NodeId node, const Viewpoint& at, bool truth, const Follow& follow,
                 bool brief = false);
  /// The same for a reference of the binding.
  Reason Reference(grammar::InstanceId instance, int slot, grammar::FrameNumber frame, bool truth,
                   const Follow& follow);

  /// The clauses of the node, as they were at the frame: those that are not `truth` have failed.
  Reasons State(grammar::NodeId node, const Viewpoint& at, bool truth);

  /// 1 when the node has this truth; else how near its clauses are to it, less than 1.
  double Nearness(grammar::NodeId node, const Viewpoint& at, bool truth, int depth = 0);

  /// What is left of a node without `and`, `or` and `not`.
  struct Clause {
    grammar::NodeId node;
    bool truth = true;  ///< as the node needs it
  };
  /// The clauses that the node depends on at the frame: of alternatives one of which is as it has
  /// to be, only those that are.
  std::vector<Clause> Split(grammar::NodeId node, const Viewpoint& at, bool truth);
  /// Whether one of the node's two parts is enough: of an `or` that has to be true, or an `and`
  /// that has to be false.
  bool IsChoice(grammar::NodeId node, bool truth) const;

  /// A sentence about one comparison, region, test or reference, as it was at the frame.
  Reason Told(const Clause& clause, const Viewpoint& at);

  /// What a comparison or a region compares at the frame, SI units.
  struct Measured {
    double value = 0;
    double limit = 0;
    grammar::Dimension dimension;
    std::string of;  ///< " from the centre"
  };
  std::optional<Measured> Measure(grammar::NodeId node, const Viewpoint& at);

  std::string Time(grammar::FrameNumber frame);
  double Seconds(grammar::Tick ticks) const {
    return static_cast<double>(ticks) / static_cast<double>(past_.entity_table().ticks_per_second);
  }

 private:
  /// Nobody knows the value, as something in it is not tracked.
  bool IsNotTracked(grammar::NodeId node, const Viewpoint& at);
  std::vector<Reading::Sample> Course(grammar::NodeId node, const Viewpoint& at);
  Reason Boundary(grammar::InstanceId instance, const grammar::CandidateOutcome& outcome, bool end,
                  const Follow& follow);
  void Edge(grammar::NodeId node, const Viewpoint& at, bool truth, const Follow& follow, bool brief,
            Reasons& out);
  Reason Leaf(grammar::NodeId node, const Viewpoint& at, bool truth, bool brief);
  Reason Measurement(const Clause& clause, const Viewpoint& at,
                     const std::optional<Measured>& before);
  void Collect(grammar::NodeId node, const Viewpoint& at, bool truth, const Follow& follow,
               bool brief, Reasons& out);
  void Split(grammar::NodeId node, const Viewpoint& at, bool truth, std::vector<Clause>& out);
  std::string WhenInstead(const grammar::Node& edge, const Viewpoint& at);
  Reason Impossible(grammar::InstanceId instance, int slot);
  double NearestMember(grammar::InstanceId any_instance, grammar::FrameNumber frame, int depth);
  std::string Since(grammar::NodeId node, const Viewpoint& at, bool truth);
  const grammar::Node& NodeAt(grammar::NodeId node) const { return past_.program().nodes[node]; }

  grammar::ReplayMonitor& past_;
};

}  // namespace prehend::show
