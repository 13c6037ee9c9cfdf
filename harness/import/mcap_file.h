// SPDX-License-Identifier: Apache-2.0
// The messages of an MCAP file, in the order in which they stand there. Read from front to back,
// without the index. Format: https://mcap.dev/spec, version 0. Tested by
// tests/program/import_mcap_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <string>
#include <string_view>

namespace prehend::harness::import {

inline constexpr std::uint64_t kMaxMcapBytes = std::uint64_t{8} << 30;
inline constexpr std::uint64_t kMaxMcapRecordBytes = std::uint64_t{64} << 20;
/// Of all chunks, decompressed.
inline constexpr std::uint64_t kMaxMcapContentBytes = std::uint64_t{32} << 30;

struct McapChannel {
  std::string topic, message_encoding, schema, schema_encoding;
};

/// Lives as long as the call that shows it.
struct McapMessage {
  const McapChannel& channel;
  std::int64_t log_ns = 0, publish_ns = 0;
  std::string_view data;
};

/// Returns what is wrong with the message, or "": then the next one is read.
using McapTaker = std::function<std::string(const McapMessage&)>;

/// `size`: of the whole stream, bytes. Returns what is wrong with the file, with the byte at which
/// it was seen, or "". `channels` hears of each channel, also of those without a message.
std::string ReadMcap(std::istream& in, std::uint64_t size, const McapTaker& take,
                     const std::function<void(const McapChannel&)>& channels);

}  // namespace prehend::harness::import
