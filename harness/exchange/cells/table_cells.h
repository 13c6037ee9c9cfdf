// SPDX-License-Identifier: Apache-2.0
// The cells of a table of numbers, as programs write them. Tested by
// tests/harness/exchange/cells/table_cells_test.cc
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/base/quoting.h"

namespace prehend::exchange {

enum class Separator { kComma, kSemicolon, kTab, kSpace };

/// Of a line; blanks and tabs are one separator, if it is kSpace.
std::vector<CsvCell> TableCellsOf(std::string_view line, Separator separator);

/// Finite or not; a plus sign before it is accepted.
std::optional<double> NumberOf(std::string_view cell, bool decimal_comma);

/// "2026-01-31T10:00:00.25Z", with a blank for the T, another zone, or the time of day only. The
/// seconds since 1970, or since midnight.
std::optional<double> SecondsOfIsoTime(std::string_view cell);

/// Times of day begin anew at midnight: then `time`, which is after `first`, is of the next day.
inline double AfterMidnight(double time, double first) {
  constexpr double kHalfDay_s = 43'200;
  return time < 2 * kHalfDay_s && time < first - kHalfDay_s ? time + 2 * kHalfDay_s : time;
}

/// Of positions; of joints also the last two.
enum class Unit { kMetre, kCentimetre, kMillimetre, kInch, kRadian, kDegree };
/// "mm", "Meters"
std::optional<Unit> UnitCalled(std::string name);
/// In m or rad.
double SiPerUnit(Unit unit);

// Numbers that say how something is turned: quaternions, angles, matrices. Tested by
// tests/harness/exchange/cells/orientation_test.cc

inline constexpr double kUnitTolerance = 0.01;  ///< of the length of a quaternion

enum class QuaternionOrder { kWxyz, kXyzw };
enum class OrientationForm { kQuaternion, kEuler, kMatrix, kAxisAngle };

/// How numbers say an orientation.
struct OrientationFormat {
  OrientationForm form = OrientationForm::kQuaternion;
  QuaternionOrder order = QuaternionOrder::kXyzw;
  /// Of three angles: the axes that are turned about, in the order of the numbers. Capitals are the
  /// body's own axes, small letters those of the file.
  std::string euler_order = "XYZ";
  double radians_per_unit = 1;  ///< of angles
};

/// 4 numbers of a quaternion, 3 angles, 9 of a matrix row by row, 3 of an axis times its angle.
std::size_t NumbersOf(OrientationForm form);

/// Returns why they are none, or "". Angles are noted in `most_angle`, if it is less, as they are.
std::string ReadOrientation(const OrientationFormat& format, std::span<const double> numbers,
                            Eigen::Quaterniond& q, double* most_angle = nullptr);

/// What is wrong with the order of angles, or "".
std::string FaultOfEulerOrder(const std::string& order);

}  // namespace prehend::exchange
