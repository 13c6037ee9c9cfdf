// SPDX-License-Identifier: Apache-2.0
// Bounds of one value are intersected; an alternative is tried on a copy of what is known.
// The seven classes and the few facts about them.
#include "grammar/analysis/contradictions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace prehend::grammar {
namespace {

bool SaysHowItMoves(std::string_view name) {
  return name == "Movable" || name == "Fixed" || name == "Jointed" || name == "Attached";
}

Op Negated(Op op) {
  constexpr std::array kNegated = {Op::kGreaterEqual, Op::kGreater,  Op::kLessEqual,
                                   Op::kLess,         Op::kNotEqual, Op::kEqual};
  return kNegated[static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::kLess)];
}

// Path consistency: a relation is narrowed by every way through a third interval until nothing
// changes.

constexpr std::size_t kRelations = kAllenNames.size();

using Table = std::array<std::array<AllenSet, kRelations>, kRelations>;

// Three intervals have six ends, so that whatever can be can be between 0 and 5.
std::vector<Interval> AllIntervals() {
  std::vector<Interval> all;
  for (Tick begin = 0; begin < 5; ++begin) {
    for (Tick end = begin + 1; end <= 5; ++end) all.push_back({begin, end});
  }
  return all;
}

Table MakeTable() {
  Table table{};
  const std::vector<Interval> all = AllIntervals();
  for (const Interval& a : all) {
    for (const Interval& b : all) {
      for (const Interval& c : all) {
        table[static_cast<std::size_t>(Relate(a, b))][static_cast<std::size_t>(Relate(b, c))] |=
            Bit(Relate(a, c));
      }
    }
  }
  return table;
}

bool Has(AllenSet relations, std::size_t relation) { return (relations >> relation & 1U) != 0; }

}  // namespace

const std::vector<std::string>& BuiltinClasses() {
  static const std::vector<std::string> kClasses = {"Entity", "Hand",    "Thing",   "Movable",
                                                    "Fixed",  "Jointed", "Attached"};
  return kClasses;
}

bool IsBuiltinClass(std::string_view name) {
  return std::ranges::count(BuiltinClasses(), name) > 0;
}

bool ClassesMeet(std::string_view a, std::string_view b) {
  if (a == b || a == "Entity" || b == "Entity") return true;
  if (a == "Hand" || b == "Hand") return false;
  return !SaysHowItMoves(a) || !SaysHowItMoves(b);
}

bool ClassImplies(std::string_view a, std::string_view b) {
  return a == b || b == "Entity" || (b == "Thing" && SaysHowItMoves(a));
}

Op Mirrored(Op op) {
  constexpr std::array kMirrored = {Op::kGreater,   Op::kGreaterEqual, Op::kLess,
                                    Op::kLessEqual, Op::kEqual,        Op::kNotEqual};
  return kMirrored[static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::kLess)];
}

bool Bounds::Add(NodeId index, bool negated) {
  const Node& node = program_.nodes[index];
  if (node.op == Op::kNot) return Add(node.args[0], !negated);
  if (node.op == Op::kKnown && !(negated ? AddNotKnown(node.args[0]) : Add(node.args[0])))
    return false;
  if (node.op == Op::kAnd || node.op == Op::kOr) {
    if ((node.op == Op::kAnd) != negated)
      return Add(node.args[0], negated) && Add(node.args[1], negated);
    alternatives_.push_back({index, negated});
    return true;
  }
  if (IsComparison(node.op))
    return AddAtom(index, negated) && AddComparison(negated ? Negated(node.op) : node.op, node);
  if (node.op == Op::kHolds && !AddCall(rule_.references[node.slot], negated)) return false;
  if (node.op == Op::kIsA) return AddClass(node, negated);
  // What begins is true from now on. What ends is false, but an event may end where its next
  // interval begins.
  if (node.op == Op::kBegins && !negated && !Add(node.args[0])) return false;
  if (node.op == Op::kEnds && !negated && !MayFollowAtOnce(node.args[0]) &&
      !Add(node.args[0], true))
    return false;
  return AddAtom(index, negated);
}

// Of `or` nothing is known.
bool Bounds::AddBefore(NodeId moment) {
  const Node& node = program_.nodes[moment];
  if (node.op == Op::kAnd) return AddBefore(node.args[0]) && AddBefore(node.args[1]);
  if (node.op == Op::kEnds) return Add(node.args[0]);
  return node.op != Op::kBegins || MayFollowAtOnce(node.args[0]) || Add(node.args[0], true);
}

// Whether an interval may begin where the one before it ends: of a truth value, none does.
bool Bounds::MayFollowAtOnce(NodeId index) const {
  const Node& node = program_.nodes[index];
  if (node.op != Op::kHolds) return false;
  const Form form = program_.rules[rule_.references[node.slot].rule].form();
  return form != Form::kTouching && form != Form::kAny && form != Form::kWhile;
}

bool Bounds::AddClass(const Node& is, bool negated) {
  const ClassClaim claim{is.roles[0], program_.class_names[is.slot], negated};
  const auto fits = [&](const ClassClaim& other) {
    if (other.role != claim.role) return true;
    if (!other.negated && !claim.negated) return ClassesMeet(other.name, claim.name);
    if (other.negated && claim.negated) return true;
    const auto& [is_one, is_none] =
        other.negated ? std::pair(claim.name, other.name) : std::pair(other.name, claim.name);
    return !ClassImplies(is_one, is_none);
  };
  const ClassClaim of_role{claim.role, rule_.roles[claim.role].class_name};
  if (!fits(of_role) || !std::ranges::all_of(classes_, fits)) return false;
  classes_.push_back(claim);
  return true;
}

bool Bounds::AddAtom(NodeId index, bool negated) {
  return Narrow(Signature(program_, rule_, index), {.low = 0, .high = 1}, Op::kEqual,
                negated ? 0 : 1);
}

// It is false, or else unknown: between the two. That a rule does not hold is unknown where nobody
// sees it, and yet it does not.
bool Bounds::AddNotKnown(NodeId index) {
  if (!denies_) return true;
  bool is_not = false;
  for (; program_.nodes[index].op == Op::kNot; index = program_.nodes[index].args[0])
    is_not = !is_not;
  if (is_not && program_.nodes[index].op == Op::kHolds) return true;
  return Narrow(Signature(program_, rule_, index), {.low = 0, .high = 1},
                is_not ? Op::kGreater : Op::kLess, is_not ? 0 : 1);
}

// Where it holds of somebody, it holds of any.
bool Bounds::AddCall(const Reference& call, bool negated) {
  const auto is_any_of = [&](const Reference& any, const Reference& one) {
    const auto* const of = program_.rules[any.rule].If<AnyRule>();
    if (of == nullptr || of->at_least != 1 || of->one != kNone) return false;
    const Reference& each = program_.rules[any.rule].references.front();
    bool fits = each.rule == one.rule;
    for (std::size_t i = 0; fits && i < each.roles.size(); ++i)
      fits = each.roles[i] == kNone ||
             any.roles[static_cast<std::size_t>(each.roles[i])] == one.roles[i];
    return fits;
  };
  const bool denied = std::ranges::any_of(calls_, [&](const auto& other) {
    return other.second != negated &&
           (negated ? is_any_of(call, other.first) : is_any_of(other.first, call));
  });
  calls_.emplace_back(call, negated);
  return !denied;
}

bool Bounds::AddComparison(Op op, const Node& comparison) {
  const NodeId left = comparison.args[0];
  const NodeId right = comparison.args[1];
  const Range of_left = RangeOf(program_, rule_, left);
  const Range of_right = RangeOf(program_, rule_, right);
  if (Judge(op, of_left, of_right) == Verdict::kNever) return false;
  if (of_right.IsPoint())
    return Narrow(Signature(program_, rule_, left), of_left, op, of_right.low);
  if (of_left.IsPoint())
    return Narrow(Signature(program_, rule_, right), of_right, Mirrored(op), of_left.low);
  // Of two that are measured, what is known is their difference.
  const std::string a = Signature(program_, rule_, left);
  const std::string b = Signature(program_, rule_, right);
  return a < b ? Narrow(a + "-" + b, {}, op, 0) : Narrow(b + "-" + a, {}, Mirrored(op), 0);
}

bool Bounds::Narrow(const std::string& value, const Range& range, Op op, double number) {
  Limit& limit = limits_.try_emplace(value, Limit{.range = range}).first->second;
  if (range.whole) {  // more than 1 is 2 at least
    if (op == Op::kGreater || op == Op::kGreaterEqual)
      number = op == Op::kGreater ? std::floor(number) + 1 : std::ceil(number);
    if (op == Op::kLess || op == Op::kLessEqual)
      number = op == Op::kLess ? std::ceil(number) - 1 : std::floor(number);
    if (op == Op::kGreater) op = Op::kGreaterEqual;
    if (op == Op::kLess) op = Op::kLessEqual;
  }
  const bool from_below = op == Op::kGreater || op == Op::kGreaterEqual || op == Op::kEqual;
  const bool from_above = op == Op::kLess || op == Op::kLessEqual || op == Op::kEqual;
  if (from_below &&
      (number > limit.range.low || (number == limit.range.low && op == Op::kGreater))) {
    limit.range.low = number;
    limit.low_open = op == Op::kGreater;
  }
  if (from_above &&
      (number < limit.range.high || (number == limit.range.high && op == Op::kLess))) {
    limit.range.high = number;
    limit.high_open = op == Op::kLess;
  }
  if (op == Op::kNotEqual) limit.never.push_back(number);
  if (limit.range.IsPoint())
    return !limit.low_open && !limit.high_open &&
           std::ranges::find(limit.never, limit.range.low) == limit.never.end();
  return limit.range.low < limit.range.high;
}

bool Bounds::SomeAlternativeFits() const {
  int budget = 256;
  return SomeFits(0, budget);
}

bool Bounds::SomeFits(std::size_t next, int& budget) const {
  if (next == alternatives_.size() || --budget < 0) return true;
  const Alternative& chosen = alternatives_[next];
  for (const NodeId arg :
       {program_.nodes[chosen.node].args[0], program_.nodes[chosen.node].args[1]}) {
    Bounds so_far = *this;
    if (so_far.Add(arg, chosen.negated) && so_far.SomeFits(next + 1, budget)) return true;
  }
  return false;
}

AllenSet Inverse(AllenSet relations) {
  AllenSet inverse = 0;
  for (std::size_t i = 0; i < kRelations;
       ++i) {  // they are listed so that before and after mirror each other, and so on
    if (Has(relations, i)) inverse |= Bit(static_cast<Allen>(kRelations - 1 - i));
  }
  return inverse;
}

AllenSet Composed(AllenSet a_to_b, AllenSet b_to_c) {
  static const Table kTable = MakeTable();
  AllenSet composed = 0;
  for (std::size_t i = 0; i < kRelations; ++i) {
    for (std::size_t j = 0; Has(a_to_b, i) && j < kRelations; ++j) {
      if (Has(b_to_c, j)) composed |= kTable[i][j];
    }
  }
  return composed;
}

AllenNetwork::AllenNetwork(int intervals)
    : size_(intervals), relations_(static_cast<std::size_t>(intervals * intervals), kAnyRelation) {
  for (int i = 0; i < size_; ++i) At(i, i) = Bit(Allen::kEquals);
}

bool AllenNetwork::Constrain(int left, int right, AllenSet relations) {
  if (!Narrow(left, right, relations)) return false;
  std::vector<std::pair<int, int>> changed = {{left, right}};
  while (!changed.empty()) {
    const auto [a, b] = changed.back();
    changed.pop_back();
    for (int c = 0; c < size_; ++c) {
      for (const auto& [from, by, to] : {std::array{a, b, c}, std::array{c, a, b}}) {
        const AllenSet before = At(from, to);
        if (!Narrow(from, to, Composed(At(from, by), At(by, to)))) return false;
        if (At(from, to) != before) changed.emplace_back(from, to);
      }
    }
  }
  return true;
}

bool AllenNetwork::Narrow(int left, int right, AllenSet relations) {
  At(left, right) &= relations;
  At(right, left) &= Inverse(relations);
  return At(left, right) != 0;
}

}  // namespace prehend::grammar
