// SPDX-License-Identifier: Apache-2.0
#include "grammar/lower_definition.h"

#include <algorithm>

namespace prehend::grammar {
namespace {

using ast::Definition;

class DefinitionLowering {
 public:
  DefinitionLowering(Program& program, int index, const Definition& definition, Lowering& lowering)
      : program_(program), index_(index), d_(definition), lowering_(lowering) {}

  void Run() {
    LowerForm();
    LowerModifiers();
  }

 private:
  // Lowering may add rules, so the rule is looked up again after each step.
  Rule& Here() { return program_.events[index_]; }

  void LowerForm() {
    using Form_ = Definition::Form;
    switch (d_.form) {
      case Form_::kWhile: {
        Here().form = Form::kWhile;
        const int first = lowering_.Truth(d_.first, {});
        const int until = d_.until ? lowering_.Truth(*d_.until, {}) : kNone;
        Here().first = first;
        Here().second = until;
        break;
      }
      case Form_::kFromTo: return LowerFromTo();
      case Form_::kUntilSince: return LowerUntilSince();
      case Form_::kRestOf: {
        Here().form = Form::kRestOf;
        const int first = lowering_.RuleCall(d_.first);
        Here().first = first;
        for (const ast::Expr& other : d_.outside) {
          const int reference = lowering_.RuleCall(other);
          Here().outside.push_back(reference);
        }
        break;
      }
      case Form_::kCompose: return LowerCompose();
    }
  }

  void LowerFromTo() {
    Here().form = Form::kFromTo;
    const int first = lowering_.Instant(d_.first, {});
    const int second = lowering_.Instant(d_.second, {.begin = true});
    const int during = d_.during ? lowering_.Truth(*d_.during, {.begin = true}) : kNone;
    Rule& rule = Here();
    rule.first = first;
    rule.second = second;
    rule.during = during;
    rule.or_drop = d_.or_drop || d_.absence;
    rule.absence = d_.absence;
    if (d_.within) LowerWithin(*d_.within);
  }

  void LowerWithin(const ast::Expr& within) {
    const double within_s = lowering_.Span(within, "'within'");
    Here().within_s = within_s;
  }

  void LowerUntilSince() {
    Here().form = Form::kUntilSince;
    const int first = lowering_.Instant(d_.first, {});
    const int second = lowering_.Truth(d_.second, {.end = true});
    Here().first = first;
    Here().second = second;
    if (d_.approach) LowerApproach(*d_.approach);
    const double back_s = lowering_.Span(d_.at_most_back, "'at most .. back'");
    Here().back_s = back_s;
  }

  void LowerApproach(const ast::Approach& approach) {
    Dimension dimension;
    const int signal = lowering_.Signal(approach.signal, {.end = true}, dimension);
    if (signal == kNone) return;
    const double slack = lowering_.Constant(approach.slack, dimension, "'receding at most'");
    int motion = kNone;
    Dimension motion_dimension = Quotient(dimension, kSeconds);
    double speed = 0;
    double idle_s = -1;
    if (approach.motion) motion = lowering_.Signal(*approach.motion, {.end = true}, motion_dimension);
    if (approach.speed) {
      speed = lowering_.Constant(*approach.speed, motion_dimension, "'slower than'");
      idle_s = lowering_.Constant(*approach.idle, kSeconds, "'slower than .. at most'");
    }
    Rule& rule = Here();
    rule.approach = signal;
    rule.slack = slack;
    rule.motion = motion;
    rule.speed = speed;
    rule.idle_s = idle_s;
  }

  void LowerCompose() {
    Here().form = Form::kCompose;
    std::vector<std::string> labels;
    if (d_.parts.size() > kMaxParts) {
      return lowering_.Complain(d_.parts[kMaxParts].place, "more than " + std::to_string(kMaxParts) + " parts",
                               "compose some of them into an event of its own");
    }
    for (const ast::Part& part : d_.parts) {
      if (std::find(labels.begin(), labels.end(), part.label) != labels.end()) {
        lowering_.Complain(part.place, "the label '" + part.label + "' is used twice");
      }
      labels.push_back(part.label);
      const int reference = lowering_.PartCall(part.call);
      if (reference == kNone) continue;
      CheckPart(part, reference);
      Here().composition.parts.push_back(reference);
    }
    if (labels.size() != Here().composition.parts.size()) return;
    const auto find = [&](const std::string& label, Place place) {
      const auto found = std::find(labels.begin(), labels.end(), label);
      if (found == labels.end()) {
        const std::string near = NearestName(label, labels);
        lowering_.Complain(place, "no part is labelled '" + label + "'", near.empty() ? "" : "did you mean '" + near + "'?");
      }
      return static_cast<int>(found - labels.begin());
    };
    for (const ast::Relation& relation : d_.relations) {
      Composition::Clause clause{.left = find(relation.left, relation.place), .right = find(relation.right, relation.place)};
      for (const std::string& name : relation.relations) {
        const std::optional<Allen> allen = AllenNamed(name);
        if (!allen) {
          lowering_.Complain(relation.place, "'" + name + "' is none of Allen's relations",
                            "they are " + JoinedAllenNames());
          continue;
        }
        clause.relations |= Bit(*allen);
      }
      Here().composition.clauses.push_back(clause);
    }
  }

  // All parts are about the same entities: those of the composition.
  void CheckPart(const ast::Part& part, int reference) {
    const Binding& named = Here().references[reference].roles;
    for (std::size_t role = 0; role < Here().roles.size(); ++role) {
      if (std::find(named.begin(), named.end(), static_cast<int>(role)) != named.end()) continue;
      lowering_.Complain(part.place, "the part '" + part.label + "' does not name the role '" + Here().roles[role].name + "'",
                        "every part of a composition names all its roles");
    }
  }

  static std::string JoinedAllenNames() {
    std::string text;
    for (const std::string_view name : kAllenNames) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
  }

  void LowerModifiers() {
    if (d_.bridging) {
      if (d_.form != Definition::Form::kWhile) {
        lowering_.Complain(d_.bridging->place, "'bridging' goes with 'while' only", "put the bridged part into a condition of its own");
      }
      const double bridging_s = lowering_.Constant(*d_.bridging, kSeconds, "'bridging'");
      Here().bridging_s = bridging_s;
    }
    if (d_.lasting) {
      const double lasting_s = lowering_.Constant(*d_.lasting, kSeconds, "'lasting'");
      Here().lasting_s = lasting_s;
      CheckLasting(*d_.lasting);
    }
    if (d_.form == Definition::Form::kCompose && (d_.requirement || d_.confirmed || d_.style || !d_.attributes.empty())) {
      lowering_.Complain(d_.place, "a composition takes no 'requires', no 'confirmed by' and no attributes of its own",
                         "put it into one of the parts");
    }
    if (d_.requirement) {
      const int requirement = lowering_.Truth(*d_.requirement, {.begin = true, .end = true});
      Here().requirement = requirement;
    }
    if (d_.confirmed) {
      const int by = lowering_.RuleCall(d_.confirmed->by);
      const int within = lowering_.RuleCall(d_.confirmed->within);
      Here().confirmed_by = by;
      Here().confirmed_within = within;
    }
    if (d_.style) {
      const int role = lowering_.HandRole(*d_.style);
      Here().style_role = role;
    }
    LowerAttributes();
  }

  // A form that can say how long an interval is at most must not be asked for longer ones.
  void CheckLasting(const ast::Expr& lasting) {
    const Rule& rule = Here();
    const bool looks_back = d_.form == Definition::Form::kUntilSince;
    const double most_s = looks_back ? rule.back_s : rule.within_s;
    if (most_s <= 0 || rule.lasting_s <= most_s) return;
    lowering_.Complain(lasting.place, "no interval lasts so long: this one looks at most " + QuantityText({most_s, kSeconds}) +
                                          (looks_back ? " back" : " ahead"),
                       looks_back ? "look further back, or ask for less" : "wait longer, or ask for less");
  }

  void LowerAttributes() {
    if (d_.attributes.size() > kMaxAttributes) {
      return lowering_.Complain(d_.attributes[kMaxAttributes].place,
                                "more than " + std::to_string(kMaxAttributes) + " attributes");
    }
    for (const ast::Attribute& attribute : d_.attributes) {
      const std::vector<RuleRole>& roles = Here().roles;
      const std::vector<RuleAttribute>& others = Here().attributes;
      const auto same = [&](const auto& named) { return named.name == attribute.name; };
      if (std::any_of(roles.begin(), roles.end(), same) || std::any_of(others.begin(), others.end(), same)) {
        lowering_.Complain(attribute.place, "'" + attribute.name + "' is a role or an attribute already", "choose another name");
      }
      Dimension dimension;
      const int node = lowering_.Attribute(attribute.value, dimension);
      Here().attributes.push_back({.name = attribute.name, .node = node, .dimension = dimension});
    }
  }

  Program& program_;
  int index_;
  const Definition& d_;
  Lowering& lowering_;
};

}  // namespace

void LowerDefinitionInto(Program& program, int index, const ast::Definition& definition, Lowering& lowering) {
  DefinitionLowering(program, index, definition, lowering).Run();
}

}  // namespace prehend::grammar
