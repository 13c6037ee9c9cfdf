// SPDX-License-Identifier: Apache-2.0
// Truth that may be unknown yet (Kleene's strong logic): false < unknown < true, `and` is the
// minimum, `or` the maximum.
#pragma once

#include <algorithm>
#include <cstdint>

namespace prehend::grammar {

enum class Kleene : std::uint8_t { kFalse, kUnknown, kTrue };

constexpr Kleene Known(bool truth) { return truth ? Kleene::kTrue : Kleene::kFalse; }
constexpr Kleene And(Kleene a, Kleene b) { return std::min(a, b); }
constexpr Kleene Or(Kleene a, Kleene b) { return std::max(a, b); }
constexpr Kleene Not(Kleene a) { return static_cast<Kleene>(2 - static_cast<int>(a)); }

}  // namespace prehend::grammar
