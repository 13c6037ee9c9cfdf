// SPDX-License-Identifier: Apache-2.0
// What stood in the grammar for a node: its text with the rule's roles as {0}, {1}, .., its unit
// and its place. Tested by tests/harness/show/explain/explain_test.cc
#include <utility>

#include "grammar/compile/lower.h"

namespace prehend::grammar {
namespace {

using ast::Expr;

constexpr std::size_t kMaxText = 200;  // bytes; a longer one is cut, it would not be read

}  // namespace

// Chains are explained by what they are made of. What is within stands first: the body of a
// definition, not its call.
void Lowering::Note(const Expr& expr, const Typed& typed) {
  const bool is_chain =
      expr.kind == Expr::Kind::kChain || (expr.kind == Expr::Kind::kUnary && expr.text != "-");
  if (is_chain || checking_ || typed.node == kNone) return;
  IdVector<NodeId, NodeNote>& notes = symbols_.program.notes;
  notes.resize(symbols_.program.nodes.size());
  NodeNote& note = notes[typed.node];
  if (!note.text.empty()) return;
  std::string text = TextOf(expr);
  if (text.size() > kMaxText) {
    text.resize(kMaxText);
    text += "..";
  }
  note = {.text = std::move(text),
          .dimension = typed.dimension,
          .file = source_->file,
          .place = expr.place};
}

void Lowering::NoteText(NodeId node, std::string text, Place place) {
  symbols_.program.notes.resize(symbols_.program.nodes.size());
  symbols_.program.notes[node] = {
      .text = std::move(text), .dimension = {}, .file = source_->file, .place = place};
}

std::string Lowering::TextOfName(const Expr& expr) {
  if (scope_ != nullptr) {
    if (const auto value = scope_->values.find(expr.text);
        value != scope_->values.end() && value->second.expr != nullptr) {
      const Scope* const inner = std::exchange(scope_, value->second.scope);
      std::string text = Bracketed(*value->second.expr);
      scope_ = inner;
      return text;
    }
  }
  if (const int role = FindRole(expr.text); role != kNone) return "{" + std::to_string(role) + "}";
  return expr.args.empty() ? expr.text : expr.text + " " + expr.args[0].text;
}

std::string Lowering::Bracketed(const Expr& expr) {
  const bool needs = expr.kind == Expr::Kind::kBinary || expr.kind == Expr::Kind::kChain ||
                     expr.kind == Expr::Kind::kEdge;
  return needs ? "(" + TextOf(expr) + ")" : TextOf(expr);
}

std::string Lowering::TextOf(const Expr& expr) {
  const auto joined = [&](const std::string& separator, bool bracket) {
    std::string text;
    for (const Expr& arg : expr.args) {
      if (text.size() > kMaxText) break;
      text += (text.empty() ? "" : separator) + (bracket ? Bracketed(arg) : TextOf(arg));
    }
    return text;
  };
  switch (expr.kind) {
    case Expr::Kind::kQuantity:
      return QuantityText(expr.quantity);
    case Expr::Kind::kName:
      return TextOfName(expr);
    case Expr::Kind::kText:
      return '"' + expr.text + '"';
    case Expr::Kind::kCall:
      if (expr.text == ast::kAtLeast) return expr.text + " " + joined(" of ", false);
      return expr.text + "(" + joined(", ", false) + ")";
    case Expr::Kind::kUnary:
      return expr.text + (expr.text == "-" ? "" : " ") + Bracketed(expr.args[0]);
    case Expr::Kind::kBinary: {
      const bool is_comparison =
          std::string_view("<>=!").find(expr.text[0]) != std::string_view::npos;
      return joined(" " + expr.text + " ", !is_comparison);  // arithmetic binds tighter
    }
    case Expr::Kind::kChain:
      return joined(" " + expr.text + " ", true);
    case Expr::Kind::kEdge: {
      const bool is_chain = expr.args[0].kind == Expr::Kind::kChain;
      return (is_chain ? Bracketed(expr.args[0]) : TextOf(expr.args[0])) + " " + expr.text;
    }
    case Expr::Kind::kAnchor:
      return Bracketed(expr.args[0]) + "@" + expr.text;
  }
  return {};
}

}  // namespace prehend::grammar
