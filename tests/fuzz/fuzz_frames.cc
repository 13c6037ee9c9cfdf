// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: a chunk of frames, damaged. The bytes of the input are edits of words of its
// tables before they are packed, so that their hashes are right: the number of the part, a word of
// its last table (2 bytes), a kind (other bits, a small number, no such column) and a byte. All
// frames that can be read are shown. How to run it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "harness/episode/frames/chunk.h"
#include "tests/fuzz/recorded_story.h"

namespace {

using namespace prehend;
using namespace prehend::episode;
using namespace prehend::fuzz;

constexpr std::size_t kEditBytes = 5;
using Parts = std::map<std::size_t, std::vector<Columns>>;

struct Recorded {
  FrameLayout layout;
  Parts parts;
  std::size_t frames = 0;
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
  TablePacker packer;
  recorded.frames = chunks.at(0).frames;
  for (const ChunkPart& part : chunks.at(0).parts)
    recorded.parts[part.part] = packer.Unpack(part.bytes);
  return recorded;
}

void Edit(Parts& parts, const std::uint8_t* edit) {
  Columns& table = std::next(parts.begin(), edit[0] % parts.size())->second.back();
  if (table.words.empty()) return;
  Word& word = table.words[(edit[1] + std::size_t{256} * edit[2]) % table.words.size()];
  if (edit[3] % 3 == 0) word ^= Word{1} << (edit[4] % 64);
  if (edit[3] % 3 == 1) word = Word{edit[4]} - 2;
  if (edit[3] % 3 == 2) table = Columns(table.rows, edit[4]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Recorded recorded = Record();
  Parts parts = recorded.parts;
  for (; size >= kEditBytes; data += kEditBytes, size -= kEditBytes) Edit(parts, data);
  TablePacker packer;
  std::string packed;
  const FetchPart fetch = [&](std::size_t part, bool) -> std::optional<std::string_view> {
    const auto found = parts.find(part);
    if (found == parts.end()) return std::nullopt;
    packed = packer.Pack(found->second);
    return packed;
  };
  FramePlayer player(recorded.layout);
  try {
    player.Open(fetch, 1, recorded.frames, false);
    for (std::size_t frame = 0; frame < recorded.frames; ++frame) player.Show(frame);
    player.Open(fetch, 481, recorded.frames, true);
    player.Show(0);
  } catch (const Damage&) {
    // That is how it is refused.
  }
  return 0;
}
