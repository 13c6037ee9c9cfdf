// SPDX-License-Identifier: Apache-2.0
#include "grammar/other_numbers.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "grammar/compile/compile.h"
#include "grammar/compile/mistakes.h"
#include "grammar/language/limits.h"
#include "grammar/program/program.h"

namespace prehend::grammar {
namespace {

using Names = std::set<std::string>;

/// What each rule and definition names. What is `otherwise` names all others of its file.
std::map<std::string, Names> NamedIn(std::deque<Source>& sources) {
  std::map<std::string, Names> named;
  for (Source& source : sources) {
    for (const ast::Define& define : source.file.defines)
      ast::AddNames(define.body, named[define.name]);
    for (ast::Definition& definition : source.file.definitions) {
      Names& names = named[definition.name];
      ast::EachExpr(definition, [&](const ast::Expr& expr) { ast::AddNames(expr, names); });
      if (definition.form != ast::Definition::Form::kOtherwise) continue;
      for (const ast::Definition& other : source.file.definitions) names.insert(other.name);
    }
  }
  return named;
}

void Rename(ast::Expr& expr, const Names& names, const std::string& ending) {
  const bool is_name = expr.kind == ast::Expr::Kind::kCall || expr.kind == ast::Expr::Kind::kName;
  if (is_name && names.contains(expr.text)) expr.text += ending;
  for (ast::Expr& arg : expr.args) Rename(arg, names, ending);
}

}  // namespace

struct OtherNumbers::State {
  const Program& program;
  std::deque<Source> sources;  ///< of the rule and what it uses
  std::map<std::string, Names> named = {};
  Names defines = {};
  std::vector<Limit> limits = {};
  std::vector<ast::Expr*> numbers = {};  ///< by limit
  bool is_otherwise = false;             ///< there is a rule that depends on which others there are

  /// These names, and what they are made of.
  Names MadeOf(Names all) const {
    std::vector<std::string> open(all.begin(), all.end());
    while (!open.empty()) {
      const auto names = named.find(open.back());
      open.pop_back();
      if (names == named.end()) continue;
      for (const std::string& name : names->second)
        if (all.insert(name).second) open.push_back(name);
    }
    return all;
  }

  /// With this value, does what is asked.
  template <typename Do>
  auto Replaced(std::size_t limit, double value, const Do& act) {
    ast::Expr& number = *numbers[limit];
    const auto kind = std::exchange(number.kind, ast::Expr::Kind::kQuantity);
    const Quantity before = std::exchange(number.quantity, {value, limits[limit].value.dimension});
    auto done = act();
    number.kind = kind;
    number.quantity = before;
    return done;
  }

  /// The rules that have the limit in their own text or in that of definitions, and whatever else
  /// of what they are made of has it.
  Names Holders(const std::string& owner) const {
    Names holders = {owner};
    for (std::size_t before = 0; before != holders.size() && defines.contains(owner);) {
      before = holders.size();
      const Names so_far = holders;
      for (const auto& [name, names] : named) {
        const bool by_definition = std::ranges::any_of(names, [&](const std::string& used) {
          return so_far.contains(used) && defines.contains(used);
        });
        if (by_definition) holders.insert(name);
      }
    }
    Names all;
    for (const std::string& name : MadeOf(holders))
      if (named.contains(name) && MadeOf({name}).contains(owner)) all.insert(name);
    return all;
  }
};

OtherNumbers::OtherNumbers(const Program& program, const std::string& rule)
    : state_(new State{.program = program, .sources = SourcesOf(program)}) {
  State& s = *state_;
  s.named = NamedIn(s.sources);
  const Names names = s.MadeOf({rule});
  const auto is_other = [&](const auto& one) { return !names.contains(one.name); };
  for (Source& source : s.sources) {
    for (const ast::Define& define : source.file.defines) s.defines.insert(define.name);
    source.file.laws.clear();
    std::erase_if(source.file.defines, is_other);
    std::erase_if(source.file.definitions, is_other);
    for (ast::Definition& definition : source.file.definitions) {
      definition.is_event |= definition.name == rule;
      s.is_otherwise |= definition.form == ast::Definition::Form::kOtherwise;
    }
  }
  std::erase_if(s.named, [&](const auto& one) { return !names.contains(one.first); });
  for (Source& source : s.sources) {
    for (const ast::FoundLimit& found : ast::FindLimits(source.file, s.defines)) {
      Limit limit{found.owner, found.clause,           source.text.file,
                  found.place, found.number->quantity, found.is_count};
      if (limit.clause.starts_with("(") && limit.clause.ends_with(")"))
        limit.clause = limit.clause.substr(1, limit.clause.size() - 2);
      if (found.number->kind == ast::Expr::Kind::kName) {
        const auto param =
            std::ranges::find(program.params, found.number->text, &ProgramParam::name);
        if (param == program.params.end()) continue;
        limit.value = param->value;
        limit.param = param->name;
      }
      if (limit.value.value == 0) continue;
      s.limits.push_back(std::move(limit));
      s.numbers.push_back(found.number);
    }
  }
}

OtherNumbers::~OtherNumbers() = default;

const std::vector<Limit>& OtherNumbers::limits() const { return state_->limits; }

std::shared_ptr<const Program> OtherNumbers::With(std::size_t limit, double value) {
  return state_->Replaced(limit, value,
                          [&] { return Recompile(state_->program, state_->sources).program; });
}

std::shared_ptr<const Program> OtherNumbers::Side(std::span<const Trial> trials) {
  State& s = *state_;
  if (s.is_otherwise) return nullptr;
  std::deque<Source> sources;
  std::map<std::string, Names> holders;  // by owner
  Names copied, used;
  for (const Trial& trial : trials) {
    const std::string& owner = s.limits[trial.limit].owner;
    const auto [found, is_new] = holders.try_emplace(owner);
    if (is_new) found->second = s.Holders(owner);
    if (is_new) used.merge(s.MadeOf(found->second));
  }
  for (const Source& source : s.sources) {
    Source& kept = sources.emplace_back(source);
    std::erase_if(kept.file.defines, [&](const auto& one) { return !used.contains(one.name); });
    std::erase_if(kept.file.definitions, [&](const auto& one) { return !used.contains(one.name); });
  }
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Names& names = holders[s.limits[trials[i].limit].owner];
    const std::string ending = "~" + std::to_string(i);
    s.Replaced(trials[i].limit, trials[i].value, [&] {
      for (std::size_t file = 0; file < sources.size(); ++file) {
        for (const ast::Define& define : s.sources[file].file.defines) {
          if (!names.contains(define.name)) continue;
          ast::Define& copy = sources[file].file.defines.emplace_back(define);
          copy.name += ending;
          Rename(copy.body, names, ending);
        }
        for (const ast::Definition& definition : s.sources[file].file.definitions) {
          if (!names.contains(definition.name)) continue;
          ast::Definition& copy = sources[file].file.definitions.emplace_back(definition);
          copy.name += ending;
          copy.is_event = true;
          ast::EachExpr(copy, [&](ast::Expr& expr) { Rename(expr, names, ending); });
        }
      }
      return true;
    });
  }
  return Recompile(s.program, sources).program;
}

}  // namespace prehend::grammar
