// SPDX-License-Identifier: Apache-2.0
// Numbers and texts from bytes, one after another, as MCAP, CDR and ROS 1 lay them out. What would
// be read behind the end is 0 or "", and `ok` says so. Tested by tests/program/import_mcap_test.cc
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace prehend::exchange {

struct ByteReader {
  std::string_view bytes;
  std::size_t at = 0;
  bool ok = true;
  bool big_endian = false;
  std::size_t most_alignment = 1;  ///< numbers are aligned to their size, at most to this

  std::size_t left() const { return bytes.size() - at; }

  std::string_view Bytes(std::uint64_t count) {
    if (!ok || count > left()) {
      ok = false;
      return {};
    }
    const std::string_view read = bytes.substr(at, static_cast<std::size_t>(count));
    at += read.size();
    return read;
  }

  /// An integer or a floating-point number.
  template <class T>
  T Number() {
    const std::size_t alignment = sizeof(T) < most_alignment ? sizeof(T) : most_alignment;
    Bytes((alignment - at % alignment) % alignment);
    const std::string_view read = Bytes(sizeof(T));
    if (!ok) return T{};
    char little[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i)
      little[i] =
          read[big_endian != (std::endian::native == std::endian::big) ? sizeof(T) - 1 - i : i];
    T value;
    std::memcpy(&value, little, sizeof value);
    return value;
  }

  /// With its length before it, 32 bits.
  std::string_view Text() { return Bytes(Number<std::uint32_t>()); }
};

}  // namespace prehend::exchange
