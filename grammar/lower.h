// SPDX-License-Identifier: Apache-2.0
// Expressions of one rule: looks names up, checks types and units, and appends nodes to the program.
// Needs the heads of all rules, so that rules may refer to later ones.
// Tested by tests/grammar/compile_test.cc
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/ast.h"
#include "grammar/builtins.h"
#include "grammar/program.h"

namespace prehend::grammar {

/// What all rules share while a grammar is compiled.
struct Symbols {
  Program& program;
  std::map<std::string, int, std::less<>> rules;   ///< name -> index in Program::events
  std::map<std::string, int, std::less<>> params;  ///< name -> index in Program::params
  std::map<std::pair<int, std::vector<int>>, int> any_rules;  ///< (rule, kept roles) -> rule
};

/// True if some entity can be of both classes. Names other than the built-in ones are taken to be Things.
bool ClassesMeet(std::string_view a, std::string_view b);

class Lowering {
 public:
  /// Writes into symbols.program.events[rule], whose roles are filled in already.
  Lowering(Symbols& symbols, int rule, const GrammarText& source, Diagnostics& diagnostics);

  /// Where values of the interval's own boundaries can be asked for.
  struct Anchors {
    bool begin = false;
    bool end = false;
  };

  /// A truth value; kNone after an error, here and below.
  int Truth(const ast::Expr& expr, Anchors anchors);
  /// A truth value that holds at single frames only: made of `begins` and `ends`.
  int Instant(const ast::Expr& expr, Anchors anchors);
  /// A call of an event or condition, as a reference of the rule.
  int RuleCall(const ast::Expr& expr);
  /// A number; its dimension is written to `dimension`.
  int Signal(const ast::Expr& expr, Anchors anchors, Dimension& dimension);
  /// A number that only depends on parameters, zero or more.
  double Constant(const ast::Expr& expr, const Dimension& dimension, std::string_view what);
  int HandRole(const ast::Expr& expr);

  bool RoleUsed(std::size_t role) const { return role_used_[role]; }
  void Complain(Place place, std::string message, std::string hint = {});

 private:
  struct Typed {
    int node = kNone;
    Type type = Type::kTruth;
    Dimension dimension;
    bool instant = false;
    bool bad = false;
  };
  Rule& rule() { return symbols_.program.events[rule_]; }

  Typed Lower(const ast::Expr& expr);
  Typed LowerName(const ast::Expr& expr);
  Typed LowerUnary(const ast::Expr& expr);
  Typed LowerBinary(const ast::Expr& expr);
  Typed LowerChain(const ast::Expr& expr);
  Typed LowerEdge(const ast::Expr& expr);
  Typed LowerAnchor(const ast::Expr& expr);
  Typed LowerCall(const ast::Expr& expr);
  Typed LowerBuiltin(const Builtin& builtin, const ast::Expr& expr);
  Typed LowerOverInterval(const ast::Expr& expr);
  Typed LowerIs(const ast::Expr& expr);
  bool LowerArgument(const ast::Expr& arg, Argument wanted, const Builtin& builtin, Node& node, int& next_node,
                     int& next_role, Typed& result);

  std::optional<double> ConstantOf(const ast::Expr& expr, const Dimension& dimension, std::string_view what);
  Typed Bad(Place place, std::string message, std::string hint = {});
  Typed Number(const ast::Expr& expr);
  Typed Position(const ast::Expr& expr);
  Typed TruthValue(const ast::Expr& expr);
  int Add(Node node);
  int AddReference(const Reference& reference);
  int AnchorAtBegin(int node);
  int FindRole(std::string_view name) const;
  std::optional<int> RoleArgument(const ast::Expr& expr, std::string_view wanted_class, std::string_view callee);
  int AnyRule(int rule, const std::vector<int>& kept);
  int UnknownName(const ast::Expr& expr);
  std::vector<std::string> KnownNames(bool calls) const;

  Symbols& symbols_;
  int rule_;
  const GrammarText& source_;
  Diagnostics& diagnostics_;
  Anchors anchors_;
  std::vector<bool> role_used_;
};

}  // namespace prehend::grammar
