// SPDX-License-Identifier: Apache-2.0
// An MCAP file (https://mcap.dev/spec, version 0) as rosbag2 of ROS 2 writes it: chunks with
// checksums, an index of the messages of each, definitions, counts. Tested by
// tests/mcap/mcap_test.mjs
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "harness/exchange/export/byte_writer.h"

namespace prehend::exchange {

struct McapTopic {
  std::string topic, type, definition;
  bool latched = false;  ///< who subscribes later gets the last message, too
  std::uint64_t messages = 0;
};

/// The quality of service that rosbag2 notes for a topic.
std::string QosText(bool latched);

class McapWriter {
 public:
  explicit McapWriter(std::ostream& out);

  /// Returns its number. All topics come before the first message.
  std::size_t AddTopic(McapTopic topic);
  void Message(std::size_t topic, std::uint64_t ns, const std::string& cdr);
  void Finish();

  const std::vector<McapTopic>& topics() const { return topics_; }
  std::uint64_t messages() const { return messages_; }
  std::uint64_t first_ns() const { return first_ns_; }
  std::uint64_t last_ns() const { return last_ns_; }

 private:
  struct Entry {
    std::uint64_t ns = 0, offset = 0;
  };
  void Put(std::string_view bytes);
  void EndChunk();
  std::string Schemas() const;
  std::string Channels() const;
  std::string Statistics() const;

  std::ostream& out_;
  std::uint64_t at_ = 0, messages_ = 0, first_ns_ = 0, last_ns_ = 0, chunks_ = 0;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::vector<McapTopic> topics_;
  std::string chunk_;                        ///< its records so far
  std::vector<std::vector<Entry>> entries_;  ///< by topic, of the chunk
  std::string chunk_indexes_;                ///< of the summary
};

}  // namespace prehend::exchange
