// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: files of poses and their maps. The first byte says what the others are: a map
// of the poses in docs/motion_capture, or a file of this kind, imported with a map that fits what
// the docs say of it, and with the map that is proposed for it. What is refused says why; a map
// that is proposed is one. How to run it is in CONTRIBUTING.md.
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "harness/exchange/import/import_poses.h"

namespace {

namespace fs = std::filesystem;
using namespace prehend;
using namespace prehend::exchange;

constexpr std::array kEndings = {".csv", ".tsv", ".trc", ".txt",  ".json", ".ndjson",
                                 ".npz", ".c3d", ".bvh", ".hdf5", ".db3",  ".bag"};

/// Of most layouts: bodies that are called as in the docs.
constexpr const char* kMap =
    "import: 1\naxes: y_up\nlost: unknown\nentities:\n"
    "  cup: {from: Cup, size_m: [0.1, 0.1, 0.1]}\n  hand: {from: Hand, hand: true, size_m: [0, 0, "
    "0]}\n";
constexpr const char* kJsonMap =
    "import: 1\nunit: m\naxes: z_up\nt: t\ntime_unit: s\nlost: unknown\nquaternion_order: xyzw\n"
    "entities:\n  cup: {position: cup.p, rotation: cup.q, size_m: [0.1, 0.1, 0.1]}\n"
    "  hand: {position: \"hands[type=right].p{x,y,z}\", hand: true, size_m: [0, 0, 0]}\n";

struct Folder {
  fs::path path = fs::temp_directory_path() / ("prehend_fuzz_import_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return (path / name).string();
  }
};

template <class T>
bool IsRead(const Result<T>& read) {
  if (!read && ErrorsOf(read).empty()) std::abort();  // refused without a word
  (void)grammar::Format(ErrorsOf(read));
  return read.has_value();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size == 0) return 0;
  const std::size_t kind = data[0] % (kEndings.size() + 1);
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (kind == kEndings.size()) {
    (void)IsRead(ImportPoses(PREHEND_SOURCE_DIR "/docs/motion_capture/poses.csv",
                             folder.Write("map.yaml", bytes)));
    return 0;
  }
  const std::string ending = kEndings.at(kind), poses = folder.Write("take" + ending, bytes);
  const Result<std::string> proposed = ProposedMap(poses);
  if (IsRead(proposed) && ending != ".hdf5" && !IsRead(ParseYaml("map.yaml", *proposed)))
    std::abort();
  const bool is_json = ending.find("json") != std::string::npos || ending == ".npz";
  const std::string map = folder.Write("map.yaml", is_json ? kJsonMap : kMap);
  if (ending == ".hdf5")
    (void)IsRead(DemonstrationImport::Open(
        poses, PREHEND_SOURCE_DIR "/docs/motion_capture/demonstrations.yaml"));
  else if (const auto imported = ImportPoses(poses, map); IsRead(imported))
    (void)ImportTable(*imported);
  return 0;
}
