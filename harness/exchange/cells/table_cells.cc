// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/cells/table_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <string>

#include "harness/base/base/number_text.h"

namespace prehend::exchange {
namespace {

/// Takes `count` digits and what follows them, one of `after`, off the text; -1 if they are not
/// there.
int TakeDigits(std::string_view& text, std::size_t count, std::string_view after) {
  int value = 0;
  if (text.size() < count) return -1;
  for (const char c : text.substr(0, count)) {
    if (c < '0' || c > '9') return -1;
    value = 10 * value + (c - '0');
  }
  text.remove_prefix(count);
  if (after.empty()) return value;
  if (text.empty() || after.find(text.front()) == std::string_view::npos) return -1;
  text.remove_prefix(1);
  return value;
}

/// "Z", "", "+02:00", "-0530".
std::optional<double> ZoneOf(std::string_view text) {
  if (text.empty() || text == "Z") return 0;
  const double sign = text.front() == '-' ? -1 : 1;
  if (text.front() != '+' && text.front() != '-') return std::nullopt;
  text.remove_prefix(1);
  const int hours = TakeDigits(text, 2, "");
  if (text.starts_with(':')) text.remove_prefix(1);
  const int minutes = text.empty() ? 0 : TakeDigits(text, 2, "");
  if (hours < 0 || minutes < 0 || !text.empty()) return std::nullopt;
  return sign * (3600 * hours + 60 * minutes);
}

constexpr double kMatrixTolerance = 0.02;  ///< of the lengths of rows and of their products

int AxisOf(char letter) { return std::tolower(static_cast<unsigned char>(letter)) - 'x'; }

std::string ReadMatrix(std::span<const double> v, Eigen::Quaterniond& q) {
  Eigen::Matrix3d m;
  m << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
  const double off = (m * m.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kMatrixTolerance))
    return fmt::format(
        "expected a rotation matrix, found one whose rows are {:.3g} off unit "
        "length or right angles",
        off);
  if (m.determinant() < 0) return "expected a rotation matrix, found one that mirrors";
  q = Eigen::Quaterniond(m).normalized();
  return "";
}

}  // namespace

std::vector<CsvCell> TableCellsOf(std::string_view line, Separator separator) {
  if (separator != Separator::kSpace) {
    constexpr std::array kSeparators = {',', ';', '\t'};
    return CsvCellsOf(line, kSeparators[static_cast<std::size_t>(separator)]);
  }
  std::vector<CsvCell> cells;
  for (std::size_t end = 0, begin; (begin = line.find_first_not_of(" \t", end)) < line.size();) {
    end = std::min(line.find_first_of(" \t", begin), line.size());
    cells.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
  }
  if (cells.empty()) cells.emplace_back();
  return cells;
}

std::optional<double> NumberOf(std::string_view cell, bool decimal_comma) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  std::string with_point;
  if (decimal_comma && cell.find('.') == std::string_view::npos) {
    with_point = cell;
    std::ranges::replace(with_point, ',', '.');
    cell = with_point;
  }
  return NumberFrom<double>(cell);
}

std::optional<double> SecondsOfIsoTime(std::string_view cell) {
  double days = 0;
  if (cell.find(':') > 2) {
    const int year = TakeDigits(cell, 4, "-/"), month = TakeDigits(cell, 2, "-/"),
              day = TakeDigits(cell, 2, "T ");
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (year < 0 || month < 0 || day < 0 || !date.ok()) return std::nullopt;
    days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  }
  const int hour = TakeDigits(cell, cell.find(':') == 1 ? 1 : 2, ":"),
            minute = TakeDigits(cell, 2, ":");
  const std::size_t zone_at = std::min(cell.find_first_of("Z+-"), cell.size());
  const auto seconds = NumberOf(cell.substr(0, zone_at), true);
  const auto zone = ZoneOf(cell.substr(zone_at));
  if (hour < 0 || hour > 24 || minute < 0 || minute > 59 || !seconds || !(*seconds < 61) || !zone)
    return std::nullopt;
  return 86400 * days + 3600 * hour + 60 * minute + *seconds - *zone;
}

std::optional<Unit> UnitCalled(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  static const std::map<std::string, Unit> kUnits = {
      {"m", Unit::kMetre},       {"meters", Unit::kMetre},
      {"cm", Unit::kCentimetre}, {"centimeters", Unit::kCentimetre},
      {"mm", Unit::kMillimetre}, {"millimeters", Unit::kMillimetre},
      {"inches", Unit::kInch},   {"in", Unit::kInch}};
  const auto found = kUnits.find(name);
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

double SiPerUnit(Unit unit) {
  constexpr std::array kSi = {1.0, 1e-2, 1e-3, 0.0254, 1.0, static_cast<double>(EIGEN_PI) / 180};
  return kSi[static_cast<std::size_t>(unit)];
}

std::size_t NumbersOf(OrientationForm form) {
  constexpr std::array<std::size_t, 4> kNumbers = {4, 3, 9, 3};
  return kNumbers[static_cast<std::size_t>(form)];
}

std::string ReadOrientation(const OrientationFormat& format, std::span<const double> v,
                            Eigen::Quaterniond& q, double* most_angle) {
  double angle = 0;
  switch (format.form) {
    case OrientationForm::kQuaternion:
      q = format.order == QuaternionOrder::kWxyz ? Eigen::Quaterniond(v[0], v[1], v[2], v[3])
                                                 : Eigen::Quaterniond(v[3], v[0], v[1], v[2]);
      if (!(std::abs(q.norm() - 1) <= kUnitTolerance))
        return fmt::format("expected a unit quaternion, found one of length {:.4g}", q.norm());
      break;
    case OrientationForm::kEuler:
      q.setIdentity();
      for (std::size_t i = 0; i < 3; ++i) {
        const char letter = format.euler_order[i];
        angle = std::max(angle, std::abs(v[i]));
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(v[i] * format.radians_per_unit,
                                                        Eigen::Vector3d::Unit(AxisOf(letter))));
        q = letter <= 'Z' ? q * turn : turn * q;
      }
      break;
    case OrientationForm::kMatrix:
      return ReadMatrix(v, q);
    case OrientationForm::kAxisAngle: {
      const Eigen::Vector3d turn(v[0], v[1], v[2]);
      angle = turn.norm();
      q.setIdentity();
      if (angle > 0) q = Eigen::AngleAxisd(angle * format.radians_per_unit, turn / angle);
      break;
    }
  }
  if (most_angle && angle > *most_angle) *most_angle = angle;
  q.normalize();
  return "";
}

std::string FaultOfEulerOrder(const std::string& order) {
  const bool three = order.size() == 3 && (order.find_first_not_of("XYZ") == std::string::npos ||
                                           order.find_first_not_of("xyz") == std::string::npos);
  if (three && order[0] != order[1] && order[1] != order[2]) return "";
  return fmt::format(
      "expected three axes like XYZ (the body's own) or xyz (the file's), no two "
      "neighbours alike, found '{}'",
      order);
}

}  // namespace prehend::exchange
