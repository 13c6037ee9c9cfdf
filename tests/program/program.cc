// SPDX-License-Identifier: Apache-2.0
#include "tests/program/program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace prehend::house {

namespace {

std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

Said Prehend(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
             const std::string& first) {
  const char* other = std::getenv("PREHEND_BINARY");
  const std::string binary = other ? other : PREHEND_BINARY_DIR "/prehend";
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string stem = test ? std::string(test->test_suite_name()) + "." + test->name() : "none";
  for (char& c : stem) c = c == '/' ? '-' : c;
  const auto folder = std::filesystem::temp_directory_path() / "prehend-said";
  std::filesystem::create_directories(folder);
  const auto out = folder / (stem + std::to_string(getpid()) + ".out"),
             err = folder / (stem + std::to_string(getpid()) + ".err");
  std::string command = "cd " + Quoted(PREHEND_SOURCE_DIR) + " && " +
                        (first.empty() ? "" : first + " && ") + "env NO_COLOR=1";
  for (const std::string& pair : environment) command += " " + Quoted(pair);
  command += " " + Quoted(binary);
  for (const std::string& argument : arguments) command += " " + Quoted(argument);
  command += " >" + Quoted(out) + " 2>" + Quoted(err) + " </dev/null";
  const int status = std::system(command.c_str());
  Said said{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), ReadFile(out),
            ReadFile(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return said;
}

std::filesystem::path FreshFolder(const std::string& name) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("prehend-" + name + "-" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

void WriteFile(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "not found: " << from;
  if (at == std::string::npos) return text;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << "found twice: " << from;
  return text.replace(at, from.size(), to);
}

}  // namespace prehend::house
