// SPDX-License-Identifier: Apache-2.0
// A compiled law: what a grammar says must hold of its own events over a whole episode. Part of a
// Program; CheckLaws() (grammar/check_laws.h) finds where it is broken.
#pragma once

#include <string>
#include <vector>

#include "grammar/base/allen.h"
#include "grammar/base/diagnostic.h"
#include "grammar/base/ids.h"

namespace prehend::grammar {

/// An event with the law's roles in it: `supported_by(object, any Table)`.
struct LawCall {
  struct Player {
    int role = -1;           ///< of the law; negative: any entity
    std::string class_name;  ///< that it must be of
    std::string any_text;    ///< "any", "any Table"; empty for a role
  };
  RuleId rule;  ///< an event
  std::vector<Player> players;
  bool has_any = false;  ///< of those who play a role of it, some may be any entity
};

enum class LawForm : std::uint8_t {
  kCovered,  ///< nothing is left of the subject's intervals without those of the others
  kRelated,  ///< each interval of a subject lies to one of the others' as `relations` says
  kApart,    ///< two subjects do not have intervals at the same time
};

struct Law {
  struct Role {
    std::string name;
    std::string class_name;
  };
  std::string name;
  std::string file;
  Place place;
  std::vector<Role> roles;  ///< at most kMaxRoles; two of them are never the same entity
  std::string says;         ///< as one line: "rest of grasping(hand, object) outside .. is empty"
  LawForm form = LawForm::kCovered;
  std::vector<LawCall> subjects;
  std::vector<LawCall> others;
  AllenSet relations = 0;     ///< kRelated
  std::string relation_text;  ///< kRelated: "meets", "lies inside"

  /// "law phases_cover_the_grasp(hand: Hand, object: Movable)"
  std::string Head() const;
};

}  // namespace prehend::grammar
