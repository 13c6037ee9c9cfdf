// SPDX-License-Identifier: Apache-2.0
// Ctrl-C during a suite: what has ended is told.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Clock = std::chrono::steady_clock;

/// `check` of two short scenarios, one after the other, each so often that none ends by itself.
class Interrupted : public testing::Test {
 protected:
  ~Interrupted() override { std::filesystem::remove_all(folder_); }

  /// What it says when it gets `signal` after three seconds.
  Said Check(const std::vector<std::string>& more, int signal, bool ignores_it = false,
             const char* repeats = "10000") {
    const char* other = std::getenv("PREHEND_BINARY");
    const std::string binary = other ? other : PREHEND_BINARY_DIR "/prehend";
    std::vector<std::string> words{binary,
                                   "check",
                                   "planar/box_is_dropped_in_the_air",
                                   "planar/disc_rolls_to_rest",
                                   "--no-pictures",
                                   "--repeat",
                                   repeats,
                                   "--report",
                                   (folder_ / "report").string()};
    words.insert(words.end(), more.begin(), more.end());
    const pid_t process = fork();
    if (process == 0) {
      if (chdir(PREHEND_SOURCE_DIR) != 0) _exit(99);
      std::signal(signal, ignores_it ? SIG_IGN : SIG_DFL);  // whatever our own shell said
      dup2(open((folder_ / "out").c_str(), O_CREAT | O_WRONLY, 0600), STDOUT_FILENO);
      dup2(open((folder_ / "err").c_str(), O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execv(arguments.front(), arguments.data());
      _exit(99);
    }
    std::this_thread::sleep_for(std::chrono::seconds(3));
    kill(process, signal);
    const Clock::time_point sent = Clock::now();
    int status = 0;
    waitpid(process, &status, 0);
    seconds_ = std::chrono::duration<double>(Clock::now() - sent).count();
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            ReadFile(folder_ / "out"), ReadFile(folder_ / "err")};
  }

  const std::filesystem::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
  double seconds_ = 0;  ///< from the signal to the end
};

TEST_F(Interrupted, CheckTellsWhatHasEnded) {
  const Said said = Check({"--junit", (folder_ / "verdicts.xml").string()}, SIGINT);
  EXPECT_EQ(said.exit_code, 128 + SIGINT) << "ends by the signal, so that loops of a shell end";
  EXPECT_TRUE(said.out.starts_with("passed  planar/")) << said.out;
  EXPECT_TRUE(said.out.ends_with("1 passed, 0 failed\n")) << said.out;
  EXPECT_EQ(said.err, "prehend: stopped by SIGINT; 1 of 2 scenarios were not checked\n");
  EXPECT_NE(ReadFile(folder_ / "verdicts.xml").find("tests=\"1\""), std::string::npos);
  EXPECT_NE(ReadFile(folder_ / "report/index.html").find("1 of 2 scenarios were not checked"),
            std::string::npos);
}

TEST_F(Interrupted, JsonSaysSo) {
  const Said said = Check({"--json"}, SIGTERM);
  EXPECT_EQ(said.exit_code, 128 + SIGTERM);
  const auto summary = nlohmann::json::parse(said.out);
  EXPECT_EQ(summary["stopped_by"], "SIGTERM");
  EXPECT_EQ(summary["scenarios"].size(), 1u);
}

TEST_F(Interrupted, AnIgnoredSignalStaysIgnored) {
  const Said said = Check({}, SIGHUP, /*ignores_it=*/true, "60");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(said.out.ends_with("2 passed, 0 failed\n")) << said.out;
}

}  // namespace
}  // namespace prehend::house
