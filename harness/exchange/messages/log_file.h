// SPDX-License-Identifier: Apache-2.0
// What files of logged messages (MCAP, bags of ROS 1) have in common: they are read from front to
// back, without the index, record by record, within limits, and what is wrong is told with its
// place. Tested by tests/program/import_mcap_test.cc and tests/program/import_bag_test.cc
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <istream>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace prehend::exchange {

inline constexpr std::uint64_t kMaxLogBytes = std::uint64_t{8} << 30;
inline constexpr std::uint64_t kMaxLogRecordBytes = std::uint64_t{64} << 20;
/// Of all chunks, decompressed: more than this, and more than so many times the file, is a bomb.
inline constexpr std::uint64_t kMaxLogContentBytes = std::uint64_t{256} << 20;
inline constexpr std::uint64_t kMaxLogContentOfByte = 100;
inline constexpr std::size_t kMaxLogChannels = 10'000;
/// Of a topic, an encoding, the name of a type.
inline constexpr std::size_t kMaxLogNameBytes = 1000;

/// Of definitions of types, all of them that differ.
inline constexpr std::size_t kMostDefinitionBytes = std::size_t{8} << 20;

struct LogChannel {
  std::string topic, message_encoding, schema, schema_encoding;
  std::string_view definition;  ///< of its type, in `schema_encoding`; lives as long as the file
};

/// Lives as long as the call that shows it.
struct LogMessage {
  const LogChannel& channel;
  std::int64_t log_ns = 0, publish_ns = 0;
  std::string_view data;
};

/// Returns what is wrong with the message, or "": then the next one is read.
using TakesMessage = std::function<std::string(const LogMessage&)>;
/// Hears of each channel, also of those without a message.
using HearsOfChannel = std::function<void(const LogChannel&)>;

/// A file that is being read. Its first problem ends the reading.
class LogFile {
 public:
  /// `size`: of the whole stream, bytes.
  LogFile(std::istream& in, std::uint64_t size, const TakesMessage& take,
          const HearsOfChannel& tell);

  /// What is wrong with the file, with the byte at which it was seen, or "".
  const std::string& problem() const { return problem_; }
  bool ok() const { return problem_.empty(); }
  /// Bytes that are not read yet.
  std::uint64_t left() const { return size_ - at_; }

  /// Problems are told at this place.
  void BeginRecord() { record_at_ = at_; }
  /// Likewise, of a table: from 0.
  void BeginRow(std::uint64_t row) {
    record_at_ = row;
    place_ = "in message";
  }
  void Fail(std::string_view why);
  /// The next bytes. Fewer at the end of the file.
  std::string Take(std::uint64_t count);
  void Skip(std::uint64_t count);
  /// Whether a record, or a chunk once it is decompressed, is within the limits.
  bool Admits(const char* what, std::uint64_t bytes);
  /// The records of a chunk. `what_is_read`: said of any other compression.
  std::string Unpack(std::string_view compression, std::string_view packed, std::uint64_t size,
                     std::string_view what_is_read);
  /// Whether one more than `count` channels, or types, is within the limits.
  bool AdmitsMore(const char* what, std::size_t count);

  /// A definition of a type, kept as long as the file.
  std::string_view Keep(std::string_view definition);
  /// `kind`: "channel". A number must mean the same channel wherever it is declared.
  void TakeChannel(const char* kind, std::uint32_t id, const LogChannel& channel);
  /// Null if there is none: a problem.
  const LogChannel* ChannelOf(const char* kind, std::uint32_t id);
  void TakeMessage(const LogMessage& message);

 private:
  bool AdmitsChunk(std::uint64_t bytes);

  std::istream& in_;
  const std::uint64_t size_;
  const TakesMessage& take_;
  const HearsOfChannel& tell_;
  std::uint64_t at_ = 0, record_at_ = 0, content_bytes_ = 0;
  std::map<std::uint32_t, LogChannel> channels_;
  std::set<std::string, std::less<>> definitions_;
  std::size_t definition_bytes_ = 0;
  const char* place_ = "at byte";
  std::string problem_;
};

/// The messages of an MCAP file (https://mcap.dev/spec, version 0) in the order in which they stand
/// there. `size`: of the whole stream, bytes. Returns what is wrong with the file, with the byte at
/// which it was seen, or "". `channels` hears of each channel, also of those without a message.
std::string ReadMcap(std::istream& in, std::uint64_t size, const TakesMessage& take,
                     const HearsOfChannel& channels);
/// The same of a bag of ROS 1 (http://wiki.ros.org/Bags/Format/2.0). A connection is a channel
/// whose messages are encoded as "ros1".
std::string ReadBag(std::istream& in, std::uint64_t size, const TakesMessage& take,
                    const HearsOfChannel& channels);

/// The same of a bag of ROS 2 in SQLite (.db3, rosbag2's schema): of files before Iron, without
/// definitions of types, of which only those of known types are read.
std::string ReadDb3(const std::string& path, std::istream& in, std::uint64_t size,
                    const TakesMessage& take, const HearsOfChannel& channels);

// Numbers and texts from bytes, one after another, as MCAP, CDR and ROS 1 lay them out. What would
// be read behind the end is 0 or "", and `ok` says so. Tested by tests/program/import_mcap_test.cc

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
