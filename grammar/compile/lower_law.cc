// SPDX-License-Identifier: Apache-2.0
// Its head and calls, the relations between them, and then whether all roles are named. Errors:
// unknown events, conditions in a law, roles that do not fit or are not used, unknown relations.
#include <algorithm>

#include "grammar/base/diagnostic.h"
#include "grammar/compile/lower.h"

namespace prehend::grammar {
namespace {

using ast::Expr;

constexpr std::size_t kMaxCalls = 16;

constexpr AllenSet kInside =
    Bit(Allen::kStarts) | Bit(Allen::kDuring) | Bit(Allen::kFinishes) | Bit(Allen::kEquals);

class LawLowering {
 public:
  LawLowering(Symbols& symbols, const GrammarText& source, const ast::Law& law,
              Diagnostics& diagnostics)
      : symbols_(symbols), source_(source), written_(law), diagnostics_(diagnostics) {}

  std::optional<Law> Run() {
    const std::size_t before = diagnostics_.size();
    law_.name = written_.name;
    law_.file = source_.file;
    law_.place = written_.place;
    law_.says = Dump(written_);
    for (const ast::Role& role : written_.roles) law_.roles.push_back({role.name, role.class_name});
    role_used_.resize(law_.roles.size());
    law_.form = FormOf(written_.form);
    law_.subjects = Calls(written_.subjects);
    law_.others = Calls(written_.others);
    Relations();
    if (diagnostics_.size() == before) CheckRolesAreNamed();
    if (diagnostics_.size() != before) return std::nullopt;
    return std::move(law_);
  }

 private:
  static LawForm FormOf(ast::Law::Form form) {
    switch (form) {
      case ast::Law::Form::kCovered:
        return LawForm::kCovered;
      case ast::Law::Form::kRelated:
        return LawForm::kRelated;
      case ast::Law::Form::kApart:
        break;
    }
    return LawForm::kApart;
  }

  void Complain(Place place, std::string message, std::string hint = {}) {
    diagnostics_.push_back(
        DiagnosticAt(source_.file, source_.text, place, std::move(message), std::move(hint)));
  }

  std::vector<LawCall> Calls(const std::vector<Expr>& written) {
    std::vector<LawCall> calls;
    if (written.size() > kMaxCalls) {
      Complain(written[kMaxCalls].place,
               "more than " + std::to_string(kMaxCalls) + " events in one list of a law",
               "say it with two laws");
      return calls;
    }
    for (const Expr& expr : written) {
      if (std::optional<LawCall> call = Call(expr)) calls.push_back(std::move(*call));
    }
    return calls;
  }

  std::optional<LawCall> Call(const Expr& expr) {
    if (expr.kind != Expr::Kind::kCall) {
      Complain(expr.place, "a law speaks about events with their roles",
               "for example: grasping(hand, object)");
      return std::nullopt;
    }
    const auto found = symbols_.rules.find(expr.text);
    if (found == symbols_.rules.end()) {
      const Diagnostic unknown =
          symbols_.Unknown("event", expr.text, DidYouMean(expr.text, EventNames()));
      Complain(expr.place, unknown.message, unknown.hint);
      return std::nullopt;
    }
    const Rule& rule = symbols_.program.rules[found->second];
    if (!rule.printed) {
      Complain(expr.place,
               Quoted(expr.text) + " is a condition; a law speaks about events, which are recorded",
               "make it an event, or name the event that uses it");
      return std::nullopt;
    }
    if (rule.roles.size() != expr.args.size()) {
      Complain(expr.place, Quoted(expr.text) + " takes " + std::to_string(rule.roles.size()) +
                               " roles, found " + std::to_string(expr.args.size()));
      return std::nullopt;
    }
    LawCall call{.rule = found->second};
    for (std::size_t i = 0; i < expr.args.size(); ++i) {
      if (!AddPlayer(expr, expr.args[i], rule.roles[i].class_name, call)) return std::nullopt;
    }
    return call;
  }

  bool AddPlayer(const Expr& expr, const Expr& arg, const std::string& wanted, LawCall& call) {
    const bool is_name = arg.kind == Expr::Kind::kName;
    if (is_name && arg.text == "any") return AddAny(expr, arg, wanted, call);
    const auto role = std::ranges::find_if(
        law_.roles, [&](const Law::Role& known) { return is_name && known.name == arg.text; });
    if (role == law_.roles.end()) {
      std::vector<std::string> names;
      for (const Law::Role& known : law_.roles) names.push_back(known.name);
      Complain(arg.place,
               Quoted(expr.text) + " takes a role here" +
                   (is_name ? ", and the law has no role " + Quoted(arg.text) : ""),
               is_name ? DidYouMean(arg.text, names) : "");
      return false;
    }
    const int index = static_cast<int>(role - law_.roles.begin());
    if (!ClassesMeet(role->class_name, wanted)) {
      Complain(arg.place, symbols_.NotOfClass(expr.text, wanted, arg.text, role->class_name),
               DidYouMean(role->class_name, {wanted}));
      return false;
    }
    const bool twice = std::ranges::any_of(
        call.players, [&](const LawCall::Player& player) { return player.role == index; });
    if (twice) {
      Complain(arg.place, Quoted(arg.text) + " cannot play two roles of " + Quoted(expr.text),
               "name another role, or 'any'");
      return false;
    }
    role_used_[static_cast<std::size_t>(index)] = true;
    call.players.push_back({index, role->class_name, ""});
    return true;
  }

  // `any`, `any Cup`.
  bool AddAny(const Expr& expr, const Expr& arg, const std::string& wanted, LawCall& call) {
    call.has_any = true;
    call.players.push_back({-1, wanted, "any"});
    if (arg.args.empty()) return true;
    const Expr& named = arg.args[0];
    if (!StartsWithCapital(named.text)) {
      Complain(named.place,
               Quoted(named.text) + " is not a class; classes start with a capital letter");
      return false;
    }
    NoteClass(symbols_.program, named.text, source_.file, named.place);
    if (!ClassesMeet(named.text, wanted)) {
      Complain(named.place, Quoted(expr.text) + " takes " + WithArticle(wanted) + " here, and no " +
                                named.text + " is one");
      return false;
    }
    call.players.back() = {-1, named.text, "any " + named.text};
    return true;
  }

  std::vector<std::string> EventNames() const {
    std::vector<std::string> names;
    for (const auto& [name, rule] : symbols_.rules) {
      if (symbols_.program.rules[rule].printed) names.push_back(name);
    }
    return names;
  }

  void Relations() {
    for (const std::string& name : written_.relations) {
      law_.relation_text += (law_.relation_text.empty() ? "" : "|") + name;
      const std::optional<Allen> allen = AllenNamed(name);
      if (name == "lies inside") {
        law_.relations = kInside;
      } else if (allen) {
        law_.relations |= Bit(*allen);
      } else {
        Complain(written_.relations_place, Quoted(name) + " is none of Allen's relations",
                 "they are " + AllenNames() + "; or 'lies inside', or 'do not overlap'");
      }
    }
  }

  // If a subject left out a role, it would be open whether the law holds for one entity or for all.
  void CheckRolesAreNamed() {
    for (std::size_t role = 0; role < law_.roles.size(); ++role) {
      if (!role_used_[role]) {
        Complain(written_.roles[role].place,
                 "the role " + Quoted(law_.roles[role].name) + " is not used",
                 "a law says something about each of its roles; leave this one out or use it");
      }
    }
    if (law_.form == LawForm::kApart) {
      if (law_.subjects.size() == 1)
        Complain(written_.subjects[0].place, "this takes two events or more",
                 "intervals of one event never overlap");
      return;
    }
    for (std::size_t i = 0; i < law_.subjects.size(); ++i) {
      for (std::size_t role = 0; role < law_.roles.size(); ++role) {
        const bool named = std::ranges::any_of(
            law_.subjects[i].players,
            [&](const LawCall::Player& player) { return player.role == static_cast<int>(role); });
        if (named || !role_used_[role]) continue;
        Complain(written_.subjects[i].place,
                 "the law is about each " + Quoted(law_.roles[role].name) +
                     ", and this event leaves it out",
                 "an event that a law is about names all roles of the law");
        break;
      }
    }
  }

  Symbols& symbols_;
  const GrammarText& source_;
  const ast::Law& written_;
  Diagnostics& diagnostics_;
  Law law_;
  std::vector<bool> role_used_;
};

}  // namespace

std::optional<Law> LowerLaw(Symbols& symbols, const GrammarText& source, const ast::Law& law,
                            Diagnostics& diagnostics) {
  return LawLowering(symbols, source, law, diagnostics).Run();
}

}  // namespace prehend::grammar
