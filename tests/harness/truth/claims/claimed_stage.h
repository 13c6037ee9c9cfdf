// SPDX-License-Identifier: Apache-2.0
// A grammar's events and a timeline of them, for tests of claims. Tested by what uses it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "harness/truth/claims/claim.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::truth {

/// Hand and cup, and a table that does not move.
inline ClaimableEvents StageOfClaims() {
  ClaimableEvents known{.grammar = "stage"};
  known.events = {
      {.name = "grasping",
       .roles = {"hand", "object"},
       .classes = {"Hand", "Thing"},
       .has_style = true},
      {.name = "sliding", .roles = {"hand", "object"}, .classes = {"Hand", "Movable"}},
      {.name = "contact", .roles = {"a", "b"}, .classes = {"Entity", "Entity"}, .symmetric = true}};
  known.entity_table.entities = {{.name = "hand", .classes = {"Hand", "Entity"}},
                                 {.name = "cup", .classes = {"Movable", "Thing", "Entity"}},
                                 {.name = "jug", .classes = {"Movable", "Thing", "Entity"}},
                                 {.name = "table", .classes = {"Fixed", "Thing", "Entity"}}};
  known.entity_table.styles = {"wrap", "pinch"};
  return known;
}

inline Claim ClaimOf(const std::string& text) {
  auto claim = ParseClaim(text);
  EXPECT_TRUE(claim) << text;
  return claim.value_or(Claim{});
}

inline grammar::NamedEvent Happened(const std::string& event, const std::string& first,
                                    const std::string& second, grammar::Interval interval,
                                    const std::string& style = {}) {
  const bool contact = event == "contact";
  grammar::NamedEvent happened{
      .event = event,
      .roles = {{contact ? "a" : "hand", first}, {contact ? "b" : "object", second}},
      .interval = interval};
  if (!style.empty()) happened.roles.push_back({"style", style});
  return happened;
}

}  // namespace prehend::truth
