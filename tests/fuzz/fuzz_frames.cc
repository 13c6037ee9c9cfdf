// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: a chunk of frames, damaged. The bytes of the input are edits of its parts
// before they are compressed: the number of the part, a place in it (2 bytes), a kind (replace,
// insert, cut off) and a byte. All frames that can be read are shown. How to run it is in
// CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "harness/episode/frames/frame_player.h"
#include "tests/fuzz/recorded_story.h"

namespace {

using namespace prehend;
using namespace prehend::fuzz;

constexpr std::size_t kMostPartBytes = std::size_t{1} << 28;
constexpr std::size_t kEditBytes = 5;

struct Recorded {
  FrameLayout layout;
  std::map<std::size_t, std::string> parts;  ///< not compressed
};

Recorded Record() {
  const episode::LoadedRun loaded = fuzz::LoadStory();
  Recorded recorded{.layout = LayoutOf(loaded.scenario.scene), .parts = {}};
  ChunkWriter writer(recorded.layout);
  std::vector<Chunk> chunks;
  fuzz::PlayStory(loaded, [&](const physics::Snapshot& snapshot) {
    writer.Add(snapshot);
    if (writer.IsFull()) chunks.push_back(writer.Take());
  });
  if (writer.frames() > 0) chunks.push_back(writer.Take());
  Compressor compressor;
  for (const ChunkPart& part : chunks.at(0).parts)
    recorded.parts[part.part] = compressor.Unpack(part.bytes, kMostPartBytes).value();
  return recorded;
}

void Edit(std::map<std::size_t, std::string>& parts, const std::uint8_t* edit) {
  std::string& part = std::next(parts.begin(), edit[0] % parts.size())->second;
  const std::size_t place = (edit[1] + std::size_t{256} * edit[2]) % (part.size() + 1);
  if (edit[3] % 3 == 0 && place < part.size()) part[place] = static_cast<char>(edit[4]);
  if (edit[3] % 3 == 1) part.insert(place, 1, static_cast<char>(edit[4]));
  if (edit[3] % 3 == 2) part.erase(place, edit[4]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Recorded recorded = Record();
  auto parts = recorded.parts;
  for (; size >= kEditBytes; data += kEditBytes, size -= kEditBytes) Edit(parts, data);
  Compressor compressor;
  const FetchPart fetch = [&](Word, std::size_t part) -> std::optional<std::string_view> {
    const auto found = parts.find(part);
    if (found == parts.end()) return std::nullopt;
    return compressor.Pack(found->second);
  };
  FramePlayer player(recorded.layout);
  if (!player.Open(fetch, false)) return 0;
  for (std::size_t frame = 0; frame < player.ticks().size(); ++frame) player.Show(frame);
  if (player.Open(fetch, true)) player.Show(0);
  return 0;
}
