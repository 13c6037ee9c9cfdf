// SPDX-License-Identifier: Apache-2.0
// The classes that every scenario has, and what is known of two of them. Other names are taken to
// be Things, of which nothing more is known. Tested by tests/grammar/compile/compile_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend::grammar {

const std::vector<std::string>& BuiltinClasses();
bool IsBuiltinClass(std::string_view name);

/// True if some entity can be of both classes.
bool ClassesMeet(std::string_view a, std::string_view b);

/// True if whoever is of class `a` is of class `b`, too, as far as that is known.
bool ClassImplies(std::string_view a, std::string_view b);

}  // namespace prehend::grammar
