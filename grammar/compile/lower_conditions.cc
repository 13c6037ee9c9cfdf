// SPDX-License-Identifier: Apache-2.0
// Conditions that are never or always true: comparisons that their ranges decide, chains of which
// the parts exclude each other, and what follows for the whole clause. Errors and warnings: "this
// is never true", "this is always true". Tested by tests/grammar/compile/compile_test.cc
#include <algorithm>
#include <utility>

#include "grammar/analysis/contradictions.h"
#include "grammar/compile/lower.h"

namespace prehend::grammar {
namespace {

using ast::Expr;

constexpr std::size_t kMostVacuous = 200;  // that are reported, of one clause and as warnings

// The names that stand in it, each once.
void CollectNames(const Expr& expr, std::vector<std::string>& names) {
  const bool is_new = std::find(names.begin(), names.end(), expr.text) == names.end();
  if (expr.kind == Expr::Kind::kName && is_new) names.push_back(expr.text);
  for (const Expr& arg : expr.args) CollectNames(arg, names);
}

}  // namespace

// What can never or only be true is a mistake, if the whole clause is. While a definition is
// checked for itself, its numbers are not known.
Lowering::Typed Lowering::LowerComparison(Op op, const Typed& left, const Typed& right,
                                          const Expr& expr, bool is_handed_in) {
  const Program& program = symbols_.program;
  const Range of_left = RangeOf(program, rule(), left.node);
  const bool same = Signature(program, rule(), left.node) == Signature(program, rule(), right.node);
  const Verdict verdict = same ? Judge(op, {.low = 0, .high = 0}, {.low = 0, .high = 0})
                               : Judge(op, of_left, RangeOf(program, rule(), right.node));
  // Compared it is in any case: where a side has no value, it is unknown.
  const NodeId node = Add({.op = op, .args = {left.node, right.node, kNone, kNone}});
  if (verdict == Verdict::kPossible || checking_) return {.node = node, .type = Type::kTruth};
  const bool never = verdict == Verdict::kNever;
  const std::string message = std::string("this is ") + (never ? "never" : "always") + " true: ";
  const std::string sides = WhatSidesCanBe(expr, left, right);
  if (same) {
    NoteVacuous(expr.place, message + "both sides are the same", "compare it with something else",
                is_handed_in);
  } else if (sides.empty()) {
    NoteVacuous(expr.place, message + "it compares two numbers",
                WithParams(expr, "compare one of them with a signal"), is_handed_in);
  } else {
    NoteVacuous(expr.place, message + sides,
                WithParams(expr, never ? "choose a bound that can be reached"
                                       : "leave it out, or choose a bound that can be missed; "
                                         "'known ..' asks whether there is a value"),
                is_handed_in);
  }
  return Decided(node, verdict);
}

// What is so whatever happens, for the reason that was noted last.
Lowering::Typed Lowering::Decided(NodeId node, Verdict verdict) const {
  return {.node = node,
          .type = Type::kTruth,
          .verdict = verdict,
          .because = {static_cast<int>(vacuous_parts_.size()) - 1}};
}

Lowering::Typed Lowering::LowerNot(const Expr& expr) {
  const std::size_t noted = vacuous_parts_.size();
  Typed arg = TruthValue(expr.args[0]);
  if (arg.bad) return arg;
  if (expr.text == "known") {
    if (arg.verdict == Verdict::kAlways) {  // it asks whether there is a value
      vacuous_parts_.erase(vacuous_parts_.begin() + static_cast<std::ptrdiff_t>(noted),
                           vacuous_parts_.end());
      arg.verdict = Verdict::kPossible;
    }
    arg.node = Add({.op = Op::kKnown, .args = {arg.node, kNone, kNone, kNone}});
    return arg;
  }
  return {.node = Add({.op = Op::kNot, .args = {arg.node, kNone, kNone, kNone}}),
          .type = Type::kTruth,
          .verdict = Opposite(arg.verdict),
          .because = arg.because};
}

void Lowering::NoteVacuous(Place place, std::string message, std::string hint, bool is_handed_in) {
  if (vacuous_parts_.size() >= kMostVacuous && is_handed_in) return;
  if (vacuous_parts_.size() >= kMostVacuous)
    vacuous_parts_.pop_back();  // an error is reported in any case
  vacuous_parts_.push_back(
      {DiagnosticAt(source_->file, source_->text, place, std::move(message), std::move(hint)),
       is_handed_in});
}

// A whole clause that is decided is an error, unless its numbers were set from outside.
NodeId Lowering::Settled(const Typed& clause) {
  bool sound = !clause.bad;
  for (std::size_t i = 0; !clause.bad && i < vacuous_parts_.size(); ++i) {
    const bool decides = clause.verdict != Verdict::kPossible &&
                         std::ranges::count(clause.because, static_cast<int>(i)) > 0;
    if (decides && !vacuous_parts_[i].is_handed_in) {
      diagnostics_.push_back(std::move(vacuous_parts_[i].diagnostic));
      sound = false;
    } else {
      Warn(std::move(vacuous_parts_[i].diagnostic));
    }
  }
  vacuous_parts_.clear();
  vacuous_ |= clause.verdict != Verdict::kPossible;
  return sound ? clause.node : kNone;
}

// The same helper may be called more than once.
void Lowering::Warn(Diagnostic warning) {
  warning.is_warning = true;
  const auto same = [&](const Diagnostic& other) {
    return other.place.line == warning.place.line && other.place.column == warning.place.column &&
           other.file == warning.file && other.hint == warning.hint;
  };
  if (symbols_.warnings.size() < kMostVacuous && std::ranges::none_of(symbols_.warnings, same))
    symbols_.warnings.push_back(std::move(warning));
}

void Lowering::ComplainOrWarn(Place place, std::string message, std::string hint) {
  if (vacuous_) return;
  Diagnostic diagnostic =
      DiagnosticAt(source_->file, source_->text, place, std::move(message), std::move(hint));
  if (from_outside_) return Warn(std::move(diagnostic));
  diagnostics_.push_back(std::move(diagnostic));
}

// Nothing of what is only a number.
std::string Lowering::WhatSidesCanBe(const Expr& comparison, const Typed& left,
                                     const Typed& right) {
  std::string text;
  const auto add = [&](const Expr& side, const Typed& typed, std::string_view which) {
    if (symbols_.program.nodes[typed.node].op == Op::kNumber) return;
    const std::string name =
        side.kind == Expr::Kind::kCall ? Quoted(side.text) : std::string(which);
    text += (text.empty() ? "" : ", ") + name + " " +
            RangeText(RangeOf(symbols_.program, rule(), typed.node), typed.dimension);
  };
  add(comparison.args[0], left, "the left side");
  add(comparison.args[1], right, "the right side");
  return text;
}

// The values of the parameters in it: where they are set from outside, the text does not show them.
std::string Lowering::WithParams(const Expr& expr, std::string remedy) const {
  std::vector<std::string> names;
  CollectNames(expr, names);
  std::string text;
  for (const std::string& name : names) {
    const Scope::Value* const handed = scope_ == nullptr || !scope_->values.contains(name)
                                           ? nullptr
                                           : &scope_->values.find(name)->second;
    const Expr* const argument = handed == nullptr ? nullptr : handed->expr;
    if (argument != nullptr && argument->kind == Expr::Kind::kQuantity)
      text += Quoted(name) + " is " + QuantityText(argument->quantity) + " here; ";
    const int found = FindParam(name);
    if (found == kNone || handed != nullptr || FindRole(name) != kNone) continue;
    const ProgramParam& param = symbols_.program.params[found];
    text += Quoted(name) + " is " + QuantityText(param.value) +
            (param.overridden ? ", set from outside; " : "; ");
  }
  return text + remedy;
}

// What is wrong with an `and` of which the parts exclude each other, or with an `or` of which one
// always holds. A part that is decided alone is reported already.
std::optional<Diagnostic> Lowering::Contradiction(const Expr& chain,
                                                  const std::vector<Typed>& parts) const {
  if (checking_) return std::nullopt;
  const bool is_and = chain.text == "and";
  const std::string verdict = is_and ? "this is never true" : "this is always true";
  const auto told = [&](const Expr& at, const std::string& which, const Expr& of) {
    return DiagnosticAt(source_->file, source_->text, at.place, verdict + which,
                        WithParams(of, is_and ? "use 'or', or change one of the bounds"
                                              : "use 'and', or change one of the bounds"));
  };
  Bounds bounds(symbols_.program, symbols_.program.rules[rule_], /*denies=*/is_and);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Expr& arg = chain.args[i];
    if (parts[i].verdict == Verdict::kPossible && !bounds.Add(parts[i].node, !is_and))
      return told(arg, " together with what stands before it: " + Dump(arg), arg);
  }
  if (bounds.SomeAlternativeFits()) return std::nullopt;
  return told(chain.args[0], ", for every choice of its alternatives: " + Dump(chain), chain);
}

// One part decides a chain, or all of them do.
Lowering::Typed Lowering::JudgeChain(const Expr& chain, const std::vector<Typed>& parts) {
  const Verdict deciding = chain.text == "and" ? Verdict::kNever : Verdict::kAlways;
  Typed judged;
  bool all = true;
  for (const Typed& part : parts) {
    all &= part.verdict != Verdict::kPossible;
    if (part.verdict != deciding) continue;
    judged.verdict = deciding;
    judged.because.insert(judged.because.end(), part.because.begin(), part.because.end());
  }
  if (judged.verdict != Verdict::kPossible || !all) return judged;
  judged.verdict = Opposite(deciding);
  for (const Typed& part : parts)
    judged.because.insert(judged.because.end(), part.because.begin(), part.because.end());
  return judged;
}

// Long chains become balanced trees, so that walking them never goes deep.
Lowering::Typed Lowering::LowerChain(const Expr& expr) {
  const bool is_and = expr.text == "and";
  std::vector<Typed> parts;
  std::vector<NodeId> nodes;
  bool bad = false;
  std::size_t instants = 0;
  const bool set_before = std::exchange(from_outside_, false);
  for (const Expr& arg : expr.args) {
    parts.push_back(TruthValue(arg));
    bad |= parts.back().bad;
    instants += parts.back().instant;
    nodes.push_back(parts.back().node);
  }
  const bool is_set = std::exchange(from_outside_, from_outside_ || set_before);
  if (bad) return {.bad = true};
  Typed judged = JudgeChain(expr, parts);
  if (std::optional<Diagnostic> told = Contradiction(expr, parts)) {
    if (!is_set) {
      diagnostics_.push_back(std::move(*told));
      return {.bad = true};
    }
    Warn(std::move(*told));
    judged.verdict = is_and ? Verdict::kNever : Verdict::kAlways;
  }
  while (nodes.size() > 1) {
    std::vector<NodeId> halved;
    for (std::size_t i = 0; i + 1 < nodes.size(); i += 2) {
      halved.push_back(
          Add({.op = is_and ? Op::kAnd : Op::kOr, .args = {nodes[i], nodes[i + 1], kNone, kNone}}));
    }
    if (nodes.size() % 2 == 1) halved.push_back(nodes.back());
    nodes = std::move(halved);
  }
  judged.node = nodes[0];
  judged.type = Type::kTruth;
  judged.instant = is_and ? instants > 0 : instants == expr.args.size();
  return judged;
}

}  // namespace prehend::grammar
