// SPDX-License-Identifier: Apache-2.0
#include "tests/program/mcap_writer.h"

#include <algorithm>
#include <cstring>

namespace prehend::house {
namespace {

template <class T>
std::string Little(T number) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes += static_cast<char>((number >> (8 * i)) & 0xFF);
  return bytes;
}

std::string Record(std::uint8_t opcode, const std::string& content) {
  return static_cast<char>(opcode) + Bytes64(content.size()) + content;
}

/// Pieces of at most 100,000 bytes, each as `block` writes it.
template <class Block>
std::string InBlocks(const std::string& text, Block block) {
  std::string all;
  for (std::size_t at = 0; at < text.size(); at += 100'000) {
    const std::string piece = text.substr(at, 100'000);
    all += block(piece, at + piece.size() == text.size());
  }
  return all;
}

/// A frame of blocks that are not compressed (RFC 8878).
std::string AsZstd(const std::string& text) {
  return Bytes32(0xFD2FB528) + "\xA0" + Bytes32(static_cast<std::uint32_t>(text.size())) +
         InBlocks(text, [](const std::string& piece, bool last) {
           return Bytes32(static_cast<std::uint32_t>(piece.size() << 3) | (last ? 1u : 0u))
                      .substr(0, 3) +
                  piece;
         });
}

}  // namespace

std::string RunAsZstd(char byte, std::size_t times) {
  constexpr std::size_t kMostOfBlock = 131'072;
  std::string frame = Bytes32(0xFD2FB528) + "\xA0" + Bytes32(static_cast<std::uint32_t>(times));
  for (std::size_t left = times; left > 0;) {
    const std::size_t run = std::min(left, kMostOfBlock);
    left -= run;
    frame +=
        Bytes32(static_cast<std::uint32_t>(run << 3) | 2u | (left == 0 ? 1u : 0u)).substr(0, 3);
    frame += byte;
  }
  return frame;
}

// As blocks that are not compressed (LZ4 Frame Format Description 1.6); blocks of up to 256 KiB.
std::string AsLz4(const std::string& text) {
  return std::string("\x04\x22\x4D\x18\x60\x50\xFB", 7) +
         InBlocks(text,
                  [](const std::string& piece, bool) {
                    return Bytes32(static_cast<std::uint32_t>(piece.size()) | 0x80000000u) + piece;
                  }) +
         Bytes32(0);
}

std::string Bytes16(std::uint16_t number) { return Little(number); }
std::string Bytes32(std::uint32_t number) { return Little(number); }
std::string Bytes64(std::uint64_t number) { return Little(number); }
std::string BytesOf(double number) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return Bytes64(bits);
}
std::string WithLength(const std::string& text) {
  return Bytes32(static_cast<std::uint32_t>(text.size())) + text;
}

std::uint16_t McapWriter::Channel(const std::string& topic, const std::string& encoding,
                                  const std::string& schema, const std::string& definition) {
  const std::uint16_t id = ++channels_;
  records_ += Record(3, Bytes16(id) + WithLength(schema) +
                            WithLength(encoding == "ros1" ? "ros1msg" : "ros2msg") +
                            WithLength(definition));
  records_ += Record(
      4, Bytes16(id) + Bytes16(id) + WithLength(topic) + WithLength(encoding) + WithLength(""));
  return id;
}

void McapWriter::Message(std::uint16_t channel, std::uint64_t log_ns, const std::string& data) {
  records_ += Record(5, Bytes16(channel) + Bytes32(0) + Bytes64(log_ns) + Bytes64(log_ns) + data);
}

std::string McapWriter::ChunkOf(const std::string& packed, std::size_t size,
                                const std::string& name) {
  return Record(6, Bytes64(0) + Bytes64(0) + Bytes64(size) + Bytes32(0) + WithLength(name) +
                       Bytes64(packed.size()) + packed);
}

std::string McapWriter::FileOf(const std::string& records, Chunks chunks) {
  std::string data = records;
  if (chunks == Chunks::kPlain) data = ChunkOf(records, records.size(), "");
  if (chunks == Chunks::kZstd) data = ChunkOf(AsZstd(records), records.size(), "zstd");
  if (chunks == Chunks::kLz4) data = ChunkOf(AsLz4(records), records.size(), "lz4");
  const std::string magic("\x89MCAP0\r\n", 8);
  return magic + Record(1, WithLength("ros2") + WithLength("prehend")) + data +
         Record(15, Bytes32(0)) + Record(2, Bytes64(0) + Bytes64(0) + Bytes32(0)) + magic;
}

void Cdr::Append(std::string little) {
  if (kind_ == Kind::kBig) std::ranges::reverse(little);
  body_ += little;
}

void Cdr::Align(std::size_t size) {
  if (kind_ == Kind::kRos1) return;
  while (body_.size() % size != 0) body_ += '\0';
}

Cdr& Cdr::U32(std::uint32_t number) {
  Align(4);
  Append(Bytes32(number));
  return *this;
}

Cdr& Cdr::Flag(bool flag) {
  body_ += flag ? '\1' : '\0';
  return *this;
}

Cdr& Cdr::F32(float number) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return U32(bits);
}

Cdr& Cdr::F64(double number) {
  Align(8);
  Append(BytesOf(number));
  return *this;
}

Cdr& Cdr::Text(const std::string& text) {
  const std::string ended = kind_ == Kind::kRos1 ? text : text + '\0';
  U32(static_cast<std::uint32_t>(ended.size()));
  body_ += ended;
  return *this;
}

Cdr& Cdr::Header(std::uint64_t ns, const std::string& frame) {
  if (kind_ == Kind::kRos1) U32(7);
  U32(static_cast<std::uint32_t>(ns / 1'000'000'000));
  U32(static_cast<std::uint32_t>(ns % 1'000'000'000));
  return Text(frame);
}

Cdr& Cdr::Pose(std::array<double, 3> p, std::array<double, 4> xyzw) {
  for (const double value : p) F64(value);
  for (const double value : xyzw) F64(value);
  return *this;
}

std::string Cdr::Bytes() const {
  if (kind_ == Kind::kRos1) return body_;
  return std::string("\0", 1) + (kind_ == Kind::kBig ? '\0' : '\1') + std::string(2, '\0') + body_;
}

}  // namespace prehend::house
