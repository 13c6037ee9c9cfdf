// SPDX-License-Identifier: Apache-2.0
// HDF5 files of strangers: groups, shapes, attributes, and numbers of datasets. Nothing but the
// file itself is read: links to other files, external and virtual datasets, and filters of plugins
// are errors. What is not asked for is not read. Signals that are false, then true for ever, added
// to an HDF5 file. Tested by tests/harness/exchange/hdf5/hdf5_file_test.cc and
// tests/program/labels_back.py
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "harness/base/base/result.h"

namespace prehend::exchange {

inline constexpr std::size_t kMostHdf5Values = std::size_t{16} << 20;  ///< of one reading
inline constexpr std::size_t kMostHdf5ChunkBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMostHdf5Names = 100'000;  ///< in a group
inline constexpr std::size_t kMostHdf5TextBytes = std::size_t{16} << 20;

enum class Hdf5Kind { kGroup, kFloat, kInteger, kBool, kText, kOther };

/// A group or a dataset.
struct Hdf5Object {
  std::string name;  ///< in its group
  Hdf5Kind kind = Hdf5Kind::kOther;
  int bytes = 0;                     ///< of a value
  std::vector<std::uint64_t> shape;  ///< none: a single value
  bool is_unsigned = false;

  std::uint64_t Rows() const { return shape.empty() ? 1 : shape[0]; }
  /// Values in a row.
  std::uint64_t Width() const;
  /// "(220, 7) float32"
  std::string Text() const;
};

/// A dataset, and which of the columns of its rows: "obs/object[0:3]", "actions[6]".
struct Hdf5Part {
  std::string dataset = {};
  std::uint64_t first = 0, count = UINT64_MAX;
};

/// None if it is no such name.
std::optional<Hdf5Part> Hdf5PartOf(const std::string& text);

using Hdf5Value = std::variant<double, std::string>;

/// An identifier of the HDF5 library, closed with this.
class Hdf5Id {
 public:
  explicit Hdf5Id(std::int64_t id = -1) : id_(id) {}
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Hdf5Id();
  operator std::int64_t() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  std::int64_t id_;
};

class Hdf5File {
 public:
  static Result<Hdf5File> Open(const std::string& path);

  const std::string& path() const { return path_; }
  /// An error that names the file: `message` begins with the object.
  grammar::Diagnostics Error(std::string message, std::string hint = {}) const;

  /// Paths have names and "/"; "" and "/" are the root.
  bool Has(const std::string& object) const;
  Result<Hdf5Object> Describe(const std::string& object) const;
  /// Names in the group: demo_2 comes before demo_10.
  Result<std::vector<std::string>> NamesIn(const std::string& group) const;
  /// A number, a truth value or a text; none if the attribute is not there or is something else.
  std::optional<Hdf5Value> Attribute(const std::string& object, const std::string& name) const;
  /// The only or the last one of a dataset of texts.
  std::optional<std::string> LastText(const std::string& dataset) const;
  /// Row after row. `part`: its columns.
  Result<std::vector<double>> Read(const std::string& dataset, const Hdf5Part& part = {}) const;

 private:
  Result<Hdf5Id> OpenObject(const std::string& path) const;
  /// A part of the way to the object that is not there, or leads out of the file.
  grammar::Diagnostics WhyNotOpened(const std::string& path) const;

  std::string path_;
  Hdf5Id file_;
};

struct Hdf5Signal {
  std::string dataset;       ///< its groups are made; a dataset of this name is replaced
  std::size_t first = 0;     ///< row that is true
  std::size_t rows = 0;      ///< of all
  bool as_integers = false;  ///< of 64 bits; else truth values, as h5py has them
};

/// Changes nothing else of the file, and adds no time of day. Returns "", or what went wrong.
std::string AddSignals(const std::string& path, std::span<const Hdf5Signal> signals);

}  // namespace prehend::exchange
