// SPDX-License-Identifier: Apache-2.0
// Names, literals and arithmetic. Calls are in grammar/compile/lower_calls.cc, conditions in
// grammar/compile/lower_conditions.cc. Errors: unknown names, one type where another is needed,
// units that do not agree, '@begin' and '@end' at wrong places, division by zero.
#include "grammar/compile/lower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace prehend::grammar {
namespace {

using ast::Expr;

constexpr std::size_t kMaxNodes = 10000;
constexpr double kLongest_s = 86400;  // more is a slip of the finger

std::string_view TypeText(Type type) {
  return type == Type::kTruth ? "true or false" : type == Type::kNumber ? "a number" : "a position";
}

}  // namespace

std::string AllenNames() {
  std::string text;
  for (const std::string_view name : kAllenNames)
    text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

int NoteName(std::vector<NameInSource>& names, std::string_view name, const std::string& file,
             Place place) {
  const auto same = [&](const NameInSource& named) {
    return named.name == name && named.file == file;
  };
  const auto found = std::ranges::find_if(names, same);
  const auto index = static_cast<int>(found - names.begin());
  if (found == names.end()) names.push_back({std::string(name), file, place});
  return index;
}

void NoteClass(Program& program, std::string_view name, const std::string& file, Place place) {
  if (!IsBuiltinClass(name)) NoteName(program.named_classes, name, file, place);
}

bool IsOverInterval(std::string_view name) {
  return std::ranges::count(SignalsOverIntervals(), name, &OverInterval::name) > 0;
}

Diagnostic Symbols::Unknown(std::string_view what, std::string_view name, std::string hint) {
  if (IsExcused(name)) return {};
  broken.emplace(name);
  const std::string owner = who_defines ? who_defines(name) : "";
  if (const std::string_view habit = HabitHint(name); !habit.empty()) hint = habit;
  if (!owner.empty()) hint = "it is in a grammar of the library: use " + owner;
  return {.message = "unknown " + std::string(what) + " " + Quoted(name), .hint = std::move(hint)};
}

std::string Symbols::NotOfClass(std::string_view callee, std::string_view wanted,
                                std::string_view role, std::string_view class_name) {
  for (const std::string_view name : {class_name, wanted})
    if (!IsBuiltinClass(name) && !broken.emplace(name).second) return {};
  return Quoted(callee) + " takes " + WithArticle(wanted) + " here, but " + Quoted(role) + " is " +
         WithArticle(class_name);
}

bool Symbols::IsParamIn(std::string_view file, std::string_view name) const {
  const auto param = params.find(name);
  if (param == params.end()) return false;
  return files.find(program.params[param->second].file)->second <= files.find(file)->second;
}

Lowering::Lowering(Symbols& symbols, RuleId rule, const GrammarText& source,
                   Diagnostics& diagnostics)
    : symbols_(symbols),
      rule_(rule),
      source_(&source),
      diagnostics_(diagnostics),
      role_used_(symbols.program.rules[rule].roles.size()) {}

void Lowering::Complain(Place place, std::string message, std::string hint) {
  if (diagnostics_.size() >= kMostDiagnostics) return;
  diagnostics_.push_back(
      DiagnosticAt(source_->file, source_->text, place, std::move(message), std::move(hint)));
}

Lowering::Typed Lowering::Bad(Place place, std::string message, std::string hint) {
  Complain(place, std::move(message), std::move(hint));
  return {.bad = true};
}

NodeId Lowering::Truth(const Expr& expr, Anchors anchors) {
  anchors_ = anchors;
  return Settled(TruthValue(expr));
}

NodeId Lowering::Instant(const Expr& expr, Anchors anchors) {
  anchors_ = anchors;
  const Typed typed = TruthValue(expr);
  const NodeId node = Settled(typed);
  if (node == kNone || typed.instant) return node;
  Complain(expr.place, "this holds for a while, but a moment is needed here",
           "add 'begins' or 'ends': X begins");
  return kNone;
}

int Lowering::RuleCall(const Expr& expr) {
  if (expr.kind != Expr::Kind::kCall || (FindBuiltin(expr.text) && expr.text != "touching")) {
    Complain(expr.place, "an event or condition with its roles is needed here",
             "for example: grasping(hand, object)");
    return kNone;
  }
  const Typed typed = Lower(expr);
  if (typed.bad) return kNone;
  const Node& node = symbols_.program.nodes[typed.node];
  if (node.op == Op::kHolds) return node.slot;
  Complain(expr.place, "an event or condition is needed here, " + Quoted(expr.text) + " is none",
           "define it as a condition: condition near(..) while ..");
  return kNone;
}

NodeId Lowering::Signal(const Expr& expr, Anchors anchors, Dimension& dimension) {
  anchors_ = anchors;
  const Typed typed = Number(expr);
  dimension = typed.dimension;
  return typed.bad ? kNone : typed.node;
}

NodeId Lowering::Attribute(const Expr& expr, Dimension& dimension) {
  attribute_ = true;
  const NodeId node = Signal(expr, {.begin = true, .end = true}, dimension);
  attribute_ = false;
  return node;
}

double Lowering::Constant(const Expr& expr, const Dimension& dimension, std::string_view what) {
  anchors_ = {};
  return ConstantOf(expr, dimension, what).value_or(0);
}

int Lowering::Count(const Expr& expr) {
  constexpr int kMost = 1'000'000;
  anchors_ = {};
  const std::optional<double> count = ConstantOf(expr, kPlain, "'at least'");
  if (!count) return 1;
  if (*count >= 1 && *count <= kMost && *count == std::floor(*count))
    return static_cast<int>(*count);
  Complain(expr.place, "'at least' takes a whole number from 1 to " + std::to_string(kMost),
           "for example: at least 3");
  return 1;
}

double Lowering::Span(const Expr& expr, std::string_view what) {
  anchors_ = {};
  const std::optional<double> seconds = ConstantOf(expr, kSeconds, what);
  if (seconds == 0) Complain(expr.place, std::string(what) + " must be longer than 0 s");
  return seconds.value_or(0);
}

std::optional<double> Lowering::ConstantOf(const Expr& expr, const Dimension& dimension,
                                           std::string_view what) {
  const Typed typed = Number(expr);
  if (typed.bad) return std::nullopt;
  const Node& node = symbols_.program.nodes[typed.node];
  if (node.op != Op::kNumber) {
    Complain(expr.place, std::string(what) + " must be a number or a parameter");
  } else if (!(typed.dimension == dimension)) {
    Complain(expr.place,
             std::string(what) + (dimension == kPlain ? " is " : " is in ") +
                 DimensionText(dimension) + ", this is " + DimensionText(typed.dimension),
             typed.dimension == kPlain && dimension == kSeconds ? "for example: 200 ms" : "");
  } else if (node.number < 0) {
    Complain(expr.place, std::string(what) + " cannot be negative");
  } else if (dimension == kSeconds && node.number > kLongest_s) {
    Complain(expr.place, std::string(what) + " is longer than a day", "a day has 86400 s");
  } else {
    return node.number;
  }
  return std::nullopt;
}

int Lowering::HandRole(const Expr& expr) {
  return RoleArgument(expr, "Hand", "style").value_or(kNone);
}

NodeId Lowering::Add(Node node) {
  IdVector<NodeId, Node>& nodes = symbols_.program.nodes;
  if (nodes.size() < kMaxNodes) return nodes.push_back(node);
  if (!full_) {
    full_ = true;
    Complain(rule().place,
             "the grammar has more than " + std::to_string(kMaxNodes) + " expressions");
  }
  return NodeId(nodes.size() - 1);
}

// A value observed of an entity; an attribute takes it where the interval begins.
NodeId Lowering::AddSignal(Node node) {
  const NodeId here = Add(node);
  const bool observes = node.roles[0] != kNone || RowOf(node.op).IsOverWindow();
  return attribute_ && observes ? AnchorAtBegin(here) : here;
}

Lowering::Typed Lowering::NumberNode(double value, const Dimension& dimension, Place place) {
  if (!std::isfinite(value))
    return Bad(place, "this number is not finite", "is something divided by zero?");
  return {.node = Add({.op = Op::kNumber, .number = value}),
          .type = Type::kNumber,
          .dimension = dimension};
}

int Lowering::AddReference(const Reference& reference) {
  std::vector<Reference>& all = rule().references;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].rule == reference.rule && all[i].roles == reference.roles)
      return static_cast<int>(i);
  }
  all.push_back(reference);
  return static_cast<int>(all.size()) - 1;
}

NodeId Lowering::AnchorAtBegin(NodeId node) {
  rule().anchors.push_back(node);
  return Add({.op = Op::kAtBegin, .slot = static_cast<int>(rule().anchors.size()) - 1});
}

int Lowering::FindRole(std::string_view name) const {
  if (scope_ != nullptr) {
    const auto found = scope_->roles.find(name);
    return found == scope_->roles.end() ? kNone : found->second;
  }
  const std::vector<RuleRole>& roles = symbols_.program.rules[rule_].roles;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i].name == name) return static_cast<int>(i);
  }
  return kNone;
}

int Lowering::FindParam(std::string_view name) const {
  const auto found = symbols_.params.find(name);
  return found == symbols_.params.end() ? kNone : found->second;
}

std::vector<std::string> Lowering::KnownNames(bool calls) const {
  std::vector<std::string> names;
  if (calls) {
    for (const auto& [name, rule] : symbols_.rules) names.push_back(name);
    for (const auto& [name, define] : symbols_.defines) names.push_back(name);
    for (const Operator& builtin : Operators()) names.emplace_back(builtin.name);
    for (const OverInterval& signal : SignalsOverIntervals()) names.emplace_back(signal.name);
    names.insert(names.end(), {"is", "not", "known"});
  } else {
    names = {"any", "drop"};
    for (const auto& [name, param] : symbols_.params) names.push_back(name);
    for (const auto& [name, define] : symbols_.defines) names.push_back(name);
    if (scope_ != nullptr) {
      for (const auto& [name, role] : scope_->roles) names.push_back(name);
      for (const auto& [name, value] : scope_->values) names.push_back(name);
    } else {
      for (const RuleRole& role : symbols_.program.rules[rule_].roles) names.push_back(role.name);
    }
  }
  return names;
}

Lowering::Typed Lowering::Lower(const Expr& expr) {
  if (full_) return {.bad = true};
  const Typed typed = LowerKind(expr);
  if (!typed.bad) Note(expr, typed);
  return typed;
}

Lowering::Typed Lowering::LowerKind(const Expr& expr) {
  switch (expr.kind) {
    case Expr::Kind::kQuantity:
      return NumberNode(expr.quantity.value, expr.quantity.dimension, expr.place);
    case Expr::Kind::kName:
      return LowerName(expr);
    case Expr::Kind::kText:
      return Bad(expr.place, "a value is needed here, not a text");
    case Expr::Kind::kCall:
      return LowerCall(expr);
    case Expr::Kind::kUnary:
      return LowerUnary(expr);
    case Expr::Kind::kBinary:
      return LowerBinary(expr);
    case Expr::Kind::kChain:
      return LowerChain(expr);
    case Expr::Kind::kEdge:
      return LowerEdge(expr);
    case Expr::Kind::kAnchor:
      return LowerAnchor(expr);
  }
  return {.bad = true};
}

Lowering::Typed Lowering::TruthValue(const Expr& expr) {
  const Typed typed = Lower(expr);
  if (typed.bad || typed.type == Type::kTruth) return typed;
  return Bad(
      expr.place, "a condition is needed here, this is " + std::string(TypeText(typed.type)),
      typed.type == Type::kNumber ? "compare it with something: speed(object) > 2 cm/s" : "");
}

Lowering::Typed Lowering::Number(const Expr& expr) {
  const Typed typed = Lower(expr);
  if (typed.bad || typed.type == Type::kNumber) return typed;
  return Bad(expr.place, "a number is needed here, this is " + std::string(TypeText(typed.type)),
             std::string(HabitHint(typed.type == Type::kTruth ? "true" : "position")));
}

Lowering::Typed Lowering::Position(const Expr& expr) {
  // The name of a role stands for the position of the entity that plays it.
  if (expr.kind == Expr::Kind::kName) {
    if (const int role = FindRole(expr.text); role != kNone) {
      role_used_[role] = true;
      return {.node = AddSignal({.op = Op::kPosition, .roles = {role, kNone}}),
              .type = Type::kPosition,
              .dimension = kMetres};
    }
  }
  const Typed typed = Lower(expr);
  if (typed.bad || typed.type == Type::kPosition) return typed;
  return Bad(expr.place, "a position is needed here, this is " + std::string(TypeText(typed.type)),
             "for example: position(object)");
}

Lowering::Typed Lowering::LowerName(const Expr& expr) {
  if (scope_ != nullptr) {
    if (const auto value = scope_->values.find(expr.text); value != scope_->values.end()) {
      handed_in_ = true;
      return LowerValue(value->second);
    }
  }
  if (FindRole(expr.text) != kNone) {
    return Bad(expr.place, Quoted(expr.text) + " is a role; a value is needed here",
               "ask for one of its signals: position(" + expr.text + ")");
  }
  if (const int param = FindParam(expr.text); param != kNone) {
    symbols_.used_params.insert(param);
    const Quantity& value = symbols_.program.params[param].value;
    const bool is_set = symbols_.program.params[param].overridden;
    from_outside_ |= is_set;
    handed_in_ |= is_set;
    return NumberNode(value.value, value.dimension, expr.place);
  }
  if (const auto define = symbols_.defines.find(expr.text); define != symbols_.defines.end()) {
    return LowerDefine(define->second, expr);
  }
  const WhileRule* const repeat = rule().If<WhileRule>();
  if (expr.text == "count" && repeat != nullptr && repeat->at_least > 0) {
    if (anchors_.begin && anchors_.end)
      return {.node = Add({.op = Op::kCount, .number = 1.0 * repeat->at_least}),
              .type = Type::kNumber};
    return Bad(expr.place, "how often something was repeated is known where it ends",
               "'count' can be used after 'requires' and 'with'");
  }
  if (expr.text == "any") {
    return Bad(expr.place, "'any' stands only for a role of an event or condition",
               "for example: supported_by(object, any)");
  }
  if (unknown_roles_.contains(expr.text)) return Bad(expr.place, "");
  const bool is_call = FindBuiltin(expr.text) != nullptr || symbols_.rules.contains(expr.text);
  const Diagnostic unknown = symbols_.Unknown("name", expr.text,
                                              is_call ? "name the entity: " + expr.text + "(object)"
                                                      : DidYouMean(expr.text, KnownNames(false)));
  return Bad(expr.place, unknown.message, unknown.hint);
}

Lowering::Typed Lowering::LowerUnary(const Expr& expr) {
  if (expr.text != "-") return LowerNot(expr);
  Typed arg = Number(expr.args[0]);
  if (arg.bad) return arg;
  const Node node = symbols_.program.nodes[arg.node];
  if (node.op == Op::kNumber) return NumberNode(-node.number, arg.dimension, expr.place);
  arg.node = Add({.op = Op::kNegate, .args = {arg.node, kNone, kNone, kNone}});
  return arg;
}

Lowering::Typed Lowering::LowerBinary(const Expr& expr) {
  static constexpr std::array<std::pair<std::string_view, Op>, 10> kOps = {
      {{"+", Op::kAdd},
       {"-", Op::kSubtract},
       {"*", Op::kMultiply},
       {"/", Op::kDivide},
       {"<", Op::kLess},
       {"<=", Op::kLessEqual},
       {">", Op::kGreater},
       {">=", Op::kGreaterEqual},
       {"==", Op::kEqual},
       {"!=", Op::kNotEqual}}};
  const Op op = std::find_if(kOps.begin(), kOps.end(), [&](const auto& entry) {
                  return entry.first == expr.text;
                })->second;
  const bool handed_in_before = std::exchange(handed_in_, false);
  const Typed left = Number(expr.args[0]);
  const Typed right = Number(expr.args[1]);
  const bool is_handed_in = std::exchange(handed_in_, handed_in_ || handed_in_before);
  if (left.bad || right.bad) return {.bad = true};
  const bool scales = op == Op::kMultiply || op == Op::kDivide;
  if (!scales && !(left.dimension == right.dimension)) {
    const bool sum = op == Op::kAdd || op == Op::kSubtract;
    return Bad(expr.place,
               std::string(sum ? "cannot combine " : "cannot compare ") +
                   DimensionText(left.dimension) + " with " + DimensionText(right.dimension),
               right.dimension == kPlain ? "the right side needs a unit"
                                         : "both sides must have the same unit");
  }
  if (IsComparison(op)) return LowerComparison(op, left, right, expr, is_handed_in);
  return LowerArithmetic(op, left, right, expr);
}

// What only depends on parameters is one number, so that it can stand where a constant must.
Lowering::Typed Lowering::LowerArithmetic(Op op, const Typed& left, const Typed& right,
                                          const Expr& expr) {
  Dimension dimension = left.dimension;
  if (op == Op::kMultiply) dimension = Product(left.dimension, right.dimension);
  if (op == Op::kDivide) dimension = Quotient(left.dimension, right.dimension);
  if (!dimension.IsModest()) return Bad(expr.place, "a unit to such a power means nothing");
  const Node a = symbols_.program.nodes[left.node];
  const Node b = symbols_.program.nodes[right.node];
  if (op == Op::kDivide && b.op == Op::kNumber && b.number == 0 && !checking_) {
    return Bad(expr.place, "this is divided by zero",
               WithParams(expr.args[1], "divide by something else"));
  }
  if (a.op == Op::kNumber && b.op == Op::kNumber)
    return NumberNode(AsWritten(Calculate(op, a.number, b.number)), dimension, expr.place);
  return {.node = Add({.op = op, .args = {left.node, right.node, kNone, kNone}}),
          .type = Type::kNumber,
          .dimension = dimension};
}

Lowering::Typed Lowering::LowerEdge(const Expr& expr) {
  const Typed arg = TruthValue(expr.args[0]);
  if (arg.bad) return arg;
  if (arg.instant) return Bad(expr.place, "this is a moment already; it cannot begin or end");
  const Op op = expr.text == "begins" ? Op::kBegins : Op::kEnds;
  return {.node = Add({.op = op, .args = {arg.node, kNone, kNone, kNone}}),
          .type = Type::kTruth,
          .instant = true,
          .verdict = arg.verdict,
          .because = arg.because};
}

Lowering::Typed Lowering::LowerAnchor(const Expr& expr) {
  const bool at_begin = expr.text == "begin";
  if (at_begin ? !anchors_.begin : !anchors_.end) {
    return Bad(
        expr.place, "the interval's " + expr.text + " is not known here",
        at_begin
            ? "'@begin' can be used after 'to', 'during', 'requires', 'with' and 'while .. until'"
            : "'@end' can be used after 'since', 'requires' and 'with'");
  }
  if (expr.args[0].kind == Expr::Kind::kCall && IsOverInterval(expr.args[0].text)) {
    return Bad(expr.place,
               Quoted(expr.args[0].text) +
                   " is measured from the interval's begin to now, not at one moment",
               "leave '@" + expr.text + "' out: " + Dump(expr.args[0]));
  }
  // Inside, the boundary is a single frame: no further anchors.
  const Anchors outer = std::exchange(anchors_, Anchors{});
  const bool in_attribute = std::exchange(attribute_, false);
  Typed arg = Lower(expr.args[0]);
  anchors_ = outer;
  attribute_ = in_attribute;
  if (arg.bad) return arg;
  if (arg.type == Type::kTruth) {
    return Bad(expr.place,
               "'@" + expr.text + "' takes a number or a position, this is true or false");
  }
  arg.node = at_begin ? AnchorAtBegin(arg.node)
                      : Add({.op = Op::kAtEnd, .args = {arg.node, kNone, kNone, kNone}});
  return arg;
}

}  // namespace prehend::grammar
