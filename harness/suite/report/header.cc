// SPDX-License-Identifier: Apache-2.0
// What stands above a report: see HeaderOf() in harness/suite/report/report.h. Tested by
// tests/program/report_command_test.cc
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "harness/base/process/child_process.h"
#include "harness/suite/report/report.h"

namespace prehend::suite {
namespace {

/// Of a tool's answer, or "" if it failed.
std::string FirstLine(const std::vector<std::string>& words) {
  const ToolResult said = RunTool(words, "", {.time_s = 5});
  return said.Succeeded() ? said.out.substr(0, said.out.find('\n')) : "";
}

std::string CommitOf(const std::string& root) {
  const std::string commit = FirstLine({"git", "-C", root, "rev-parse", "--short=10", "HEAD"});
  if (commit.empty()) return "";
  const bool is_changed =
      !FirstLine({"git", "-C", root, "status", "--porcelain", "--untracked-files=no"}).empty();
  return commit + (is_changed ? ", with changes" : "");
}

/// "Linux 6.1.0 x86_64, 2 processors (AMD EPYC 7B13)"
std::string MachineText() {
  utsname system{};
  if (uname(&system) != 0) return "";
  std::string processor;
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; processor.empty() && std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos)
      processor = " (" + line.substr(colon + 2) + ")";
  }
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return fmt::format("{} {} {}, {} processor{}{}", system.sysname, system.release, system.machine,
                     count, count == 1 ? "" : "s", processor);
}

}  // namespace

ReportHeader HeaderOf(const std::string& command, const std::string& root,
                      const std::string& date) {
  return {.command = command, .date = date, .commit = CommitOf(root), .machine = MachineText()};
}

}  // namespace prehend::suite
