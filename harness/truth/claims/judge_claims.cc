// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/claims/judge_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>

#include "grammar/base/diagnostic.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

using grammar::NamedEvent;

/// Events by their index in the timeline.
using Indices = std::vector<std::size_t>;

/// "grasping(any, jug)", as it was claimed.
std::string TextOf(const ClaimedEvent& claimed) {
  if (claimed.roles.empty()) return claimed.name.text;
  std::vector<std::string> roles;
  for (const ClaimRole& role : claimed.roles)
    roles.push_back((role.name.text.empty() ? "" : role.name.text + "=") + role.value.text);
  return fmt::format("{}({})", claimed.name.text, fmt::join(roles, ", "));
}

class ClaimJudge {
 public:
  ClaimJudge(const Claim& claim, const ClaimableEvents& known, const grammar::Timeline& timeline)
      : claim_(claim), timeline_(timeline) {
    for (const ClaimedEvent& claimed : claim.events) {
      Indices& fitting = fitting_.emplace_back();
      for (std::size_t i = 0; i < timeline.events.size(); ++i) {
        if (Fits(timeline.events[i], claimed, known)) fitting.push_back(i);
      }
    }
    related_ = Related();
  }

  bool Holds() const {
    const auto count = related_.size(), wanted = static_cast<std::size_t>(claim_.number);
    switch (claim_.quantity) {
      case Quantity::kAtLeast:
        return count >= wanted;
      case Quantity::kAtMost:
        return count <= wanted;
      case Quantity::kExactly:
        return count == wanted;
      case Quantity::kEvery:
        return count > 0 && count == fitting_.front().size();
    }
    return false;
  }

  /// "found 11"; of events that are to lie somewhere, "found 2 of 3".
  std::string Found() const {
    const std::size_t all = fitting_.front().size();
    if (all == 0) return "found none";
    if (claim_.relations.empty()) return fmt::format("found {}", all);
    return fmt::format("found {} of {}", related_.size(), all);
  }

  std::string Times() const {
    std::string lines;
    for (std::size_t i = 0; i < fitting_.size(); ++i) {
      if (!fitting_[i].empty()) {
        lines += TimesOf(fitting_[i]);
        continue;
      }
      const Indices others = EventsNamed(claim_.events[i].name.text);
      lines += fmt::format("  no {}{}\n", TextOf(claim_.events[i]),
                           others.empty() ? "" : ", but of others:");
      lines += TimesOf(others);
    }
    return lines;
  }

 private:
  /// A line for each, of many for the first.
  std::string TimesOf(const Indices& events) const {
    constexpr std::size_t kMostShown = 20;
    std::string lines;
    for (std::size_t k = 0; k < std::min(events.size(), kMostShown); ++k) {
      const NamedEvent& event = timeline_.events[events[k]];
      lines += fmt::format("  {} {}\n", event.Label(),
                           IntervalText(event.interval, timeline_.ticks_per_second));
    }
    if (events.size() > kMostShown)
      lines += fmt::format("  and {} more\n", events.size() - kMostShown);
    return lines;
  }

  Indices EventsNamed(const std::string& name) const {
    Indices named;
    for (std::size_t i = 0; i < timeline_.events.size(); ++i) {
      if (timeline_.events[i].event == name) named.push_back(i);
    }
    return named;
  }

  /// The first of each chain, found from its end.
  Indices Related() const {
    Indices later = fitting_.back();
    for (std::size_t i = claim_.relations.size(); i-- > 0;) {
      Indices earlier;
      for (const std::size_t event : fitting_[i]) {
        const bool lies_so = std::ranges::any_of(later, [&](std::size_t other) {
          return other != event && (claim_.relations[i] & Bit(Relate(event, other))) != 0;
        });
        if (lies_so) earlier.push_back(event);
      }
      later = std::move(earlier);
    }
    return later;
  }

  grammar::Allen Relate(std::size_t a, std::size_t b) const {
    return grammar::Relate(timeline_.events[a].interval, timeline_.events[b].interval);
  }

  const Claim& claim_;
  const grammar::Timeline& timeline_;
  std::vector<Indices> fitting_;  ///< for each event of the claim
  Indices related_;               ///< of the first event's, those that lie as claimed
};

using grammar::EventSignature;
using Names = std::vector<std::string>;

constexpr const char* kStyle = "style";

const EventSignature* Find(const ClaimableEvents& known, const std::string& event) {
  const auto found = std::ranges::find(known.events, event, &EventSignature::name);
  return found == known.events.end() ? nullptr : &*found;
}

bool IsAnybody(const ClaimRole& role) { return role.value.text == kAnybody; }

bool IsStyle(const ClaimRole& role) { return role.name.text == kStyle; }

/// The role of the head that the i-th of a claimed event is about; the style has none.
std::size_t IndexOf(const EventSignature& event, const ClaimedEvent& claimed, std::size_t i) {
  const std::string& name = claimed.roles[i].name.text;
  if (name.empty()) return i;
  return static_cast<std::size_t>(std::ranges::find(event.roles, name) - event.roles.begin());
}

/// Mismatches of one claimed event.
class FittingEvent {
 public:
  FittingEvent(const EventSignature& event, const ClaimedEvent& claimed,
               const ClaimableEvents& known)
      : event_(event), claimed_(claimed), known_(known), taken_(event.roles.size(), false) {}

  std::vector<ClaimProblem> Problems() {
    for (std::size_t i = 0; i < claimed_.roles.size(); ++i) CheckRole(i);
    return std::move(problems_);
  }

 private:
  void CheckRole(std::size_t i) {
    const ClaimRole& role = claimed_.roles[i];
    if (IsStyle(role)) {
      if (!event_.has_style) Add(role.name, fmt::format("'{}' has no style", event_.name));
      return;
    }
    const std::size_t index = IndexOf(event_, claimed_, i);
    if (index >= event_.roles.size()) return AddUnknownRole(role);
    if (taken_[index])
      return Add(role.name, fmt::format("the role '{}' is given twice", event_.roles[index]));
    taken_[index] = true;
    const bool is_first = IsAnybody(role) || players_.insert(role.value.text).second;
    if (is_first) return CheckClass(role, index);
    Add(role.value,
        fmt::format("'{}' cannot have two roles of '{}'", role.value.text, event_.name));
  }

  void AddUnknownRole(const ClaimRole& role) {
    if (std::ranges::count(event_.attributes, role.name.text) > 0)
      return Add(role.name,
                 fmt::format("'{}' is a value of '{}'; a claim asks for roles and 'style' only",
                             role.name.text, event_.name),
                 "leave it out; 'prehend run' prints the values of events");
    if (!role.name.text.empty())
      return Add(role.name, fmt::format("'{}' has no role '{}'", event_.name, role.name.text),
                 HintForName(role.name.text, event_.roles));
    std::string head = event_.name + "(";
    for (const std::string& name : event_.roles)
      head += (&name == &event_.roles.front() ? "" : ", ") + name;
    Add(role.value,
        fmt::format("'{}' has {}", event_.name,
                    grammar::CountOf(static_cast<long long>(event_.roles.size()), "role")),
        "it is " + head + ")");
  }

  /// Of a symmetric event the first two roles have the same class.
  void CheckClass(const ClaimRole& role, std::size_t index) {
    const auto& entities = known_.entity_table.entities;
    const auto entity = std::ranges::find(entities, role.value.text, &grammar::EntityInfo::name);
    if (entity == entities.end()) return;  // one of UnknownNames(), or anybody
    const std::string& wanted = event_.classes[index];
    if (Takes(index, role.value.text)) return;
    Add(role.value,
        fmt::format("'{}' is never '{}' of '{}', which takes {}", role.value.text,
                    event_.roles[index], event_.name, grammar::WithArticle(wanted)),
        Remedy(index));
  }

  /// Whether anybody of this name can have the role.
  bool Takes(std::size_t index, const std::string& name) const {
    const auto& entities = known_.entity_table.entities;
    const auto entity = std::ranges::find(entities, name, &grammar::EntityInfo::name);
    return entity != entities.end() &&
           std::ranges::count(entity->classes, event_.classes[index]) > 0;
  }

  /// The event with two participants exchanged if they fit so; else who can have the role.
  std::string Remedy(std::size_t index) const {
    std::size_t by_place = 0;
    while (by_place < claimed_.roles.size() && claimed_.roles[by_place].name.text.empty())
      ++by_place;
    const auto name = [&](std::size_t i) { return claimed_.roles[i].value.text; };
    for (std::size_t other = 0; index < by_place && other < by_place; ++other) {
      if (other == index || !Takes(index, name(other)) || !Takes(other, name(index))) continue;
      std::string exchanged = event_.name + "(";
      for (std::size_t i = 0; i < by_place; ++i)
        exchanged += (i == 0 ? "" : ", ") + name(i == index ? other : i == other ? index : i);
      return "did you mean '" + exchanged + (by_place < claimed_.roles.size() ? ", ..)'?" : ")'?");
    }
    std::string who;
    for (const grammar::EntityInfo& entity : known_.entity_table.entities)
      if (Takes(index, entity.name)) who += (who.empty() ? "" : ", ") + entity.name;
    return who.empty() ? "the scenario has none" : "that can be " + who;
  }

  void Add(const ClaimWord& word, std::string message, std::string hint = {}) {
    problems_.push_back({word.offset, std::move(message), std::move(hint)});
  }

  const EventSignature& event_;
  const ClaimedEvent& claimed_;
  const ClaimableEvents& known_;
  std::vector<bool> taken_;
  std::set<std::string> players_;
  std::vector<ClaimProblem> problems_;
};

bool FitsInOrder(const grammar::NamedEvent& event, const EventSignature& signature,
                 const ClaimedEvent& claimed, bool exchanged) {
  for (std::size_t i = 0; i < claimed.roles.size(); ++i) {
    const ClaimRole& role = claimed.roles[i];
    if (IsAnybody(role)) continue;
    if (IsStyle(role)) {
      const auto style = std::ranges::find(event.roles, kStyle, &grammar::Role::name);
      if (style == event.roles.end() || style->value != role.value.text) return false;
      continue;
    }
    std::size_t index = IndexOf(signature, claimed, i);
    if (exchanged && index < 2) index = 1 - index;
    if (index >= event.roles.size() || event.roles[index].value != role.value.text) return false;
  }
  return true;
}

}  // namespace

bool IsAboutLimit(const Claim& claim) {
  return std::ranges::any_of(claim.events, [](const ClaimedEvent& event) {
    return std::ranges::count(kLimitEvents, std::string_view(event.name.text)) > 0;
  });
}

std::vector<ClaimVerdict> JudgeClaims(const std::vector<Claim>& claims, const std::string& file,
                                      const ClaimableEvents& known,
                                      const grammar::Timeline& timeline) {
  std::vector<ClaimVerdict> verdicts;
  for (const Claim& claim : claims) {
    if (IsAboutLimit(claim)) continue;
    const std::string place = claim.where.source == 0
                                  ? fmt::format("{}:{}", file, claim.where.place.line)
                                  : std::string("--set");
    ClaimVerdict& verdict = verdicts.emplace_back(
        ClaimVerdict{.claim = claim.text, .place = place, .says = kNotJudged});
    const std::vector<ClaimProblem> mismatches = Mismatches(claim, known);
    if (!mismatches.empty()) {
      verdict.found = "not judged: " + mismatches.front().message;
      continue;
    }
    const ClaimJudge judge(claim, known, timeline);
    verdict.says = judge.Holds() ? kHolds : kContradicted;
    verdict.found = judge.Found();
    verdict.times = judge.Times();
  }
  return verdicts;
}

std::string Text(const ClaimVerdict& verdict) {
  return fmt::format("expects: '{}' ({}): {}", verdict.claim, verdict.place, verdict.found);
}

nlohmann::ordered_json ClaimsJson(const std::vector<ClaimVerdict>& verdicts) {
  nlohmann::ordered_json claims = nlohmann::ordered_json::array();
  for (const ClaimVerdict& verdict : verdicts)
    claims.push_back({{"claim", verdict.claim},
                      {"place", verdict.place},
                      {"verdict", verdict.says},
                      {"found", verdict.found}});
  return claims;
}

bool IsContradicted(const ClaimVerdict& verdict) { return verdict.says == kContradicted; }

std::string TextOfContradicted(const std::vector<ClaimVerdict>& verdicts) {
  std::string text;
  for (const ClaimVerdict& verdict : verdicts) {
    if (IsContradicted(verdict)) text += Text(verdict) + "\n" + verdict.times;
  }
  return text;
}

std::string TextOfUndecided(const std::vector<ClaimVerdict>& verdicts) {
  std::string text;
  for (const ClaimVerdict& verdict : verdicts) {
    if (verdict.says == kNotJudged) text += Text(verdict) + "\n";
  }
  return text;
}

std::vector<ClaimProblem> UnknownNames(const Claim& claim, const ClaimableEvents& known) {
  Names entities;
  for (const grammar::EntityInfo& entity : known.entity_table.entities)
    entities.push_back(entity.name);
  const Names& styles = known.entity_table.styles;
  std::vector<ClaimProblem> problems;
  for (const ClaimedEvent& claimed : claim.events) {
    for (const ClaimRole& role : claimed.roles) {
      const std::string& value = role.value.text;
      const EventSignature* event = Find(known, claimed.name.text);
      if (event && std::ranges::count(event->attributes, role.name.text) > 0 && !IsStyle(role))
        continue;  // one of Mismatches()
      if (IsAnybody(role) || std::ranges::count(IsStyle(role) ? styles : entities, value) > 0)
        continue;
      problems.push_back({role.value.offset,
                          IsStyle(role) ? "no hand of the scenario has the style '" + value + "'"
                                        : "the scenario has no '" + value + "'",
                          HintForName(value, IsStyle(role) ? styles : entities)});
    }
  }
  return problems;
}

std::vector<ClaimProblem> Mismatches(const Claim& claim, const ClaimableEvents& known) {
  std::vector<ClaimProblem> problems;
  if (IsAboutLimit(claim)) return problems;
  for (const ClaimedEvent& claimed : claim.events) {
    if (const EventSignature* event = Find(known, claimed.name.text)) {
      for (ClaimProblem& problem : FittingEvent(*event, claimed, known).Problems())
        problems.push_back(std::move(problem));
      continue;
    }
    Names events;
    for (const EventSignature& event : known.events) events.push_back(event.name);
    problems.push_back(
        {claimed.name.offset,
         fmt::format("grammar '{}' has no event '{}'", known.grammar, claimed.name.text),
         HintForName(claimed.name.text, events)});
  }
  return problems;
}

bool Fits(const grammar::NamedEvent& event, const ClaimedEvent& claimed,
          const ClaimableEvents& known) {
  if (event.event != claimed.name.text) return false;
  const EventSignature& signature = *Find(known, event.event);
  return FitsInOrder(event, signature, claimed, false) ||
         (signature.symmetric && FitsInOrder(event, signature, claimed, true));
}

}  // namespace prehend::truth
