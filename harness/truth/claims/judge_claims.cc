// SPDX-License-Identifier: Apache-2.0
// See harness/truth/claims/judge_claims.h. Tested by
// tests/harness/truth/claims/judge_claims_test.cc
#include "harness/truth/claims/judge_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

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

}  // namespace

std::vector<ClaimVerdict> JudgeClaims(const std::vector<Claim>& claims, const std::string& file,
                                      const ClaimableEvents& known,
                                      const grammar::Timeline& timeline) {
  std::vector<ClaimVerdict> verdicts;
  for (const Claim& claim : claims) {
    const std::string place = claim.where.source == 0
                                  ? fmt::format("{}:{}", file, claim.where.place.line)
                                  : std::string("--set");
    ClaimVerdict& verdict = verdicts.emplace_back(ClaimVerdict{
        .claim = claim.text, .place = place, .says = kNotJudged, .found = {}, .times = {}});
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

}  // namespace prehend::truth
