// SPDX-License-Identifier: Apache-2.0
// `one hand per object`: what the rule said so far becomes a hidden rule of its own, the
// candidates; another hidden rule says whose turn it is; and the rule holds where its candidate
// does and it is its turn. Errors: roles that are none, that are named twice, forms that cannot be
// shared out.
#include <algorithm>
#include <utility>

#include "grammar/compile/lower.h"

namespace prehend::grammar {

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
