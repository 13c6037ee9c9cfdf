// SPDX-License-Identifier: Apache-2.0
// Grammar files -> Program: reads includes, collects parameters and heads, lowers every definition, orders the
// rules so that each follows those it refers to, and picks each rule's guard.
// Tested by tests/grammar/compile_test.cc
#include <algorithm>
#include <deque>
#include <set>

#include "grammar/guard.h"
#include "grammar/lower.h"
#include "grammar/monitor.h"
#include "grammar/parser.h"

namespace prehend::grammar {
namespace {

using ast::Definition;

constexpr std::size_t kMaxFiles = 64;
constexpr std::size_t kMaxRules = 1000;

struct Source {
  GrammarText text;
  ast::File file;
};

class Compiler {
 public:
  Compiler(const GrammarText& grammar, const Includer& includer, const Overrides& overrides)
      : includer_(includer), overrides_(overrides) {
    Read(grammar);
  }

  CompileResult Run() {
    CollectParams();
    ApplyOverrides();
    CollectHeads();
    if (diagnostics_.empty()) LowerAll();
    if (diagnostics_.empty()) Order();
    if (!diagnostics_.empty()) return {.program = nullptr, .diagnostics = std::move(diagnostics_)};
    ChooseGuards(program_);
    return {.program = std::make_shared<const Program>(std::move(program_)), .diagnostics = {}};
  }

 private:
  void Complain(const Source& source, Place place, std::string message, std::string hint = {}) {
    diagnostics_.push_back(
        DiagnosticAt(source.text.file, source.text.text, place, std::move(message), std::move(hint)));
  }

  // The grammar and everything it uses, each once, what is used first.
  void Read(const GrammarText& grammar) {
    std::set<std::string, std::less<>> seen;
    ReadFile(grammar, seen);
    if (!sources_.empty()) program_.name = sources_.back().file.name;
  }

  void ReadFile(const GrammarText& grammar, std::set<std::string, std::less<>>& seen) {
    Source source{grammar, Parse(grammar, diagnostics_)};
    seen.insert(source.file.name);
    for (const ast::Use& use : source.file.uses) {
      if (!seen.insert(use.name).second) continue;
      if (seen.size() > kMaxFiles) {
        Complain(source, use.place, "more than " + std::to_string(kMaxFiles) + " grammars are used together");
        break;
      }
      const std::optional<GrammarText> used = includer_ ? includer_(use.name) : std::nullopt;
      if (!used) {
        Complain(source, use.place, "there is no grammar '" + use.name + "' to use");
      } else {
        ReadFile(*used, seen);
      }
    }
    sources_.push_back(std::move(source));
  }

  void CollectParams() {
    for (const Source& source : sources_) {
      for (const ast::Param& param : source.file.params) {
        const auto [entry, is_new] = symbols_.params.try_emplace(param.name, static_cast<int>(program_.params.size()));
        if (!is_new) {
          const ProgramParam& first = program_.params[entry->second];
          Complain(source, param.place, "the parameter '" + param.name + "' is defined twice", FirstAt(first.file, first.place));
          continue;
        }
        program_.params.push_back(
            {.name = param.name, .value = param.value, .file = source.text.file, .place = param.place});
      }
    }
  }

  static std::string FirstAt(const std::string& file, Place place) {
    return "the first one is at " + file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
  }

  void ApplyOverrides() {
    for (const auto& [name, value] : overrides_) {
      const GrammarText text{"parameter " + name, value};
      const auto complain = [&](std::string message, std::string hint) {
        diagnostics_.push_back(DiagnosticAt(text.file, text.text, {1, 1}, std::move(message), std::move(hint)));
      };
      const auto found = symbols_.params.find(name);
      if (found == symbols_.params.end()) {
        std::vector<std::string> names;
        for (const auto& [known, index] : symbols_.params) names.push_back(known);
        const std::string near = NearestName(name, names);
        complain("the grammar has no parameter '" + name + "'", near.empty() ? "" : "did you mean '" + near + "'?");
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
    program_.events.push_back({.name = "touching",
                               .roles = {{"a", "Entity"}, {"b", "Entity"}},
                               .form = Form::kTouching,
                               .symmetric = true});
    for (const Source& source : sources_) {
      for (const Definition& definition : source.file.definitions) CollectHead(source, definition);
    }
    if (program_.events.size() == 1 && diagnostics_.empty()) {
      Complain(sources_.back(), {1, 1}, "the grammar defines no event", "for example: event held(hand: Hand, "
               "object: Thing) while sensor_sets(hand, object) >= 2");
    }
  }

  void CollectHead(const Source& source, const Definition& definition) {
    const int index = static_cast<int>(program_.events.size());
    if (program_.events.size() > kMaxRules) {
      if (program_.events.size() == kMaxRules + 1) Complain(source, definition.place, "the grammar has more than 1000 rules");
      return;
    }
    if (FindBuiltin(definition.name) != nullptr || definition.name == "is" || definition.name == "displacement" ||
        definition.name == "rise" || definition.name == "drop") {
      return Complain(source, definition.place, "'" + definition.name + "' is a built-in signal", "choose another name");
    }
    const auto [entry, is_new] = symbols_.rules.try_emplace(definition.name, index);
    if (!is_new) {
      const Rule& first = program_.events[entry->second];
      return Complain(source, definition.place, "'" + definition.name + "' is defined twice", FirstAt(first.file, first.place));
    }
    Rule rule{.name = definition.name, .file = source.text.file, .place = definition.place};
    rule.printed = definition.is_event;
    rule.symmetric = definition.symmetric;
    CheckRoles(source, definition);
    for (const ast::Role& role : definition.roles) rule.roles.push_back({role.name, role.class_name});
    program_.events.push_back(std::move(rule));
    definitions_.push_back({&source, &definition});
  }

  void CheckRoles(const Source& source, const Definition& definition) {
    if (definition.roles.size() > kMaxRoles) {
      Complain(source, definition.roles[kMaxRoles].place, "more than " + std::to_string(kMaxRoles) + " roles");
    }
    std::set<std::string> names;
    for (const ast::Role& role : definition.roles) {
      if (!names.insert(role.name).second) Complain(source, role.place, "the role '" + role.name + "' is named twice");
      if (symbols_.params.contains(role.name)) {
        Complain(source, role.place, "'" + role.name + "' is a parameter and cannot be a role too");
      }
      CheckClassName(source, role);
    }
    if (!definition.symmetric) return;
    if (definition.roles.size() != 2 || definition.roles[0].class_name != definition.roles[1].class_name) {
      Complain(source, definition.place, "a symmetric event has two roles of the same class");
    }
  }

  // `hand: hand` is meant to be `hand: Hand`; other unknown names may be classes of a scenario.
  void CheckClassName(const Source& source, const ast::Role& role) {
    static const std::vector<std::string> kRoots = {"Entity", "Hand", "Thing", "Movable", "Fixed"};
    if (std::find(kRoots.begin(), kRoots.end(), role.class_name) != kRoots.end()) return;
    const bool capital = role.class_name[0] >= 'A' && role.class_name[0] <= 'Z';
    const std::string near = NearestName(role.class_name, kRoots);
    if (!capital) {
      Complain(source, role.place, "'" + role.class_name + "' is not a class; classes start with a capital letter",
               near.empty() ? "" : "did you mean '" + near + "'?");
    }
  }

  void LowerAll() {
    for (std::size_t i = 0; i < definitions_.size(); ++i) {
      LowerDefinition(*definitions_[i].source, *definitions_[i].definition, static_cast<int>(i) + 1);
    }
  }

  void LowerDefinition(const Source& source, const Definition& definition, int index) {
    Lowering lowering(symbols_, index, source.text, diagnostics_);
    const std::size_t before = diagnostics_.size();
    LowerForm(definition, index, lowering);
    LowerModifiers(definition, index, lowering);
    if (diagnostics_.size() != before) return;
    for (std::size_t i = 0; i < definition.roles.size(); ++i) {
      if (!lowering.RoleUsed(i)) {
        Complain(source, definition.roles[i].place, "the role '" + definition.roles[i].name + "' is not used",
                 "an event says something about each of its roles; leave this one out or use it");
      }
    }
  }

  // Lowering may add rules, so a Rule is looked up again after each step.
  Rule& At(int index) { return program_.events[index]; }

  void LowerForm(const Definition& d, int index, Lowering& lowering) {
    using Form_ = Definition::Form;
    switch (d.form) {
      case Form_::kWhile: {
        At(index).form = Form::kWhile;
        const int first = lowering.Truth(d.first, {});
        At(index).first = first;
        break;
      }
      case Form_::kFromTo: return LowerFromTo(d, index, lowering);
      case Form_::kUntilSince: return LowerUntilSince(d, index, lowering);
      case Form_::kRestOf: {
        At(index).form = Form::kRestOf;
        const int first = lowering.RuleCall(d.first);
        At(index).first = first;
        for (const ast::Expr& other : d.outside) {
          const int reference = lowering.RuleCall(other);
          At(index).outside.push_back(reference);
        }
        break;
      }
      case Form_::kCompose: return LowerCompose(d, index, lowering);
    }
  }

  void LowerFromTo(const Definition& d, int index, Lowering& lowering) {
    At(index).form = Form::kFromTo;
    const int first = lowering.Instant(d.first, {});
    const int second = lowering.Instant(d.second, {.begin = true});
    const int during = d.during ? lowering.Truth(*d.during, {.begin = true}) : kNone;
    Rule& rule = At(index);
    rule.first = first;
    rule.second = second;
    rule.during = during;
    rule.or_drop = d.or_drop;
  }

  void LowerUntilSince(const Definition& d, int index, Lowering& lowering) {
    At(index).form = Form::kUntilSince;
    const int first = lowering.Instant(d.first, {});
    const int second = lowering.Truth(d.second, {.end = true});
    At(index).first = first;
    At(index).second = second;
    if (d.approach) LowerApproach(*d.approach, index, lowering);
    const double back_s = lowering.Constant(d.at_most_back, kSeconds, "'at most .. back'");
    At(index).back_s = back_s;
  }

  void LowerApproach(const ast::Approach& approach, int index, Lowering& lowering) {
    Dimension dimension;
    const int signal = lowering.Signal(approach.signal, {.end = true}, dimension);
    if (signal == kNone) return;
    const double slack = lowering.Constant(approach.slack, dimension, "'receding at most'");
    int motion = kNone;
    Dimension motion_dimension = Quotient(dimension, kSeconds);
    double speed = 0;
    double idle_s = -1;
    if (approach.motion) motion = lowering.Signal(*approach.motion, {.end = true}, motion_dimension);
    if (approach.speed) {
      speed = lowering.Constant(*approach.speed, motion_dimension, "'slower than'");
      idle_s = lowering.Constant(*approach.idle, kSeconds, "'slower than .. at most'");
    }
    Rule& rule = At(index);
    rule.approach = signal;
    rule.slack = slack;
    rule.motion = motion;
    rule.speed = speed;
    rule.idle_s = idle_s;
  }

  void LowerCompose(const Definition& d, int index, Lowering& lowering) {
    At(index).form = Form::kCompose;
    std::vector<std::string> labels;
    if (d.parts.size() > kMaxParts) {
      return lowering.Complain(d.parts[kMaxParts].place, "more than " + std::to_string(kMaxParts) + " parts",
                               "compose some of them into an event of its own");
    }
    for (const ast::Part& part : d.parts) {
      if (std::find(labels.begin(), labels.end(), part.label) != labels.end()) {
        lowering.Complain(part.place, "the label '" + part.label + "' is used twice");
      }
      labels.push_back(part.label);
      const int reference = lowering.RuleCall(part.call);
      if (reference == kNone) continue;
      CheckPart(part, index, reference, lowering);
      At(index).composition.parts.push_back(reference);
    }
    if (labels.size() != At(index).composition.parts.size()) return;
    const auto find = [&](const std::string& label, Place place) {
      const auto found = std::find(labels.begin(), labels.end(), label);
      if (found == labels.end()) {
        const std::string near = NearestName(label, labels);
        lowering.Complain(place, "no part is labelled '" + label + "'", near.empty() ? "" : "did you mean '" + near + "'?");
      }
      return static_cast<int>(found - labels.begin());
    };
    for (const ast::Relation& relation : d.relations) {
      Composition::Clause clause{.left = find(relation.left, relation.place), .right = find(relation.right, relation.place)};
      for (const std::string& name : relation.relations) {
        const std::optional<Allen> allen = AllenNamed(name);
        if (!allen) {
          lowering.Complain(relation.place, "'" + name + "' is none of Allen's relations",
                            "they are " + JoinedAllenNames());
          continue;
        }
        clause.relations |= Bit(*allen);
      }
      At(index).composition.clauses.push_back(clause);
    }
  }

  // All parts are about the same entities: those of the composition.
  void CheckPart(const ast::Part& part, int index, int reference, Lowering& lowering) {
    const Binding& named = At(index).references[reference].roles;
    for (std::size_t role = 0; role < At(index).roles.size(); ++role) {
      if (std::find(named.begin(), named.end(), static_cast<int>(role)) != named.end()) continue;
      lowering.Complain(part.place, "the part '" + part.label + "' does not name the role '" + At(index).roles[role].name + "'",
                        "every part of a composition names all its roles");
    }
  }

  static std::string JoinedAllenNames() {
    std::string text;
    for (const std::string_view name : kAllenNames) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
  }

  void LowerModifiers(const Definition& d, int index, Lowering& lowering) {
    if (d.bridging) {
      if (d.form != Definition::Form::kWhile) {
        lowering.Complain(d.bridging->place, "'bridging' goes with 'while' only", "put the bridged part into a condition of its own");
      }
      const double bridging_s = lowering.Constant(*d.bridging, kSeconds, "'bridging'");
      At(index).bridging_s = bridging_s;
    }
    if (d.lasting) {
      const double lasting_s = lowering.Constant(*d.lasting, kSeconds, "'lasting'");
      At(index).lasting_s = lasting_s;
    }
    if (d.form == Definition::Form::kCompose && (d.requirement || d.confirmed)) {
      lowering.Complain(d.place, "a composition takes no 'requires' and no 'confirmed by'", "put it into one of the parts");
    }
    if (d.requirement) {
      const int requirement = lowering.Truth(*d.requirement, {.begin = true, .end = true});
      At(index).requirement = requirement;
    }
    if (d.confirmed) {
      const int by = lowering.RuleCall(d.confirmed->by);
      const int within = lowering.RuleCall(d.confirmed->within);
      At(index).confirmed_by = by;
      At(index).confirmed_within = within;
    }
    if (d.style) {
      const int role = lowering.HandRole(*d.style);
      At(index).style_role = role;
    }
  }

  // Depth first; a rule that is met again while its own references are followed refers to itself.
  void Order() {
    enum class Mark { kNew, kOpen, kDone };
    std::vector<Mark> marks(program_.events.size(), Mark::kNew);
    struct Step {
      int rule;
      std::size_t next = 0;
    };
    for (std::size_t root = 0; root < program_.events.size(); ++root) {
      std::vector<Step> path;
      if (marks[root] == Mark::kNew) path.push_back({static_cast<int>(root)});
      while (!path.empty()) {
        Step& step = path.back();
        const Rule& rule = program_.events[step.rule];
        marks[step.rule] = Mark::kOpen;
        if (step.next == rule.references.size()) {
          marks[step.rule] = Mark::kDone;
          program_.schedule.push_back(step.rule);
          path.pop_back();
          continue;
        }
        const int target = rule.references[step.next++].rule;
        if (marks[target] == Mark::kOpen) return ComplainCycle(target);
        if (marks[target] == Mark::kNew) path.push_back({target});
      }
    }
  }

  void ComplainCycle(int rule) {
    while (program_.events[rule].form == Form::kAny) rule = program_.events[rule].references[0].rule;
    const Rule& circular = program_.events[rule];
    Complain(*definitions_[rule - 1].source, circular.place, "'" + circular.name + "' refers to itself",
             "a rule may only use rules that do not use it, directly or through others");
  }

  const Includer& includer_;
  const Overrides& overrides_;
  Diagnostics diagnostics_;
  std::deque<Source> sources_;
  struct Located {
    const Source* source;
    const Definition* definition;
  };
  std::vector<Located> definitions_;  // definition i is rule i + 1
  Program program_;
  Symbols symbols_{program_, {}, {}, {}};
};

}  // namespace

CompileResult Compile(const GrammarText& grammar, const Includer& includer, const Overrides& overrides) {
  return Compiler(grammar, includer, overrides).Run();
}

}  // namespace prehend::grammar
