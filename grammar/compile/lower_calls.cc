// SPDX-License-Identifier: Apache-2.0
// Calls in expressions: of events and conditions, of definitions, of built-in signals and tests.
// Errors: unknown callees, the number and kind of arguments, classes that do not fit a role, one
// entity in two roles, definitions that refer to themselves.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "grammar/analysis/value_ranges.h"
#include "grammar/base/diagnostic.h"
#include "grammar/compile/lower.h"

namespace prehend::grammar {
namespace {

using ast::Expr;

constexpr int kMaxDefineDepth = 16;

// Of those that are roles.
constexpr std::array<std::string_view, 5> kClassOf = {"Entity", "Hand", "Thing", "Movable",
                                                      "Jointed"};

// "2 or 3 arguments", of all signals of this name.
std::string ArgumentCounts(std::string_view name) {
  std::set<std::size_t> counts;
  for (const Operator& builtin : Operators()) {
    if (builtin.name != name) continue;
    counts.insert(builtin.arguments.size());
    if (builtin.left_out_m > 0) counts.insert(builtin.arguments.size() - 1);
  }
  std::string text;
  for (const std::size_t count : counts)
    text += (text.empty() ? "" : " or ") + std::to_string(count);
  return text + (counts == std::set<std::size_t>{1} ? " argument" : " arguments");
}

}  // namespace

std::optional<int> Lowering::RoleArgument(const Expr& expr, std::string_view wanted_class,
                                          std::string_view callee) {
  const bool is_name = expr.kind == Expr::Kind::kName;
  const int role = is_name ? FindRole(expr.text) : kNone;
  if (role == kNone) {
    if (expr.text == "any") {
      Complain(expr.place, "'any' stands only for a role of an event or condition",
               "for example: contact(object, any), with `use contact`");
      return std::nullopt;
    }
    const bool is_told = is_name && (symbols_.broken.contains(expr.text) ||
                                     !unknown_roles_.insert(expr.text).second);
    std::vector<std::string> names = {"any"};
    for (const RuleRole& known : rule().roles) names.push_back(known.name);
    const std::string found = is_name ? ", and there is no role " + Quoted(expr.text) : "";
    Complain(expr.place, is_told ? "" : Quoted(callee) + " takes a role here" + found,
             is_name ? DidYouMean(expr.text, names, HabitHint("role")) : "");
    return std::nullopt;
  }
  role_used_[role] = true;
  const std::string& class_name = rule().roles[role].class_name;
  if (!ClassesMeet(class_name, wanted_class)) {
    Complain(expr.place, symbols_.NotOfClass(callee, wanted_class, expr.text, class_name),
             wanted_class == "Jointed"
                 ? "what hangs on a slider or a hinge is Jointed: " + expr.text + ": Jointed"
                 : DidYouMean(class_name, {std::string(wanted_class)}));
    return std::nullopt;
  }
  return role;
}

Lowering::Typed Lowering::LowerCall(const Expr& expr) {
  if (expr.text == ast::kAtLeast) return LowerAtLeast(expr);
  if (IsOverInterval(expr.text)) return LowerOverInterval(expr);
  if (expr.text == "is") return LowerIs(expr);
  if (const auto found = symbols_.rules.find(expr.text); found != symbols_.rules.end()) {
    return LowerRuleCall(found->second, expr);
  }
  if (const auto found = symbols_.defines.find(expr.text); found != symbols_.defines.end()) {
    return LowerDefine(found->second, expr);
  }
  if (const Operator* builtin = FindBuiltin(expr.text, expr.args.size()))
    return LowerBuiltin(*builtin, expr);
  const Diagnostic unknown = symbols_.Unknown("event, condition or signal", expr.text,
                                              DidYouMean(expr.text, KnownNames(true)));
  return Bad(expr.place, unknown.message, unknown.hint);
}

// `at least 3 of grasping(hand, any)`: so many that play `any` do so at once.
Lowering::Typed Lowering::LowerAtLeast(const Expr& expr) {
  const Expr& call = expr.args[1];
  const auto found = symbols_.rules.find(call.text);
  const bool has_any = std::ranges::any_of(call.args, [](const Expr& arg) {
    return arg.kind == Expr::Kind::kName && arg.text == "any";
  });
  if (found == symbols_.rules.end() || !has_any) {
    return Bad(call.place, "'at least .. of' counts who plays 'any' in an event or a condition",
               "for example: at least 3 of grasping(hand, any)");
  }
  const Anchors anchors = anchors_;
  const int at_least = Count(expr.args[0]);
  anchors_ = anchors;
  return LowerRuleCall(found->second, call, at_least);
}

Lowering::Typed Lowering::LowerRuleCall(RuleId rule, const Expr& expr, int at_least) {
  const std::vector<RuleRole> wanted = symbols_.program.rules[rule].roles;
  if (wanted.size() != expr.args.size()) {
    return Bad(expr.place, Quoted(expr.text) + " takes " + std::to_string(wanted.size()) +
                               " roles, found " + std::to_string(expr.args.size()));
  }
  Reference reference{.rule = rule};
  std::vector<int> kept;
  std::vector<std::string> classes;
  bool narrowed = false;
  int count = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    classes.push_back(wanted[i].class_name);
    if (expr.args[i].kind == Expr::Kind::kName && expr.args[i].text == "any") {
      if (expr.args[i].args.empty()) continue;
      narrowed = true;
      classes[i] = expr.args[i].args[0].text;
      if (!StartsWithCapital(classes[i])) {
        return Bad(expr.args[i].args[0].place,
                   Quoted(classes[i]) + " is not a class; classes start with a capital letter");
      }
      NoteClass(symbols_.program, classes[i], source_->file, expr.args[i].args[0].place);
      if (ClassesMeet(classes[i], wanted[i].class_name)) continue;
      return Bad(expr.args[i].args[0].place, Quoted(expr.text) + " takes " +
                                                 WithArticle(wanted[i].class_name) +
                                                 " here, and no " + classes[i] + " is one");
    }
    const std::optional<int> role = RoleArgument(expr.args[i], wanted[i].class_name, expr.text);
    if (!role) return {.bad = true};
    if (std::find(reference.roles.begin(), reference.roles.end(), *role) != reference.roles.end()) {
      return Bad(expr.args[i].place,
                 "this is never true: " + Quoted(expr.args[i].text) + " cannot play two roles of " +
                     Quoted(expr.text),
                 "name another role, or 'any'");
    }
    kept.push_back(static_cast<int>(i));
    reference.roles[count++] = *role;
  }
  if (kept.empty()) return Bad(expr.place, "at least one role must be named; all are 'any'");
  if (narrowed) reference.rule = MakeNarrowedRule(rule, classes);
  if (kept.size() < wanted.size()) reference.rule = MakeAnyRule(reference.rule, kept, at_least);
  return {.node = Add({.op = Op::kHolds, .slot = AddReference(reference)}), .type = Type::kTruth};
}

// The hidden rule "`rule`, but only for these classes".
RuleId Lowering::MakeNarrowedRule(RuleId rule, const std::vector<std::string>& classes) {
  const RuleId next = symbols_.program.rules.end_id();
  const auto [entry, is_new] = symbols_.narrowed_rules.try_emplace({rule, classes}, next);
  if (!is_new) return entry->second;
  const Rule& source = symbols_.program.rules[rule];
  Rule narrowed{.name = source.name,
                .file = source.file,
                .place = source.place,
                .roles = source.roles,
                .hidden = true};
  Reference whole{.rule = rule};
  for (std::size_t i = 0; i < classes.size(); ++i) {
    narrowed.roles[i].class_name = classes[i];
    whole.roles[i] = static_cast<int>(i);
  }
  narrowed.references = {whole};
  narrowed.of_form = WhileRule{.condition = Add({.op = Op::kHolds, .slot = 0})};
  symbols_.program.rules.push_back(std::move(narrowed));
  return next;
}

// The hidden rule "so many bindings of `rule` with these roles hold".
RuleId Lowering::MakeAnyRule(RuleId rule, const std::vector<int>& kept, int at_least) {
  const auto [entry, is_new] =
      symbols_.any_rules.try_emplace({rule, kept, at_least}, symbols_.program.rules.end_id());
  if (is_new) {
    const Rule& source = symbols_.program.rules[rule];
    Rule any{.name = source.name,
             .file = source.file,
             .place = source.place,
             .hidden = true,
             .of_form = AnyRule{.at_least = at_least}};
    Reference guard{.rule = rule};
    for (std::size_t i = 0; i < kept.size(); ++i) {
      any.roles.push_back(source.roles[kept[i]]);
      guard.roles[kept[i]] = static_cast<int>(i);
    }
    any.references = {guard};
    any.guard = 0;
    symbols_.program.rules.push_back(std::move(any));
  }
  return entry->second;
}

// The class of a definition's parameter says what the argument must be.
bool Lowering::BindParameter(const DefineSource& source, std::size_t index, const Expr& arg,
                             Scope& scope) {
  const ast::Role& parameter = source.define->parameters[index];
  const bool is_position = parameter.class_name == "position";
  if (!is_position && parameter.class_name != "number") {
    const std::optional<int> role = RoleArgument(arg, parameter.class_name, source.define->name);
    if (role) scope.roles[parameter.name] = *role;
    return role.has_value();
  }
  const Typed value = is_position ? Position(arg) : Number(arg);
  if (value.bad) return false;
  const Dimension& wanted = source.define->dimensions[index];
  if (!is_position && !(value.dimension == wanted)) {
    Complain(arg.place, Quoted(source.define->name) + " takes " + DimensionText(wanted) + " for " +
                            Quoted(parameter.name) + ", this is " + DimensionText(value.dimension));
    return false;
  }
  scope.values[parameter.name] = {.expr = &arg, .source = source_, .scope = scope_};
  return true;
}

Lowering::Typed Lowering::LowerDefine(const DefineSource& source, const Expr& expr) {
  const ast::Define& define = *source.define;
  symbols_.used_defines.insert(define.name);
  if (define.parameters.size() != expr.args.size()) {
    return Bad(expr.place, Quoted(define.name) + " takes " +
                               CountOf(define.parameters.size(), "argument") + ", found " +
                               std::to_string(expr.args.size()));
  }
  Scope scope{
      .define = define.name, .outer = scope_, .depth = scope_ == nullptr ? 1 : scope_->depth + 1};
  for (const Scope* outer = scope_; outer != nullptr; outer = outer->outer) {
    if (outer->define == define.name)
      return Bad(expr.place, Quoted(define.name) + " refers to itself");
  }
  if (too_deep_) return {.bad = true};
  if (scope.depth > kMaxDefineDepth) {
    too_deep_ = true;
    return Bad(expr.place,
               "definitions use each other more than " + std::to_string(kMaxDefineDepth) + " deep");
  }
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (!BindParameter(source, i, expr.args[i], scope)) return {.bad = true};
  }
  return LowerBody(source, scope);
}

Lowering::Typed Lowering::LowerBody(const DefineSource& source, const Scope& scope) {
  const GrammarText* const outer_source = std::exchange(source_, source.text);
  const Scope* const outer_scope = std::exchange(scope_, &scope);
  const Typed body = Lower(source.define->body);
  source_ = outer_source;
  scope_ = outer_scope;
  return body;
}

// Where a body names a parameter, the argument is read again in the place that it comes from.
Lowering::Typed Lowering::LowerValue(const Scope::Value& value) {
  if (value.expr == nullptr) return value.placeholder;
  const GrammarText* const inner_source = std::exchange(source_, value.source);
  const Scope* const inner_scope = std::exchange(scope_, value.scope);
  const bool is_role = value.expr->kind == Expr::Kind::kName && FindRole(value.expr->text) != kNone;
  Typed typed = is_role ? Position(*value.expr) : Lower(*value.expr);
  if (!typed.bad && typed.type != Type::kNumber) typed = Position(*value.expr);
  source_ = inner_source;
  scope_ = inner_scope;
  return typed;
}

void Lowering::Check(const DefineSource& source) {
  checking_ = true;
  anchors_ = {.begin = true, .end = true};
  Scope scope{.define = source.define->name};
  int role = 0;
  for (std::size_t i = 0; i < source.define->parameters.size(); ++i) {
    const ast::Role& parameter = source.define->parameters[i];
    if (parameter.class_name == "number") {
      const Typed placeholder = NumberNode(1, source.define->dimensions[i], parameter.place);
      scope.values[parameter.name] = {.placeholder = placeholder};
    } else if (parameter.class_name == "position") {
      const NodeId node = Add({.op = Op::kPosition, .roles = {0, kNone}});
      scope.values[parameter.name] = {
          .placeholder = {.node = node, .type = Type::kPosition, .dimension = kMetres}};
    } else {
      scope.roles[parameter.name] = role++;
    }
  }
  LowerBody(source, scope);
}

// is(object, Cup): the class test.
Lowering::Typed Lowering::LowerIs(const Expr& expr) {
  if (expr.args.size() != 2 || expr.args[1].kind != Expr::Kind::kName) {
    return Bad(expr.place, "'is' takes a role and the name of a class",
               "for example: is(object, Cup)");
  }
  const std::optional<int> role = RoleArgument(expr.args[0], "Entity", "is");
  if (!role) return {.bad = true};
  // Within a definition, this depends on the call.
  const std::string& class_name = rule().roles[*role].class_name;
  const bool both_known = IsBuiltinClass(class_name) && IsBuiltinClass(expr.args[1].text);
  if ((scope_ == nullptr || checking_) && both_known &&
      !ClassesMeet(class_name, expr.args[1].text)) {
    return Bad(expr.place, "this is never true: " + Quoted(expr.args[0].text) + " is " +
                               WithArticle(class_name) + ", and no " + class_name + " is " +
                               WithArticle(expr.args[1].text));
  }
  NoteClass(symbols_.program, expr.args[1].text, source_->file, expr.args[1].place);
  symbols_.program.class_names.push_back(expr.args[1].text);
  const int slot = static_cast<int>(symbols_.program.class_names.size()) - 1;
  const NodeId node = Add({.op = Op::kIsA, .roles = {*role, kNone}, .slot = slot});
  if (scope_ == nullptr && !checking_ && ClassImplies(class_name, expr.args[1].text)) {
    NoteVacuous(
        expr.place,
        "this is always true: " + Quoted(expr.args[0].text) + " is " + WithArticle(class_name),
        "leave it out", false);
    return Decided(node, Verdict::kAlways);
  }
  return {.node = node, .type = Type::kTruth};
}

Lowering::Typed Lowering::TwiceTheSame(const Expr& role, std::string_view callee) {
  return Bad(role.place, Quoted(callee) + " needs two different roles");
}

// A distance from itself is 0, and every region around itself has it inside.
bool Lowering::LiesOnItself(const Node& node) {
  const Program& program = symbols_.program;
  const auto signature = [&](int arg) { return Signature(program, rule(), node.args[arg]); };
  if (node.op == Op::kSolidInSphere) {
    const Node& centre = program.nodes[node.args[0]];
    return centre.op == Op::kPosition && centre.roles[0] == node.roles[0];
  }
  const bool compares =
      node.op == Op::kDistance || node.op == Op::kInSphere || node.op == Op::kInCylinder;
  return compares && signature(0) == signature(1);
}

// As seen from whom a position is; kNone: in the world.
int Lowering::SeenFrom(NodeId position) {
  const Node& node = symbols_.program.nodes[position];
  if (node.op == Op::kAtEnd) return SeenFrom(node.args[0]);
  if (node.op == Op::kAtBegin) return SeenFrom(rule().anchors[static_cast<std::size_t>(node.slot)]);
  return node.op == Op::kPositionOn ? node.roles[1] : kNone;
}

// Positions as seen from different entities have nothing to do with each other. What is wrong, or
// nothing.
std::string Lowering::WhyNotComparable(const Node& node) {
  const bool is_solid = node.op == Op::kSolidInSphere;
  if (!is_solid && node.op != Op::kDistance && node.op != Op::kInSphere &&
      node.op != Op::kInCylinder)
    return {};
  const int first = is_solid ? kNone : SeenFrom(node.args[0]);
  const int second = SeenFrom(node.args[is_solid ? 0 : 1]);
  const auto text = [&](int role) {
    return role == kNone
               ? std::string("in the world")
               : "as seen from " + Quoted(rule().roles[static_cast<std::size_t>(role)].name);
  };
  return first == second ? "" : "the first is " + text(first) + ", and this is " + text(second);
}

// The reference to the touch of the node's two roles.
int Lowering::TouchOf(const Node& node) {
  return AddReference(
      {.rule = kTouchingRule, .roles = {node.roles[0], node.roles[1], kNone, kNone}});
}

NodeId Lowering::AtOneMoment(const OverInterval::Part& part, std::array<int, 2> roles) {
  Node node{.op = part.op, .roles = roles, .number = part.number};
  if (part.op == Op::kHeight)
    node = {.op = part.op,
            .args = {Add({.op = Op::kPosition, .roles = roles}), kNone, kNone, kNone}};
  if (RowOf(part.op).AsksTouchValues()) node.slot = TouchOf(node);
  return Add(node);
}

// They compare this frame with the interval's begin.
Lowering::Typed Lowering::LowerOverInterval(const Expr& expr) {
  if (!anchors_.begin) {
    return Bad(expr.place, Quoted(expr.text) + " is measured over an interval; there is none here",
               "it can be used after 'to', 'during', 'requires' and 'while .. until'");
  }
  const OverInterval* signal = nullptr;
  std::string counts;
  std::size_t count = expr.args.size();
  const bool may_have_axis = std::ranges::any_of(
      SignalsOverIntervals(),
      [&](const OverInterval& one) { return one.name == expr.text && one.about_axis; });
  const int axis = may_have_axis && count > 1 && FindRole(expr.args.back().text) == kNone
                       ? AxisNamed(expr.args.back())
                       : kNone;
  if (axis != kNone) --count;
  for (const OverInterval& one : SignalsOverIntervals()) {
    if (one.name != expr.text || one.about_axis != (axis != kNone)) continue;
    counts += std::string(counts.empty() ? " takes " : " or ") + (one.roles == 1 ? "one" : "two");
    if (one.roles == count) signal = &one;
  }
  if (signal == nullptr) {
    return Bad(expr.place, Quoted(expr.text) + counts +
                               (counts == " takes one" ? " role" : " roles") +
                               (may_have_axis ? ", and perhaps an axis, x, y or z" : ""));
  }
  std::array<int, 2> roles = {kNone, kNone};
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<int> role = RoleArgument(expr.args[i], "Entity", expr.text);
    if (!role) return {.bad = true};
    if (i == 1 && roles[0] == *role) return TwiceTheSame(expr.args[i], expr.text);
    roles[i] = *role;
  }
  Node node{.op = signal->op, .name = axis};
  if (signal->looks) node.roles = roles;
  NodeId here;
  for (std::size_t i = 0; i < signal->parts.size() && signal->parts[i]; ++i) {
    const OverInterval::Part& part = *signal->parts[i];
    const bool is_new = i == 0 || part.op != signal->parts[i - 1]->op ||
                        part.number != signal->parts[i - 1]->number;
    if (is_new) here = AtOneMoment(part, roles);
    node.args[i] = part.at_begin ? AnchorAtBegin(here) : here;
  }
  return {.node = Add(node), .type = Type::kNumber, .dimension = signal->dimension};
}

Lowering::Typed Lowering::LowerBuiltin(const Operator& builtin, const Expr& expr) {
  const std::size_t most = builtin.arguments.size();
  const std::size_t least = builtin.left_out_m > 0 ? most - 1 : most;
  if (expr.args.size() < least || expr.args.size() > most) {
    return Bad(expr.place,
               Quoted(builtin.name) + " takes " + ArgumentCounts(builtin.name) + ", found " +
                   std::to_string(expr.args.size()),
               std::string(builtin.name) + ": " + std::string(builtin.meaning));
  }
  Typed result{.type = builtin.type, .dimension = builtin.dimension};
  Node node{.op = builtin.op};
  int next_node = 0;
  int next_role = 0;
  const bool in_attribute = attribute_;
  if (builtin.IsOverWindow()) attribute_ = false;  // itself is what is taken at the begin
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (!LowerArgument(expr.args[i], builtin.arguments[i], builtin, node, next_node, next_role,
                       result)) {
      attribute_ = in_attribute;
      return {.bad = true};
    }
  }
  if (expr.args.size() < most)
    node.args[next_node++] = NumberNode(builtin.left_out_m, kMetres, expr.place).node;
  attribute_ = in_attribute;
  if (node.op == Op::kRate) result.dimension = Quotient(result.dimension, kSeconds);
  if (!checking_ && LiesOnItself(node)) {
    return Bad(expr.args[1].place,
               Quoted(builtin.name) + " needs two different positions, and both are the same",
               "name another one");
  }
  if (const std::string why = checking_ ? "" : WhyNotComparable(node); !why.empty()) {
    return Bad(expr.args[1].place,
               Quoted(builtin.name) + " needs two positions of one kind: " + why,
               "position_on(a, c) goes with position_on(b, c), or with position_on(a, c)@begin");
  }
  if (builtin.asks == Asks::kTouching || builtin.AsksTouchValues()) node.slot = TouchOf(node);
  result.node = AddSignal(node);
  return result;
}

// 0, 1 or 2; kNone: it is something else.
int Lowering::AxisNamed(const Expr& expr) {
  const bool is_name = expr.kind == Expr::Kind::kName && expr.args.empty();
  constexpr std::string_view kAxes = "xyz";
  return is_name && expr.text.size() == 1 && kAxes.find(expr.text[0]) != std::string_view::npos
             ? static_cast<int>(kAxes.find(expr.text[0]))
             : kNone;
}

// sensor_set(hand, thumb, object), or the number of the set, from 1.
bool Lowering::LowerSet(const Expr& arg, Node& node) {
  constexpr int kMaxSets = 32;
  const bool is_value = symbols_.IsParamIn(source_->file, arg.text) ||
                        (scope_ != nullptr && scope_->values.contains(arg.text));
  const bool is_name =
      arg.kind == Expr::Kind::kText || (arg.kind == Expr::Kind::kName && !is_value);
  if (is_name) {
    node.name = NoteName(symbols_.program.sensor_sets, arg.text, source_->file, arg.place);
    return true;
  }
  const std::optional<double> number = ConstantOf(arg, kPlain, "a sensor set");
  if (!number) return false;
  node.number = *number;
  if (*number >= 1 && *number <= kMaxSets && *number == std::floor(*number)) {
    NoteName(symbols_.program.numbered_sets, QuantityText({*number, kPlain}), source_->file,
             arg.place);
    return true;
  }
  Complain(arg.place, "a sensor set is a name, or a number from 1 to " + std::to_string(kMaxSets),
           "for example: thumb");
  return false;
}

bool Lowering::LowerArgument(const Expr& arg, Argument wanted, const Operator& builtin, Node& node,
                             int& next_node, int& next_role, Typed& result) {
  switch (wanted) {
    case Argument::kAxis: {
      const int axis = AxisNamed(arg);
      if (axis == kNone) {
        Complain(arg.place, "an axis is x, y or z, of the entity before it",
                 "for example: aligned(peg, z, hole, z)");
        return false;
      }
      node.name = node.name == kNone ? axis : node.name + 3 * axis;
      return true;
    }
    case Argument::kPosition: {
      if (node.op == Op::kInSphere && next_node == 0 && arg.kind == Expr::Kind::kName &&
          FindRole(arg.text) != kNone) {
        node.op = Op::kSolidInSphere;
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
        Complain(arg.place, Quoted(builtin.name) + " takes a length here, this is " +
                                DimensionText(number.dimension));
        return false;
      }
      if (wanted == Argument::kNumber) result.dimension = number.dimension;
      const bool is_size = wanted == Argument::kLength && result.type == Type::kTruth;
      if (is_size && !checking_ && RangeOf(symbols_.program, rule(), number.node).high < 0) {
        Complain(arg.place, "this is never true: nothing is within a negative length of something",
                 WithParams(arg, "lengths are from 0 m on"));
        return false;
      }
      node.args[next_node++] = number.node;
      return true;
    }
    case Argument::kSet:
      return LowerSet(arg, node);
    case Argument::kWindow: {
      const std::optional<double> window_s =
          ConstantOf(arg, kSeconds, "the window of " + Quoted(builtin.name));
      node.number = window_s.value_or(0);
      if (!window_s || node.number > 0) return window_s.has_value();
      Complain(arg.place, "the window of " + Quoted(builtin.name) + " must be longer than 0 s",
               "for example: 100 ms");
      return false;
    }
    case Argument::kEntity:
    case Argument::kHand:
    case Argument::kThing:
    case Argument::kMovable:
    case Argument::kJointed:
      break;
  }
  const std::optional<int> role =
      RoleArgument(arg, kClassOf[static_cast<std::size_t>(wanted)], builtin.name);
  if (!role) return false;
  if (next_role == 1 && node.roles[0] == *role) {
    TwiceTheSame(arg, builtin.name);
    return false;
  }
  node.roles[next_role++] = *role;
  return true;
}

}  // namespace prehend::grammar
