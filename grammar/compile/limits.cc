// SPDX-License-Identifier: Apache-2.0
#include "grammar/compile/limits.h"

#include <algorithm>
#include <deque>
#include <set>

#include "grammar/compile/compile.h"
#include "grammar/compile/mistakes.h"
#include "grammar/language/limits.h"

namespace prehend::grammar {
namespace {

std::set<std::string> DefinesIn(const std::deque<Source>& sources) {
  std::set<std::string> names;
  for (const Source& source : sources)
    for (const ast::Define& define : source.file.defines) names.insert(define.name);
  return names;
}

/// The names of what the rule is made of, its own among them. What is `otherwise` is made of all
/// others of its file.
std::set<std::string> MadeOf(const std::string& rule, const std::deque<Source>& sources) {
  std::set<std::string> all = {rule};
  for (std::size_t before = 0; before != all.size();) {
    before = all.size();
    for (const Source& source : sources) {
      for (const ast::Define& define : source.file.defines)
        if (all.contains(define.name)) ast::AddNames(define.body, all);
      for (const ast::Definition& definition : source.file.definitions) {
        if (!all.contains(definition.name)) continue;
        ast::EachExpr(definition, [&](const ast::Expr& expr) { ast::AddNames(expr, all); });
        if (definition.form != ast::Definition::Form::kOtherwise) continue;
        for (const ast::Definition& other : source.file.definitions) all.insert(other.name);
      }
    }
  }
  return all;
}

}  // namespace

std::vector<Limit> LimitsOf(const Program& program, const std::string& rule) {
  std::vector<Limit> limits;
  Recompile(program, [&](std::deque<Source>& sources) {
    const std::set<std::string> names = MadeOf(rule, sources), defines = DefinesIn(sources);
    for (Source& source : sources) {
      for (const ast::FoundLimit& found : ast::FindLimits(source.file, defines)) {
        if (!names.contains(found.owner)) continue;
        Limit limit{found.owner, found.clause,           source.text.file,
                    found.place, found.number->quantity, found.is_count};
        if (limit.clause.starts_with("(") && limit.clause.ends_with(")"))
          limit.clause = limit.clause.substr(1, limit.clause.size() - 2);
        if (found.number->kind == ast::Expr::Kind::kName) {
          const auto param =
              std::ranges::find(program.params, found.number->text, &ProgramParam::name);
          if (param == program.params.end()) continue;
          limit.value = param->value;
        }
        if (limit.value.value != 0) limits.push_back(std::move(limit));
      }
    }
  });
  return limits;
}

std::shared_ptr<const Program> WithLimit(const Program& program, const std::string& rule,
                                         const Limit& limit, double value) {
  const auto edit = [&](std::deque<Source>& sources) {
    const std::set<std::string> names = MadeOf(rule, sources), defines = DefinesIn(sources);
    for (Source& source : sources) {
      source.file.laws.clear();
      const auto is_other = [&](const auto& one) { return !names.contains(one.name); };
      std::erase_if(source.file.defines, is_other);
      std::erase_if(source.file.definitions, is_other);
      for (ast::Definition& definition : source.file.definitions)
        definition.is_event |= definition.name == rule;
      if (source.text.file != limit.file) continue;
      for (const ast::FoundLimit& found : ast::FindLimits(source.file, defines)) {
        if (found.place.line != limit.place.line || found.place.column != limit.place.column)
          continue;
        found.number->kind = ast::Expr::Kind::kQuantity;
        found.number->quantity = {value, limit.value.dimension};
      }
    }
  };
  return Recompile(program, edit).program;
}

}  // namespace prehend::grammar
