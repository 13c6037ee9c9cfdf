// SPDX-License-Identifier: Apache-2.0
// Another program as a function: text in, text out, within a time. No shell is involved. Tested by
// tests/harness/base/process/run_tool_test.cc
#pragma once

#include <string>
#include <vector>

namespace prehend {

struct ToolLimits {
  double time_s = 60;
  double answering_s = 0;  ///< from its first line on; 0: it has time_s for all
  std::size_t output_bytes = std::size_t{1} << 28;  ///< of standard output and error together
  std::size_t memory_bytes = 0;                     ///< of its address space; 0: any
};

struct ToolResult {
  /// Empty if it ended by itself; else why not: "'rsvg-convert' is not installed", "took more than
  /// 60 s", "was ended by signal 9".
  std::string problem;
  int exit_code = 0;  ///< if it ended by itself
  std::string out, err;

  bool Succeeded() const { return problem.empty() && exit_code == 0; }
};

/// `words`: the program, which is searched in PATH, and its arguments. `input` is its standard
/// input. A program that exceeds a limit is killed.
ToolResult RunTool(const std::vector<std::string>& words, const std::string& input,
                   const ToolLimits& limits = {});

}  // namespace prehend
