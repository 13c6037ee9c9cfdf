// SPDX-License-Identifier: Apache-2.0
// Grammar files -> Program: reads includes, collects parameters and heads, lowers every definition,
// orders the rules so that each follows those it refers to, picks each rule's guard, and checks all
// ids.
#include "grammar/compile/compile.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <set>

#include "grammar/analysis/analyze_dependencies.h"
#include "grammar/compile/lower.h"
#include "grammar/compile/mistakes.h"
#include "grammar/language/parser.h"
#include "grammar/program/program.h"

namespace prehend::grammar {
namespace {

using ast::Definition;

constexpr std::size_t kMaxFiles = 64;
constexpr std::size_t kMaxRules = 1000;

class Compiler {
 public:
  Compiler(const GrammarText& grammar, const Includer& includer, const Overrides& overrides,
           const std::vector<std::string>& known)
      : includer_(includer), overrides_(overrides), known_(known) {
    symbols_.who_defines = WhoDefines(includer, known);
    Read(grammar);
  }

  /// Of a program that was compiled before: its texts as they were edited.
  Compiler(const Program& before, std::deque<Source>& edited, const Includer& includer)
      : includer_(includer), overrides_(before.texts->overrides), sources_(edited) {
    program_.name = before.name;
    program_.text_hash = before.text_hash;
    program_.texts = before.texts;
  }

  std::deque<Source> TakeSources() { return std::move(sources_); }

  CompileResult Run() {
    if (!program_.texts) program_.texts = std::make_shared<const ProgramTexts>(std::move(texts_));
    CollectParams();
    ApplySettings();
    ApplyOverrides();
    CollectHeads();
    CollectDefines();
    CheckLawHeads();
    CheckDefines();
    LowerAll();
    if (diagnostics_.empty()) Order();
    if (!diagnostics_.empty()) return {.diagnostics = InOrder(std::move(diagnostics_), symbols_)};
    RequireSight(program_);
    ChooseGuards(program_);
    warnings_ = std::move(symbols_.warnings);
    WarnOfUnused(sources_.back(), symbols_, warnings_);
    program_.warnings = warnings_;
    CheckIds(program_);
    return {.program = std::make_shared<const Program>(std::move(program_)),
            .warnings = std::move(warnings_)};
  }

 private:
  void Complain(const Source& source, Place place, std::string message, std::string hint = {}) {
    if (diagnostics_.size() >= kMostDiagnostics) return;
    diagnostics_.push_back(DiagnosticAt(source.text.file, source.text.text, place,
                                        std::move(message), std::move(hint)));
  }

  // The grammar and everything it uses, each once, what is used first.
  void Read(const GrammarText& grammar) {
    std::set<std::string, std::less<>> seen;
    texts_ = {.grammar = grammar, .used = {}, .overrides = overrides_};
    ReadFile(grammar, seen);
    if (!sources_.empty()) program_.name = sources_.back().file.name;
  }

  void ReadFile(const GrammarText& grammar, std::set<std::string, std::less<>>& seen) {
    Source source{grammar, Parse(grammar, diagnostics_)};
    symbols_.broken.merge(source.file.broken);
    symbols_.is_incomplete |= source.file.is_incomplete;
    seen.insert({source.file.name, grammar.file});
    for (const ast::Use& use : source.file.uses) {
      if (use.is_path && !CheckPath(source, use)) continue;
      std::string name = use.is_path ? Beside(grammar.file, use.name) : use.name;
      if (!use.variant.empty()) {
        name += "_from_" + use.variant;
        const auto [stands_for, is_new] = variants_.try_emplace(use.name, name);
        if (seen.contains(use.name) && (is_new || stands_for->second != name)) {
          Complain(source, use.place,
                   "'" + use.name + "' was used before, and '" + use.name + " from " + use.variant +
                       "' is to take its place",
                   "write this line above all others that use " + use.name);
          continue;
        }
        seen.insert(use.name);
      }
      if (!seen.insert(name).second) continue;
      if (seen.size() > kMaxFiles) {
        Complain(source, use.place,
                 "more than " + std::to_string(kMaxFiles) + " grammars are used together");
        break;
      }
      const std::optional<GrammarText> used = includer_ ? includer_(name) : std::nullopt;
      if (!used) {
        Complain(source, use.place,
                 "there is no grammar '" + (use.variant.empty() ? use.name : name) + "' to use",
                 use.is_path ? "looked for " + name : DidYouMean(name, known_));
        symbols_.is_incomplete = true;
      } else {
        texts_.used.try_emplace(name, *used);
        ReadFile(*used, seen);
      }
    }
    program_.text_hash = 31 * program_.text_hash + std::hash<std::string>()(source.text.text);
    sources_.push_back(std::move(source));
  }

  // A path is seen from the file that names it, and leads to a file of the same folder or below.
  bool CheckPath(const Source& source, const ast::Use& use) {
    const bool climbs =
        use.name.starts_with("/") || ("/" + use.name + "/").find("/../") != std::string::npos;
    if (!climbs && use.name.ends_with(".grammar")) return true;
    Complain(source, use.place, "\"" + use.name + "\" is not a file beside this one",
             "a relative path that ends with .grammar and does not climb: use "
             "\"shared/pouring.grammar\"");
    return false;
  }

  static std::string Beside(const std::string& file, const std::string& path) {
    const std::size_t slash = file.rfind('/');
    return file.substr(0, slash == std::string::npos ? 0 : slash + 1) +
           path.substr(path.starts_with("./") ? 2 : 0);
  }

  void CollectParams() {
    for (const Source& source : sources_) {
      symbols_.files.try_emplace(source.text.file, static_cast<int>(symbols_.files.size()));
      for (const ast::Param& param : source.file.params) {
        const auto [entry, is_new] =
            symbols_.params.try_emplace(param.name, static_cast<int>(program_.params.size()));
        if (!is_new) {
          const ProgramParam& first = program_.params[entry->second];
          Complain(source, param.place, "the parameter '" + param.name + "' is defined twice",
                   FirstAt(first.file, first.place));
          continue;
        }
        program_.params.push_back({.name = param.name,
                                   .value = param.value,
                                   .file = source.text.file,
                                   .place = param.place});
      }
    }
  }

  // What a file says of the parameters of those that it uses. The file that uses others is read
  // after them, so its word is the last.
  void ApplySettings() {
    for (const Source& source : sources_) {
      std::set<std::string> names;
      for (const ast::Use& use : source.file.uses) {
        for (const ast::Param& setting : use.settings) {
          ApplySetting(source, setting);
          if (!names.insert(setting.name).second)
            Complain(source, setting.place, "'" + setting.name + "' is set twice in this file");
        }
      }
    }
  }

  void ApplySetting(const Source& source, const ast::Param& setting) {
    const auto found = symbols_.params.find(setting.name);
    const bool is_own =
        found != symbols_.params.end() && program_.params[found->second].file == source.text.file;
    if (found == symbols_.params.end() && symbols_.IsExcused(setting.name)) return;
    if (found == symbols_.params.end() || is_own) {
      std::vector<std::string> names;
      for (const auto& [name, index] : symbols_.params) {
        if (program_.params[index].file != source.text.file) names.push_back(name);
      }
      return Complain(source, setting.place,
                      "no grammar that is used has a parameter '" + setting.name + "'",
                      DidYouMean(setting.name, names));
    }
    ProgramParam& param = program_.params[found->second];
    if (!(setting.value.dimension == param.value.dimension)) {
      return Complain(source, setting.place,
                      "'" + setting.name + "' is in " + DimensionText(param.value.dimension) +
                          ", this is " + DimensionText(setting.value.dimension),
                      "its value in " + param.file + " is " + QuantityText(param.value));
    }
    param.value = setting.value;
  }

  static std::string FirstAt(const std::string& file, Place place) {
    return "the first one is at " + file + ":" + std::to_string(place.line) + ":" +
           std::to_string(place.column);
  }

  void ApplyOverrides() {
    for (const auto& [name, value] : overrides_) {
      const GrammarText text{"parameter " + name, value};
      const auto complain = [&](std::string message, std::string hint) {
        diagnostics_.push_back(
            DiagnosticAt(text.file, text.text, {1, 1}, std::move(message), std::move(hint)));
      };
      const auto found = symbols_.params.find(name);
      if (found == symbols_.params.end()) {
        if (symbols_.IsExcused(name)) continue;
        std::vector<std::string> names;
        for (const auto& [known, index] : symbols_.params) names.push_back(known);
        complain("the grammar has no parameter '" + name + "'", DidYouMean(name, names));
        continue;
      }
      const std::optional<Quantity> quantity = ParseQuantity(text, diagnostics_);
      if (!quantity) continue;
      ProgramParam& param = program_.params[found->second];
      if (!(quantity->dimension == param.value.dimension)) {
        complain("'" + name + "' is in " + DimensionText(param.value.dimension) + ", this is " +
                     DimensionText(quantity->dimension),
                 "its value in the grammar is " + QuantityText(param.value));
        continue;
      }
      param.value = *quantity;
      param.overridden = true;
    }
  }

  void CollectHeads() {
    program_.rules.push_back({.name = "touching",
                              .roles = {{"a", "Entity"}, {"b", "Entity"}},
                              .symmetric = true,
                              .of_form = TouchingRule()});
    for (const Source& source : sources_) {
      for (const Definition& definition : source.file.definitions) CollectHead(source, definition);
    }
  }

  void CollectHead(const Source& source, const Definition& definition) {
    const RuleId index = program_.rules.end_id();
    if (program_.rules.size() > kMaxRules) {
      if (program_.rules.size() == kMaxRules + 1)
        Complain(source, definition.place, "the grammar has more than 1000 rules");
      return;
    }
    if (IsBuiltin(definition.name)) {
      return Complain(source, definition.place, "'" + definition.name + "' is a built-in signal",
                      "choose another name");
    }
    const auto [entry, is_new] = symbols_.rules.try_emplace(definition.name, index);
    if (!is_new) {
      const Rule& first = program_.rules[entry->second];
      return Complain(source, definition.place, "'" + definition.name + "' is defined twice",
                      FirstAt(first.file, first.place));
    }
    Rule rule{.name = definition.name, .file = source.text.file, .place = definition.place};
    rule.printed = definition.is_event;
    rule.symmetric = definition.symmetric;
    rule.of_form = FormOf(definition);  // others must know before it is lowered
    if (definition.form == Definition::Form::kRepeat && definition.gap)
      rule.As<WhileRule>().at_least = 1;
    const std::size_t before = diagnostics_.size();
    CheckRoles(source, definition.roles, definition.is_event);
    CheckSymmetry(source, definition);
    if (diagnostics_.size() != before) {
      symbols_.rules.erase(definition.name);
      symbols_.broken.insert(definition.name);
      return;
    }
    for (const ast::Role& role : definition.roles)
      rule.roles.push_back({role.name, role.class_name});
    program_.rules.push_back(std::move(rule));
    definitions_.push_back({&source, &definition});
    if (definition.form == Definition::Form::kOtherwise) symbols_.otherwise.insert(index);
  }

  static RuleForm FormOf(const Definition& definition) {
    switch (definition.form) {
      case Definition::Form::kRepeat:
        if (!definition.gap) break;
        return WhileRule();
      case Definition::Form::kWhile:
      case Definition::Form::kOtherwise:
        return WhileRule();
      case Definition::Form::kFromTo:
        return FromToRule();
      case Definition::Form::kUntilSince:
        return UntilSinceRule();
      case Definition::Form::kRestOf:
        return RestOfRule();
      case Definition::Form::kCompose:
        break;
    }
    return ComposeRule();
  }

  static bool IsBuiltin(std::string_view name) {
    return FindBuiltin(name) != nullptr || name == "is" || IsOverInterval(name);
  }

  void CollectDefines() {
    for (const Source& source : sources_) {
      for (const ast::Define& define : source.file.defines) {
        const auto rule = symbols_.rules.find(define.name);
        if (rule != symbols_.rules.end() &&
            IsLater(program_.rules[rule->second].file, source.text.file)) {
          const Located& located = definitions_[rule->second.index() - 1];
          Complain(*located.source, located.definition->place,
                   "'" + define.name + "' is defined twice",
                   FirstAt(source.text.file, define.place));
          symbols_.rules.erase(rule);
          symbols_.defines.try_emplace(define.name, DefineSource{&source.text, &define});
        } else if (IsBuiltin(define.name)) {
          Complain(source, define.place, "'" + define.name + "' means something already",
                   "it is built in; choose another name");
        } else if (rule != symbols_.rules.end()) {
          const Located& first = definitions_[rule->second.index() - 1];
          Complain(source, define.place, "'" + define.name + "' is defined twice",
                   FirstAt(first.source->text.file, first.definition->place));
        } else if (symbols_.IsParamIn(source.text.file, define.name)) {
          Complain(source, define.place, "'" + define.name + "' means something already",
                   "it is a parameter; choose another name");
        } else if (const auto [first, is_new] = symbols_.defines.try_emplace(
                       define.name, DefineSource{&source.text, &define});
                   !is_new) {
          Complain(source, define.place, "'" + define.name + "' is defined twice",
                   FirstAt(first->second.text->file, first->second.define->place));
        }
        const std::size_t before = diagnostics_.size();
        CheckParameters(source, define);
        if (diagnostics_.size() == before) continue;
        symbols_.broken.insert(define.name);
        symbols_.defines.erase(define.name);
      }
    }
    CheckParamsAgainstDefines();
  }

  // Of two definitions with the same name, the later one is reported.
  void CheckParamsAgainstDefines() {
    for (const Source& source : sources_) {
      for (const ast::Param& param : source.file.params) {
        const auto define = symbols_.defines.find(param.name);
        if (define == symbols_.defines.end() ||
            !IsLater(source.text.file, define->second.text->file))
          continue;
        Complain(source, param.place, "'" + param.name + "' is defined twice",
                 FirstAt(define->second.text->file, define->second.define->place));
      }
    }
  }

  // Nothing refers to a law, so only another law's name is in its way.
  void CheckLawHeads() {
    std::map<std::string, std::string, std::less<>> laws;  // name -> where the first one is
    for (const Source& source : sources_) {
      for (const ast::Law& law : source.file.laws) {
        const auto [first, is_new] =
            laws.try_emplace(law.name, FirstAt(source.text.file, law.place));
        if (!is_new)
          Complain(source, law.place, "the law '" + law.name + "' is defined twice", first->second);
        const std::size_t before = diagnostics_.size();
        CheckRoles(source, law.roles);
        if (diagnostics_.size() != before) broken_laws_.insert(&law);
      }
    }
  }

  bool IsLater(const std::string& file, const std::string& other) const {
    return symbols_.files.find(file)->second > symbols_.files.find(other)->second;
  }

  void CheckParameters(const Source& source, const ast::Define& define) {
    std::set<std::string> names;
    for (const ast::Role& parameter : define.parameters) {
      if (!names.insert(parameter.name).second) {
        Complain(source, parameter.place, "the parameter '" + parameter.name + "' is named twice");
      }
      if (symbols_.IsParamIn(source.text.file, parameter.name)) {
        Complain(source, parameter.place,
                 "'" + parameter.name + "' is a parameter of the grammar already");
      }
      if (parameter.class_name == "number" || parameter.class_name == "position") continue;
      std::vector<std::string> others = UnitNames();
      others.insert(others.end(), {"number", "position"});
      CheckClassName(source, parameter, others);
    }
  }

  // Each body for itself, on a copy of the heads, with the widest entities that it allows.
  void CheckDefines() {
    Program scratch = program_;
    for (const auto& [name, source] : symbols_.defines) {
      Symbols symbols{.program = scratch,
                      .rules = symbols_.rules,
                      .params = symbols_.params,
                      .files = symbols_.files,
                      .defines = symbols_.defines,
                      .broken = symbols_.broken,
                      .is_incomplete = symbols_.is_incomplete,
                      .who_defines = symbols_.who_defines};
      scratch.rules.resize(program_.rules.size());
      scratch.nodes.clear();
      const RuleId body = scratch.rules.push_back({});
      const std::size_t before = diagnostics_.size();
      Rule& rule = scratch.rules[body];
      rule.place = source.define->place;
      for (const ast::Role& parameter : source.define->parameters) {
        if (parameter.class_name != "number" && parameter.class_name != "position") {
          rule.roles.push_back({parameter.name, parameter.class_name});
        }
      }
      Lowering(symbols, body, *source.text, diagnostics_).Check(source);
      symbols_.used_params.merge(symbols.used_params);
      symbols_.broken.merge(symbols.broken);
      if (diagnostics_.size() != before) symbols_.broken.insert(name);
    }
    std::erase_if(symbols_.defines,
                  [this](const auto& define) { return symbols_.broken.contains(define.first); });
  }

  void CheckRoles(const Source& source, const std::vector<ast::Role>& roles, bool printed = false) {
    static const std::set<std::string_view> kOfGoldens = {"tolerance", "because", "oracle",
                                                          "accepted",  "spread",  "open_end"};
    if (roles.size() > kMaxRoles) {
      Complain(source, roles[kMaxRoles].place, "more than " + std::to_string(kMaxRoles) + " roles");
    }
    std::set<std::string> names;
    for (const ast::Role& role : roles) {
      if (!names.insert(role.name).second)
        Complain(source, role.place, "the role '" + role.name + "' is named twice");
      if (printed && kOfGoldens.contains(role.name))
        Complain(source, role.place,
                 "'" + role.name + "' means something in goldens and cannot be a role of an event",
                 "choose another name");
      if (symbols_.IsParamIn(source.text.file, role.name)) {
        Complain(source, role.place, "'" + role.name + "' is a parameter and cannot be a role too",
                 "call one of them otherwise");
      }
      CheckClassName(source, role);
    }
  }

  void CheckSymmetry(const Source& source, const Definition& definition) {
    if (!definition.symmetric) return;
    if (definition.roles.size() < 2 ||
        definition.roles[0].class_name != definition.roles[1].class_name) {
      Complain(source, definition.place,
               "the first two roles of a symmetric event are of the same class");
    }
  }

  // `hand: hand` is meant to be `hand: Hand`; other unknown names may be classes of a scenario.
  void CheckClassName(const Source& source, const ast::Role& role,
                      std::vector<std::string> known = {}) {
    if (StartsWithCapital(role.class_name)) {
      NoteClass(program_, role.class_name, source.text.file, role.place);
    } else {
      known.insert(known.end(), BuiltinClasses().begin(), BuiltinClasses().end());
      Complain(source, role.place,
               "'" + role.class_name + "' is not a class; classes start with a capital letter",
               DidYouMean(role.class_name, known));
    }
  }

  void LowerAll() {
    for (std::size_t i = 0; i < definitions_.size(); ++i) {
      LowerDefinition(*definitions_[i].source, *definitions_[i].definition, RuleId(i + 1));
    }
    for (const Source& source : sources_) {
      for (const ast::Law& written : source.file.laws) {
        if (broken_laws_.contains(&written)) continue;
        std::optional<Law> law = LowerLaw(symbols_, source.text, written, diagnostics_);
        if (law) program_.laws.push_back(std::move(*law));
      }
    }
    if (program_.rules.size() == 1 && diagnostics_.empty()) {
      Complain(sources_.back(), {1, 1}, "the grammar defines no event",
               "for example: event held(hand: Hand, "
               "object: Thing) while sensor_sets(hand, object) >= 2");
    }
  }

  void LowerDefinition(const Source& source, const Definition& definition, RuleId index) {
    Lowering lowering(symbols_, index, source.text, diagnostics_);
    const std::size_t before = diagnostics_.size();
    LowerDefinitionInto(program_, index, definition, lowering);
    if (diagnostics_.size() != before) return;
    for (std::size_t i = 0; i < definition.roles.size(); ++i) {
      if (!lowering.RoleUsed(i)) {
        Complain(source, definition.roles[i].place,
                 "the role '" + definition.roles[i].name + "' is not used",
                 "an event says something about each of its roles; leave this one out or use it");
      }
    }
  }

  // Depth first; a rule that is met again while its own references are followed refers to itself.
  void Order() {
    enum class Mark { kNew, kOpen, kDone };
    IdVector<RuleId, Mark> marks(program_.rules.size(), Mark::kNew);
    struct Step {
      RuleId rule;
      std::size_t next = 0;
    };
    for (const RuleId root : IdsOf(program_.rules)) {
      std::vector<Step> path;
      if (marks[root] == Mark::kNew) path.push_back({root});
      while (!path.empty()) {
        Step& step = path.back();
        const Rule& rule = program_.rules[step.rule];
        marks[step.rule] = Mark::kOpen;
        if (step.next == rule.references.size()) {
          marks[step.rule] = Mark::kDone;
          program_.schedule.push_back(step.rule);
          path.pop_back();
          continue;
        }
        const RuleId target = rule.references[step.next++].rule;
        if (marks[target] == Mark::kOpen) {
          std::vector<RuleId> circle;
          for (auto link = path.rbegin(); circle.empty() || circle.back() != target; ++link)
            circle.push_back(link->rule);
          return ComplainCycle({circle.rbegin(), circle.rend()});
        }
        if (marks[target] == Mark::kNew) path.push_back({target});
      }
    }
  }

  // Rules that each use the next one, and the last one the first; those that the compiler made
  // are left out.
  void ComplainCycle(std::vector<RuleId> circle) {
    std::erase_if(circle, [&](RuleId rule) { return program_.rules[rule].hidden; });
    const Rule& first = program_.rules[circle.front()];
    std::string hint;
    for (std::size_t i = 0; circle.size() > 1 && i < circle.size(); ++i) {
      hint += (i == 0 ? "" : ", ") + program_.rules[circle[i]].name + " uses " +
              program_.rules[circle[(i + 1) % circle.size()]].name;
    }
    Complain(*definitions_[circle.front().index() - 1].source, first.place,
             "'" + first.name + "' refers to itself",
             hint.empty() ? "a rule may only use rules that do not use it" : hint);
  }

  const Includer& includer_;
  const Overrides& overrides_;
  const std::vector<std::string> known_;
  Diagnostics diagnostics_;
  Diagnostics warnings_;
  std::deque<Source> read_;
  std::deque<Source>& sources_ = read_;
  ProgramTexts texts_;
  std::set<const ast::Law*> broken_laws_;
  std::map<std::string, std::string> variants_;  // `use name from ..`: what stands for the name
  struct Located {
    const Source* source;
    const Definition* definition;
  };
  std::vector<Located> definitions_;  // definition i is rule i + 1
  Program program_;
  Symbols symbols_{program_, {}, {}, {}, {}, {}, {}, {}, {}, {}};
};

}  // namespace

CompileResult Compile(const GrammarText& grammar, const Includer& includer,
                      const Overrides& overrides, const std::vector<std::string>& known) {
  return Compiler(grammar, includer, overrides, known).Run();
}

std::deque<Source> SourcesOf(const Program& program) {
  const ProgramTexts& texts = *program.texts;
  const Includer includer = [&](std::string_view name) -> std::optional<GrammarText> {
    const auto found = texts.used.find(name);
    if (found == texts.used.end()) return std::nullopt;
    return found->second;
  };
  return Compiler(texts.grammar, includer, texts.overrides, {}).TakeSources();
}

CompileResult Recompile(const Program& program, std::deque<Source>& sources) {
  return Compiler(program, sources, nullptr).Run();
}

}  // namespace prehend::grammar
