// SPDX-License-Identifier: Apache-2.0
// hostile [FILES [SEED [FOLDER]]]: shows hostile files to the program. Every run must end by an
// exit code from 0 to 5, within 5 s of processor time and 300 MB, without a crash. Prints a
// summary; exit code 1 and the files, left in FOLDER, if one does not. See CONTRIBUTING.md.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "tests/fuzz/hostile_files.h"
#include "tests/fuzz/logs.h"
#include "tests/program/bag_writer.h"
#include "tests/program/mcap_writer.h"

namespace {

namespace fs = std::filesystem;
using prehend::fuzz::HostileFile;
using prehend::fuzz::Kind;

/// What files of poses mean.
const std::map<Kind, std::string> kMaps = {{Kind::kPoses, "bodies"},
                                           {Kind::kBvh, "bvh_bodies"},
                                           {Kind::kMcap, "mcap_bodies"},
                                           {Kind::kBag, "mcap_bodies"}};
constexpr double kMost_s = 5;
constexpr long kMost_KiB = 300'000'000 / 1024;

struct Ended {
  int status = 0;
  double cpu_s = 0;
  long memory_KiB = 0;
  std::string said;
};

std::string ReadFile(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
}

Ended Run(const std::vector<std::string>& words, const fs::path& folder) {
  const std::string said = (folder / "said").string();
  const pid_t process = fork();
  if (process == 0) {
    const int out = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    const rlimit cpu{60, 60};
    setrlimit(RLIMIT_CPU, &cpu);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  Ended ended;
  rusage usage{};
  wait4(process, &ended.status, 0, &usage);
  ended.cpu_s = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  ended.memory_KiB = usage.ru_maxrss;
  ended.said = ReadFile(said);
  return ended;
}

/// `limited`: its time and memory have limits, which a scenario may reach when it is played.
std::string WhatIsWrong(const Ended& ended, bool limited) {
  if (WIFSIGNALED(ended.status)) return "signal " + std::to_string(WTERMSIG(ended.status));
  const int code = WEXITSTATUS(ended.status);
  if (code > 5) return "exit code " + std::to_string(code);
  std::vector<const char*> words = {"internal error", "crashed (", "aborted ("};
  if (!limited) words.insert(words.end(), {"needs more memory", "no end after"});
  for (const char* word : words) {
    if (ended.said.find(word) != std::string::npos) return word;
  }
  if (ended.cpu_s > kMost_s) return std::to_string(ended.cpu_s) + " s";
  if (ended.memory_KiB > kMost_KiB) return std::to_string(ended.memory_KiB / 1024) + " MiB";
  for (const char c : ended.said) {
    if (c == '\x1b' || c == '\xff' || c == '\0') return "it prints what terminals obey";
  }
  return {};
}

/// A carton that stands, and a hand beside it.
constexpr const char* kRecorded = R"(scenario: seed
shows: a carton stands on a table
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  carton: {class: Carton, box: {size_m: [0.06, 0.06, 0.10]}, mass_kg: 0.3, on: table, at_m: [0.15, 0.15]}
actors:
  right_hand: {hand: human_right, at_m: [-0.25, -0.1, 1.1]}
script:
  - right_hand: {wait_s: 0.1}
)";

/// In chunks of every kind.
std::vector<std::string> McapFiles() {
  using prehend::house::McapWriter;
  std::vector<std::string> files;
  for (const auto chunks : {McapWriter::Chunks::kNone, McapWriter::Chunks::kPlain,
                            McapWriter::Chunks::kZstd, McapWriter::Chunks::kLz4})
    files.push_back(McapWriter::FileOf(prehend::fuzz::McapRecords(), chunks));
  return files;
}

std::vector<std::string> BagFiles() {
  std::vector<std::string> files;
  for (const char* compression : {"", "none", "lz4"})
    files.push_back(prehend::house::BagHead() +
                    prehend::house::BagChunk(prehend::fuzz::BagRecords(), compression));
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  const long files = argc > 1 ? std::atol(argv[1]) : 10'000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const fs::path folder =
      argc > 3 ? fs::path(argv[3])
               : fs::temp_directory_path() / ("prehend-hostile-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const char* const other = std::getenv("PREHEND_BINARY");
  const std::string program = other != nullptr ? other : PREHEND_BINARY_DIR "/prehend";
  const std::string source = PREHEND_SOURCE_DIR;
  setenv("PREHEND_HOME", source.c_str(), 1);
  const fs::path scenario = folder / "seed.yaml", recording = folder / "seed.jsonl";
  std::ofstream(scenario) << kRecorded;
  const Ended recorded =
      Run({program, "run", scenario.string(), "--record", recording.string()}, folder);
  const std::string lines = ReadFile(recording);
  if (recorded.status != 0 || lines.empty()) {
    std::printf("the seed was not recorded:\n%s", recorded.said.c_str());
    return 1;
  }
  std::map<Kind, std::vector<std::string>> made = {
      {Kind::kRecording, {lines, lines.substr(0, lines.size() / 3)}},
      {Kind::kMcap, McapFiles()},
      {Kind::kBag, BagFiles()}};
  for (const auto& [kind, file] : {std::pair(Kind::kEaf, folder / "seed.eaf"),
                                   std::pair(Kind::kTextGrid, folder / "seed.TextGrid")}) {
    Run({program, "episode", "resegment", recording.string(), "-o", file.string()}, folder);
    made[kind] = {ReadFile(file)};
    if (made[kind].front().empty()) {
      std::printf("no labels were written to %s\n", file.c_str());
      return 1;
    }
  }
  prehend::fuzz::HostileFiles hostile(source, std::move(made), seed);
  std::map<int, long> codes;
  long wrong = 0;
  double longest_s = 0;
  long most_KiB = 0;
  for (long i = 0; i < files; ++i) {
    const HostileFile file = hostile.Next();
    const fs::path path = folder / ("file" + prehend::fuzz::EndingOf(file.kind));
    std::ofstream(path, std::ios::binary) << file.text;
    std::vector<std::string> words = {program, "validate", path.string()};
    if (file.kind == Kind::kRecording) {
      const std::vector<std::string> readers[] = {
          {"episode", "resegment"}, {"explain"}, {"grammar", "tracks"}};
      words = readers[i % 3];
      words.insert(words.begin(), program);
      words.push_back(path.string());
    } else if (file.kind == Kind::kScenario && i % 5 == 0) {
      words = {program, "run", path.string(), "--time-limit-s", "4", "--memory-limit-mb", "250"};
    } else if (file.kind == Kind::kGrammar && i % 3 == 0) {
      words = {program, "episode", "resegment", recording.string(), "--grammar", path.string()};
    } else if (const auto map = kMaps.find(file.kind); map != kMaps.end()) {
      words = {program,
               "import",
               path.string(),
               "--map",
               source + "/docs/motion_capture/" + map->second + ".yaml",
               "--check"};
    } else if (file.kind == Kind::kPosesMap) {
      constexpr const char* kPoses[] = {"poses.csv", "take.bvh", "run.mcap"};
      words = {program, "import",      source + "/docs/motion_capture/" + kPoses[i % 3],
               "--map", path.string(), "--check"};
    } else if (file.kind == Kind::kEaf || file.kind == Kind::kTextGrid) {
      words = {program, "score", recording.string(), "--truth", path.string()};
    }
    const Ended ended = Run(words, folder);
    const std::string why = WhatIsWrong(ended, words[1] == "run");
    if (WIFEXITED(ended.status)) ++codes[WEXITSTATUS(ended.status)];
    longest_s = std::max(longest_s, ended.cpu_s);
    most_KiB = std::max(most_KiB, ended.memory_KiB);
    if (why.empty()) continue;
    const fs::path kept =
        folder / ("wrong" + std::to_string(++wrong) + prehend::fuzz::EndingOf(file.kind));
    fs::copy_file(path, kept, fs::copy_options::overwrite_existing);
    std::printf("%s: %s (%s): %s\n", words[1].c_str(), kept.c_str(), file.what.c_str(),
                why.c_str());
    std::fflush(stdout);
  }
  std::printf("%ld files, %ld wrong; at most %.1f s and %ld MB; exit codes:", files, wrong,
              longest_s, most_KiB * 1024 / 1'000'000);
  for (const auto& [code, times] : codes) std::printf(" %d (%ld)", code, times);
  std::printf("\n");
  if (wrong == 0 && argc <= 3) fs::remove_all(folder);
  return wrong == 0 ? 0 : 1;
}
