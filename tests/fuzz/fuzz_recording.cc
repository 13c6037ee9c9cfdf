// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a recording. What can be read is written, and read again. How to
// run it is in CONTRIBUTING.md.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include "harness/episode/sense/episode_file.h"

namespace {

using namespace prehend;

/// A file without a place on any disk.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("recording", 0)) {
    if (descriptor_ < 0) std::abort();
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  Result<episode::Recording> ReadAs(std::string_view bytes) {
    if (ftruncate(descriptor_, 0) != 0 ||
        pwrite(descriptor_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
      std::abort();
    return episode::ReadRecording("/proc/self/fd/" + std::to_string(descriptor_));
  }

 private:
  int descriptor_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static MemoryFile file;
  Result<episode::Recording> read = file.ReadAs({reinterpret_cast<const char*>(data), size});
  if (!read) {
    if (ErrorsOf(read).empty()) std::abort();  // refused without a word
    (void)Format(ErrorsOf(read));
    return 0;
  }
  std::ostringstream written;
  episode::EpisodeWriter writer(written, read->header);
  for (episode::EpisodeFrame& frame : read->frames) writer.Write(frame.View());
  writer.Finish(read->end_tick);
  const Result<episode::Recording> again = file.ReadAs(written.str());
  if (!again || again->frames.size() != read->frames.size() || again->end_tick != read->end_tick)
    std::abort();  // something is lost
  return 0;
}
