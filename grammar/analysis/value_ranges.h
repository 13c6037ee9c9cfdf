// SPDX-License-Identifier: Apache-2.0
// The range of each number of a program. A comparison that can only be true, or only be false, is
// reported as an error. The ranges of single signals are in grammar/program/operators.cc. Tested by
// tests/grammar/analysis/value_ranges_test.cc
#pragma once

#include <string>

#include "grammar/program/program.h"

namespace prehend::grammar {

/// Of a number of one of the rule's expressions.
Range RangeOf(const Program& program, const Rule& rule, NodeId node);

enum class Verdict : std::uint8_t { kPossible, kNever, kAlways };

/// Of the negation.
Verdict Opposite(Verdict verdict);

/// What is to be said of `left op right`, op being a comparison.
Verdict Judge(Op op, const Range& left, const Range& right);

/// "goes from 0 to 1", "is never below 0 m/s", "is never above ..", "can be any number".
std::string RangeText(const Range& range, const Dimension& dimension);

/// The same for the same expression, and for `distance(p, q)` and `distance(q, p)`.
std::string Signature(const Program& program, const Rule& rule, NodeId node);

}  // namespace prehend::grammar
