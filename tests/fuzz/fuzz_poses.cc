// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as an MCAP file, as records of one or as a message in one; the first
// byte says which. Every number of a pose that is read was in the message. How to run it is in
// CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "harness/messages/mcap_file.h"
#include "harness/messages/pose_messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend::harness::messages;
  if (size == 0) return 0;
  std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const int kind = data[0] % 16;
  if (kind < 15) {
    const MessageFormat format{.content = static_cast<MessageContent>(kind % 5),
                               .encoding = static_cast<MessageFormat::Encoding>(kind / 5)};
    std::vector<MessagePose> poses;
    (void)DecodePoses(format, bytes, poses);
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
