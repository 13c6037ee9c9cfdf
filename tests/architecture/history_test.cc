// SPDX-License-Identifier: Apache-2.0
// The oracle and the grammar library judge each other, so no commit changes both (docs/truth.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace prehend::architecture {
namespace {

/// The commit that made the oracle an evaluator of its own; the rule holds from here on.
constexpr const char* kSince = "625670f";

struct Commit {
  std::string subject;  ///< its short hash and its subject
  bool oracle = false, library = false;

  bool ChangesBoth() const { return oracle && library; }
};

/// What `git log --format=@%h %s --name-only` prints -> commits.
std::vector<Commit> CommitsIn(const std::string& log) {
  std::vector<Commit> commits;
  for (std::size_t at = 0; at < log.size();) {
    const std::size_t end = std::min(log.find('\n', at), log.size());
    const std::string line = log.substr(at, end - at);
    at = end + 1;
    if (line.starts_with("@")) commits.push_back({line.substr(1)});
    if (commits.empty()) continue;
    commits.back().oracle |= line.starts_with("harness/truth/oracle/");
    commits.back().library |= line.starts_with("grammar/library/");
  }
  return commits;
}

/// Standard output of a command; "" if it fails.
std::string OutputOf(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  char buffer[4096];
  while (pipe && fgets(buffer, sizeof buffer, pipe.get())) output += buffer;
  return output;
}

TEST(History, CommitsThatChangeOracleAndLibraryAreFound) {
  const std::vector<Commit> commits = CommitsIn(
      "@1 both\n\nharness/truth/oracle/carry.cc\ngrammar/library/contact.grammar\n"
      "@2 one\n\nharness/truth/oracle/carry.cc\n@3 other\n\ngrammar/library/contact.grammar\n");
  ASSERT_EQ(commits.size(), 3u);
  EXPECT_TRUE(commits[0].ChangesBoth());
  EXPECT_FALSE(commits[1].ChangesBoth());
  EXPECT_FALSE(commits[2].ChangesBoth());
}

TEST(History, NoCommitChangesTheOracleTogetherWithTheLibrary) {
  const std::string log =
      OutputOf(std::string("git -C '") + PREHEND_SOURCE_DIR + "' log " + kSince +
               "..HEAD --no-merges --format='@%h %s' --name-only -- "
               "harness/truth/oracle grammar/library 2>/dev/null");
  if (log.empty()) GTEST_SKIP() << "no history since " << kSince << " here";
  for (const Commit& commit : CommitsIn(log)) EXPECT_FALSE(commit.ChangesBoth()) << commit.subject;
}

}  // namespace
}  // namespace prehend::architecture
