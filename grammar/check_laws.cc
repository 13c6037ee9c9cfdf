// SPDX-License-Identifier: Apache-2.0
// Each call of a law becomes the intervals of the events that fit it, with who plays
// the law's roles in them. A form then compares intervals whose players agree.
#include "grammar/check_laws.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "grammar/base/timeline.h"

namespace prehend::grammar {
namespace {

/// Who plays the law's roles, kNoEntity where a call leaves the role open.
using Players = std::array<int, kMaxRoles>;

struct CallInterval {
  Interval interval;
  Players players;
};
using CallIntervals = std::vector<CallInterval>;

/// What is said of one call, and where it is so.
struct Occurrences {
  const LawCall* call = nullptr;
  CallIntervals where;
};

constexpr Players kOpen = {kNoEntity, kNoEntity, kNoEntity, kNoEntity};

/// No role is played by one in the first and by another one in the second.
bool Agree(const Players& a, const Players& b) {
  for (std::size_t role = 0; role < a.size(); ++role) {
    if (a[role] != kNoEntity && b[role] != kNoEntity && a[role] != b[role]) return false;
  }
  return true;
}

/// The two together, or nothing when one entity would play two roles.
bool Distinct(const Players& a, const Players& b) {
  Players all = a;
  for (std::size_t role = 0; role < all.size(); ++role) {
    if (all[role] == kNoEntity) all[role] = b[role];
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] != kNoEntity && std::count(all.begin(), all.end(), all[i]) > 1) return false;
  }
  return true;
}

bool Overlap(const Interval& a, const Interval& b) { return a.begin < b.end && b.begin < a.end; }

class Checker {
 public:
  Checker(const Program& program, const EntityTable& entity_table, const Timeline& timeline)
      : program_(program), entity_table_(entity_table) {
    std::map<std::string, int, std::less<>> entities;
    for (std::size_t i = 0; i < entity_table.entities.size(); ++i)
      entities.emplace(entity_table.entities[i].name, static_cast<int>(i));
    for (const NamedEvent& event : timeline.events) {
      Happened happened{.interval = event.interval, .roles = kOpen};
      for (std::size_t i = 0; i < std::min(event.roles.size(), kOpen.size()); ++i) {
        const auto found = entities.find(event.roles[i].value);
        if (found != entities.end()) happened.roles[i] = found->second;
      }
      happened_[event.event].push_back(happened);
    }
  }

  std::vector<LawViolation> Run() {
    for (const Law& law : program_.laws) {
      law_ = &law;
      const std::size_t before = violations_.size();
      Check();
      const auto first = violations_.begin() + static_cast<std::ptrdiff_t>(before);
      const auto key = [](const LawViolation& v) {
        return std::tie(v.when.begin, v.when.end, v.what);
      };
      std::sort(first, violations_.end(),
                [&](const auto& a, const auto& b) { return key(a) < key(b); });
      // The two of a symmetric event, and two roles of one class, are tried in either order.
      violations_.erase(std::unique(first, violations_.end(),
                                    [&](const auto& a, const auto& b) { return key(a) == key(b); }),
                        violations_.end());
    }
    return std::move(violations_);
  }

 private:
  struct Happened {
    Interval interval;
    std::array<int, kMaxRoles> roles;  ///< of the event's head
  };

  void Check() {
    std::vector<Occurrences> subjects = All(law_->subjects);
    switch (law_->form) {
      case LawForm::kCovered:
        return CheckCovered(subjects.front());
      case LawForm::kRelated:
        for (const Occurrences& subject : subjects) CheckRelated(subject);
        return;
      case LawForm::kApart:
        return CheckApart(subjects);
    }
  }

  std::vector<Occurrences> All(const std::vector<LawCall>& calls) const {
    std::vector<Occurrences> all;
    for (const LawCall& call : calls) all.push_back({&call, CallsIn(call)});
    return all;
  }

  CallIntervals CallsIn(const LawCall& call) const {
    const Rule& rule = program_.rules[call.rule];
    const auto found = happened_.find(rule.name);
    if (found == happened_.end()) return {};
    CallIntervals where;
    for (const Happened& event : found->second) {
      AddIfItFits(call, event, where);
      if (!rule.symmetric) continue;
      Happened turned = event;
      std::swap(turned.roles[0], turned.roles[1]);
      AddIfItFits(call, turned, where);
    }
    return call.has_any ? Merged(where) : where;
  }

  void AddIfItFits(const LawCall& call, const Happened& event, CallIntervals& where) const {
    Players players = kOpen;
    for (std::size_t i = 0; i < call.players.size(); ++i) {
      const LawCall::Player& player = call.players[i];
      if (!IsA(event.roles[i], player.class_name)) return;
      if (player.role >= 0) players[static_cast<std::size_t>(player.role)] = event.roles[i];
    }
    where.push_back({event.interval, players});
  }

  bool IsA(int entity, const std::string& class_name) const {
    if (entity == kNoEntity) return false;
    const std::vector<std::string>& classes =
        entity_table_.entities[static_cast<std::size_t>(entity)].classes;
    return std::find(classes.begin(), classes.end(), class_name) != classes.end();
  }

  /// `any` makes one interval of those that overlap or follow at once.
  static CallIntervals Merged(const CallIntervals& where) {
    std::map<Players, std::vector<Interval>> intervals;
    for (const CallInterval& one : where) intervals[one.players].push_back(one.interval);
    CallIntervals merged;
    for (auto& [players, all] : intervals) {
      for (const Interval& interval : Union(std::move(all))) merged.push_back({interval, players});
    }
    return merged;
  }

  void CheckCovered(const Occurrences& subject) {
    const std::vector<Occurrences> others = All(law_->others);
    for (const CallInterval& whole : subject.where) {
      std::vector<Interval> parts;
      for (const Occurrences& other : others) {
        for (const CallInterval& part : other.where) {
          if (Agree(whole.players, part.players)) parts.push_back(part.interval);
        }
      }
      for (const Interval& left : Without(whole.interval, Union(std::move(parts)))) {
        std::string what = Text(*subject.call, whole.players) + " lies outside ";
        for (const Occurrences& other : others)
          what += (&other == &others.front() ? "" : ", ") + Text(*other.call, whole.players);
        violations_.push_back({law_, left, std::move(what)});
      }
    }
  }

  void CheckRelated(const Occurrences& subject) {
    const std::vector<Occurrences> others = All(law_->others);
    for (const CallInterval& one : subject.where) {
      const bool related = std::any_of(others.begin(), others.end(), [&](const Occurrences& other) {
        return std::any_of(other.where.begin(), other.where.end(), [&](const CallInterval& to) {
          return Agree(one.players, to.players) &&
                 (law_->relations & Bit(Relate(one.interval, to.interval))) != 0;
        });
      });
      if (related) continue;
      std::string what = Text(*subject.call, one.players) + " " + law_->relation_text;
      for (const Occurrences& other : others)
        what += (&other == &others.front() ? " no " : " and no ") + Text(*other.call, one.players);
      violations_.push_back({law_, one.interval, std::move(what)});
    }
  }

  void CheckApart(const std::vector<Occurrences>& subjects) {
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      for (std::size_t j = i + 1; j < subjects.size(); ++j) CheckApart(subjects[i], subjects[j]);
    }
  }

  // The later one is said to overlap the earlier one, whichever the law names first.
  void CheckApart(const Occurrences& a, const Occurrences& b) {
    for (const CallInterval& one : a.where) {
      for (const CallInterval& other : b.where) {
        if (!Overlap(one.interval, other.interval) || !Agree(one.players, other.players) ||
            !Distinct(one.players, other.players))
          continue;
        std::string first = Text(*a.call, one.players);
        std::string later = Text(*b.call, other.players);
        if (std::tie(one.interval.begin, first) > std::tie(other.interval.begin, later))
          std::swap(first, later);
        const Interval both = {std::max(one.interval.begin, other.interval.begin),
                               std::min(one.interval.end, other.interval.end)};
        violations_.push_back({law_, both, later + " overlaps " + first});
      }
    }
  }

  /// "supported_by(milk, any)"
  std::string Text(const LawCall& call, const Players& players) const {
    std::string text = program_.rules[call.rule].name + "(";
    for (std::size_t i = 0; i < call.players.size(); ++i) {
      if (i > 0) text += ", ";
      const LawCall::Player& player = call.players[i];
      const int entity =
          player.role < 0 ? kNoEntity : players[static_cast<std::size_t>(player.role)];
      if (entity != kNoEntity) {
        text += entity_table_.entities[static_cast<std::size_t>(entity)].name;
      } else {
        text += player.any_text;
      }
    }
    return text + ")";
  }

  const Program& program_;
  const EntityTable& entity_table_;
  std::map<std::string, std::vector<Happened>, std::less<>> happened_;  // by event
  const Law* law_ = nullptr;
  std::vector<LawViolation> violations_;
};

}  // namespace

std::vector<LawViolation> CheckLaws(const Program& program, const EntityTable& entity_table,
                                    const Timeline& timeline) {
  return Checker(program, entity_table, timeline).Run();
}

}  // namespace prehend::grammar
