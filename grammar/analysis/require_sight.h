// SPDX-License-Identifier: Apache-2.0
// What nobody sees may happen: `from A without B` and `without X between` claim that something did
// not, so they ask for the sight of it.
#pragma once

#include "grammar/program/program.h"

namespace prehend::grammar {

/// Adds to each absence that what it names is tracked all the time, as far as poses show it: those
/// of the roles that B or X is about, also through the rules that they use. What is meant by `any`
/// is not named. After the rules are ordered, before ChooseGuards().
void RequireSight(Program& program);

}  // namespace prehend::grammar
