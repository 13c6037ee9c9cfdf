// SPDX-License-Identifier: Apache-2.0
// The form of a definition first, then its modifiers; each is checked as soon as it is lowered.
// Errors: forms of which no interval ever begins or counts, modifiers that a form does not take,
// how an event is drawn, attributes. Compositions are in grammar/compile/lower_composition.cc.
#include <algorithm>
#include <initializer_list>

#include "grammar/analysis/contradictions.h"
#include "grammar/base/diagnostic.h"
#include "grammar/compile/lower.h"

namespace prehend::grammar {
namespace {

using ast::Definition;

/// Where a grammar does not say `onset`: a tenth of the speed below which something pauses.
constexpr double kPausePerOnset = 10;

class DefinitionLowering {
 public:
  DefinitionLowering(Program& program, RuleId index, const Definition& definition,
                     Lowering& lowering)
      : program_(program), index_(index), d_(definition), lowering_(lowering) {}

  void Run() {
    LowerForm();
    LowerModifiers();
    if (d_.each && (!Here().anchors.empty() || Here().style_role != kNone))
      lowering_.Complain(d_.place, "'each' keeps no values of where A was",
                         "leave out 'each', or what speaks of the begin");
  }

 private:
  // Lowering may add rules, so the rule is looked up after each step, the right side of a '='
  // first.
  Rule& Here() { return program_.rules[index_]; }
  template <typename Part>
  Part& As() {
    return Here().As<Part>();
  }

  void LowerForm() {
    using Form_ = Definition::Form;
    switch (d_.form) {
      case Form_::kWhile: {
        const NodeId condition = lowering_.Truth(d_.first, {});
        const NodeId until = d_.until ? lowering_.Truth(*d_.until, {.begin = true}) : kNone;
        As<WhileRule>() = {.condition = condition, .until = until};
        CheckUntil();
        break;
      }
      case Form_::kFromTo:
        return LowerFromTo();
      case Form_::kUntilSince:
        return LowerUntilSince();
      case Form_::kRestOf: {
        As<RestOfRule>().whole = lowering_.RuleCall(d_.first);
        for (const ast::Expr& other : d_.outside) {
          const int reference = lowering_.RuleCall(other);
          As<RestOfRule>().outside.push_back(reference);
          CheckRest(other, reference);
        }
        break;
      }
      case Form_::kCompose:
        return LowerComposition(program_, index_, d_, lowering_);
      case Form_::kRepeat:
        return LowerRepeat();
      case Form_::kOtherwise:
        return LowerOtherwise();
    }
  }

  // While none of the other events of this file holds, in any role of the same class.
  void LowerOtherwise() {
    std::vector<ast::Expr> calls;
    const std::vector<RuleRole> roles = Here().roles;
    for (const RuleId other : IdsOf(program_.rules)) {
      const Rule& rule = program_.rules[other];
      const bool counts = rule.printed && rule.file == Here().file && other != index_ &&
                          rule.form() != Form::kCompose && !lowering_.IsOtherwise(other);
      if (counts) AddCalls(rule, std::vector<int>(rule.roles.size(), kNone), roles, 0, calls);
    }
    if (calls.empty()) {
      return lowering_.Complain(
          d_.place,
          "'otherwise' is when no other event holds, and no other event of this file is about " +
              WithArticle(roles.front().class_name),
          "define such events, or say what must not hold: while not X");
    }
    const NodeId none = lowering_.Truth(
        {.kind = ast::Expr::Kind::kUnary, .place = d_.place, .text = "not", .args = {AnyOf(calls)}},
        {});
    As<WhileRule>() = {.condition = none};
  }

  // One call for each way in which roles of the event can be those of this one.
  void AddCalls(const Rule& event, std::vector<int> plays, const std::vector<RuleRole>& roles,
                std::size_t role, std::vector<ast::Expr>& calls) {
    if (role == roles.size()) {
      ast::Expr call{.kind = ast::Expr::Kind::kCall, .place = d_.place, .text = event.name};
      for (const int who : plays) {
        call.args.push_back({.kind = ast::Expr::Kind::kName,
                             .place = d_.place,
                             .text = who == kNone ? "any" : roles[who].name});
      }
      return calls.push_back(std::move(call));
    }
    for (std::size_t i = 0; i < plays.size(); ++i) {
      const bool fits = plays[i] == kNone && event.roles[i].class_name == roles[role].class_name;
      if (!fits) continue;
      plays[i] = static_cast<int>(role);
      AddCalls(event, plays, roles, role + 1, calls);
      plays[i] = kNone;
      if (event.symmetric && i == 0) return;  // the second of a pair says the same
    }
  }

  static ast::Expr AnyOf(const std::vector<ast::Expr>& calls) {
    if (calls.size() == 1) return calls.front();
    return {
        .kind = ast::Expr::Kind::kChain, .place = calls.front().place, .text = "or", .args = calls};
  }

  void LowerRepeat() {
    std::vector<int> counted;
    for (const ast::Expr& call : d_.repeated) counted.push_back(lowering_.RuleCall(call));
    const bool all_calls = std::ranges::find(counted, kNone) == counted.end();
    const double gap_s = d_.gap ? lowering_.Constant(*d_.gap, kSeconds, "'gap at most'") : 0;
    const int whole = lowering_.Count(d_.at_least);
    if (!d_.gap) {
      const double within_s = lowering_.Span(*d_.within, "'within'");
      if (!all_calls) return;
      As<ComposeRule>() = {
          .count = static_cast<int>(counted.size()), .at_least = whole, .within_s = within_s};
      for (const int one : counted) As<ComposeRule>().AddPart(one);
      return;
    }
    const NodeId condition = all_calls ? lowering_.Truth(AnyOf(d_.repeated), {}) : NodeId();
    As<WhileRule>() = {.condition = condition,
                       .bridging_s = gap_s,
                       .at_least = whole,
                       .counted = std::move(counted)};
  }

  void LowerFromTo() {
    const NodeId from = lowering_.Instant(d_.first, {});
    const NodeId to = lowering_.Instant(d_.second, {.begin = true});
    const NodeId during = d_.during ? lowering_.Truth(*d_.during, {.begin = true}) : kNone;
    As<FromToRule>() = {.from = from,
                        .to = to,
                        .during = during,
                        .or_drop = d_.or_drop || d_.absence,
                        .absence = d_.absence,
                        .each = d_.each};
    CheckBegin();
    if (d_.each && d_.absence) {
      lowering_.Complain(
          d_.place, "'each' is for what comes: from each A to B within t",
          "leave out 'each': some A has no answer only if from A without B within t finds one");
    } else if (d_.each && !d_.within) {
      lowering_.Complain(d_.place, "without a limit, one B ends what each A began",
                         "say how long each may wait: from each A to B within 2 s");
    }
    if (d_.within) As<FromToRule>().within_s = lowering_.Span(*d_.within, "'within'");
  }

  // What is true at one frame, and what, negated, is not true: false, or not known.
  struct Claim {
    NodeId node;
    bool negated = false;
  };
  bool CanBe(std::initializer_list<Claim> claims) {
    Bounds bounds(program_, Here(), /*denies=*/std::ranges::none_of(claims, &Claim::negated));
    const auto fits = [&](const Claim& claim) {
      return claim.node == kNone || bounds.Add(claim.node, claim.negated);
    };
    return std::all_of(claims.begin(), claims.end(), fits) && bounds.SomeAlternativeFits();
  }

  void CheckUntil() {
    const WhileRule& rule = As<WhileRule>();
    if (rule.condition == kNone || rule.until == kNone ||
        CanBe({{rule.condition}, {rule.until, true}}))
      return;
    lowering_.ComplainOrWarn(
        d_.until->place, "nothing ever begins: this holds wherever the condition before it does",
        "it begins where that holds and this does not, and lasts until this holds");
  }

  void CheckBegin() {
    const FromToRule& rule = As<FromToRule>();
    if (rule.from == kNone || rule.to == kNone) return;
    if (!CanBe({{rule.from}, {rule.to, true}})) {
      lowering_.ComplainOrWarn(
          d_.second.place, "nothing ever begins: each begin is such an end, too, at the same frame",
          "from one X to the next is 'from X ends to X begins'");
    } else if (!CanBe({{rule.from}, {rule.to, true}, {rule.during}})) {
      lowering_.ComplainOrWarn(d_.during->place,
                               "nothing ever begins: this is false wherever it would begin",
                               "'during' must hold from the begin on");
    }
  }

  // The frame before the end is the last one that the interval can have.
  void CheckSince() {
    const UntilSinceRule& rule = As<UntilSinceRule>();
    if (rule.until == kNone || rule.since == kNone) return;
    Bounds before(program_, Here(), /*denies=*/false);
    if (before.Add(rule.since) && before.AddBefore(rule.until) && before.SomeAlternativeFits())
      return;
    lowering_.ComplainOrWarn(d_.second.place,
                             "nothing ever begins: this is false right before each such end",
                             "up to the frame before X begins, X is false; before X ends, true");
  }

  // Where something always ends with a moment, this is asked at that very moment.
  void CheckRequirement() {
    const Rule& rule = Here();
    NodeId moment;
    if (const UntilSinceRule* looks_back = rule.If<UntilSinceRule>()) moment = looks_back->until;
    if (const FromToRule* from_to = rule.If<FromToRule>();
        from_to != nullptr && from_to->or_drop && !from_to->absence)
      moment = from_to->to;
    if (moment == kNone || rule.requirement == kNone || CanBe({{moment}, {rule.requirement}}))
      return;
    lowering_.ComplainOrWarn(
        d_.requirement->place,
        "nothing ever begins that counts: this is false wherever an interval ends",
        "'requires' is asked at the first frame that no longer belongs to the interval");
  }

  // Something of each interval must be left.
  void CheckRest(const ast::Expr& other, int reference) {
    const int whole = As<RestOfRule>().whole;
    if (whole == kNone || reference == kNone ||
        !Covers(Here().references[reference], Here().references[whole]))
      return;
    lowering_.Complain(other.place, "nothing is ever left: this takes away all of it",
                       "take away something else");
  }

  // Whatever interval one of them has, the other one has it, too: it is the same, or "some" of the
  // same.
  bool Covers(const Reference& other, const Reference& whole) const {
    if (other.rule == whole.rule) return other.roles == whole.roles;
    const Rule& some = program_.rules[other.rule];
    if (some.form() != Form::kAny || some.references[0].rule != whole.rule) return false;
    for (std::size_t role = 0; role < kMaxRoles; ++role) {
      const int kept = some.references[0].roles[role];
      if (kept != kNone && other.roles[kept] != whole.roles[role]) return false;
    }
    return true;
  }

  void LowerUntilSince() {
    As<UntilSinceRule>().until = lowering_.Instant(d_.first, {});
    As<UntilSinceRule>().since = lowering_.Truth(d_.second, {.end = true});
    CheckSince();
    if (d_.approach) LowerApproach(*d_.approach);
    As<UntilSinceRule>().back_s = lowering_.Span(d_.at_most_back, "'at most .. back'");
  }

  void LowerApproach(const ast::Approach& approach) {
    Dimension dimension;
    const NodeId signal = lowering_.Signal(approach.signal, {.end = true}, dimension);
    if (signal == kNone) return;
    const double slack = lowering_.Constant(approach.slack, dimension, "'receding at most'");
    const double over_s =
        approach.over ? lowering_.Span(*approach.over, "'receding at most .. over'") : 0;
    NodeId motion;
    Dimension motion_dimension = Quotient(dimension, kSeconds);
    double speed = 0;
    double idle_s = -1;
    if (approach.motion)
      motion = lowering_.Signal(*approach.motion, {.end = true}, motion_dimension);
    if (approach.motion && motion == kNone) return;
    if (approach.speed) {
      speed = lowering_.Constant(*approach.speed, motion_dimension, "'slower than'");
      idle_s = lowering_.Constant(*approach.idle, kSeconds, "'slower than .. at most'");
    }
    int hand = kNone;
    double still_m = 0, still_s = 0;
    if (approach.still) {
      hand = HandOf(approach, motion);
      still_m = lowering_.Constant(*approach.still, kMetres, "'or within'");
      still_s = lowering_.Span(*approach.still_over, "'or within .. over'");
    }
    const double onset = approach.onset
                             ? lowering_.Constant(*approach.onset, motion_dimension, "'onset'")
                             : speed / kPausePerOnset;
    As<UntilSinceRule>().approach = Approach{.signal = signal,
                                             .slack = slack,
                                             .over_s = over_s,
                                             .motion = motion,
                                             .speed = speed,
                                             .onset = onset,
                                             .idle_s = idle_s,
                                             .hand = hand,
                                             .still_m = still_m,
                                             .still_s = still_s};
  }

  // Of what is said to stay within a length: the hand whose speed is the motion.
  int HandOf(const ast::Approach& approach, NodeId motion) {
    if (motion != kNone && program_.nodes[motion].op == Op::kSurfaceSpeed)
      return program_.nodes[motion].roles[0];
    if (!approach.motion || motion != kNone)
      lowering_.Complain(approach.still->place, "only a hand can be 'within' a length",
                         "for example: with surface_speed(hand) slower than 1 cm/s or within 2.5 "
                         "mm over 0.5 s at most 0.5 s");
    return kNone;
  }

  void LowerModifiers() {
    if (d_.bridging) {
      if (d_.form != Definition::Form::kWhile) {
        lowering_.Complain(d_.bridging->place, "'bridging' goes with 'while' only",
                           "put the bridged part into a condition of its own");
      }
      const double bridging_s = lowering_.Constant(*d_.bridging, kSeconds, "'bridging'");
      if (d_.form == Definition::Form::kWhile) {
        lowering_.HideIfAnchored();
        As<WhileRule>().bridging_s = bridging_s;
      }
    }
    if (d_.one_per) ShareOut(*d_.one_per);
    if (d_.lasting) {
      Here().lasting_s = lowering_.Constant(*d_.lasting, kSeconds, "'lasting'");
      CheckLasting(*d_.lasting);
    }
    if (d_.lasting_to) {
      const double most_s = lowering_.Span(*d_.lasting_to, "'lasting .. to'");
      Here().lasting_most_s = most_s;
      const auto* const from = Here().If<FromToRule>();
      const bool is_waited = from != nullptr && from->absence && most_s < from->within_s;
      if (most_s < Here().lasting_s || is_waited)
        lowering_.ComplainOrWarn(d_.lasting_to->place,
                                 "no interval lasts that long and no longer than this",
                                 is_waited ? "an absence lasts as long as its 'within'"
                                           : "the shorter time stands first: lasting 1 s to 2 s");
    }
    if (Here().form() == Form::kCompose &&
        (d_.requirement || d_.confirmed || d_.style || !d_.attributes.empty())) {
      lowering_.Complain(
          d_.place,
          "a composition takes no 'requires', no 'confirmed by' and no attributes of its own",
          "put it into one of the parts, or into a rule that uses this one: while C(hand, cup)");
    }
    if (d_.requirement) {
      Here().requirement = lowering_.Truth(*d_.requirement, {.begin = true, .end = true});
      CheckRequirement();
    }
    if (d_.confirmed) {
      Here().confirmed_by = lowering_.RuleCall(d_.confirmed->by);
      Here().confirmed_within = lowering_.RuleCall(d_.confirmed->within);
    }
    if (d_.drawn) CheckDrawn(*d_.drawn);
    if (d_.style) Here().style_role = lowering_.HandRole(*d_.style);
    LowerAttributes();
  }

  void ShareOut(const ast::OnePer& one_per) {
    if (d_.form == Definition::Form::kWhile) return lowering_.LowerOnePer(one_per);
    lowering_.Complain(
        one_per.place, "'one .. per' goes with 'while' only",
        "make this a condition, and share that out: while C(hand, object) one hand per object");
  }

  void CheckDrawn(const ast::Drawn& drawn) {
    const std::vector<RuleRole>& roles = Here().roles;
    const bool has_hand = std::any_of(
        roles.begin(), roles.end(), [](const RuleRole& role) { return role.class_name == "Hand"; });
    const DrawnAs as = drawn.drawing.as;
    if (!d_.is_event) {
      lowering_.Complain(drawn.place, "a condition is not drawn", "make it an event");
    } else if ((as == DrawnAs::kPhase || as == DrawnAs::kGrasp) && !has_hand) {
      lowering_.Complain(drawn.place, "this is drawn of a hand, and no role is a Hand",
                         "a phase is what a hand does, a grasp what it holds");
    } else if ((as == DrawnAs::kGrasp || as == DrawnAs::kSupport) && roles.size() < 2) {
      lowering_.Complain(drawn.place, "this is drawn of two, and the event has one role",
                         "a hand and what it holds, a thing and what it stands on");
    }
    Here().drawing = drawn.drawing;
  }

  // A form that can say how long an interval is at most must not be asked for longer ones.
  void CheckLasting(const ast::Expr& lasting) {
    const Rule& rule = Here();
    const bool looks_back = d_.form == Definition::Form::kUntilSince;
    const FromToRule* const from_to = rule.If<FromToRule>();
    const ComposeRule* const composition = rule.If<ComposeRule>();
    const double most_s = looks_back               ? As<UntilSinceRule>().back_s
                          : from_to != nullptr     ? from_to->within_s
                          : composition != nullptr ? composition->within_s
                                                   : 0;
    if (most_s <= 0 || rule.lasting_s <= most_s) return;
    lowering_.ComplainOrWarn(
        lasting.place,
        "no interval can last that long: this form reaches at most " +
            QuantityText({most_s, kSeconds}) + (looks_back ? " back" : " ahead"),
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
      if (std::any_of(roles.begin(), roles.end(), same) ||
          std::any_of(others.begin(), others.end(), same)) {
        lowering_.Complain(attribute.place,
                           "'" + attribute.name + "' is a role or an attribute already",
                           "choose another name");
      }
      Dimension dimension;
      const NodeId node = lowering_.Attribute(attribute.value, dimension);
      Here().attributes.push_back({.name = attribute.name, .node = node, .dimension = dimension});
    }
  }

  Program& program_;
  RuleId index_;
  const Definition& d_;
  Lowering& lowering_;
};

}  // namespace

void LowerDefinitionInto(Program& program, RuleId index, const ast::Definition& definition,
                         Lowering& lowering) {
  DefinitionLowering(program, index, definition, lowering).Run();
}

}  // namespace prehend::grammar
