// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as an MCAP file, as a message of JSON or as the definition of a type
// and, after a zero, a message of it; the first byte says which. Every number of a pose that is
// read was in the message. How to run it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "harness/exchange/messages/log_file.h"
#include "harness/exchange/messages/pose_fields.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend;
  using namespace prehend::exchange;
  if (size == 0) return 0;
  std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const int kind = data[0] % 8;
  std::vector<MessagePose> poses;
  if (kind < 5) {
    (void)DecodeJsonPoses(static_cast<JsonContent>(kind), bytes, poses);
    if (poses.size() > size) std::abort();
    return 0;
  }
  if (kind < 7) {
    const bool ros1 = kind == 5;
    const std::size_t zero = bytes.find('\0');
    MessageDefinition definition;
    if (!ReadDefinition("a/A", bytes.substr(0, zero), ros1, definition).empty()) return 0;
    const PoseLayout layout = LayoutOf(std::move(definition));
    if (layout.fields.size() > kMostPoseFields) std::abort();
    const std::vector<bool> wanted(layout.fields.size(), true);
    (void)DecodeBinaryPoses(layout, ros1, zero < size ? bytes.substr(zero + 1) : "", wanted, poses);
    if (poses.size() > size) std::abort();
    return 0;
  }
  bytes = "\x89MCAP0\r\n" + bytes;
  std::istringstream in(bytes);
  std::size_t messages = 0;
  const std::string why = ReadMcap(
      in, bytes.size(),
      [&](const LogMessage& message) -> std::string {
        if (message.data.size() > kMaxLogRecordBytes || ++messages > 1'000'000) std::abort();
        return "";
      },
      [](const LogChannel&) {});
  (void)why;
  return 0;
}
