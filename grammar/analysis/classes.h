// SPDX-License-Identifier: Apache-2.0
// The classes that the language knows, and which of them exclude or imply each other. Nothing is
// known about a class of any other name; scenarios have more that are built in
// (IsScenarioBuiltinClass). Tested by tests/grammar/compile/compile_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend::grammar {

const std::vector<std::string>& BuiltinClasses();
bool IsBuiltinClass(std::string_view name);

/// True if some entity can be of both classes.
bool ClassesMeet(std::string_view a, std::string_view b);

/// True if every entity of class `a` is of class `b`, too, as far as that is known.
bool ClassImplies(std::string_view a, std::string_view b);

}  // namespace prehend::grammar
