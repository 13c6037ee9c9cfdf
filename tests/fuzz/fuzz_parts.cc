// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: what projects have beside scenarios and grammars. The first byte says which:
// drawings with a grammar above them, a hand, a motion of a hand in CSV or in the JSON of A-Frame.
// How to run it is in CONTRIBUTING.md.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "grammar/drawing/drawn_episode.h"
#include "harness/scenario/motion/body_motion.h"
#include "harness/scenario/read/read_scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend;
  namespace fs = std::filesystem;
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 4 == 0) {
    grammar::Diagnostics wrong;
    const auto drawn = grammar::ReadDrawings({.file = "fuzz.grammar", .text = bytes}, wrong);
    if (drawn.empty() && wrong.empty() && bytes.find("episode ") == 0) std::abort();
    (void)grammar::Format(wrong);
    return 0;
  }
  static const fs::path path =
      fs::temp_directory_path() / ("prehend_fuzz_part_" + std::to_string(getpid()));
  const std::string file = path.string() + (data[0] % 4 == 1 ? ".yaml" : ".json");
  std::ofstream(file, std::ios::binary) << bytes;
  grammar::Diagnostics wrong;
  if (data[0] % 4 == 1) {
    wrong = ErrorsOf(scenario::ReadHandModel(file));
  } else {
    const auto track = data[0] % 4 == 2 ? scenario::ReadMotionCsv(file)
                                        : scenario::ReadMotionCapture(file, {.name = "right"});
    wrong = ErrorsOf(track);
    if (!track && wrong.empty()) std::abort();  // refused without a word
    if (track && track->samples.size() < 2) std::abort();
    if (track) (void)scenario::CheckTrack(*track, {});
  }
  (void)grammar::Format(wrong);
  return 0;
}
