// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: a robot's log, imported. The first byte says what the others are: a whole file
// of MCAP or a bag, or the records in one, with and without a chunk. What is imported is within the
// limits; what is not says why. A folder as first argument gets files to begin with. How to run it
// is in CONTRIBUTING.md.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "harness/exchange/import/import_poses.h"
#include "tests/fuzz/logs.h"
#include "tests/program/bag_writer.h"
#include "tests/program/mcap_writer.h"

namespace {

namespace fs = std::filesystem;
using namespace prehend;
using Chunks = house::McapWriter::Chunks;

constexpr int kKinds = 9;
constexpr int kFirstBag = 5;

struct Files {
  fs::path folder = fs::temp_directory_path() / ("prehend_fuzz_log_" + std::to_string(getpid()));
  fs::path mcap = folder / "run.mcap", bag = folder / "run.bag";
  Files() { fs::create_directories(folder); }
  ~Files() { fs::remove_all(folder); }
};

/// What a file of this kind is, of the bytes that the fuzzer made.
std::string FileOf(int kind, const std::string& bytes) {
  switch (kind) {
    case 1:
      return house::McapWriter::FileOf(bytes, Chunks::kNone);
    case 2:
      return house::McapWriter::FileOf(bytes, Chunks::kPlain);
    case 3:
      return house::McapWriter::FileOf(bytes, Chunks::kZstd);
    case 4:
      return house::McapWriter::FileOf(bytes, Chunks::kLz4);
    case 6:
      return house::BagHead() + bytes;
    case 7:
      return house::BagHead() + house::BagChunk(bytes, "none");
    case 8:
      return house::BagHead() + house::BagChunk(bytes, "lz4");
    default:
      return bytes;
  }
}

void WriteSeeds(const fs::path& folder) {
  const std::string mcap = fuzz::McapRecords(), bag = fuzz::BagRecords();
  for (int kind = 0; kind < kKinds; ++kind) {
    std::string bytes = kind < kFirstBag ? mcap : bag;
    if (kind == 0) bytes = FileOf(3, mcap);
    if (kind == kFirstBag) bytes = FileOf(8, bag);
    std::ofstream(folder / ("log_" + std::to_string(kind)), std::ios::binary)
        << static_cast<char>(kind) << bytes;
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  if (*count > 1 && fs::is_directory((*words)[1])) WriteSeeds((*words)[1]);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend::exchange;
  using namespace prehend::fuzz;
  static const Files files;
  if (size == 0) return 0;
  const int kind = data[0] % kKinds;
  const fs::path& path = kind < kFirstBag ? files.mcap : files.bag;
  std::ofstream(path, std::ios::binary)
      << FileOf(kind, {reinterpret_cast<const char*>(data) + 1, size - 1});
  const auto imported =
      ImportPoses(path.string(), PREHEND_SOURCE_DIR "/docs/motion_capture/mcap_bodies.yaml");
  if (!imported) {
    if (ErrorsOf(imported).empty()) std::abort();  // refused without a word
    (void)grammar::Format(ErrorsOf(imported));
    return 0;
  }
  if (imported->episode.frames.size() > 1'000'000) std::abort();
  return 0;
}
