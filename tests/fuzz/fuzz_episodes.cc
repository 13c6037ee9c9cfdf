// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: an episode file, damaged. The input is where the file is cut off (3 bytes, 0:
// it is not), and then edits: a place (3 bytes) and a byte. Everything that can be read of the file
// is read. How to run it is in CONTRIBUTING.md.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/record_episode.h"
#include "tests/fuzz/recorded_story.h"

namespace {

using namespace prehend;
using namespace prehend::episode;
using namespace prehend::fuzz;
namespace fs = std::filesystem;

struct Recorded {
  fs::path path =
      fs::temp_directory_path() / ("prehend_fuzz_" + std::to_string(getpid()) + ".episodes");
  FrameLayout layout;
  std::string bytes;
  ~Recorded() { fs::remove(path); }
};

const Recorded& Story() {
  static Recorded recorded;
  if (!recorded.bytes.empty()) return recorded;
  const episode::LoadedRun loaded = fuzz::LoadStory();
  recorded.layout = LayoutOf(loaded.scenario.scene);
  EpisodeRecorder recorder({.file = recorded.path.string(),
                            .root = PREHEND_SOURCE_DIR,
                            .run = {.scenario_file = loaded.scenario.file},
                            .files = {},
                            .recorded_on = "2026-01-01",
                            .program_hash = "0"},
                           loaded.scenario);
  recorder.Finish(
      fuzz::PlayStory(loaded, [&](const physics::Snapshot& snapshot) { recorder.Add(snapshot); }));
  if (!recorder.problem().empty()) std::abort();
  std::ifstream in(recorded.path, std::ios::binary);
  recorded.bytes = {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return recorded;
}

/// Gives each page its checksum, which would refuse nearly all.
void Sum(std::string& bytes) {
  constexpr std::size_t kPage = 2048, kSum = kPage - 8;
  for (std::size_t at = 0; at + kPage <= bytes.size(); at += kPage) {
    const std::uint64_t sum = ContentHashAt(at, std::string_view(bytes).substr(at, kSum));
    std::memcpy(bytes.data() + at + kSum, &sum, sizeof(sum));
  }
}

void ReadAll(const Recorded& story) {
  const Result<EpisodeFile> file = EpisodeFile::Open(story.path.string());
  if (!file) {
    if (ErrorsOf(file).empty()) std::abort();  // refused without a word
    return;
  }
  for (const EpisodeRow& episode : file->episodes()) {
    (void)file->TaskOf(episode);
    (void)file->TimelineOf(episode);
    (void)file->EntitiesOf(episode);
    (void)file->NotesOf(episode);
    EpisodeFrames frames(*file, episode, story.layout);
    (void)frames.Play([](const physics::Snapshot&) {});
    (void)frames.At(episode.ticks / 2);
    (void)frames.TrackOf(1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Recorded& story = Story();
  std::string bytes = story.bytes;
  const auto place = [&] {
    return (data[0] + std::size_t{256} * data[1] + std::size_t{65536} * data[2]) % bytes.size();
  };
  if (size < 3) return 0;
  const std::size_t most = place();
  for (data += 3, size -= 3; size >= 4; data += 4, size -= 4)
    bytes[place()] = static_cast<char>(data[3]);
  if (most > 0) bytes.resize(most);
  Sum(bytes);
  std::ofstream(story.path, std::ios::binary) << bytes;
  ReadAll(story);
  return 0;
}
