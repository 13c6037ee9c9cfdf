// SPDX-License-Identifier: Apache-2.0
#include "grammar/language/limits.h"

#include <algorithm>
#include <utility>

namespace prehend::grammar::ast {
namespace {

/// What a number or condition of a definition stands behind.
struct Field {
  const char* word;  ///< null: no limit
  Expr* expr;
  bool is_condition = false;
};

void AddAll(std::vector<Expr>& exprs, std::vector<Field>& fields) {
  for (Expr& expr : exprs) fields.push_back({nullptr, &expr});
}

/// Of an `approaching`: windows are no limits.
void AddApproach(Approach& approach, std::vector<Field>& fields) {
  fields.push_back({nullptr, &approach.signal});
  fields.push_back({"receding at most", &approach.slack});
  const std::pair<const char*, std::optional<Expr>*> parts[] = {
      {nullptr, &approach.over},        {nullptr, &approach.motion},
      {"slower than", &approach.speed}, {"within", &approach.still},
      {nullptr, &approach.still_over},  {"at most", &approach.idle},
      {"onset", &approach.onset}};
  for (const auto& [word, part] : parts)
    if (*part) fields.push_back({word, &**part});
}

std::vector<Field> FieldsOf(Definition& d) {
  std::vector<Field> fields = {{nullptr, &d.first, true}, {nullptr, &d.second, true}};
  const auto add = [&](const char* word, std::optional<Expr>& expr, bool is_condition = false) {
    if (expr) fields.push_back({word, &*expr, is_condition});
  };
  add(nullptr, d.until, true);
  add("within", d.within);
  add(nullptr, d.during, true);
  if (d.approach) AddApproach(*d.approach, fields);
  fields.push_back({"at most .. back", &d.at_most_back});
  AddAll(d.repeated, fields);
  fields.push_back({"at least", &d.at_least});
  add("gap at most", d.gap);
  AddAll(d.outside, fields);
  for (Part& part : d.parts) AddAll(part.calls, fields);
  for (Relation& relation : d.relations)
    for (Relation::Alternative& alternative : relation.alternatives)
      add("within", alternative.within);
  for (Absence& absence : d.absences) fields.push_back({nullptr, &absence.call});
  add("bridging", d.bridging);
  if (d.one_per) add("nearest within", d.one_per->within);
  add("lasting", d.lasting);
  add("lasting .. to", d.lasting_to);
  add(nullptr, d.requirement, true);
  if (d.confirmed) {
    fields.push_back({nullptr, &d.confirmed->by});
    fields.push_back({nullptr, &d.confirmed->within});
  }
  for (Attribute& attribute : d.attributes) fields.push_back({nullptr, &attribute.value});
  return fields;
}

class Finder {
 public:
  Finder(std::string owner, const std::set<std::string>& defines, std::vector<FoundLimit>& found)
      : owner_(std::move(owner)), defines_(defines), found_(found) {}

  void Number(Expr& expr, const std::string& clause, bool is_count = false) {
    if (expr.text == "-" && expr.args.size() == 1 && expr.args[0].kind == Expr::Kind::kQuantity) {
      expr.kind = Expr::Kind::kQuantity;
      expr.quantity = {-expr.args[0].quantity.value, expr.args[0].quantity.dimension};
    }
    if (expr.kind == Expr::Kind::kQuantity || expr.kind == Expr::Kind::kName)
      return found_.push_back({owner_, clause, expr.place, is_count, &expr});
    if (expr.kind == Expr::Kind::kCall && !defines_.contains(expr.text)) return;
    if (expr.kind == Expr::Kind::kCall) return Call(expr);
    for (Expr& arg : expr.args) Number(arg, clause);
  }

  void Condition(Expr& expr) {
    const bool is_joint = expr.text == "and" || expr.text == "or" || expr.text == "not" ||
                          expr.text == "known" || expr.kind == Expr::Kind::kEdge ||
                          expr.kind == Expr::Kind::kAnchor;
    if (expr.kind == Expr::Kind::kCall) return Call(expr);
    for (Expr& arg : expr.args) {
      if (is_joint) {
        Condition(arg);
      } else {
        Number(arg, Dump(expr), IsOfACount(expr));
      }
    }
  }

 private:
  /// `sensor_sets(..) >= 2`: there is no half of a set.
  static bool IsOfACount(const Expr& expr) {
    return std::ranges::any_of(expr.args, [](const Expr& arg) {
      return arg.kind == Expr::Kind::kCall && arg.text == "sensor_sets";
    });
  }

  // Numbers of regions and of definitions: `in_sphere(cup, here, 30 cm)`, `near(a, b, 5 cm)`.
  void Call(Expr& expr) {
    if (expr.text == "sensor_set") return;  // its number is a name
    if (expr.text == kAtLeast) return Number(expr.args[0], Dump(expr), true);
    for (Expr& arg : expr.args) {
      if (arg.kind == Expr::Kind::kQuantity) Number(arg, Dump(expr));
      if (arg.kind == Expr::Kind::kName && arg.args.empty()) Number(arg, Dump(expr));
    }
  }

  std::string owner_;
  const std::set<std::string>& defines_;
  std::vector<FoundLimit>& found_;
};

}  // namespace

std::vector<FoundLimit> FindLimits(File& file, const std::set<std::string>& defines) {
  std::vector<FoundLimit> found;
  for (Define& define : file.defines) {
    Finder finder(define.name, defines, found);
    const bool is_number = define.body.kind != Expr::Kind::kChain && define.body.text != "not";
    is_number ? finder.Number(define.body, Dump(define.body)) : finder.Condition(define.body);
  }
  for (Definition& definition : file.definitions) {
    Finder finder(definition.name, defines, found);
    for (const Field& field : FieldsOf(definition)) {
      if (field.is_condition) finder.Condition(*field.expr);
      if (field.word == nullptr || field.expr->place.line == 0) continue;
      finder.Number(*field.expr, std::string(field.word) + " " + Dump(*field.expr),
                    field.expr == &definition.at_least);
    }
  }
  return found;
}

void EachExpr(Definition& definition, const std::function<void(Expr&)>& look) {
  for (const Field& field : FieldsOf(definition)) look(*field.expr);
}

void AddNames(const Expr& expr, std::set<std::string>& names) {
  const bool is_name = expr.kind == Expr::Kind::kCall || expr.kind == Expr::Kind::kName;
  if (is_name) names.insert(expr.text);
  for (const Expr& arg : expr.args) AddNames(arg, names);
}

}  // namespace prehend::grammar::ast
