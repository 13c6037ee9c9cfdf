// SPDX-License-Identifier: Apache-2.0
// The table of units, and how numbers with units are read and written.
#include "grammar/base/quantity.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace prehend::grammar {
namespace {

constexpr std::array kUnits = {
    Unit{"m", kMetres, 1},       Unit{"cm", kMetres, 0.01},
    Unit{"mm", kMetres, 0.001},  Unit{"s", kSeconds, 1},
    Unit{"ms", kSeconds, 0.001}, Unit{"N", kNewtons, 1},
    Unit{"rad", kRadians, 1},    Unit{"deg", kRadians, std::numbers::pi / 180},
};

// As the language has it: m/s/s.
void AppendPower(std::string& text, char sign, std::string_view name, int power) {
  for (int i = 0; i < power; ++i) {
    if (!text.empty() || sign == '/') text += sign;
    text += name;
  }
}

std::string Digits(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end};
}

}  // namespace

bool Dimension::IsModest() const {
  constexpr int kHighest = 9;
  for (const int power : {length, time, force, angle}) {
    if (power > kHighest || power < -kHighest) return false;
  }
  return true;
}

Dimension Product(const Dimension& a, const Dimension& b) {
  return {a.length + b.length, a.time + b.time, a.force + b.force, a.angle + b.angle};
}

Dimension Quotient(const Dimension& a, const Dimension& b) {
  return {a.length - b.length, a.time - b.time, a.force - b.force, a.angle - b.angle};
}

double AsWritten(double value) {
  char digits[32];
  const auto [end, problem] =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::scientific, 11);
  double written = value;
  std::from_chars(digits, end, written);
  return std::abs(value - written) <= 1e-15 * std::abs(value) ? written : value;
}

const Unit* FindUnit(std::string_view name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

std::vector<std::string> UnitNames() {
  std::vector<std::string> names;
  for (const Unit& unit : kUnits) names.emplace_back(unit.name);
  return names;
}

std::string DimensionText(const Dimension& dimension) {
  if (dimension == kPlain) return "a plain number";
  std::string above;
  std::string below;
  const auto add = [&](std::string_view name, int power) {
    AppendPower(above, '*', name, power);
    AppendPower(below, '/', name, -power);
  };
  add("m", dimension.length);
  add("s", dimension.time);
  add("N", dimension.force);
  add("rad", dimension.angle);
  if (above.empty()) above = "1";
  return above + below;
}

std::string QuantityText(const Quantity& quantity) {
  std::string text = Digits(quantity.value);
  const std::string dimension = DimensionText(quantity.dimension);
  // As it is read: "0.05 /s".
  if (quantity.dimension != kPlain)
    text += " " + (dimension.starts_with("1/") ? dimension.substr(1) : dimension);
  return text;
}

std::string ReadableQuantityText(const Quantity& quantity) {
  constexpr std::size_t kMostDigits = 12;
  constexpr double kDegree = std::numbers::pi / 180;
  const std::string in_si = QuantityText(quantity), unit = DimensionText(quantity.dimension);
  const double degrees = AsWritten(quantity.value / kDegree);
  if (Digits(quantity.value).size() <= kMostDigits || !unit.starts_with("rad") ||
      degrees * kDegree != quantity.value)
    return in_si;
  return Digits(degrees) + " deg" + unit.substr(3);
}

}  // namespace prehend::grammar
