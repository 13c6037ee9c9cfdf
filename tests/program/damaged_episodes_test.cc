// SPDX-License-Identifier: Apache-2.0
// One bit of an episode file is wrong: whatever is asked of it, it is refused, or the answer is
// that of the whole file.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

const std::string kShort = "reach/idling_beside_the_object_is_no_reach";

class DamagedEpisodes : public testing::Test {
 protected:
  DamagedEpisodes() {
    EXPECT_EQ(Prehend({"run", kShort, "--record", file_}).exit_code, 0);
    whole_ = ReadFile(file_);
  }

  std::vector<std::vector<std::string>> Questions() const {
    return {{"episode", "resegment", file_, "--json"},
            {"episode", "verify", file_},
            {"episode", "query", file_, "--event", "*", "--parts", "--json"},
            {"check", file_, "--no-pictures", "--report", (folder_ / "report").string()},
            {"render", file_, "--at", "1.5", "-o", (folder_ / "a.png").string()}};
  }

  /// All that is said and drawn, and the exit code.
  std::string Answer(const std::vector<std::string>& question) const {
    std::filesystem::remove(folder_ / "a.png");
    const Said said = Prehend(question);
    if (said.exit_code == 2) {
      EXPECT_NE(said.out + said.err, "") << question[0];
      return "refused";
    }
    return std::to_string(said.exit_code) + said.out + ReadFile(folder_ / "a.png");
  }

  void WriteFlipped(std::size_t byte, int bit) const {
    std::string bytes = whole_;
    bytes[byte] = static_cast<char>(bytes[byte] ^ 1 << bit);
    WriteFile(file_, bytes);
  }

  const std::filesystem::path folder_ = FreshFolder("one_bit_is_wrong");
  const std::string file_ = (folder_ / "a.episodes").string();
  std::string whole_;
};

TEST_F(DamagedEpisodes, AreRefusedOrAnswerAsBefore) {
  std::vector<std::string> answers;
  for (const auto& question : Questions()) answers.push_back(Answer(question));
  const char* count = std::getenv("PREHEND_FLIPS");  // more of them, by hand
  const int flips = count ? std::atoi(count) : 12;
  std::mt19937 random(20113689);
  int refused = 0;
  for (int i = 0; i < flips; ++i) {
    // Every fourth in the header, which says how all else is read.
    const std::size_t bytes = i % 4 == 0 ? 100 : whole_.size();
    const std::size_t byte = random() % bytes;
    const int bit = static_cast<int>(random() % 8);
    WriteFlipped(byte, bit);
    for (std::size_t q = 0; q < answers.size(); ++q) {
      const std::string answer = Answer(Questions()[q]);
      refused += answer == "refused";
      if (answer == "refused") continue;
      EXPECT_EQ(answer, answers[q]) << Questions()[q][0] << ": byte " << byte << ", bit " << bit;
    }
  }
  EXPECT_GT(refused, flips) << "most of the file is read by most commands";
}

TEST_F(DamagedEpisodes, EveryBitThatSaysWhetherThereAreChecksumsIsWatched) {
  for (const std::size_t byte :
       {20, 60, 61, 62, 63, 68, 69, 70, 71}) {  // room for checksums, version, whose
    for (int bit = 0; bit < 8; ++bit) {
      WriteFlipped(byte, bit);
      EXPECT_EQ(Prehend({"episode", "list", file_}).exit_code, 2) << byte << " " << bit;
    }
  }
}

TEST_F(DamagedEpisodes, APageInThePlaceOfAnotherIsRefused) {
  constexpr std::size_t kPage = 2048;
  std::string bytes = whole_;
  const std::size_t at = kPage * (bytes.size() / kPage / 2);
  bytes.replace(at, kPage, whole_.substr(at + kPage, kPage));
  WriteFile(file_, bytes);
  const Said said = Prehend({"episode", "verify", file_});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("the file is damaged"), std::string::npos) << said.err;
}

TEST_F(DamagedEpisodes, WhatRepeatsACheckNamesTheFile) {
  WriteFlipped(whole_.size() / 2, 3);
  const Said said =
      Prehend({"check", file_, "--no-pictures", "--report", (folder_ / "report").string()});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.out.find("again: prehend check " + file_ + "\n"), std::string::npos) << said.out;
  for (const char* name : {"no.episodes", "no.jsonl", "no.yaml"})
    EXPECT_EQ(
        Prehend({"check", (folder_ / name).string(), "--report", (folder_ / "report").string()})
            .exit_code,
        2)
        << name;
}

}  // namespace
}  // namespace prehend::house
