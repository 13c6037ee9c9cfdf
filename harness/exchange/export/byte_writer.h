// SPDX-License-Identifier: Apache-2.0
// Numbers and texts as bytes, one after another, little-endian: what MCAP, CDR, zip and NumPy lay
// down. Tested by tests/program/exported.py
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace prehend::exchange {

struct ByteWriter {
  std::string bytes;
  std::size_t most_alignment = 1;  ///< numbers are aligned to their size, at most to this
  std::size_t origin = 0;          ///< alignment counts from here

  template <class T>
  ByteWriter& Number(T value) {
    static_assert(std::endian::native == std::endian::little);
    const std::size_t alignment = sizeof(T) < most_alignment ? sizeof(T) : most_alignment;
    while ((bytes.size() - origin) % alignment != 0) bytes += '\0';
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
    return *this;
  }
  ByteWriter& U16(std::size_t value) { return Number(static_cast<std::uint16_t>(value)); }
  ByteWriter& U32(std::size_t value) { return Number(static_cast<std::uint32_t>(value)); }
  ByteWriter& U64(std::uint64_t value) { return Number(value); }
  ByteWriter& F64(double value) { return Number(value); }

  /// With its length before it, 32 bits.
  ByteWriter& Text(std::string_view text) {
    U32(text.size());
    bytes += text;
    return *this;
  }
};

/// A message of ROS 2 (CDR, little-endian).
struct CdrWriter : ByteWriter {
  CdrWriter() { bytes = {'\0', '\1', '\0', '\0'}, most_alignment = 8, origin = 4; }
  /// Ended by a zero.
  CdrWriter& String(std::string_view text) {
    U32(text.size() + 1);
    bytes.append(text) += '\0';
    return *this;
  }
};

}  // namespace prehend::exchange
