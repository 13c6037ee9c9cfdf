// SPDX-License-Identifier: Apache-2.0
// Numbers with units: what `25 cm` means and which numbers may be compared with which.
// Tested by tests/grammar/base/quantity_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend::grammar {

/// Powers of metre, second, newton and radian. A plain number has none.
struct Dimension {
  int length = 0;
  int time = 0;
  int force = 0;
  int angle = 0;
  friend bool operator==(const Dimension&, const Dimension&) = default;
  /// No power is absurdly high.
  bool IsModest() const;
};

inline constexpr Dimension kPlain{};
inline constexpr Dimension kMetres{.length = 1};
inline constexpr Dimension kSeconds{.time = 1};
inline constexpr Dimension kMetresPerSecond{.length = 1, .time = -1};
inline constexpr Dimension kNewtons{.force = 1};
inline constexpr Dimension kRadians{.angle = 1};

Dimension Product(const Dimension& a, const Dimension& b);
Dimension Quotient(const Dimension& a, const Dimension& b);

/// One unit word of the language: `cm` is a length and 0.01 SI units.
struct Unit {
  std::string_view name;
  Dimension dimension;
  double si = 1;
};

/// Null when there is no such unit.
const Unit* FindUnit(std::string_view name);
std::vector<std::string> UnitNames();

/// A value in SI units (metres, seconds, newtons, radians).
struct Quantity {
  double value = 0;
  Dimension dimension;
};

/// 0.57 for 570 * 0.001, 0.3 for 0.1 + 0.2: a number of at most 12 digits that is next to it, or
/// else `value`.
double AsWritten(double value);

/// "m/s", "a plain number": for messages.
std::string DimensionText(const Dimension& dimension);

/// "0.25 m", "0.3": the value in SI units, shortest form that reads back as the same number.
std::string QuantityText(const Quantity& quantity);

/// The same for people: "20 deg", where that reads as 0.3490658503988659 rad.
std::string ReadableQuantityText(const Quantity& quantity);

}  // namespace prehend::grammar
