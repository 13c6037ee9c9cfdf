// SPDX-License-Identifier: Apache-2.0
#include "grammar/lower.h"

#include <algorithm>
#include <array>
#include <utility>

namespace prehend::grammar {
namespace {

using ast::Expr;

constexpr std::size_t kMaxNodes = 10000;
constexpr std::array<std::string_view, 3> kOverInterval = {"displacement", "rise", "drop"};

std::string Quoted(std::string_view text) { return "'" + std::string(text) + "'"; }
std::string Suggest(std::string_view name, const std::vector<std::string>& known) {
  const std::string near = NearestName(name, known);
  return near.empty() ? std::string() : "did you mean " + Quoted(near) + "?";
}

std::string_view ClassOf(Argument argument) {
  switch (argument) {
    case Argument::kHand: return "Hand";
    case Argument::kThing: return "Thing";
    case Argument::kMovable: return "Movable";
    default: return "Entity";
  }
}

// `signal op value` for no signal within the range.
bool NeverHolds(Op op, const Range& range, double value) {
  switch (op) {
    case Op::kLess: return range.low >= value;
    case Op::kLessEqual: return range.low > value;
    case Op::kGreater: return range.high <= value;
    case Op::kGreaterEqual: return range.high < value;
    case Op::kEqual: return value < range.low || value > range.high;
    default: return false;
  }
}

std::string_view TypeText(Type type) {
  switch (type) {
    case Type::kTruth: return "true or false";
    case Type::kNumber: return "a number";
    case Type::kPosition: return "a position";
  }
  return "";
}

}  // namespace

bool ClassesMeet(std::string_view a, std::string_view b) {
  if (a == b || a == "Entity" || b == "Entity") return true;
  if (a == "Hand" || b == "Hand") return false;
  return !(a == "Movable" && b == "Fixed") && !(a == "Fixed" && b == "Movable");
}

Lowering::Lowering(Symbols& symbols, int rule, const GrammarText& source, Diagnostics& diagnostics)
    : symbols_(symbols),
      rule_(rule),
      source_(source),
      diagnostics_(diagnostics),
      role_used_(symbols.program.events[rule].roles.size()) {}

void Lowering::Complain(Place place, std::string message, std::string hint) {
  diagnostics_.push_back(DiagnosticAt(source_.file, source_.text, place, std::move(message), std::move(hint)));
}

Lowering::Typed Lowering::Bad(Place place, std::string message, std::string hint) {
  Complain(place, std::move(message), std::move(hint));
  return {.bad = true};
}

int Lowering::Truth(const Expr& expr, Anchors anchors) {
  anchors_ = anchors;
  const Typed typed = TruthValue(expr);
  return typed.bad ? kNone : typed.node;
}

int Lowering::Instant(const Expr& expr, Anchors anchors) {
  anchors_ = anchors;
  const Typed typed = TruthValue(expr);
  if (typed.bad) return kNone;
  if (!typed.instant) {
    Complain(expr.place, "this holds for a while, but a moment is needed here", "add 'begins' or 'ends': X begins");
    return kNone;
  }
  return typed.node;
}

int Lowering::RuleCall(const Expr& expr) {
  if (expr.kind != Expr::Kind::kCall || (FindBuiltin(expr.text) && expr.text != "touching")) {
    Complain(expr.place, "an event or condition with its roles is needed here", "for example: grasping(hand, object)");
    return kNone;
  }
  const Typed typed = Lower(expr);
  if (typed.bad || symbols_.program.nodes[typed.node].op != Op::kHolds) return kNone;
  return symbols_.program.nodes[typed.node].slot;
}

int Lowering::Signal(const Expr& expr, Anchors anchors, Dimension& dimension) {
  anchors_ = anchors;
  const Typed typed = Number(expr);
  dimension = typed.dimension;
  return typed.bad ? kNone : typed.node;
}

double Lowering::Constant(const Expr& expr, const Dimension& dimension, std::string_view what) {
  anchors_ = {};
  return ConstantOf(expr, dimension, what).value_or(0);
}

std::optional<double> Lowering::ConstantOf(const Expr& expr, const Dimension& dimension, std::string_view what) {
  const Typed typed = Number(expr);
  if (typed.bad) return std::nullopt;
  const Node& node = symbols_.program.nodes[typed.node];
  if (node.op != Op::kNumber) {
    Complain(expr.place, std::string(what) + " must be a number or a parameter");
  } else if (!(typed.dimension == dimension)) {
    Complain(expr.place,
             std::string(what) + " is in " + DimensionText(dimension) + ", this is " + DimensionText(typed.dimension));
  } else if (node.number < 0) {
    Complain(expr.place, std::string(what) + " cannot be negative");
  } else {
    return node.number;
  }
  return std::nullopt;
}

int Lowering::HandRole(const Expr& expr) { return RoleArgument(expr, "Hand", "style").value_or(kNone); }

int Lowering::Add(Node node) {
  if (symbols_.program.nodes.size() == kMaxNodes) {
    Complain(rule().place, "the grammar has more than " + std::to_string(kMaxNodes) + " expressions");
  }
  symbols_.program.nodes.push_back(node);
  return static_cast<int>(symbols_.program.nodes.size()) - 1;
}

int Lowering::AddReference(const Reference& reference) {
  std::vector<Reference>& all = rule().references;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].rule == reference.rule && all[i].roles == reference.roles) return static_cast<int>(i);
  }
  all.push_back(reference);
  return static_cast<int>(all.size()) - 1;
}

int Lowering::AnchorAtBegin(int node) {
  rule().anchors.push_back(node);
  return Add({.op = Op::kAtBegin, .slot = static_cast<int>(rule().anchors.size()) - 1});
}

int Lowering::FindRole(std::string_view name) const {
  const std::vector<RuleRole>& roles = symbols_.program.events[rule_].roles;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i].name == name) return static_cast<int>(i);
  }
  return kNone;
}

std::vector<std::string> Lowering::KnownNames(bool calls) const {
  std::vector<std::string> names;
  if (calls) {
    for (const auto& [name, rule] : symbols_.rules) names.push_back(name);
    for (const Builtin& builtin : Builtins()) names.emplace_back(builtin.name);
    names.insert(names.end(), kOverInterval.begin(), kOverInterval.end());
    names.emplace_back("is");
  } else {
    for (const auto& [name, param] : symbols_.params) names.push_back(name);
    for (const RuleRole& role : symbols_.program.events[rule_].roles) names.push_back(role.name);
  }
  return names;
}

Lowering::Typed Lowering::Lower(const Expr& expr) {
  switch (expr.kind) {
    case Expr::Kind::kQuantity:
      return {.node = Add({.op = Op::kNumber, .number = expr.quantity.value}),
              .type = Type::kNumber,
              .dimension = expr.quantity.dimension};
    case Expr::Kind::kName: return LowerName(expr);
    case Expr::Kind::kCall: return LowerCall(expr);
    case Expr::Kind::kUnary: return LowerUnary(expr);
    case Expr::Kind::kBinary: return LowerBinary(expr);
    case Expr::Kind::kChain: return LowerChain(expr);
    case Expr::Kind::kEdge: return LowerEdge(expr);
    case Expr::Kind::kAnchor: return LowerAnchor(expr);
  }
  return {.bad = true};
}

Lowering::Typed Lowering::TruthValue(const Expr& expr) {
  const Typed typed = Lower(expr);
  if (typed.bad || typed.type == Type::kTruth) return typed;
  return Bad(expr.place, "a condition is needed here, this is " + std::string(TypeText(typed.type)),
             typed.type == Type::kNumber ? "compare it with something: speed(object) > 2 cm/s" : "");
}

Lowering::Typed Lowering::Number(const Expr& expr) {
  const Typed typed = Lower(expr);
  if (typed.bad || typed.type == Type::kNumber) return typed;
  return Bad(expr.place, "a number is needed here, this is " + std::string(TypeText(typed.type)));
}

Lowering::Typed Lowering::Position(const Expr& expr) {
  // The name of a role stands for the place of who plays it.
  if (expr.kind == Expr::Kind::kName) {
    if (const int role = FindRole(expr.text); role != kNone) {
      role_used_[role] = true;
      return {.node = Add({.op = Op::kPosition, .roles = {role, kNone}}), .type = Type::kPosition, .dimension = kMetres};
    }
  }
  const Typed typed = Lower(expr);
  if (typed.bad || typed.type == Type::kPosition) return typed;
  return Bad(expr.place, "a position is needed here, this is " + std::string(TypeText(typed.type)),
             "for example: position(object)");
}

Lowering::Typed Lowering::LowerName(const Expr& expr) {
  if (const auto param = symbols_.params.find(expr.text); param != symbols_.params.end()) {
    const Quantity& value = symbols_.program.params[param->second].value;
    return {.node = Add({.op = Op::kNumber, .number = value.value}), .type = Type::kNumber, .dimension = value.dimension};
  }
  if (FindRole(expr.text) != kNone) {
    return Bad(expr.place, Quoted(expr.text) + " is a role; a value is needed here",
               "ask for one of its signals: position(" + expr.text + ")");
  }
  if (expr.text == "any") {
    return Bad(expr.place, "'any' stands only for a role of an event or condition",
               "for example: supported_by(object, any)");
  }
  return Bad(expr.place, "unknown name " + Quoted(expr.text), Suggest(expr.text, KnownNames(false)));
}

Lowering::Typed Lowering::LowerUnary(const Expr& expr) {
  if (expr.text == "not") {
    const Typed arg = TruthValue(expr.args[0]);
    if (arg.bad) return arg;
    return {.node = Add({.op = Op::kNot, .args = {arg.node, kNone, kNone, kNone}}), .type = Type::kTruth};
  }
  Typed arg = Number(expr.args[0]);
  if (arg.bad) return arg;
  if (symbols_.program.nodes[arg.node].op == Op::kNumber) {
    symbols_.program.nodes[arg.node].number *= -1;
    return arg;
  }
  arg.node = Add({.op = Op::kNegate, .args = {arg.node, kNone, kNone, kNone}});
  return arg;
}

Lowering::Typed Lowering::LowerBinary(const Expr& expr) {
  static constexpr std::array<std::pair<std::string_view, Op>, 10> kOps = {{{"+", Op::kAdd},
                                                                            {"-", Op::kSubtract},
                                                                            {"*", Op::kMultiply},
                                                                            {"/", Op::kDivide},
                                                                            {"<", Op::kLess},
                                                                            {"<=", Op::kLessEqual},
                                                                            {">", Op::kGreater},
                                                                            {">=", Op::kGreaterEqual},
                                                                            {"==", Op::kEqual},
                                                                            {"!=", Op::kNotEqual}}};
  const Op op = std::find_if(kOps.begin(), kOps.end(), [&](const auto& entry) { return entry.first == expr.text; })->second;
  const Typed left = Number(expr.args[0]);
  const Typed right = Number(expr.args[1]);
  if (left.bad || right.bad) return {.bad = true};
  Typed result{.node = Add({.op = op, .args = {left.node, right.node, kNone, kNone}}),
               .type = Type::kNumber,
               .dimension = left.dimension};
  if (op == Op::kMultiply) {
    result.dimension = Product(left.dimension, right.dimension);
  } else if (op == Op::kDivide) {
    result.dimension = Quotient(left.dimension, right.dimension);
  } else if (!(left.dimension == right.dimension)) {
    const bool sum = op == Op::kAdd || op == Op::kSubtract;
    return Bad(expr.place, std::string(sum ? "cannot combine " : "cannot compare ") + DimensionText(left.dimension) +
                               " with " + DimensionText(right.dimension),
               right.dimension == kPlain ? "the right side needs a unit" : "both sides must have the same unit");
  }
  if (op < Op::kLess || op > Op::kNotEqual) return result;
  const Node& value = symbols_.program.nodes[right.node];
  const std::optional<Range> range = RangeOf(symbols_.program.nodes[left.node].op);
  if (range && value.op == Op::kNumber && NeverHolds(op, *range, value.number)) {
    return Bad(expr.place, "this is never true: " + Quoted(expr.args[0].text) + " goes from " +
                               QuantityText({range->low, left.dimension}) + " to " +
                               QuantityText({range->high, left.dimension}));
  }
  return {.node = result.node, .type = Type::kTruth};
}

// Long chains become balanced trees, so that walking them never goes deep.
Lowering::Typed Lowering::LowerChain(const Expr& expr) {
  const bool is_and = expr.text == "and";
  std::vector<int> nodes;
  bool bad = false;
  std::size_t instants = 0;
  for (const Expr& arg : expr.args) {
    const Typed typed = TruthValue(arg);
    bad |= typed.bad;
    instants += typed.instant;
    nodes.push_back(typed.node);
  }
  if (bad) return {.bad = true};
  while (nodes.size() > 1) {
    std::vector<int> halved;
    for (std::size_t i = 0; i + 1 < nodes.size(); i += 2) {
      halved.push_back(Add({.op = is_and ? Op::kAnd : Op::kOr, .args = {nodes[i], nodes[i + 1], kNone, kNone}}));
    }
    if (nodes.size() % 2 == 1) halved.push_back(nodes.back());
    nodes = std::move(halved);
  }
  const bool instant = is_and ? instants > 0 : instants == expr.args.size();
  return {.node = nodes[0], .type = Type::kTruth, .instant = instant};
}

Lowering::Typed Lowering::LowerEdge(const Expr& expr) {
  const Typed arg = TruthValue(expr.args[0]);
  if (arg.bad) return arg;
  if (arg.instant) return Bad(expr.place, "this is a moment already; it cannot begin or end");
  const Op op = expr.text == "begins" ? Op::kBegins : Op::kEnds;
  return {.node = Add({.op = op, .args = {arg.node, kNone, kNone, kNone}}), .type = Type::kTruth, .instant = true};
}

Lowering::Typed Lowering::LowerAnchor(const Expr& expr) {
  const bool at_begin = expr.text == "begin";
  if (at_begin ? !anchors_.begin : !anchors_.end) {
    return Bad(expr.place, "the interval's " + expr.text + " is not known here",
               at_begin ? "'@begin' can be used after 'to', 'during' and 'requires'"
                        : "'@end' can be used after 'since' and 'requires'");
  }
  // Inside, the boundary is a single frame: no further anchors.
  const Anchors outer = std::exchange(anchors_, Anchors{});
  Typed arg = Lower(expr.args[0]);
  anchors_ = outer;
  if (arg.bad) return arg;
  if (arg.type == Type::kTruth) {
    return Bad(expr.place, "'@" + expr.text + "' takes a number or a position, this is true or false");
  }
  arg.node = at_begin ? AnchorAtBegin(arg.node) : Add({.op = Op::kAtEnd, .args = {arg.node, kNone, kNone, kNone}});
  return arg;
}

std::optional<int> Lowering::RoleArgument(const Expr& expr, std::string_view wanted_class, std::string_view callee) {
  const int role = expr.kind == Expr::Kind::kName ? FindRole(expr.text) : kNone;
  if (role == kNone) {
    std::vector<std::string> names;
    for (const RuleRole& known : rule().roles) names.push_back(known.name);
    if (expr.text == "any") {
      Complain(expr.place, "'any' stands only for a role of an event or condition", "for example: contact(object, any)");
      return std::nullopt;
    }
    Complain(expr.place, Quoted(callee) + " takes a role here" +
                             (expr.kind == Expr::Kind::kName ? ", and there is no role " + Quoted(expr.text) : ""),
             expr.kind == Expr::Kind::kName ? Suggest(expr.text, names) : "");
    return std::nullopt;
  }
  role_used_[role] = true;
  const std::string& class_name = rule().roles[role].class_name;
  if (!ClassesMeet(class_name, wanted_class)) {
    Complain(expr.place, Quoted(callee) + " takes a " + std::string(wanted_class) + " here, but " + Quoted(expr.text) +
                             " is a " + class_name);
    return std::nullopt;
  }
  return role;
}

Lowering::Typed Lowering::LowerCall(const Expr& expr) {
  if (std::find(kOverInterval.begin(), kOverInterval.end(), expr.text) != kOverInterval.end()) {
    return LowerOverInterval(expr);
  }
  if (expr.text == "is") return LowerIs(expr);
  const auto found = symbols_.rules.find(expr.text);
  if (found == symbols_.rules.end()) {
    if (const Builtin* builtin = FindBuiltin(expr.text)) return LowerBuiltin(*builtin, expr);
    return Bad(expr.place, "unknown event, condition or signal " + Quoted(expr.text),
               Suggest(expr.text, KnownNames(true)));
  }
  const std::vector<RuleRole> wanted = symbols_.program.events[found->second].roles;
  if (wanted.size() != expr.args.size()) {
    return Bad(expr.place, Quoted(expr.text) + " takes " + std::to_string(wanted.size()) + " roles, found " +
                               std::to_string(expr.args.size()));
  }
  Reference reference{.rule = found->second};
  std::vector<int> kept;
  int count = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (expr.args[i].kind == Expr::Kind::kName && expr.args[i].text == "any") continue;
    const std::optional<int> role = RoleArgument(expr.args[i], wanted[i].class_name, expr.text);
    if (!role) return {.bad = true};
    kept.push_back(static_cast<int>(i));
    reference.roles[count++] = *role;
  }
  if (kept.empty()) return Bad(expr.place, "at least one role must be named; all are 'any'");
  if (kept.size() < wanted.size()) reference.rule = AnyRule(found->second, kept);
  return {.node = Add({.op = Op::kHolds, .slot = AddReference(reference)}), .type = Type::kTruth};
}

// The hidden rule "some binding of `rule` with these roles holds".
int Lowering::AnyRule(int rule, const std::vector<int>& kept) {
  const auto [entry, is_new] = symbols_.any_rules.try_emplace({rule, kept}, static_cast<int>(symbols_.program.events.size()));
  if (is_new) {
    const Rule& source = symbols_.program.events[rule];
    Rule any{.name = source.name, .file = source.file, .place = source.place, .form = Form::kAny};
    Reference guard{.rule = rule};
    for (std::size_t i = 0; i < kept.size(); ++i) {
      any.roles.push_back(source.roles[kept[i]]);
      guard.roles[kept[i]] = static_cast<int>(i);
    }
    any.references = {guard};
    any.guard = 0;
    symbols_.program.events.push_back(std::move(any));
  }
  return entry->second;
}

// is(object, Cup): the class test.
Lowering::Typed Lowering::LowerIs(const Expr& expr) {
  if (expr.args.size() != 2 || expr.args[1].kind != Expr::Kind::kName) {
    return Bad(expr.place, "'is' takes a role and the name of a class", "for example: is(object, Cup)");
  }
  const std::optional<int> role = RoleArgument(expr.args[0], "Entity", "is");
  if (!role) return {.bad = true};
  symbols_.program.class_names.push_back(expr.args[1].text);
  const int slot = static_cast<int>(symbols_.program.class_names.size()) - 1;
  return {.node = Add({.op = Op::kIsA, .roles = {*role, kNone}, .slot = slot}), .type = Type::kTruth};
}

// displacement, rise and drop compare this frame with the interval's begin.
Lowering::Typed Lowering::LowerOverInterval(const Expr& expr) {
  if (!anchors_.begin) {
    return Bad(expr.place, Quoted(expr.text) + " is measured over an interval; there is none here",
               "it can be used after 'to', 'during' and 'requires'");
  }
  const bool is_displacement = expr.text == "displacement";
  if (expr.args.empty() || expr.args.size() > (is_displacement ? 2 : 1)) {
    return Bad(expr.place, Quoted(expr.text) + (is_displacement ? " takes one or two roles" : " takes one role"));
  }
  Node now{.op = is_displacement ? (expr.args.size() == 2 ? Op::kPositionOn : Op::kPosition) : Op::kHeight};
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    const std::optional<int> role = RoleArgument(expr.args[i], "Entity", expr.text);
    if (!role) return {.bad = true};
    now.roles[i] = *role;
  }
  if (!is_displacement) {
    now.args[0] = Add({.op = Op::kPosition, .roles = {now.roles[0], kNone}});
    now.roles[0] = kNone;
  }
  const int here = Add(now);
  const int there = AnchorAtBegin(here);
  const Op op = is_displacement ? Op::kDistance : Op::kSubtract;
  const bool falls = expr.text == "drop";
  return {.node = Add({.op = op, .args = {falls ? there : here, falls ? here : there, kNone, kNone}}),
          .type = Type::kNumber,
          .dimension = kMetres};
}

Lowering::Typed Lowering::LowerBuiltin(const Builtin& builtin, const Expr& expr) {
  if (expr.args.size() != builtin.arguments.size()) {
    return Bad(expr.place, Quoted(builtin.name) + " takes " + std::to_string(builtin.arguments.size()) +
                               " arguments, found " + std::to_string(expr.args.size()),
               std::string(builtin.name) + ": " + std::string(builtin.meaning));
  }
  Typed result{.type = builtin.type, .dimension = builtin.dimension};
  Node node{.op = builtin.op};
  int next_node = 0;
  int next_role = 0;
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (!LowerArgument(expr.args[i], builtin.arguments[i], builtin, node, next_node, next_role, result)) {
      return {.bad = true};
    }
  }
  const bool from_touch = node.op == Op::kHolds || node.op == Op::kSensorSets || node.op == Op::kUp ||
                          node.op == Op::kForceBetween;
  if (from_touch) {
    node.slot = AddReference({.rule = kTouchingRule, .roles = {node.roles[0], node.roles[1], kNone, kNone}});
  }
  result.node = Add(node);
  return result;
}

bool Lowering::LowerArgument(const Expr& arg, Argument wanted, const Builtin& builtin, Node& node, int& next_node,
                             int& next_role, Typed& result) {
  switch (wanted) {
    case Argument::kPosition: {
      if (node.op == Op::kInSphere && next_node == 0 && arg.kind == Expr::Kind::kName && FindRole(arg.text) != kNone) {
        node.op = Op::kBoxInSphere;
        node.roles[next_role++] = FindRole(arg.text);
        role_used_[node.roles[0]] = true;
        return true;
      }
      const Typed position = Position(arg);
      node.args[next_node++] = position.node;
      return !position.bad;
    }
    case Argument::kLength:
    case Argument::kNumber: {
      const Typed number = Number(arg);
      if (number.bad) return false;
      if (wanted == Argument::kLength && !(number.dimension == kMetres)) {
        Complain(arg.place, Quoted(builtin.name) + " takes a length here, this is " + DimensionText(number.dimension));
        return false;
      }
      if (wanted == Argument::kNumber) result.dimension = number.dimension;
      node.args[next_node++] = number.node;
      return true;
    }
    case Argument::kWindow: {
      const std::optional<double> window_s = ConstantOf(arg, kSeconds, "the window of " + Quoted(builtin.name));
      if (!window_s) return false;
      node.number = *window_s;
      if (node.number > 0) return true;
      Complain(arg.place, "the window of " + Quoted(builtin.name) + " must be longer than 0 s", "for example: 100 ms");
      return false;
    }
    default: {
      const std::optional<int> role = RoleArgument(arg, ClassOf(wanted), builtin.name);
      if (!role) return false;
      if (next_role == 1 && node.roles[0] == *role) {
        Complain(arg.place, Quoted(builtin.name) + " needs two different roles");
        return false;
      }
      node.roles[next_role++] = *role;
      return true;
    }
  }
}

}  // namespace prehend::grammar
