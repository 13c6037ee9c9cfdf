// SPDX-License-Identifier: Apache-2.0
// Finds contradictions between the parts of an `and`: `speed(x) > 5 cm/s and speed(x) < 3 cm/s` is
// never true, so it is reported as an error. Starts from the range of each value. Two values count
// as the same if they are written alike, so some contradictions are missed. Tested by
// tests/grammar/compile/compile_test.cc
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grammar/analysis/value_ranges.h"
#include "grammar/base/allen.h"

namespace prehend::grammar {

// The classes that the language knows, and which of them exclude or imply each other. Nothing is
// known about a class of any other name; scenarios have more that are built in
// (IsRootClass). Tested by tests/grammar/compile/compile_test.cc

const std::vector<std::string>& BuiltinClasses();
bool IsBuiltinClass(std::string_view name);

/// True if some entity can be of both classes.
bool ClassesMeet(std::string_view a, std::string_view b);

/// True if every entity of class `a` is of class `b`, too, as far as that is known.
bool ClassImplies(std::string_view a, std::string_view b);

/// The comparison `a op b` as `b op a`.
Op Mirrored(Op op);

class Bounds {
 public:
  /// `denies`: what is added negated is false; else it is not true, and may be unknown.
  Bounds(const Program& program, const Rule& rule, bool denies = true)
      : program_(program), rule_(rule), denies_(denies) {}

  /// Adds what must be so for this truth value to be true. False: it contradicts what was added
  /// before.
  bool Add(NodeId node, bool negated = false);
  /// Adds what must have been so one frame before a moment: false what begins, true what ends.
  bool AddBefore(NodeId moment);
  /// False: whichever of the alternatives (of an `or`) one takes, it contradicts the rest. Gives up
  /// where there are very many.
  bool SomeAlternativeFits() const;

 private:
  struct Limit {
    Range range;
    bool low_open = false;
    bool high_open = false;
    std::vector<double> never = {};
  };
  struct Alternative {
    NodeId node;
    bool negated = false;
  };
  bool AddAtom(NodeId node, bool negated);
  bool AddNotKnown(NodeId node);
  bool AddCall(const Reference& reference, bool negated);
  bool AddClass(const Node& is, bool negated);
  bool MayFollowAtOnce(NodeId node) const;
  bool AddComparison(Op op, const Node& comparison);
  bool Narrow(const std::string& value, const Range& range, Op op, double number);
  bool SomeFits(std::size_t next, int& budget) const;

  const Program& program_;
  const Rule& rule_;
  const bool denies_;
  struct ClassClaim {
    int role = kNone;
    std::string name;
    bool negated = false;
  };
  std::map<std::string, Limit> limits_;
  std::vector<ClassClaim> classes_;
  std::vector<std::pair<Reference, bool>> calls_;  ///< and whether it is negated
  std::vector<Alternative> alternatives_;
};

// Relations between several intervals that must hold at once, and whether they can: path
// consistency over Allen's thirteen relations, after his paper of 1983. What it refuses can never
// be; a network that it accepts may still, in rare cases, be impossible. Tested by
// tests/grammar/analysis/allen_network_test.cc

inline constexpr AllenSet kAnyRelation = (1U << kAllenNames.size()) - 1;

/// How b may lie to a if a lies to b in one of these ways.
AllenSet Inverse(AllenSet relations);

/// How a may lie to c if a lies to b, and b to c, in one of these ways.
AllenSet Composed(AllenSet a_to_b, AllenSet b_to_c);

class AllenNetwork {
 public:
  /// So many intervals, about which nothing is known but that each equals itself.
  explicit AllenNetwork(int intervals);

  /// `left` lies to `right` in one of these ways, too. False: together with what was said before,
  /// that cannot be.
  bool Constrain(int left, int right, AllenSet relations);

 private:
  AllenSet& At(int left, int right) { return relations_[left * size_ + right]; }
  bool Narrow(int left, int right, AllenSet relations);

  int size_;
  std::vector<AllenSet> relations_;
};

}  // namespace prehend::grammar
