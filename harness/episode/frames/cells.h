// SPDX-License-Identifier: Apache-2.0
// The values of a row of a table. A function that hands them to its `cells` in their order fills
// the row with a CellWriter and reads it with a CellReader, so both directions are told once.
// Tested by tests/harness/episode/frames/frames_test.cc
#pragma once

#include <Eigen/Geometry>
#include <bit>
#include <concepts>
#include <cstdint>

#include "harness/episode/frames/columns.h"
#include "physics/base/ids.h"

namespace prehend::episode {

/// Appends values to a row.
class CellWriter {
 public:
  explicit CellWriter(std::vector<Word>& row) : row_(row) {}
  template <typename... Values>
  void operator()(const Values&... values) {
    (Put(values), ...);
  }

 private:
  void Put(double value) { row_.push_back(std::bit_cast<Word>(value)); }
  void Put(std::integral auto value) {
    row_.push_back(static_cast<Word>(static_cast<std::int64_t>(value)));
  }
  template <typename Thing>
  void Put(physics::Index<Thing> index) {
    Put(index.number());
  }
  void Put(const Eigen::Vector3d& v) { (*this)(v[0], v[1], v[2]); }
  void Put(const Eigen::Quaterniond& q) { (*this)(q.x(), q.y(), q.z(), q.w()); }

  std::vector<Word>& row_;
};

/// Takes them from a row of a table. Integers are not checked.
class CellReader {
 public:
  CellReader(const Columns& columns, std::size_t row) : columns_(columns), row_(row) {}
  template <typename... Values>
  void operator()(Values&... values) {
    (Take(values), ...);
  }

 private:
  Word Next() { return columns_.At(row_, next_++); }
  void Take(double& value) { value = std::bit_cast<double>(Next()); }
  template <std::integral Integer>
  void Take(Integer& value) {
    value = static_cast<Integer>(static_cast<std::int64_t>(Next()));
  }
  template <typename Thing>
  void Take(physics::Index<Thing>& index) {
    index = physics::Index<Thing>(static_cast<std::int64_t>(Next()));
  }
  void Take(Eigen::Vector3d& v) { (*this)(v[0], v[1], v[2]); }
  void Take(Eigen::Quaterniond& q) { (*this)(q.x(), q.y(), q.z(), q.w()); }

  const Columns& columns_;
  std::size_t row_;
  std::size_t next_ = 0;
};

}  // namespace prehend::episode
