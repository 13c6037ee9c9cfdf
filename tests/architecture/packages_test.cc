// SPDX-License-Identifier: Apache-2.0
// What the build of the program asks pkg-config for is in a package that ./run installs. A package
// that only ./test installs stops ./run on a bare Debian, where no test sees it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

namespace fs = std::filesystem;

/// What `command` prints.
std::string PrintedBy(const std::string& command) {
  std::string printed;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::array<char, 256> some{};
  while (pipe && std::fgets(some.data(), some.size(), pipe.get())) printed += some.data();
  return printed;
}

/// What the program's own CMakeLists.txt ask for, without that of tests and benchmarks.
std::set<std::string> ModulesOfTheProgram() {
  static const std::regex kAsked(R"(pkg_check_modules\(\w+ ([^)]*)\))");
  std::set<std::string> modules;
  for (const char* folder : {"", "grammar", "harness", "physics", "render"}) {
    const std::string text = Slurp(fs::path(PREHEND_SOURCE_DIR) / folder / "CMakeLists.txt");
    for (std::sregex_iterator one(text.begin(), text.end(), kAsked), end; one != end; ++one) {
      std::istringstream words((*one)[1]);
      for (std::string word; words >> word;)
        if (word.find_first_of("abcdefghijklmnopqrstuvwxyz") != std::string::npos)
          modules.insert(word);
    }
  }
  return modules;
}

std::set<std::string> PackagesOf(const char* list) {
  std::set<std::string> packages;
  std::istringstream lines(Slurp(fs::path(PREHEND_SOURCE_DIR) / ".ci" / list));
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line.front() != '#') packages.insert(line);
  return packages;
}

TEST(Packages, ThatTheProgramIsBuiltWithAreInstalledByRun) {
  if (PrintedBy("command -v dpkg-query").empty()) GTEST_SKIP() << "this is not Debian";
  const std::set<std::string> modules = ModulesOfTheProgram();
  EXPECT_GT(modules.size(), 8u);
  const std::set<std::string> installed = PackagesOf("packages");
  for (const std::string& module : modules) {
    const std::string owner =
        PrintedBy("dpkg-query -S \"$(readlink -f \"$(pkg-config --variable=pcfiledir " + module +
                  ")/" + module + ".pc\")\"");
    EXPECT_TRUE(installed.contains(owner.substr(0, owner.find(':'))))
        << module << " is of " << owner << "which .ci/packages does not list";
  }
}

}  // namespace
}  // namespace prehend::architecture
