// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/arrays/read_array_poses.h: a zip file of arrays of NumPy (.npy, versions 1
// to 3), stored or deflated. Tested by tests/program/import_arrays.py
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <map>

#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/arrays/row_poses.h"
#include "harness/exchange/hdf5/hdf5_file.h"
#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kMostEntries = 10'000, kMostHeaderBytes = 10'000;
constexpr std::size_t kEndBytes = 22, kMostCommentBytes = 65'535;

/// A file in the zip file.
struct ZipEntry {
  std::uint16_t method = 0;
  std::uint32_t checksum = 0, packed = 0, size = 0, at = 0;
};

struct NumpyArray {
  char kind = ' ';  ///< f, i, u, b
  int bytes = 0;    ///< of a value
  bool big_endian = false;
  std::vector<std::size_t> shape;
  std::string_view data;
  std::string text;  ///< "(300, 7) <f8"

  std::size_t Rows() const { return shape.empty() ? 1 : shape[0]; }
};

/// What stands behind 'key': in the header of an array.
std::string_view ValueOfKey(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  header.remove_prefix(at + key.size());
  header.remove_prefix(std::min(header.find_first_not_of("': "), header.size()));
  return header;
}

/// Returns what is wrong, or "".
std::string ReadNumpy(std::string_view bytes, NumpyArray& array) {
  ByteReader reader{.bytes = bytes};
  if (reader.Bytes(6) != "\x93NUMPY") return "it is no array of NumPy";
  const auto major = reader.Number<std::uint8_t>();
  reader.Number<std::uint8_t>();
  const std::size_t size =
      major == 1 ? reader.Number<std::uint16_t>() : reader.Number<std::uint32_t>();
  const std::string_view header = reader.Bytes(size);
  if (!reader.ok || size > kMostHeaderBytes) return "its header is cut off, or too long";
  const std::string_view type = ValueOfKey(header, "'descr'");
  array.big_endian = type.starts_with('>');
  array.kind = type.size() > 2 ? type[1] : ' ';
  array.bytes = type.size() > 2 ? type[2] - '0' : 0;
  const bool is_whole = type.size() > 3 && type[3] == '\'';
  const bool is_real = array.kind == 'f' && (array.bytes == 4 || array.bytes == 8);
  const bool is_integer =
      (array.kind == 'i' || array.kind == 'u' || array.kind == 'b') &&
      (array.bytes == 1 || array.bytes == 2 || array.bytes == 4 || array.bytes == 8);
  if (!is_whole || (!is_real && !is_integer))
    return fmt::format("its values are of the type {}; numbers are read: f4, f8, integers, bool",
                       ReadableName(type.substr(0, type.find_first_of(",}"))));
  std::string_view shape = ValueOfKey(header, "'shape'");
  shape = shape.substr(0, shape.find(')'));
  std::size_t count = 1;
  while ((shape.remove_prefix(std::min(shape.find_first_of("0123456789"), shape.size())),
          !shape.empty())) {
    const std::size_t end = std::min(shape.find_first_not_of("0123456789"), shape.size());
    const std::string number(shape.substr(0, end));
    array.shape.push_back(number.size() > 9 ? kMostRowNumbers + 1 : std::stoul(number));
    count *= array.shape.back();
    if (count > kMostRowNumbers) return fmt::format("more than {} numbers", kMostRowNumbers);
    shape.remove_prefix(end);
  }
  if (ValueOfKey(header, "'fortran_order'").starts_with("True") && array.shape.size() > 1)
    return "its columns stand one after another: numpy.ascontiguousarray turns them into rows";
  array.data = reader.Bytes(count * static_cast<std::size_t>(array.bytes));
  if (!reader.ok) return fmt::format("it is cut off: {} numbers are wanted", count);
  array.text = fmt::format("({}) {}", fmt::join(array.shape, ", "), type.substr(0, 3));
  return "";
}

double NumberAt(const NumpyArray& array, std::size_t index) {
  const auto bytes = static_cast<std::size_t>(array.bytes);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    bits = bits << 8 | static_cast<unsigned char>(
                           array.data[index * bytes + (array.big_endian ? i : bytes - 1 - i)]);
  if (array.kind == 'f')
    return bytes == 8 ? std::bit_cast<double>(bits)
                      : std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  const std::size_t unused = 64 - 8 * bytes;
  return array.kind == 'i'
             ? static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused)
             : static_cast<double>(bits);
}

class NpzRows : public RowSource {
 public:
  explicit NpzRows(std::string bytes) : bytes_(std::move(bytes)) {}

  /// The list of files. Returns what is wrong, or "".
  std::string Load() {
    const std::size_t tail = bytes_.size() - std::min(bytes_.size(), kEndBytes + kMostCommentBytes);
    const std::size_t end = bytes_.rfind("PK\x05\x06");
    if (!bytes_.starts_with("PK") || end == std::string::npos || end < tail ||
        end + kEndBytes > bytes_.size())
      return "it is no .npz file, or is cut off: a zip file ends with its list of files";
    ByteReader reader{.bytes = bytes_, .at = end + 10};
    const auto count = reader.Number<std::uint16_t>();
    reader.Number<std::uint32_t>();
    reader.at =
        reader.ok ? std::min<std::size_t>(reader.Number<std::uint32_t>(), bytes_.size()) : 0;
    for (std::size_t i = 0; i < count && i < kMostEntries; ++i) {
      const std::size_t at = reader.at;
      const bool is_entry = reader.Bytes(4) == "PK\x01\x02";
      reader.Bytes(6);
      ZipEntry entry{.method = reader.Number<std::uint16_t>()};
      reader.Bytes(4);
      entry.checksum = reader.Number<std::uint32_t>();
      entry.packed = reader.Number<std::uint32_t>();
      entry.size = reader.Number<std::uint32_t>();
      const auto name = reader.Number<std::uint16_t>(), extra = reader.Number<std::uint16_t>(),
                 comment = reader.Number<std::uint16_t>();
      reader.Bytes(8);
      entry.at = reader.Number<std::uint32_t>();
      std::string key(reader.Bytes(name));
      reader.Bytes(std::size_t{extra} + comment);
      if (!reader.ok || !is_entry)
        return fmt::format("at byte {}: its list of files is damaged", at);
      if (key.ends_with(".npy")) key.resize(key.size() - 4);
      entries_.emplace(ReadableName(key), entry);
    }
    return "";
  }

  /// What looks like times and poses.
  FoundPoses Find() const {
    FoundPoses found;
    std::map<std::string, std::vector<std::string>> values;
    for (const auto& [name, entry] : entries_) {
      std::string content;
      NumpyArray array;
      if (!Unpack(entry, content).empty() || !ReadNumpy(content, array).empty()) continue;
      std::vector<std::size_t> shape = array.shape;
      for (std::size_t i = 0; shape.size() < 2 && i < std::min<std::size_t>(array.Rows(), 50); ++i)
        values[name].push_back(fmt::format("{}", NumberAt(array, i)));
      std::size_t of_row = 1, width = shape.empty() ? 0 : shape.back();
      for (std::size_t i = 1; i < shape.size(); ++i) of_row *= shape[i];
      if (shape.size() > 2 && (width == 3 || width == 4) && shape[shape.size() - 2] == width)
        width *= width;
      for (std::size_t at = 0; width > 0 && at + width <= of_row && at < 50 * width; at += width)
        found.Add(of_row == width ? "" : fmt::format("body {}", at / width + 1), name,
                  of_row == width ? name : fmt::format("{}[{}:{}]", name, at, at + width), width,
                  false);
    }
    found.AddTime(values);
    return found;
  }

  std::optional<Rows> Read(const Located<std::string>& name, DiagnosticList& errors) override {
    const Hdf5Part part = Hdf5PartOf(name.value).value_or(Hdf5Part{.dataset = name.value});
    const auto entry = entries_.find(part.dataset);
    if (entry == entries_.end()) {
      std::vector<std::string> names;
      for (const auto& [key, one] : entries_) names.push_back(key);
      errors.AddUnknownName(name.where, fmt::format("no array is called '{}'", part.dataset),
                            part.dataset, names);
      return std::nullopt;
    }
    std::string content;
    NumpyArray array;
    std::string why = Unpack(entry->second, content);
    if (why.empty()) why = ReadNumpy(content, array);
    if (!why.empty()) {
      errors.Add(name.where, fmt::format("'{}', at byte {} of the file: {}", part.dataset,
                                         entry->second.at, why));
      return std::nullopt;
    }
    Rows rows{.count = array.Rows(), .shape = array.text, .values = {}};
    std::size_t of_row = 1;
    for (std::size_t i = 1; i < array.shape.size(); ++i) of_row *= array.shape[i];
    if (part.first < of_row) rows.width = std::min<std::size_t>(part.count, of_row - part.first);
    if (rows.width == 0 || rows.count == 0 ||
        (part.count != UINT64_MAX && rows.width != part.count)) {
      errors.Add(name.where,
                 fmt::format("'{}' has nothing there: the array is {}", name.value, array.text));
      return std::nullopt;
    }
    for (std::size_t row = 0; row < rows.count; ++row)
      for (std::size_t i = 0; i < rows.width; ++i)
        rows.values.push_back(NumberAt(array, row * of_row + part.first + i));
    rows.is_matrix = array.shape.size() == 3 && array.shape[1] == 4 && rows.width == 16;
    return rows;
  }

 private:
  std::string Unpack(const ZipEntry& entry, std::string& content) const {
    ByteReader reader{.bytes = bytes_, .at = std::min<std::size_t>(entry.at, bytes_.size())};
    const bool is_entry = reader.Bytes(4) == "PK\x03\x04";
    reader.Bytes(22);
    const auto name = reader.Number<std::uint16_t>(), extra = reader.Number<std::uint16_t>();
    reader.Bytes(std::size_t{name} + extra);
    const std::string_view packed = reader.Bytes(entry.packed);
    if (!reader.ok || !is_entry) return "it is damaged, or cut off";
    if (entry.size > kMostRowNumbers * sizeof(double) + kMostHeaderBytes)
      return fmt::format("more than {} numbers", kMostRowNumbers);
    if (entry.method != 0 && entry.method != 8)
      return fmt::format("it is packed by the method {}; 0 and 8 are read", entry.method);
    content.resize(entry.size);
    if (entry.method == 0) {
      content.assign(packed.substr(0, entry.size));
    } else {
      z_stream stream{};
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream.avail_in = entry.packed;
      stream.next_out = reinterpret_cast<Bytef*>(content.data());
      stream.avail_out = entry.size;
      if (inflateInit2(&stream, -15) != Z_OK) return "it cannot be unpacked";
      const int state = inflate(&stream, Z_FINISH);
      content.resize(stream.total_out);
      inflateEnd(&stream);
      if (state != Z_STREAM_END) return "it is damaged: it cannot be unpacked";
    }
    const auto* data = reinterpret_cast<const Bytef*>(content.data());
    if (content.size() != entry.size || crc32_z(0, data, content.size()) != entry.checksum)
      return "it is damaged: its checksum is wrong";
    return "";
  }

  const std::string bytes_;
  std::map<std::string, ZipEntry> entries_;
};

}  // namespace

Result<FoundPoses> FindNpzPoses(const std::string& path) {
  PREHEND_TRY(std::string bytes, ReadBytes(path));
  NpzRows rows(std::move(bytes));
  if (const std::string why = rows.Load(); !why.empty())
    return tl::unexpected(ErrorOfFile(path, why));
  return rows.Find();
}

Result<PoseFile> ReadNpzPoses(const std::string& path, const MapFile& map) {
  PREHEND_TRY(std::string bytes, ReadBytes(path));
  NpzRows rows(std::move(bytes));
  if (const std::string why = rows.Load(); !why.empty())
    return tl::unexpected(ErrorOfFile(path, why));
  return ReadRowPoses(rows, map, path, map.map.rate_hz ? map.map.rate_hz->value : 1);
}

}  // namespace prehend::exchange
