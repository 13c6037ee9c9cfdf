// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/query_events.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <limits>
#include <span>

#include "grammar/base/allen.h"
#include "grammar/base/diagnostic.h"

namespace prehend::episode {
namespace {

bool Fits(const std::string& pattern, const std::string& text) {
  return fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

const KeptEntity* EntityNamed(const std::string& name, const std::vector<KeptEntity>& entities) {
  const auto found = std::ranges::find(entities, name, &KeptEntity::name);
  return found == entities.end() ? nullptr : &*found;
}

class Asker {
 public:
  Asker(const EventQuestion& question, const std::vector<KeptEntity>& entities,
        const grammar::Timeline& timeline)
      : question_(question), entities_(entities), timeline_(timeline) {
    for (const EventQuestion::Relation& relation : question.relations) {
      Others& others = others_.emplace_back();
      for (const grammar::NamedEvent& event : timeline.events) {
        if (!Fits(relation.event, event.event)) continue;
        others.longest = std::max(others.longest, event.interval.end - event.interval.begin);
        others.first_end = std::min(others.first_end, event.interval.end);
        others.events.push_back(&event);
      }
    }
  }

  bool Holds(const grammar::NamedEvent& event) const {
    const auto seconds = [&](grammar::Tick ticks) {
      return static_cast<double>(ticks) / static_cast<double>(timeline_.ticks_per_second);
    };
    const double begin = seconds(event.interval.begin), end = seconds(event.interval.end);
    if (!question_.event.empty() && !Fits(question_.event, event.event)) return false;
    if (question_.at_least_s && end - begin < *question_.at_least_s) return false;
    if (question_.at_most_s && end - begin > *question_.at_most_s) return false;
    if (question_.from_s && begin < *question_.from_s) return false;
    if (question_.until_s && end > *question_.until_s) return false;
    return AllHold(question_.roles, event,
                   [&](const std::string& value, const std::string& wanted) {
                     const KeptEntity* entity = Find(value);
                     return Fits(wanted, value) || (entity && IsA(*entity, wanted));
                   }) &&
           AllHold(question_.parts_of, event,
                   [&](const std::string& value, const std::string& wanted) {
                     return IsPartOf(value, wanted);
                   }) &&
           HasRelations(event) && (question_.with.empty() || HasParts(event));
  }

 private:
  template <typename Test>
  static bool AllHold(const std::vector<RoleCondition>& conditions,
                      const grammar::NamedEvent& event, const Test& test) {
    return std::ranges::all_of(conditions, [&](const RoleCondition& condition) {
      return std::ranges::any_of(event.roles, [&](const grammar::Role& role) {
        return (condition.role == "any" || condition.role == role.name) &&
               test(role.value, condition.value);
      });
    });
  }

  bool HasParts(const grammar::NamedEvent& event) const {
    const auto parts = PartsOf(event, timeline_, entities_);
    return std::ranges::all_of(question_.with, [&](const std::string& name) {
      return std::ranges::any_of(
          parts, [&](const grammar::NamedEvent* part) { return Fits(name, part->event); });
    });
  }

  const KeptEntity* Find(const std::string& name) const { return EntityNamed(name, entities_); }

  static bool IsA(const KeptEntity& entity, const std::string& wanted) {
    return std::ranges::any_of(entity.classes,
                               [&](const std::string& known) { return Fits(wanted, known); });
  }

  bool IsPartOf(const std::string& name, const std::string& wanted) const {
    const KeptEntity* entity = Find(name);
    for (std::size_t step = 0; entity && step < entities_.size(); ++step) {
      const auto whole = static_cast<std::size_t>(entity->part_of);
      if (entity->part_of < 0 || whole >= entities_.size()) return false;
      entity = &entities_[whole];
      if (Fits(wanted, entity->name) || IsA(*entity, wanted)) return true;
    }
    return false;
  }

  /// The events that a relation speaks of, in the order of their begins.
  struct Others {
    std::vector<const grammar::NamedEvent*> events;
    grammar::Tick longest = 0;
    grammar::Tick first_end = std::numeric_limits<grammar::Tick>::max();
  };

  bool HasRelations(const grammar::NamedEvent& event) const {
    for (std::size_t i = 0; i < others_.size(); ++i) {
      if (!HasRelation(event, question_.relations[i].relation, others_[i])) return false;
    }
    return true;
  }

  static bool HasRelation(const grammar::NamedEvent& event, const std::string& relation,
                          const Others& others) {
    if (others.events.empty()) return false;
    const grammar::Interval& interval = event.interval;
    using grammar::Allen;
    const auto is = [&](Allen allen) {
      return relation == grammar::kAllenNames[static_cast<std::size_t>(allen)];
    };
    if (is(Allen::kBefore)) return others.events.back()->interval.begin > interval.end;
    if (is(Allen::kAfter)) return others.first_end < interval.begin;
    // All others share a moment with it: they begin before it ends, and not too long before.
    const auto begin_of = [](const grammar::NamedEvent* other) { return other->interval.begin; };
    auto other =
        std::ranges::lower_bound(others.events, interval.begin - others.longest, {}, begin_of);
    for (; other != others.events.end() && begin_of(*other) <= interval.end; ++other) {
      if (*other != &event && is(grammar::Relate(interval, (*other)->interval))) return true;
    }
    return false;
  }

  const EventQuestion& question_;
  const std::vector<KeptEntity>& entities_;
  const grammar::Timeline& timeline_;
  std::vector<Others> others_;  ///< one for each relation of the question
};

}  // namespace

bool IsSelected(const EpisodeRow& episode, const std::string& which) {
  for (const auto& [word, value] :
       {std::pair<std::string_view, std::string_view>{"status=", episode.status},
        {"outcome=", episode.outcome}})
    if (which.starts_with(word)) return Fits(which.substr(word.size()), std::string(value));
  const std::string& scenario = episode.scenario;
  return which.empty() || which == std::to_string(episode.id) || which == scenario ||
         Fits(which, scenario) || Fits(which, scenario.substr(scenario.rfind('/') + 1));
}

std::vector<const grammar::NamedEvent*> PartsOf(const grammar::NamedEvent& whole,
                                                const grammar::Timeline& timeline,
                                                const std::vector<KeptEntity>& entities) {
  std::vector<const grammar::NamedEvent*> parts;
  const auto begin_of = [](const grammar::NamedEvent& event) { return event.interval.begin; };
  const auto first = std::ranges::lower_bound(timeline.events, whole.interval.begin, {}, begin_of);
  const auto last = std::ranges::lower_bound(timeline.events, whole.interval.end, {}, begin_of);
  for (const grammar::NamedEvent& event : std::span(first, last)) {
    if (&event == &whole) continue;
    const bool same_participants = std::ranges::all_of(event.roles, [&](const auto& role) {
      return std::ranges::any_of(whole.roles, [&](const grammar::Role& other) {
        return other.value == role.value || !EntityNamed(role.value, entities);
      });
    });
    if (same_participants) parts.push_back(&event);
  }
  return parts;
}

std::optional<RoleCondition> ParseRoleCondition(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    return std::nullopt;
  return RoleCondition{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

std::optional<EventQuestion::Relation> ParseRelation(std::string_view text, std::string& problem) {
  const std::size_t blank = text.find(' ');
  std::string name(text.substr(0, blank));
  if (name == "during") name = "inside";  // Allen's own word
  const std::vector<std::string> known(grammar::kAllenNames.begin(), grammar::kAllenNames.end());
  if (std::ranges::find(known, name) == known.end()) {
    problem = fmt::format(
        "found '{}', wanted one of Allen's relations; {}", name,
        grammar::DidYouMean(name, known, fmt::format("they are {}", fmt::join(known, ", "))));
    return std::nullopt;
  }
  if (blank == std::string_view::npos || blank + 1 == text.size()) {
    problem =
        fmt::format("found '{}', wanted an event after it, like '{} transporting'", text, name);
    return std::nullopt;
  }
  return EventQuestion::Relation{name, std::string(text.substr(blank + 1))};
}

Result<std::vector<EventAnswer>> Ask(const std::string& path, const EventQuestion& question,
                                     KnownNames& known) {
  PREHEND_TRY(const EpisodeFile file, EpisodeFile::Open(path));
  std::vector<EventAnswer> answers;
  for (const EpisodeRow& row : file.episodes()) {
    if (!IsSelected(row, question.scenario)) continue;
    PREHEND_TRY(const grammar::Timeline timeline, file.TimelineOf(row));
    PREHEND_TRY(const std::vector<KeptEntity> entities, file.EntitiesOf(row));
    for (const KeptEntity& entity : entities) {
      known.values.insert(entity.name);
      known.values.insert(entity.classes.begin(), entity.classes.end());
    }
    const Asker asker(question, entities, timeline);
    for (const grammar::NamedEvent& event : timeline.events) {
      known.events.insert(event.event);
      for (const grammar::Role& role : event.roles) {
        known.roles.insert(role.name);
        known.values.insert(role.value);
      }
      if (!asker.Holds(event)) continue;
      EventAnswer& answer = answers.emplace_back();
      answer = {path, row.id, row.scenario, row.ticks_per_second, event, {}, {}};
      for (const grammar::Role& role : event.roles) {
        const KeptEntity* entity = EntityNamed(role.value, entities);
        answer.classes.push_back(entity ? entity->classes.front() : "");
      }
      if (!question.tells_parts) continue;
      for (const grammar::NamedEvent* part : PartsOf(event, timeline, entities))
        answer.parts.push_back(*part);
    }
  }
  return answers;
}

}  // namespace prehend::episode
