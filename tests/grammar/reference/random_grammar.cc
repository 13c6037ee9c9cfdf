// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/reference/random_grammar.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "grammar/base/allen.h"
#include "grammar/base/frame.h"
#include "tests/grammar/reference/random_meaning.h"

namespace prehend::grammar::testing {
namespace {

using Kind = Term::Kind;
using Form = RandomRule::Form;

constexpr int kRoles = 3;  // p, q, r; x has a part in everything
constexpr std::array<const char*, kRoles> kNames = {"p", "q", "r"};
constexpr std::array<const char*, kRoles> kClasses = {"P", "Q", "R"};

unsigned RolesOf(const Term& term) {
  unsigned roles = term.kind == Kind::kTouch   ? 1U << term.which
                   : term.kind == Kind::kHighP ? kP
                   : term.kind == Kind::kRule  ? term.named
                                               : 0;
  for (const Term& arg : term.args) roles |= RolesOf(arg);
  return roles;
}

std::string Head(int rule, unsigned roles, unsigned named, bool classes) {
  std::string text = "rule" + std::to_string(rule) + (classes ? "(x: Hand" : "(x");
  for (int i = 0; i < kRoles; ++i) {
    if (!(roles >> i & 1)) continue;
    text += std::string(", ") + (named >> i & 1 ? kNames[i] : "any") +
            (classes ? std::string(": ") + kClasses[i] : "");
  }
  return text + ")";
}

// Draws rules one after another; each may use those before it.
class Maker {
 public:
  Maker(std::mt19937_64& random, std::vector<RandomRule>& rules) : random_(random), rules_(rules) {}

  void Add() {
    RandomRule rule;
    const unsigned form = Below(rules_.size() < 2 ? 4 : 8);
    rule.form = static_cast<Form>(form);
    if (rule.form == Form::kRest) MakeRest(rule);
    if (rule.form == Form::kCompose || rule.form == Form::kAllOf) MakeCompose(rule);
    if (rule.form == Form::kRepeat) MakeRepeat(rule);
    if (form < 4) MakeConditions(rule);
    if (Below(3) == 0) rule.lasting = static_cast<Tick>(Below(6));
    if (rule.lasting > 0 && Below(3) == 0)
      rule.lasting_most = rule.lasting + 1 + static_cast<Tick>(Below(6));
    if (rule.within >= 0) rule.lasting = std::min(rule.lasting, rule.within);
    if (rule.form == Form::kUntil) rule.lasting = std::min(rule.lasting, rule.back);
    rule.halves = Sometimes();
    const bool is_composed = rule.form == Form::kCompose || rule.form == Form::kAllOf ||
                             (rule.form == Form::kRepeat && rule.within >= 0);
    if (!is_composed) MakeConditionsOfTheWhole(rule);
    rule.roles = RolesOf(rule.first) | RolesOf(rule.second) | RolesOf(rule.during) |
                 RolesOf(rule.requirement) | RolesOf(rule.by) | RolesOf(rule.episode);
    for (const Term& call : rule.calls) rule.roles |= RolesOf(call);
    for (const auto& [part, call] : rule.choices) rule.roles |= RolesOf(call);
    rules_.push_back(std::move(rule));
  }

 private:
  unsigned Below(std::size_t limit) { return static_cast<unsigned>(random_() % limit); }
  bool Sometimes() { return Below(3) == 0; }

  void MakeConditions(RandomRule& rule) {
    if (rule.form == Form::kWhile) {
      rule.first = rules_.empty() || Below(3) != 0 ? Condition(3) : LooksAsWell();
      rule.has_second = Sometimes();
      if (rule.has_second) rule.second = Condition(2, Sometimes() ? "begin" : "");
      if (Sometimes()) rule.bridging = 1 + static_cast<Tick>(Below(4));
      const unsigned roles = RolesOf(rule.first) | RolesOf(rule.second);
      rule.one_per = (roles & kP) != 0 && Below(2) == 0;
      if (rule.one_per && Sometimes()) rule.nearest_within = static_cast<Tick>(Below(6));
      return;
    }
    rule.first = Moment("");
    if (rule.form == Form::kUntil) {
      rule.second = Condition(2, "end");
      rule.back = 1 + static_cast<Tick>(Below(20));
      rule.approaches = Sometimes();
      rule.slack_m = static_cast<int>(Below(2));
      rule.idles = rule.approaches && Sometimes();
      rule.speed_m_per_s = rule.idles ? 370 : 0;
      rule.idle = static_cast<Tick>(Below(5));
      rule.onset_m_per_s = rule.idle % 2 == 1 ? 120 : rule.speed_m_per_s / 10;
      if (rule.approaches && Sometimes()) rule.over = 1 + static_cast<Tick>(Below(9));
      if (rule.idles && Sometimes()) rule.still_over = 1 + static_cast<Tick>(Below(9));
      return;
    }
    rule.from_each = rule.form == Form::kFromTo && Sometimes();
    const std::string begin = rule.from_each ? "" : "begin";
    rule.second = Moment(begin);
    rule.has_during = Sometimes();
    if (rule.has_during) rule.during = Condition(2, begin);
    rule.or_drop = rule.form == Form::kFromTo && rule.has_during && Below(2) == 0;
    if (rule.form == Form::kWithout || rule.from_each || Sometimes())
      rule.within = 1 + static_cast<Tick>(Below(9));
  }

  void MakeConditionsOfTheWhole(RandomRule& rule) {
    rule.has_requirement = Sometimes();
    rule.requires_at_end = rule.from_each || Below(2) == 0;
    if (rule.has_requirement)
      rule.requirement = Condition(2, rule.requires_at_end ? "end" : "begin");
    rule.is_confirmed = !rules_.empty() && Below(5) == 0;
    if (!rule.is_confirmed) return;
    rule.by = Call();
    rule.episode = Call();
  }

  void MakeRest(RandomRule& rule) {
    const unsigned others = 1 + Below(2);
    for (unsigned i = 0; i <= others; ++i) rule.calls.push_back(Call());
  }

  void MakeRepeat(RandomRule& rule) {
    rule.calls.push_back(Below(4) == 0 ? Touch() : Call());
    if (Sometimes()) rule.calls.push_back(Call());
    rule.at_least = 1 + static_cast<int>(Below(4));
    if (Sometimes()) {
      rule.within = 1 + static_cast<Tick>(Below(30));
    } else {
      rule.bridging = static_cast<Tick>(Below(6));
    }
  }

  int AnyRule() { return static_cast<int>(Below(rules_.size())); }

  void MakeCompose(RandomRule& rule) {
    const unsigned parts = 1 + Below(3);
    for (unsigned i = 0; i < parts; ++i) rule.calls.push_back(Call());
    if (Sometimes()) rule.choices.emplace_back(Below(parts), Call());
    rule.takes_first = rule.form == Form::kCompose && Sometimes();
    if (rule.form == Form::kAllOf) rule.within = 1 + static_cast<Tick>(Below(30));
    rule.has_absence = parts > 1 && Sometimes();
    if (rule.has_absence) {
      rule.during = Below(4) == 0 ? Touch() : Call();
      rule.left = Below(parts);
      rule.right = (rule.left + 1 + Below(parts - 1)) % parts;
    }
    if (rule.form == Form::kAllOf && Sometimes()) return;
    const unsigned clauses = 1 + Below(parts);
    for (unsigned i = 0; i < clauses; ++i) {
      RandomRule::Clause clause{.left = Below(parts), .right = Below(parts), .relations = {}};
      auto& [any, within] = clause.relations;
      any = static_cast<AllenSet>(1 + Below((1U << kAllenNames.size()) - 1));
      // Against time, from the first to the last part, is refused.
      constexpr AllenSet kLater = Bit(Allen::kAfter) | Bit(Allen::kMetBy);
      constexpr AllenSet kSooner = Bit(Allen::kBefore) | Bit(Allen::kMeets);
      const bool is_ordered = rule.form == Form::kCompose;
      if (is_ordered && clause.left == 0 && clause.right == parts - 1) any &= ~kLater;
      if (is_ordered && clause.right == 0 && clause.left == parts - 1) any &= ~kSooner;
      if (any == 0) any = Bit(Allen::kEquals);
      within.fill(-1);
      for (std::size_t k = 0; k < within.size(); ++k) {
        const bool can_be = (any & kBounded & Bit(static_cast<Allen>(k))) != 0;
        if (can_be && Sometimes()) within[k] = static_cast<Tick>(Below(9));
      }
      rule.clauses.push_back(clause);
    }
  }

  // Instants are allowed wherever conditions are.
  Term Condition(int depth, const std::string& anchor = "") {
    const unsigned choice = Below(depth > 0 ? 10 : 5);
    if (Below(12) == 0) return Rising(anchor);
    if (Below(12) == 0) return rules_.empty() ? Term{.kind = Kind::kGrip} : LooksAsWell();
    if (depth > 0 && Below(10) == 0) return Known(Condition(depth - 1, anchor));
    switch (choice) {
      case 0:
      case 1:
        return Touch();
      case 2:
        return {.kind = Kind::kHigh,
                .value =
                    static_cast<int>(Below(3)) + (Below(2) == 0 ? 1 : 0) - (anchor.empty() ? 0 : 1),
                .anchor = anchor};
      case 3:
      case 4:
        return rules_.empty() ? Touch() : CallOfSome();
      case 5:
        return {.kind = Kind::kNot, .args = {Condition(depth - 1, anchor)}};
      case 6:
        return Below(4) == 0 ? Moment(anchor) : Touch();
      default:
        return {.kind = choice == 7 ? Kind::kOr : Kind::kAnd,
                .args = {Condition(depth - 1, anchor), Condition(depth - 1, anchor)}};
    }
  }

  Term Moment(const std::string& anchor) {
    Term edge{.kind = Kind::kEdge, .begins = Below(2) == 0, .args = {State(anchor)}};
    if (Below(4) != 0) return edge;
    Term other = Below(2) == 0 ? Moment(anchor) : State(anchor);
    const bool both = other.kind != Kind::kEdge || Below(2) == 0;
    return {.kind = both ? Kind::kAnd : Kind::kOr, .args = {std::move(edge), std::move(other)}};
  }

  // What can begin and end: it has no moments in it.
  Term State(const std::string& anchor) {
    if (Below(12) == 0) return Rising(anchor);
    if (Below(12) == 0) return Known(State(anchor));
    switch (Below(6)) {
      case 0:
        return {.kind = Kind::kHigh, .value = static_cast<int>(Below(3)), .anchor = anchor};
      case 1:
        return {.kind = Kind::kNot, .args = {Touch()}};
      case 2:
        return {.kind = Kind::kOr, .args = {Touch(), rules_.empty() ? Touch() : CallOfSome()}};
      case 3:
        return Touch();
      default:
        return rules_.empty() ? Touch() : CallOfSome();
    }
  }

  // More often something that is denied: of that alone it says something.
  Term Known(Term of) {
    if (Below(3) != 0) of = {.kind = Kind::kNot, .args = {std::move(of)}};
    return {.kind = Kind::kKnown, .args = {std::move(of)}};
  }

  // Known only when the window is over.
  Term Rising(const std::string& anchor) {
    if (Below(2) == 0) return OfWindow(anchor);
    return {.kind = Kind::kRising,
            .value = static_cast<int>(Below(5)) - 2,
            .anchor = Below(2) == 0 ? anchor : "",
            .window = 1 + static_cast<Tick>(Below(9))};
  }

  Term OfWindow(const std::string& anchor) {
    return {.kind = Kind::kOfWindow,
            .which = static_cast<int>(Below(kOverWindow.size())),
            .value = static_cast<int>(Below(4)),
            .anchor = Below(2) == 0 ? anchor : "",
            .window = 1 + static_cast<Tick>(Below(9))};
  }

  // Of others, which may be known later than what it looks at itself, one sooner than the other.
  Term LooksAsWell() {
    Term others = CallOfSome();
    if (Below(2) == 0) others = {.kind = Kind::kAnd, .args = {CallOfSome(), std::move(others)}};
    const Kind looks = Below(2) == 0 ? Kind::kHighP : Kind::kGrip;
    return {.kind = Kind::kAnd, .args = {std::move(others), {.kind = looks}}};
  }

  Term Touch() { return {.kind = Kind::kTouch, .which = static_cast<int>(Below(kRoles))}; }

  // In a condition it may count who plays `any`.
  Term CallOfSome() {
    Term call = Call();
    if ((rules_[call.which].roles & kP & ~call.named) != 0 && Below(2) == 0) call.at_least = 2;
    return call;
  }

  Term Call() {
    Term call{.kind = Kind::kRule, .which = AnyRule()};
    const unsigned roles = rules_[call.which].roles;
    call.named = Below(3) == 0 ? roles & Below(8) : roles;
    return call;
  }

  std::mt19937_64& random_;
  std::vector<RandomRule>& rules_;
};

// Writes rules down.
class Writer {
 public:
  explicit Writer(const std::vector<RandomRule>& rules) : rules_(rules) {}

  std::string Text() const {
    std::string text = "grammar random\n";
    for (std::size_t i = 0; i < rules_.size(); ++i) text += RuleText(static_cast<int>(i));
    return text;
  }

 private:
  std::string TermText(const Term& term) const {
    switch (term.kind) {
      case Kind::kTouch:
        return std::string("touching(x, ") + kNames[term.which] + ")";
      case Kind::kGrip:
        return "(trigger(x) >= 0.5)";
      case Kind::kHighP:
        return "height(p) >= 2 m";
      case Kind::kHigh: {
        const std::string value = std::to_string(term.value) + " m";
        return term.anchor.empty() ? "height(x) >= " + value
                                   : "height(x) >= height(x)@" + term.anchor + " + " + value;
      }
      case Kind::kRising: {
        const std::string rate = "rate(height(x), " + std::to_string(term.window) + " ms)";
        return rate + " >= " + (term.anchor.empty() ? "" : rate + "@" + term.anchor + " + ") +
               std::to_string(250 * term.value) + " m/s";
      }
      case Kind::kOfWindow: {
        const bool speed = term.which == kSpeed;
        const std::string value = std::string(kOverWindow[term.which]) +
                                  (speed ? "(x, " : "(height(x), ") + std::to_string(term.window) +
                                  " ms)";
        return value + " > " + (term.anchor.empty() ? "" : value + "@" + term.anchor + " + ") +
               std::to_string(speed ? 250 * term.value : term.value) + (speed ? " m/s" : ".5 m");
      }
      case Kind::kRule:
        return (term.at_least > 1 ? "at least 2 of " : "") +
               Head(term.which, rules_[term.which].roles, term.named, false);
      case Kind::kNot:
        return "(not " + TermText(term.args[0]) + ")";
      case Kind::kKnown:
        return "(known " + TermText(term.args[0]) + ")";
      case Kind::kEdge:
        return "(" + TermText(term.args[0]) + (term.begins ? " begins)" : " ends)");
      default:
        return "(" + TermText(term.args[0]) + (term.kind == Kind::kAnd ? " and " : " or ") +
               TermText(term.args[1]) + ")";
    }
  }

  std::string RuleText(int index) const {
    const RandomRule& rule = rules_[index];
    // As written; in whole ticks the same as without the half.
    const std::string half = rule.halves ? ".5 ms" : " ms";
    const auto at_most = [&](Tick ticks) { return std::to_string(ticks) + half; };
    const auto at_least = [&](Tick ticks) {
      return std::to_string(ticks - (rule.halves ? 1 : 0)) + half;
    };
    std::string text = "event " + Head(index, rule.roles, rule.roles, true) + "\n ";
    switch (rule.form) {
      case Form::kWhile:
        text += " while " + TermText(rule.first) +
                (rule.has_second ? " until " + TermText(rule.second) : "");
        break;
      case Form::kFromTo:
      case Form::kWithout:
        text += (rule.from_each ? " from each " : " from ") + TermText(rule.first) +
                (rule.form == Form::kWithout ? " without " : " to ") + TermText(rule.second) +
                (rule.within < 0               ? ""
                 : rule.form == Form::kWithout ? " within " + at_least(rule.within)
                                               : " within " + at_most(rule.within)) +
                (rule.has_during ? " during " + TermText(rule.during) : "") +
                (rule.or_drop && rule.form == Form::kFromTo ? " or drop" : "");
        break;
      case Form::kUntil:
        text += " until " + TermText(rule.first) + " since " + TermText(rule.second) +
                ApproachText(rule) + " at most " + at_most(rule.back) + " back";
        break;
      case Form::kRest:
        text += " rest of " + TermText(rule.calls[0]) + " outside " + TermText(rule.calls[1]);
        for (std::size_t i = 2; i < rule.calls.size(); ++i) text += ", " + TermText(rule.calls[i]);
        break;
      case Form::kCompose:
        text += (rule.takes_first ? " compose first " : " compose ") + ComposeText(rule);
        break;
      case Form::kAllOf:
        text += " all of " + ComposeText(rule) + " within " + at_most(rule.within);
        break;
      case Form::kRepeat:
        text += " repeat " + TermText(rule.calls[0]) +
                (rule.calls.size() > 1 ? " or " + TermText(rule.calls[1]) : "") + " at least " +
                std::to_string(rule.at_least) +
                (rule.within >= 0 ? " within " + at_most(rule.within)
                                  : ", gap at most " + at_most(rule.bridging));
        break;
    }
    if (rule.bridging > 0 && rule.form != Form::kRepeat)
      text += " bridging " + at_most(rule.bridging);
    if (rule.one_per) text += " one p per x";
    if (rule.nearest_within > 0) text += ", nearest within " + at_most(rule.nearest_within);
    if (rule.lasting > 0) text += " lasting " + at_least(rule.lasting);
    if (rule.lasting_most > 0) text += " to " + at_most(rule.lasting_most);
    if (rule.has_requirement) text += " requires " + TermText(rule.requirement);
    if (rule.is_confirmed)
      text += " confirmed by " + TermText(rule.by) + " within " + TermText(rule.episode);
    return text + "\n";
  }

  static std::string ApproachText(const RandomRule& rule) {
    if (!rule.approaches) return {};
    std::string text =
        " approaching height(x) receding at most " + std::to_string(rule.slack_m) + ".5 m";
    if (rule.over > 0) text += " over " + std::to_string(rule.over) + " ms";
    if (rule.idles) {
      const std::string still = std::to_string(rule.still_over) + " ms";
      text += rule.still_over > 0
                  ? ", with surface_speed(x) slower than 370 m/s or within 1.5 m over " + still
                  : ", slower than 370 m/s";
      text += " at most " + std::to_string(rule.idle) + " ms";
    }
    return text + (rule.onset_m_per_s == 120 ? ", onset 120 m/s" : "");
  }

  std::string ComposeText(const RandomRule& rule) const {
    std::string text;
    for (std::size_t i = 0; i < rule.calls.size(); ++i) {
      text += (i == 0 ? "a" : ", a") + std::to_string(i) + ": " + TermText(rule.calls[i]);
      for (const auto& [part, call] : rule.choices)
        if (part == i) text += " or " + TermText(call);
    }
    std::string comma = " where ";
    const auto label = [](std::size_t part) { return "a" + std::to_string(part); };
    if (rule.has_absence)
      text += std::exchange(comma, ", ") + "without " + TermText(rule.during) + " between " +
              label(rule.left) + " and " + label(rule.right);
    for (const RandomRule::Clause& clause : rule.clauses) {
      text += std::exchange(comma, ", ") + label(clause.left) + " ";
      std::string names;
      for (const bool bounded : {true, false}) {
        for (std::size_t i = 0; i < kAllenNames.size(); ++i) {
          const Tick within = clause.relations.within[i];
          if ((clause.relations.any >> i & 1) == 0 || (within >= 0) != bounded) continue;
          names += (names.empty() ? "" : "|") + std::string(kAllenNames[i]);
          if (bounded) names += " within " + std::to_string(within) + ".5 ms";
        }
      }
      text += names + " a" + std::to_string(clause.right);
    }
    return text;
  }

  const std::vector<RandomRule>& rules_;
};

}  // namespace

RandomEpisode MakeEpisode(std::mt19937_64& random, int frames, unsigned calm) {
  RandomEpisode episode;
  std::array<bool, 4> touches = {};
  int height = 0;
  Tick tick = static_cast<Tick>(random() % 5);
  const bool uneven = random() % 2 == 0;
  bool is_lost = false, grips = false;
  const unsigned lost_each = random() % 2 == 0 ? 2 * calm : 0;
  for (int i = 0; i < frames; ++i) {
    if (lost_each > 0 && random() % (is_lost ? calm : lost_each) == 0) is_lost = !is_lost;
    episode.lost.push_back(is_lost);
    for (std::size_t k = 0; k < touches.size(); ++k) {
      if (random() % calm == 0) touches[k] = !touches[k];
      episode.touches[k].push_back(touches[k]);
    }
    if (random() % calm == 0) height = static_cast<int>(random() % 4);
    episode.height_m.push_back(height);
    if (random() % calm == 0) grips = !grips;
    episode.grips.push_back(grips);
    episode.ticks.push_back(tick);
    tick += 1 + static_cast<Tick>(uneven && random() % 4 == 0 ? random() % 6 : 0);
  }
  episode.ticks.push_back(tick);
  return episode;
}

std::string Drawn(const RandomEpisode& episode) {
  static constexpr std::array<const char*, 4> kFacts = {"p1 ", "p2 ", "q  ", "r  "};
  std::string text;
  for (std::size_t k = 0; k < kFacts.size(); ++k) {
    text += kFacts[k];
    for (const bool b : episode.touches[k]) text += b ? '#' : '.';
    text += '\n';
  }
  text += "z  ";
  for (int i = 0; i < episode.frames(); ++i)
    text += episode.lost[i] ? "?" : std::to_string(episode.height_m[i]);
  text += "\ngrip ";
  for (const bool grips : episode.grips) text += grips ? '#' : '.';
  text += "\nticks";
  for (const Tick tick : episode.ticks) text += " " + std::to_string(tick);
  return text + "\n";
}

EntityTable RandomEntityTable() {
  EntityTable entity_table{.ticks_per_second = 1000};
  const std::pair<const char*, const char*> all[] = {
      {"x", "X"}, {"p1", "P"}, {"p2", "P"}, {"q", "Q"}, {"r", "R"}};
  for (const auto& [name, class_name] : all)
    entity_table.entities.push_back({.name = name, .classes = {class_name, "Thing", "Entity"}});
  entity_table.entities.front().classes = {"Hand", "Entity"};
  return entity_table;
}

void EpisodeFeed::Step(Shown shown, std::vector<Event>& events) {
  const int frame = next_++;
  if (frame == episode_.frames()) return monitor_.Finish(episode_.ticks.back(), events);
  std::vector<ContactEnd> contact_ends;
  touches_.clear();
  for (std::size_t k = 0; k < episode_.touches.size(); ++k) {
    const int whom = static_cast<int>(k) + 1;
    const bool touches = episode_.touches[k][frame];
    const bool touched = frame > 0 && episode_.touches[k][frame - 1];
    if (touches && (!touched || shown != Shown::kNew)) touches_.push_back({.a = 0, .b = whom});
    if (!touches && touched) contact_ends.push_back({whom, 0});
  }
  if (episode_.lost[frame]) {
    looks_[0] = NotTracked();
  } else {
    looks_[0] = {};
    looks_[0].p_WB_m.z() = episode_.height_m[frame];
  }
  looks_[2].p_WB_m.z() = kHeightOfP2_m;
  const std::array changes = {EntityChange{.entity = 2, .look = looks_[2]},
                              EntityChange{.entity = 0, .look = looks_[0]}};
  const CollisionSphere surface{.p_W_m = looks_[0].p_WB_m};
  const HandSample hand{.entity = 0,
                        .trigger = episode_.grips[frame] ? 1.0 : 0.0,
                        .collision_spheres = {&surface, 1}};
  const bool moves = frame == 0 || episode_.height_m[frame] != episode_.height_m[frame - 1] ||
                     episode_.lost[frame] != episode_.lost[frame - 1];
  const std::size_t shows_pose = moves || shown != Shown::kNew ? 1 : 0;
  const bool pulls = frame > 0 && episode_.grips[frame] != episode_.grips[frame - 1];
  if (shown == Shown::kWhole)
    return monitor_.Advance({.tick = episode_.ticks[frame],
                             .entities = looks_,
                             .hands = {&hand, 1},
                             .touches = touches_},
                            events);
  monitor_.AdvanceBy(
      {.tick = episode_.ticks[frame],
       .entities = std::span(changes).subspan(frame == 0 ? 0 : 1, frame == 0 ? 2 : shows_pose),
       .hands = {&hand, pulls ? 1 : shows_pose},
       .touches = touches_,
       .contact_ends = contact_ends},
      events);
}

RandomGrammar::RandomGrammar(std::mt19937_64& random, int rules) {
  Maker maker(random, rules_);
  for (int i = 0; i < rules; ++i) maker.Add();
  text_ = Writer(rules_).Text();
}

std::map<std::string, std::vector<Interval>> RandomGrammar::Expected(
    const RandomEpisode& episode) const {
  const std::vector<std::array<MeantIntervals, 2>> meaning = MeaningOf(rules_, episode);
  std::map<std::string, std::vector<Interval>> expected;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    const bool two = (rules_[i].roles & kP) != 0;
    for (int p = 0; p < (two ? 2 : 1); ++p) {
      std::vector<Interval> intervals;
      for (const reference::Timed& one : meaning[i][p]) intervals.push_back(one.ticks);
      if (intervals.empty()) continue;
      std::sort(intervals.begin(), intervals.end(),
                [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
      expected["rule" + std::to_string(i) + (two ? "(p" + std::to_string(p + 1) + ")" : "")] =
          std::move(intervals);
    }
  }
  return expected;
}

}  // namespace prehend::grammar::testing
