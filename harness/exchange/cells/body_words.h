// SPDX-License-Identifier: Apache-2.0
// What the names of bodies say: hands, bones of a skeleton, tables. Tested by
// tests/program/import_propose_test.cc
#pragma once

#include <set>
#include <string>
#include <vector>

namespace prehend::exchange {

using Words = std::vector<std::string>;

/// "global:LeftHand_2" -> left, hand, 2.
Words WordsIn(const std::string& name);

/// Also with a letter for the side: "lhand".
bool AnyOf(const Words& words, const std::set<std::string>& of);
/// A bone of a skeleton that is no hand.
bool IsBone(const Words& words);
bool IsHand(const Words& words);
bool IsTable(const Words& words);

}  // namespace prehend::exchange
