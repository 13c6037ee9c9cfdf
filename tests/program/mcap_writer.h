// SPDX-License-Identifier: Apache-2.0
// MCAP files for tests, written byte by byte from the specification (https://mcap.dev/spec), and
// messages for them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace prehend::house {

std::string Bytes16(std::uint16_t number);
std::string Bytes32(std::uint32_t number);
std::string Bytes64(std::uint64_t number);
std::string BytesOf(double number);
/// With its length before it.
std::string WithLength(const std::string& text);
/// A frame of LZ4.
std::string AsLz4(const std::string& text);

/// A frame of ZSTD in which a byte comes again and again; it is 30,000 times smaller.
std::string RunAsZstd(char byte, std::size_t times);

class McapWriter {
 public:
  enum class Chunks { kNone, kPlain, kZstd, kLz4 };
  explicit McapWriter(Chunks chunks = Chunks::kNone) : chunks_(chunks) {}

  /// The file of these records, whatever they are.
  static std::string FileOf(const std::string& records, Chunks chunks);
  /// A chunk whose content is packed already.
  static std::string ChunkOf(const std::string& packed, std::size_t size, const std::string& name);

  /// Returns its number. `definition`: of the type, that of ROS 1 if the encoding is "ros1".
  std::uint16_t Channel(const std::string& topic, const std::string& encoding,
                        const std::string& schema, const std::string& definition = "");
  void Message(std::uint16_t channel, std::uint64_t log_ns, const std::string& data);
  /// The whole file.
  std::string Bytes() const { return FileOf(records_, chunks_); }
  const std::string& records() const { return records_; }

 private:
  Chunks chunks_;
  std::uint16_t channels_ = 0;
  std::string records_;
};

/// How a message in CDR or in the encoding of ROS 1 begins, and what it consists of.
class Cdr {
 public:
  enum class Kind { kLittle, kBig, kRos1 };
  explicit Cdr(Kind kind = Kind::kLittle) : kind_(kind) {}
  Cdr& Flag(bool flag);
  Cdr& U32(std::uint32_t number);
  Cdr& F32(float number);
  Cdr& F64(double number);
  Cdr& Text(const std::string& text);
  /// Time and frame.
  Cdr& Header(std::uint64_t ns, const std::string& frame);
  Cdr& Pose(std::array<double, 3> p, std::array<double, 4> xyzw = {0, 0, 0, 1});
  std::string Bytes() const;

 private:
  void Align(std::size_t size);
  void Append(std::string little);
  Kind kind_;
  std::string body_;
};

}  // namespace prehend::house
