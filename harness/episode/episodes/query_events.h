// SPDX-License-Identifier: Apache-2.0
// Questions to the events of many episodes, without code: by name, roles, class, part-of, time,
// duration, and Allen's relation to another event. Tested by tests/program/query_test.cc
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/episode/episodes/episode_file.h"

namespace prehend::episode {

/// Whether --episode selects it: "" all, its number, its scenario (name, skill/name or a glob), or
/// "status=failed" and "outcome=spilled" (globs, too).
bool IsSelected(const EpisodeRow& episode, const std::string& which);

/// ROLE=VALUE; the role may be `any`.
struct RoleCondition {
  std::string role, value;
};

/// What must hold of an event. Names of events, entities and classes may be globs.
struct EventQuestion {
  std::string scenario, event;                  ///< empty: any
  std::vector<RoleCondition> roles;             ///< its value: an entity, or a class that it has
  std::vector<RoleCondition> parts_of;          ///< an entity, or its class, of which it is a part
  std::optional<double> at_least_s, at_most_s;  ///< duration
  std::optional<double> from_s, until_s;        ///< the event lies between them
  /// "inside transporting": this relation to some event of this name in the same episode.
  struct Relation {
    std::string relation, event;
  };
  std::vector<Relation> relations;
  std::vector<std::string> with;  ///< it has a part of each of these names
  bool tells_parts = false;       ///< of each answer, which may be many: EventAnswer::parts
};

/// "ROLE=VALUE"; nothing if it is not of that form.
std::optional<RoleCondition> ParseRoleCondition(std::string_view text);
/// "inside transporting"; otherwise `problem` says why not.
std::optional<EventQuestion::Relation> ParseRelation(std::string_view text, std::string& problem);

struct EventAnswer {
  std::string file;
  std::int64_t episode = 0;
  std::string scenario;
  grammar::Tick ticks_per_second = 480;
  grammar::NamedEvent event;
  std::vector<std::string> classes;        ///< by its roles; "" of what is no entity
  std::vector<grammar::NamedEvent> parts;  ///< PartsOf() it, if they are wanted
};

/// The events of an episode that begin within this one and whose participants are all its own, in
/// the order of the timeline, which is that of begins.
std::vector<const grammar::NamedEvent*> PartsOf(const grammar::NamedEvent& whole,
                                                const grammar::Timeline& timeline,
                                                const std::vector<KeptEntity>& entities);

/// What the events of files are called, their roles, and who or what may have them: entities and
/// classes.
struct KnownNames {
  std::set<std::string> events, roles, values;
};

/// The answers in one file, in the order of episodes and time. `known` gets the names in it.
Result<std::vector<EventAnswer>> Ask(const std::string& file, const EventQuestion& question,
                                     KnownNames& known);

}  // namespace prehend::episode
