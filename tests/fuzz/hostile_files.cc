// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/hostile_files.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>

#include "tests/program/bag_writer.h"
#include "tests/program/mcap_writer.h"

namespace prehend::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMost_bytes = 1'000'000;

std::vector<std::string> TextsBelow(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ending) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

std::string Times(std::string_view text, std::size_t times) {
  std::string all;
  while (times-- > 0 && all.size() + text.size() <= kMost_bytes) all += text;
  return all;
}

std::string Numbered(std::size_t times, const std::function<std::string(const std::string&)>& one) {
  std::string all;
  for (std::size_t i = 0; i < times && all.size() < kMost_bytes - 200; ++i)
    all += one(std::to_string(i));
  return all;
}

const std::vector<std::string> kNumbers = {"0",
                                           "-1",
                                           "1e308",
                                           "-1e308",
                                           "1e-320",
                                           "1e999",
                                           "nan",
                                           ".inf",
                                           "0x10",
                                           "1e15",
                                           "1:30",
                                           "+5",
                                           "1_000",
                                           "00",
                                           "4294967296",
                                           "1e5",
                                           "-0.0",
                                           "0.1e-9",
                                           "9223372036854775808",
                                           "99999999999999999999999999999999999999"};
const std::vector<std::string> kStrange = {std::string(1, '\0'),
                                           "\x1b[31m",
                                           "\xff",
                                           "\xc3",
                                           "\xed\xa0\x80",
                                           "\xe2\x80\xa8",
                                           "\xe2\x80\xae",
                                           "\xc2\x9b",
                                           "\xef\xbf\xbe",
                                           "\r",
                                           "\t",
                                           "\x7f",
                                           "\xef\xbb\xbf",
                                           "%s%n",
                                           "\"\\u009b\"",
                                           "'",
                                           "\"",
                                           "{",
                                           "}",
                                           "[",
                                           "]",
                                           "&a *a",
                                           "!!int ",
                                           "<<: ",
                                           "---\n",
                                           "# ",
                                           ": ",
                                           "../../../etc/passwd",
                                           "/dev/zero"};

bool IsWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The run of characters around `at` for which `is` holds.
std::pair<std::size_t, std::size_t> RunAround(const std::string& text, std::size_t at,
                                              const std::function<bool(char)>& is) {
  std::size_t begin = at, end = at;
  while (begin > 0 && is(text[begin - 1])) --begin;
  while (end < text.size() && is(text[end])) ++end;
  return {begin, end - begin};
}

}  // namespace

std::string EndingOf(Kind kind) {
  constexpr const char* kEndings[] = {".yaml", ".grammar", ".timeline", ".jsonl",    ".csv", ".bvh",
                                      ".mcap", ".yaml",    ".eaf",      ".TextGrid", ".bag"};
  return kEndings[static_cast<int>(kind)];
}

HostileFiles::HostileFiles(const fs::path& source, std::map<Kind, std::vector<std::string>> made,
                           std::uint64_t seed)
    : random_(seed) {
  seeds_[0] = TextsBelow(source / "scenarios", ".yaml");
  seeds_[1] = TextsBelow(source / "grammar/library", ".grammar");
  seeds_[2] = TextsBelow(source / "golden", ".timeline");
  const fs::path poses = source / "docs/motion_capture";
  seeds_[static_cast<int>(Kind::kPoses)] = TextsBelow(poses, ".csv");
  seeds_[static_cast<int>(Kind::kBvh)] = TextsBelow(poses, ".bvh");
  seeds_[static_cast<int>(Kind::kMcap)] = TextsBelow(poses, ".mcap");
  seeds_[static_cast<int>(Kind::kPosesMap)] = TextsBelow(poses, ".yaml");
  for (auto& [kind, texts] : made) {
    for (std::string& text : texts) seeds_[static_cast<int>(kind)].push_back(std::move(text));
  }
}

HostileFile HostileFiles::Next() {
  const Kind kind = static_cast<Kind>(Below(kKinds));
  HostileFile file = Below(8) == 0 ? Flood(kind) : Damaged(kind);
  if (file.text.size() > kMost_bytes) file.text.resize(kMost_bytes);
  return file;
}

HostileFile HostileFiles::Damaged(Kind kind) {
  HostileFile file{.kind = kind, .what = {}, .text = OneOf(seeds_[static_cast<int>(kind)])};
  for (std::size_t times = 1 + Below(4); times > 0; --times)
    file.what += (file.what.empty() ? "" : ", ") + Damage(file.text, kind);
  return file;
}

std::string HostileFiles::Damage(std::string& text, Kind kind) {
  if (text.empty()) text = "x";
  const std::size_t at = Below(text.size());
  const std::size_t length = std::min(1 + Below(1 + Below(400)), text.size() - at);
  switch (Below(12)) {
    case 0:
      text.resize(at);
      return "cut off";
    case 1:
      text.erase(at, length);
      return "a piece lost";
    case 2:
      text.insert(Below(text.size()), text.substr(at, length));
      return "a piece twice";
    case 3:
      text.insert(at, OneOf(kStrange));
      return "strange characters";
    case 4:
      text[at] = static_cast<char>(text[at] ^ (1 << Below(8)));
      return "a bit flipped";
    case 5: {
      const auto [begin, size] = RunAround(text, at, IsWord);
      const auto [other, other_size] = RunAround(text, Below(text.size()), IsWord);
      text.replace(begin, size, std::string(text.substr(other, other_size)));
      return "another word";
    }
    case 6: {
      const std::size_t digit = text.find_first_of("0123456789", at);
      if (digit == std::string::npos) return "nothing";
      const auto [begin, size] = RunAround(text, digit, [](char c) {
        return std::isdigit(static_cast<unsigned char>(c)) || c == '.';
      });
      text.replace(begin, size, OneOf(kNumbers));
      return "another number";
    }
    case 7: {
      const auto not_end = [](char c) { return c != '\n'; };
      const auto [begin, size] = RunAround(text, at, not_end);
      const std::string line = text.substr(begin, size) + "\n";
      text.insert(begin, Times(line, 1 + Below(Below(8) == 0 ? 20'000 : 3)));
      return "a line again and again";
    }
    case 8: {
      const auto [begin, size] = RunAround(text, at, IsWord);
      text.insert(begin, Times(Below(2) == 0 ? "a" : "7", 1 + Below(100'000)));
      return "a long word";
    }
    case 9: {
      const std::string& other = OneOf(seeds_[Below(kKinds)]);
      const std::size_t from = Below(other.size());
      text.insert(at, other.substr(from, 1 + Below(2000)));
      return "a piece of another file";
    }
    case 10: {
      const char bracket = "[{("[Below(3)];
      text.insert(at, std::string(1 + Below(3000), bracket));
      return "brackets";
    }
    default:
      std::replace(text.begin() + static_cast<std::ptrdiff_t>(at),
                   text.begin() + static_cast<std::ptrdiff_t>(at + length), '\n', ' ');
      (void)kind;
      return "lines joined";
  }
}

HostileFile HostileFiles::McapFlood(std::size_t many) {
  using house::McapWriter;
  HostileFile file{.kind = Kind::kMcap, .what = "flood", .text = {}};
  constexpr McapWriter::Chunks kChunks[] = {McapWriter::Chunks::kNone, McapWriter::Chunks::kPlain,
                                            McapWriter::Chunks::kZstd, McapWriter::Chunks::kLz4};
  const auto chunks = kChunks[Below(4)];
  McapWriter writer;
  switch (Below(4)) {
    case 0:  // headers
      file.text = "\x89MCAP0\r\n" + Numbered(many, [](const std::string&) {
                    return std::string("\x01\0\0\0\0\0\0\0\0", 9);
                  });
      return file;
    case 1: {  // a bomb: chunks of nothing, each 64 MB of a file of 2 KB
      constexpr std::size_t kBytes = 64'000'000 / 9 * 9;
      const std::string chunk = McapWriter::ChunkOf(house::RunAsZstd('\0', kBytes), kBytes, "zstd");
      file.what = "bomb";
      file.text = McapWriter::FileOf(Times(chunk, std::min<std::size_t>(many, 480)),
                                     McapWriter::Chunks::kNone);
      return file;
    }
    case 2:
      for (std::size_t i = 0; i < std::min<std::size_t>(many, 60'000); ++i) {
        if (writer.records().size() > kMost_bytes - 500) break;
        writer.Channel("/t" + std::to_string(i), "cdr", "tf2_msgs/msg/TFMessage");
      }
      break;
    default: {  // frames in frames in frames
      const auto tf = writer.Channel("/tf", "cdr", "tf2_msgs/msg/TFMessage");
      const bool ring = Below(2) == 0;
      for (std::size_t i = 0; i < many && writer.records().size() < kMost_bytes - 500; ++i) {
        const std::size_t in = ring ? (i + 1) % (1 + many % 7) : i + 1;
        const std::string child = i == 0 ? "carton" : "f" + std::to_string(ring ? i % 7 : i);
        writer.Message(tf, Below(2) == 0 ? 1'000'000'000 : random_(),
                       house::Cdr()
                           .U32(1)
                           .Header(1'000'000'000 + i / 2, "f" + std::to_string(in))
                           .Text(child)
                           .Pose({0, 0, 1})
                           .Bytes());
      }
    }
  }
  file.text = McapWriter::FileOf(writer.records(), chunks);
  return file;
}

HostileFile HostileFiles::BagFlood(std::size_t many) {
  HostileFile file{.kind = Kind::kBag, .what = "flood", .text = house::BagHead()};
  constexpr const char* kCompressions[] = {"", "none", "lz4"};
  const std::string compression = kCompressions[Below(3)];
  switch (Below(3)) {
    case 0:
      file.text += house::BagChunk(Numbered(many,
                                            [](const std::string& i) {
                                              return house::BagConnection(
                                                  static_cast<std::uint32_t>(std::stoul(i)),
                                                  "/t" + i, "tf2_msgs/TFMessage");
                                            }),
                                   compression);
      break;
    case 1:  // chunks in a chunk
      for (std::size_t i = 0; i < std::min<std::size_t>(many, 2000); ++i)
        file.text = house::BagChunk(file.text, compression);
      break;
    default:
      file.text += house::BagChunk(house::BagConnection(0, "/tf", "tf2_msgs/TFMessage") +
                                       Numbered(many,
                                                [](const std::string& i) {
                                                  return house::BagMessage(0, std::stoul(i),
                                                                           std::string(4, '\0'));
                                                }),
                                   compression);
  }
  return file;
}

// One thing, a hundred thousand times.
HostileFile HostileFiles::Flood(Kind kind) {
  const std::size_t many = std::size_t{10} << Below(15);  // 10 to 163,840
  HostileFile file{.kind = kind, .what = "flood", .text = {}};
  const auto list = [&](const std::string& before, const std::string& after,
                        const std::function<std::string(const std::string&)>& one) {
    file.text = before + Numbered(many, one) + after;
    return file;
  };
  using S = const std::string&;
  const std::string head = "scenario: x\nshows: x\n";
  switch (kind) {
    case Kind::kScenario:
      switch (Below(9)) {
        case 0:
          return list(head + "entities:\n  a: {", "}\n", [](S i) { return "k" + i + ": 1, "; });
        case 1:
          return list("", "", [](S i) { return "k" + i + ": 1\n"; });
        case 2:
          return list(head, "", [](S) { return std::string("tags: [a]\n"); });
        case 3:
          return list(head + "tags: [", "]\n", [](S i) { return "&a" + i + " *b, "; });
        case 4:
          return list(head + "entities:\n", "", [](S i) {
            return "  e" + i +
                   ": {class: Cup, box: {size_m: [1, 1, 1]}, mass_kg: 1, at_m: [0, 0, " + i +
                   "]}\n";
          });
        case 5:
          return list(head + "expects:\n", "", [](S i) { return "  - no e" + i + "\n"; });
        case 6:
          return list(head + "classes: {", "}\n", [](S i) {
            return "C" + i + ": C" + std::to_string(std::stoul(i) + 1) + ", ";
          });
        case 7:
          return list(head + "script:\n", "",
                      [](S) { return std::string("  - h: {wait_s: 1}\n"); });
        default:
          return list(head + "notes: \"", "\"\n", [](S) { return std::string("\\x41\\\""); });
      }
    case Kind::kGrammar:
      switch (Below(9)) {
        case 0:
          return list("grammar x ", "", [](S) { return std::string("$ "); });
        case 1:
          return list("grammar x\nevent e(a: Entity) while speed(a) > 0 m/s", "\n",
                      [](S) { return std::string(" + 1 m/s"); });
        case 2:
          return list("grammar x\n", "", [](S i) { return "param p" + i + " = 1 m\n"; });
        case 3:
          return list("grammar x\n", "", [](S) { return std::string("param p = 1 m\n"); });
        case 4:
          return list("grammar x\nparam p = 1 m", "\n", [](S) { return std::string("/s"); });
        case 5:
          return list("grammar x\n", "", [](S i) {
            return "event e" + i + "(a: Entity, b: Entity) while touching(a, b)\n";
          });
        case 6:
          return list("grammar x\ndefine d0 = 1\n", "event e(a: Entity) while d5 > 1\n", [](S i) {
            return "define d" + std::to_string(std::stoul(i) + 1) + " = d" + i + " + d" + i + "\n";
          });
        case 7:
          return list(
              "grammar x\nevent t(a: Entity, b: Entity) while touching(a, b)\n"
              "event e(a: Entity, b: Entity) compose p: t(a, b)",
              " where p before p\n", [](S i) { return ", p" + i + ": t(a, b)"; });
        default:
          return list("grammar x\nevent e(a: Entity) while ", "\n",
                      [](S) { return std::string("not "); });
      }
    case Kind::kGolden:
      switch (Below(3)) {
        case 0:
          return list("# scenario: pick_and_place/milk_carton_wrap\n", "",
                      [](S i) { return "# reason: " + i + "\n"; });
        case 1:
          return list(seeds_[2].front(), "", [](S i) { return i + " " + i + " contact a=b\n"; });
        default:
          return list(seeds_[2].front(), "", [](S i) { return "0.1 0.2 e" + i + " a=b c=d "; });
      }
    case Kind::kRecording:
      break;
    case Kind::kPoses:
      return list("time,Carton_x,Carton_y,Carton_z,Glove_x,Glove_y,Glove_z\n", "",
                  [](S i) { return i + ",0,0,0,1,1,1\n"; });
    case Kind::kBvh:
      return Below(2) == 0 ? list("HIERARCHY\n", "",
                                  [](S i) { return "ROOT r" + i + " {\nOFFSET 0 0 0\n}\n"; })
                           : list("HIERARCHY\n", "", [](S i) {
                               return (i == "0" ? "ROOT r" : "JOINT j") + i + " {\n";
                             });
    case Kind::kMcap:
      return McapFlood(many);
    case Kind::kBag:
      return BagFlood(many);
    case Kind::kPosesMap:
      return list("import: 1\nunit: m\naxes: y_up\nentities:\n", "",
                  [](S i) { return "  e" + i + ": {from: b" + i + ", size_m: [1, 1, 1]}\n"; });
    case Kind::kEaf:
      return list("<ANNOTATION_DOCUMENT><TIME_ORDER>", "</TIME_ORDER></ANNOTATION_DOCUMENT>",
                  [](S i) { return "<TIME_SLOT TIME_SLOT_ID=\"" + i + "\"/>"; });
    case Kind::kTextGrid:
      return list("\"ooTextFile\" \"TextGrid\" 0 3 <exists> 9999 ", "",
                  [](S) { return std::string("\"IntervalTier\" \"t\" 0 3 0 "); });
  }
  const std::string& recording = OneOf(seeds_[3]);
  const std::size_t end = recording.find('\n');
  const std::string header = recording.substr(0, end + 1);
  switch (Below(4)) {
    case 0:
      return list("{", "}\n", [](S i) { return "\"k" + i + "\": 1, "; });
    case 1:
      return list(header, "", [](S i) { return "{\"tick\": " + i + "}\n"; });
    case 2:
      return list(header + "{\"tick\": 1, \"touches\": [", "]}\n",
                  [](S) { return std::string("{\"a\": \"carton\", \"b\": \"table\"}, "); });
    default:
      return list(header + "{\"tick\": 1", "}\n", [](S) { return std::string(", \"tick\": 1"); });
  }
}

}  // namespace prehend::fuzz
