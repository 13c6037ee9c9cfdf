// SPDX-License-Identifier: Apache-2.0
// Writes parts of a syntax tree as text again, for messages.
#include "grammar/language/ast.h"

namespace prehend::grammar::ast {
namespace {

std::string Joined(const std::vector<Expr>& args, const std::string& separator) {
  std::string text;
  for (const Expr& arg : args) text += (text.empty() ? "" : separator) + Dump(arg);
  return text;
}

}  // namespace

std::string Dump(const Expr& expr) {
  switch (expr.kind) {
    case Expr::Kind::kQuantity:
      return QuantityText(expr.quantity);
    case Expr::Kind::kName:
      return expr.text + (expr.args.empty() ? "" : " " + Dump(expr.args[0]));
    case Expr::Kind::kText:
      return '"' + expr.text + '"';
    case Expr::Kind::kCall:
      return expr.text + "(" + Joined(expr.args, ", ") + ")";
    case Expr::Kind::kUnary:
      return "(" + expr.text + (expr.text == "-" ? "" : " ") + Dump(expr.args[0]) + ")";
    case Expr::Kind::kBinary:
    case Expr::Kind::kChain:
      return "(" + Joined(expr.args, " " + expr.text + " ") + ")";
    case Expr::Kind::kEdge:
      return "(" + Dump(expr.args[0]) + " " + expr.text + ")";
    case Expr::Kind::kAnchor:
      return Dump(expr.args[0]) + "@" + expr.text;
  }
  return {};
}

std::string Dump(const Law& law) {
  const std::string subjects = Joined(law.subjects, ", ");
  switch (law.form) {
    case Law::Form::kCovered:
      return "rest of " + subjects + " outside " + Joined(law.others, ", ") + " is empty";
    case Law::Form::kApart:
      return subjects + " do not overlap";
    case Law::Form::kRelated:
      break;
  }
  std::string relations;
  for (const std::string& name : law.relations) relations += (relations.empty() ? "" : "|") + name;
  return subjects + " " + relations + " " + Joined(law.others, " or ");
}

}  // namespace prehend::grammar::ast
