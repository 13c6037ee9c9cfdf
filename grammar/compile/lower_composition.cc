// SPDX-License-Identifier: Apache-2.0
// Parts and relations of a composition. Errors: labels, relations that never hold, alone or
// together, and orders in which it would end before it begins.
#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "grammar/analysis/contradictions.h"
#include "grammar/base/diagnostic.h"
#include "grammar/compile/lower.h"

namespace prehend::grammar {
namespace {

class CompositionLowering {
 public:
  CompositionLowering(Program& program, RuleId index, const ast::Definition& definition,
                      Lowering& lowering)
      : program_(program), index_(index), d_(definition), lowering_(lowering) {}

  void Run() {
    const std::size_t before = lowering_.complaints();
    std::vector<std::string> labels;
    std::vector<std::vector<int>> calls;  // by part
    if (d_.parts.size() > kMaxParts) {
      return lowering_.Complain(d_.parts[kMaxParts].place,
                                "more than " + std::to_string(kMaxParts) + " parts",
                                "compose some of them into an event of its own");
    }
    for (const ast::Part& part : d_.parts) {
      if (!part.label.empty() && std::ranges::find(labels, part.label) != labels.end()) {
        lowering_.Complain(part.place, "the label '" + part.label + "' is used twice");
      }
      labels.push_back(part.label);
      calls.push_back({});
      for (const ast::Expr& call : part.calls) calls.back().push_back(lowering_.RuleCall(call));
    }
    for (const std::vector<int>& part : calls) {
      if (std::ranges::find(part, kNone) != part.end()) return;
      Composition().AddPart(part.front());
    }
    Composition().count = static_cast<int>(labels.size());
    Composition().hull = d_.all_of;
    Composition().first = d_.first_of_equals;
    std::set<std::string> unknown;
    const auto find = [&](const std::string& label, Place place) {
      const auto found = std::ranges::find(labels, label);
      if (found == labels.end() && unknown.insert(label).second)
        lowering_.Complain(place, "no part is labelled '" + label + "'", DidYouMean(label, labels));
      return static_cast<int>(found - labels.begin());
    };
    for (const ast::Relation& relation : d_.relations) {
      ComposeRule::Clause clause{.left = find(relation.left, relation.place),
                                 .right = find(relation.right, relation.right_place)};
      clause.within_s.fill(-1);
      for (const ast::Relation::Alternative& one : relation.alternatives)
        LowerAlternative(one, clause);
      Composition().clauses.push_back(clause);
    }
    for (const ast::Absence& absence : d_.absences) {
      const int left = find(absence.left, absence.left_place),
                right = find(absence.right, absence.right_place);
      const int reference = lowering_.RuleCall(absence.call);
      if (reference == kNone || lowering_.complaints() != before) return;
      Composition().absences.push_back(
          {.part = Composition().AddPart(reference), .left = left, .right = right});
    }
    for (std::size_t part = 0; part < calls.size(); ++part) {
      for (std::size_t i = 1; i < calls[part].size(); ++i) {
        Composition().AddPart(calls[part][i], static_cast<int>(part));
        Composition().has_choices = true;
      }
    }
    if (d_.all_of) LowerAllOf();
    if (lowering_.complaints() == before) CheckRelations();
    if (lowering_.complaints() == before && !d_.all_of) CheckOrders();
  }

 private:
  ComposeRule& Composition() { return program_.rules[index_].As<ComposeRule>(); }

  // Both name an event; `by_any`: or may, as `any` may be whom the other one names.
  bool Share(int left, int right, bool by_any = false) {
    const std::vector<Reference>& all = program_.rules[index_].references;
    const std::vector<int> some = Composition().ChoicesFor(left);
    return std::ranges::any_of(Composition().ChoicesFor(right), [&](int one) {
      return std::ranges::any_of(some, [&](int other) {
        return one == other || (by_any && MayBeOne(all[one], all[other]));
      });
    });
  }

  // Of the rule that is written, not of one that was made for `any` or for classes: kNone is any.
  Reference Written(Reference call) {
    while (program_.rules[call.rule].hidden) {
      Reference of = program_.rules[call.rule].references.front();
      for (int& role : of.roles) role = role == kNone ? kNone : call.roles[role];
      call = of;
    }
    return call;
  }

  bool MayBeOne(Reference a, Reference b) {
    a = Written(a), b = Written(b);
    const auto alike = [&](int i, int k) {
      return a.roles[i] == b.roles[k] || a.roles[i] == kNone || b.roles[k] == kNone;
    };
    const bool crossed = program_.rules[a.rule].symmetric && alike(0, 1) && alike(1, 0);
    return a.rule == b.rule && (crossed || (alike(0, 0) && alike(1, 1))) && alike(2, 2) &&
           alike(3, 3);
  }

  // What is named twice happens twice.
  void LowerAllOf() {
    if (d_.within) {
      const double within_s = lowering_.Span(*d_.within, "'within'");
      Composition().within_s = within_s;
    }
    for (int left = 0; left < Composition().count; ++left) {
      for (int right = left + 1; right < Composition().count; ++right) {
        if (!Share(left, right, /*by_any=*/true)) continue;
        ComposeRule::Clause other{
            .left = left,
            .right = right,
            .relations = kAnyRelation & static_cast<AllenSet>(~Bit(Allen::kEquals))};
        other.within_s.fill(-1);
        Composition().clauses.push_back(other);
      }
    }
  }

  void LowerAlternative(const ast::Relation::Alternative& one, ComposeRule::Clause& clause) {
    const std::optional<Allen> allen = AllenNamed(one.name);
    if (!allen) {
      return lowering_.Complain(one.place, "'" + one.name + "' is none of Allen's relations",
                                "they are " + AllenNames());
    }
    constexpr AllenSet kGap = Bit(Allen::kBefore) | Bit(Allen::kAfter);
    const AllenSet gaps = clause.relations & kGap;
    const auto is_endless = [&](Allen gap) {
      return (gaps & Bit(gap)) != 0 && clause.within_s[static_cast<std::size_t>(gap)] < 0;
    };
    clause.relations |= Bit(*allen);
    if (!one.within) return;
    clause.within_s[static_cast<std::size_t>(*allen)] =
        lowering_.Constant(*one.within, kSeconds, "'within'");
    if ((Bit(*allen) & kBounded) == 0) {
      lowering_.Complain(
          one.within->place,
          "'within' limits a gap, or how far apart two boundaries are that should be one, and '" +
              one.name + "' has neither",
          "boundaries that meet, give or take 20 ms: a meets within 20 ms b");
    } else if (is_endless(Allen::kBefore) || is_endless(Allen::kAfter)) {
      lowering_.Complain(one.within->place, "'within' belongs to '" + one.name + "' alone",
                         "say it of each: before within 1 s|meets within 20 ms; or put first what "
                         "has a limit");
    }
  }

  // From the begin of the first part to the end of the last: what would end before it begins is
  // none.
  static constexpr AllenSet kAgainstTime = Bit(Allen::kAfter) | Bit(Allen::kMetBy);

  // Of several orders each must be possible.
  void CheckOrders() {
    const ComposeRule& composition = Composition();
    const int last = composition.count - 1;
    for (std::size_t i = 0; i < composition.clauses.size() && last > 0; ++i) {
      const ComposeRule::Clause& clause = composition.clauses[i];
      const bool as_listed = clause.left == 0 && clause.right == last;
      if (!as_listed && (clause.left != last || clause.right != 0)) continue;
      AllenSet never = 0;
      for (AllenSet left = clause.relations; left != 0; left &= left - 1) {
        const AllenSet one = left & ~(left - 1);
        const AllenSet may_be = MayBe({.relations = one, .within_s = clause.within_s});
        if (((as_listed ? may_be : Inverse(may_be)) & ~kAgainstTime) == 0) never |= one;
      }
      if (never == 0) continue;
      const auto name = kAllenNames[static_cast<std::size_t>(std::countr_zero(never))];
      lowering_.Complain(d_.relations[i].place,
                         "'" + std::string(name) + "' never makes an event here: '" +
                             d_.parts.back().label + "', the last part, would end before '" +
                             d_.parts.front().label + "', the first one, begins",
                         "from the first part to the last; in any order: all of " +
                             d_.parts.front().label + ": .., " + d_.parts.back().label +
                             ": .. where " + d_.relations[i].left + " before|after " +
                             d_.relations[i].right + " within 60 s");
    }
  }

  static AllenSet MayBe(const ComposeRule::Clause& clause) {
    AllenSet set = 0;
    for (std::size_t i = 0; i < clause.within_s.size(); ++i) {
      const auto relation = static_cast<Allen>(i);
      if ((clause.relations & Bit(relation)) == 0) continue;
      set |= clause.within_s[i] < 0 ? Bit(relation) : grammar::MayBe(relation);
    }
    return set;
  }

  // Of a clause: where it is written, or what is named twice.
  Place PlaceOf(std::size_t clause) {
    return clause < d_.relations.size()
               ? d_.relations[clause].place
               : d_.parts[static_cast<std::size_t>(Composition().clauses[clause].right)].place;
  }

  void CheckRelations() {
    constexpr AllenSet kApart =
        Bit(Allen::kBefore) | Bit(Allen::kMeets) | Bit(Allen::kMetBy) | Bit(Allen::kAfter);
    const ComposeRule& composition = Composition();
    const int parts = composition.count;
    AllenNetwork network(parts);
    for (int left = 0; left < parts; ++left) {
      for (int right = left + 1; right < parts; ++right) {  // intervals of one event do not overlap
        const bool is_sure =
            composition.ChoicesFor(left).size() == 1 && composition.ChoicesFor(right).size() == 1;
        if (is_sure && Share(left, right))
          network.Constrain(left, right, kApart | Bit(Allen::kEquals));
      }
    }
    const AllenNetwork nothing_said = network;
    for (std::size_t i = 0; i < composition.clauses.size(); ++i) {
      const ComposeRule::Clause& clause = composition.clauses[i];
      if (network.Constrain(clause.left, clause.right, MayBe(clause))) continue;
      AllenNetwork alone = nothing_said;
      if (!alone.Constrain(clause.left, clause.right, MayBe(clause))) {
        const ast::Relation& relation = d_.relations[i];
        return lowering_.Complain(relation.place, "this relation is never true",
                                  clause.left == clause.right
                                      ? "'" + relation.left + "' equals itself"
                                      : "'" + relation.left + "' and '" + relation.right +
                                            "' are the same event, whose intervals do not overlap");
      }
      return lowering_.Complain(PlaceOf(i),
                                "this relation is never true together with what stands before it",
                                "draw the parts below each other; intervals of one event do not "
                                "overlap, and a part equals itself");
    }
    if (parts > 1 && !d_.all_of && !network.Constrain(0, parts - 1, kAnyRelation & ~kAgainstTime))
      return lowering_.Complain(d_.parts.back().place,
                                "this is never an event: the last part, '" + d_.parts.back().label +
                                    "', ends before the first one, '" + d_.parts.front().label +
                                    "', begins",
                                "list the parts as they follow each other in time");
    const auto may_follow = [&](int first, int second) {
      return AllenNetwork(network).Constrain(first, second, Bit(Allen::kBefore));
    };
    for (std::size_t i = 0; i < d_.absences.size(); ++i) {
      const ast::Absence& absence = d_.absences[i];
      const auto& [part, left, right] = composition.absences[i];
      if (may_follow(left, right)) continue;
      lowering_.Complain(
          absence.left_place,
          "this is always true: no time is between '" + absence.left + "' and '" + absence.right +
              "', as '" + absence.right + "' never begins after '" + absence.left + "' ends",
          may_follow(right, left) ? "without .. between " + absence.right + " and " + absence.left
                                  : "leave it out, or let one follow the other");
    }
  }

  Program& program_;
  RuleId index_;
  const ast::Definition& d_;
  Lowering& lowering_;
};

}  // namespace

void LowerComposition(Program& program, RuleId index, const ast::Definition& definition,
                      Lowering& lowering) {
  CompositionLowering(program, index, definition, lowering).Run();
}

// `one hand per object`: what the rule said so far becomes a hidden rule of its own, the
// candidates; another hidden rule says whose turn it is; and the rule holds where its candidate
// does and it is its turn. Errors: roles that are none, that are named twice, forms that cannot be
// shared out.

// The roles that share, or none after an error.
std::vector<int> Lowering::SharingRoles(const ast::OnePer& one_per, int one) {
  std::vector<int> per;
  for (const ast::Expr& expr : one_per.per) {
    const std::optional<int> role = RoleArgument(expr, "Entity", "one .. per");
    if (!role) return {};
    if (*role == one || std::ranges::find(per, *role) != per.end()) {
      Complain(expr.place, Quoted(expr.text) + " is named twice",
               "name the role of which there is one, and the roles that share it: one hand per "
               "object");
      return {};
    }
    per.push_back(*role);
  }
  return per;
}

// What the rule says so far becomes a hidden rule of its own; the node is true where that holds.
NodeId Lowering::HideSoFar() {
  Rule hidden = rule();
  hidden.printed = false;
  hidden.hidden = true;
  Reference all;
  for (std::size_t i = 0; i < hidden.roles.size(); ++i) all.roles[i] = static_cast<int>(i);
  all.rule = symbols_.program.rules.push_back(std::move(hidden));
  rule().references.clear();
  rule().anchors.clear();
  return Add({.op = Op::kHolds, .slot = AddReference(all)});
}

void Lowering::HideIfAnchored() {
  if (rule().anchors.empty()) return;
  const NodeId holds = HideSoFar();
  rule().of_form = WhileRule{.condition = holds, .until = {}};
}

void Lowering::LowerOnePer(const ast::OnePer& one_per) {
  if (rule().symmetric) {
    return Complain(one_per.place, "the first two roles of a symmetric event are alike",
                    "put 'one .. per' into a condition, and use that");
  }
  const int one = RoleArgument(one_per.one, "Entity", "one .. per").value_or(kNone);
  const std::vector<int> per = one == kNone ? std::vector<int>() : SharingRoles(one_per, one);
  if (per.empty()) return;
  const double within_s =
      one_per.within ? Constant(*one_per.within, kSeconds, "'nearest within'") : 0;

  IdVector<RuleId, Rule>& rules = symbols_.program.rules;
  Rule owners{.name = rule().name,
              .file = rule().file,
              .place = rule().place,
              .hidden = true,
              .of_form = AnyRule{.one = one, .within_s = within_s}};
  Reference of_candidates{.rule = rules.end_id()}, whose;
  for (std::size_t i = 0; i < per.size(); ++i) {
    owners.roles.push_back(rule().roles[static_cast<std::size_t>(per[i])]);
    of_candidates.roles[static_cast<std::size_t>(per[i])] = static_cast<int>(i);
    whose.roles[i] = per[i];
  }
  owners.references = {of_candidates};
  owners.guard = 0;
  const NodeId holds = HideSoFar();
  whose.rule = rules.push_back(std::move(owners));
  const NodeId owns = Add({.op = Op::kOwns, .roles = {one, kNone}, .slot = AddReference(whose)});
  std::string text = "one {" + std::to_string(one) + "} per ";
  for (const int role : per)
    text += (role == per.front() ? "{" : " and {") + std::to_string(role) + "}";
  NoteText(owns, std::move(text), one_per.place);
  rule().of_form =
      WhileRule{.condition = Add({.op = Op::kAnd, .args = {holds, owns, kNone, kNone}})};
}

}  // namespace prehend::grammar
