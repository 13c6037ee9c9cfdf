// SPDX-License-Identifier: Apache-2.0
// Expressions of one rule: looks names up, checks types and units, and appends nodes to the
// program. Needs the heads of all rules, so that rules may refer to later ones. Tested by
// tests/grammar/compile/compile_test.cc
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "grammar/analysis/contradictions.h"
#include "grammar/analysis/value_ranges.h"
#include "grammar/base/source.h"
#include "grammar/language/ast.h"
#include "grammar/language/token_reader.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

/// A `define`, with the file it stands in.
struct DefineSource {
  const GrammarText* text = nullptr;
  const ast::Define* define = nullptr;
};

/// What all rules share while a grammar is compiled.
struct Symbols {
  Program& program;
  std::map<std::string, RuleId, std::less<>> rules;  ///< by name
  std::map<std::string, int, std::less<>> params;    ///< name -> index in Program::params
  std::map<std::string, int, std::less<>>
      files;  ///< name -> place in the order in which they were read, what is used first
  std::map<std::string, DefineSource, std::less<>> defines;
  std::map<std::tuple<RuleId, std::vector<int>, int>, RuleId>
      any_rules;  ///< (rule, kept roles, how many bindings) -> rule
  std::map<std::pair<RuleId, std::vector<std::string>>, RuleId>
      narrowed_rules;          ///< (rule, classes of its roles) -> rule
  std::set<RuleId> otherwise;  ///< rules of that form
  std::set<int> used_params;
  std::set<std::string, std::less<>> used_defines;
  Diagnostics warnings = {};
  /// Names of what is wrong itself: that they are unknown is no further mistake.
  std::set<std::string, std::less<>> broken = {};
  bool is_incomplete = false;                                     ///< so may every unknown name be
  std::function<std::string(std::string_view)> who_defines = {};  ///< a grammar to `use`, or ""

  /// That a name is unknown is no mistake; a head without its '(' is broken as one longer name.
  bool IsExcused(std::string_view name) const {
    return is_incomplete || std::ranges::any_of(broken, [&](const std::string& wrong) {
             return wrong.find(name) != std::string::npos;
           });
  }
  /// What to say of a name that nobody knows, once; no message: nothing.
  Diagnostic Unknown(std::string_view what, std::string_view name, std::string hint);
  /// What to say of a role whose class does not fit; nothing, if one of the two classes is not
  /// built in, perhaps misspelt, and it was told of it before.
  std::string NotOfClass(std::string_view callee, std::string_view wanted, std::string_view role,
                         std::string_view class_name);
  /// A parameter of this file or of one that it uses; another file's may be called like something
  /// of its own.
  bool IsParamIn(std::string_view file, std::string_view name) const;
};

/// Remembers a name that stands at a place of a file, once per name and file; which of the names it
/// is.
int NoteName(std::vector<NameInSource>& names, std::string_view name, const std::string& file,
             Place place);

/// Likewise, a class that stands there, unless it is built in.
void NoteClass(Program& program, std::string_view name, const std::string& file, Place place);

inline bool StartsWithCapital(std::string_view name) {
  return !name.empty() && name[0] >= 'A' && name[0] <= 'Z';
}

/// Whether it is a signal that is measured over an interval.
bool IsOverInterval(std::string_view name);

inline std::string Quoted(std::string_view text) { return "'" + std::string(text) + "'"; }
/// "before, meets, ..": all thirteen.
std::string AllenNames();

class Lowering {
 public:
  /// Writes into symbols.program.rules[rule], whose roles are filled in already.
  Lowering(Symbols& symbols, RuleId rule, const GrammarText& source, Diagnostics& diagnostics);

  /// Where values of the interval's own boundaries can be asked for.
  struct Anchors {
    bool begin = false;
    bool end = false;
  };

  /// A truth value; kNone after an error, here and below.
  NodeId Truth(const ast::Expr& expr, Anchors anchors);
  /// A truth value that holds at single frames only: made of `begins` and `ends`.
  NodeId Instant(const ast::Expr& expr, Anchors anchors);
  /// A call of an event or condition, as a reference of the rule.
  int RuleCall(const ast::Expr& expr);
  /// A number; its dimension is written to `dimension`.
  NodeId Signal(const ast::Expr& expr, Anchors anchors, Dimension& dimension);
  /// A number to be asked for where the interval ends: signals as they were at its begin, `x@end`
  /// as they are.
  NodeId Attribute(const ast::Expr& expr, Dimension& dimension);
  /// A number that only depends on parameters, zero or more.
  double Constant(const ast::Expr& expr, const Dimension& dimension, std::string_view what);
  /// How many, of `at least`: a whole number.
  int Count(const ast::Expr& expr);
  /// A constant time of more than 0 s.
  double Span(const ast::Expr& expr, std::string_view what);
  int HandRole(const ast::Expr& expr);
  /// `while F until G@begin`, before it is bridged: what has ended has another begin afterwards, so
  /// it becomes a hidden rule, whose gaps are bridged.
  void HideIfAnchored();
  /// Makes what the rule, a `while`, says so far the candidates of `one .. per`.
  void LowerOnePer(const ast::OnePer& one_per);
  /// The body of a definition for itself: only for its mistakes.
  void Check(const DefineSource& define);

  bool IsOtherwise(RuleId rule) const { return symbols_.otherwise.contains(rule); }
  bool RoleUsed(std::size_t role) const { return role_used_[role]; }
  void Complain(Place place, std::string message, std::string hint = {});
  /// Likewise; only a warning, if a parameter was set from outside. Nothing where a condition is
  /// never or always true: that is reported already.
  void ComplainOrWarn(Place place, std::string message, std::string hint = {});
  /// How many there were so far.
  std::size_t complaints() const { return diagnostics_.size(); }

 private:
  struct Typed {
    NodeId node;
    Type type = Type::kTruth;
    Dimension dimension;
    bool instant = false;
    bool bad = false;
    Verdict verdict = Verdict::kPossible;  ///< of a truth value
    std::vector<int> because = {};         ///< the vacuous parts that decide it
  };
  /// A condition that is never or always true: a mistake, if its whole clause is and nobody else
  /// gave it its numbers.
  struct VacuousPart {
    Diagnostic diagnostic;
    bool is_handed_in = false;
  };
  /// What the names of a definition's parameters stand for while its body is lowered.
  struct Scope {
    struct Value {
      const ast::Expr* expr = nullptr;  ///< the argument, and where it was written
      const GrammarText* source = nullptr;
      const Scope* scope = nullptr;
      Typed placeholder = {};  ///< without an argument
    };
    std::string_view define;
    const Scope* outer = nullptr;
    int depth = 1;
    std::map<std::string, int, std::less<>> roles = {};
    std::map<std::string, Value, std::less<>> values = {};
  };
  Rule& rule() { return symbols_.program.rules[rule_]; }

  Typed Lower(const ast::Expr& expr);
  Typed LowerKind(const ast::Expr& expr);
  void Note(const ast::Expr& expr, const Typed& typed);
  void NoteText(NodeId node, std::string text, Place place);
  NodeId HideSoFar();
  std::vector<int> SharingRoles(const ast::OnePer& one_per, int one);
  std::string TextOf(const ast::Expr& expr);
  std::string Bracketed(const ast::Expr& expr);
  std::string TextOfName(const ast::Expr& expr);
  Typed LowerName(const ast::Expr& expr);
  Typed LowerUnary(const ast::Expr& expr);
  Typed LowerBinary(const ast::Expr& expr);
  Typed LowerArithmetic(Op op, const Typed& left, const Typed& right, const ast::Expr& expr);
  Typed LowerComparison(Op op, const Typed& left, const Typed& right, const ast::Expr& expr,
                        bool is_handed_in);
  Typed LowerNot(const ast::Expr& expr);
  Typed LowerChain(const ast::Expr& expr);
  std::string WhatSidesCanBe(const ast::Expr& comparison, const Typed& left, const Typed& right);
  std::string WithParams(const ast::Expr& expr, std::string remedy) const;
  Typed JudgeChain(const ast::Expr& chain, const std::vector<Typed>& parts);
  std::optional<Diagnostic> Contradiction(const ast::Expr& chain,
                                          const std::vector<Typed>& parts) const;
  Typed Decided(NodeId node, Verdict verdict) const;
  void NoteVacuous(Place place, std::string message, std::string hint, bool is_handed_in);
  NodeId Settled(const Typed& clause);
  void Warn(Diagnostic warning);
  Typed LowerEdge(const ast::Expr& expr);
  Typed LowerAnchor(const ast::Expr& expr);
  Typed LowerCall(const ast::Expr& expr);
  Typed LowerRuleCall(RuleId rule, const ast::Expr& expr, int at_least = 1);
  Typed LowerAtLeast(const ast::Expr& expr);
  Typed LowerDefine(const DefineSource& source, const ast::Expr& expr);
  Typed LowerBody(const DefineSource& source, const Scope& scope);
  Typed LowerValue(const Scope::Value& value);
  bool BindParameter(const DefineSource& source, std::size_t index, const ast::Expr& arg,
                     Scope& scope);
  Typed LowerBuiltin(const Operator& builtin, const ast::Expr& expr);
  Typed LowerOverInterval(const ast::Expr& expr);
  Typed LowerIs(const ast::Expr& expr);
  Typed TwiceTheSame(const ast::Expr& role, std::string_view callee);
  bool LiesOnItself(const Node& node);
  int SeenFrom(NodeId position);
  std::string WhyNotComparable(const Node& node);
  bool LowerArgument(const ast::Expr& arg, Argument wanted, const Operator& builtin, Node& node,
                     int& next_node, int& next_role, Typed& result);
  static int AxisNamed(const ast::Expr& expr);
  bool LowerSet(const ast::Expr& arg, Node& node);

  std::optional<double> ConstantOf(const ast::Expr& expr, const Dimension& dimension,
                                   std::string_view what);
  Typed Bad(Place place, std::string message, std::string hint = {});
  Typed Number(const ast::Expr& expr);
  Typed Position(const ast::Expr& expr);
  Typed TruthValue(const ast::Expr& expr);
  Typed NumberNode(double value, const Dimension& dimension, Place place);
  NodeId Add(Node node);
  NodeId AddSignal(Node node);
  int AddReference(const Reference& reference);
  NodeId AnchorAtBegin(NodeId node);
  int TouchOf(const Node& node);
  NodeId AtOneMoment(const OverInterval::Part& part, std::array<int, 2> roles);
  int FindRole(std::string_view name) const;
  int FindParam(std::string_view name) const;
  std::optional<int> RoleArgument(const ast::Expr& expr, std::string_view wanted_class,
                                  std::string_view callee);
  RuleId MakeAnyRule(RuleId rule, const std::vector<int>& kept, int at_least);
  RuleId MakeNarrowedRule(RuleId rule, const std::vector<std::string>& classes);
  std::vector<std::string> KnownNames(bool calls) const;

  Symbols& symbols_;
  RuleId rule_;
  const GrammarText* source_;
  Diagnostics& diagnostics_;
  Anchors anchors_;
  bool attribute_ = false;     ///< signals are taken where the interval begins
  bool full_ = false;          ///< the grammar has too many expressions
  bool checking_ = false;      ///< numbers of parameters are placeholders
  bool too_deep_ = false;      ///< definitions, which is told once: each might double what to read
  bool from_outside_ = false;  ///< a parameter that was set from outside has been met
  bool handed_in_ = false;     ///< likewise, or a number that a definition was called with
  bool vacuous_ = false;       ///< a clause of the rule is never or always true
  std::vector<VacuousPart> vacuous_parts_;
  const Scope* scope_ = nullptr;
  std::vector<bool> role_used_;
  std::set<std::string, std::less<>> unknown_roles_;  ///< each is told once
};

/// One definition, its form and modifiers: fills in program.rules[index], whose head is there
/// already. Mistakes go to the diagnostics of `lowering`.
void LowerDefinitionInto(Program& program, RuleId index, const ast::Definition& definition,
                         Lowering& lowering);

/// Likewise, the parts and relations of a composition.
void LowerComposition(Program& program, RuleId index, const ast::Definition& definition,
                      Lowering& lowering);

/// One law, looked up and checked; needs the heads of all rules. Nothing after an error, which is
/// appended to `diagnostics`. Tested by tests/grammar/errors.txt and
/// tests/grammar/check_laws_test.cc
std::optional<Law> LowerLaw(Symbols& symbols, const GrammarText& source, const ast::Law& law,
                            Diagnostics& diagnostics);

}  // namespace prehend::grammar
