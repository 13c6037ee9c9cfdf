// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/run_tool.h"

#include <fmt/format.h>

#include <chrono>

#include "harness/base/process/child_process.h"

namespace prehend {

using Clock = std::chrono::steady_clock;

ToolResult RunTool(const std::vector<std::string>& words, const std::string& input,
                   const ToolLimits& limits) {
  ToolResult result;
  ChildProcess tool;
  // If this process is stopped, nobody looks at the clock.
  const double cpu_s = limits.answering_s > 0 ? limits.time_s + limits.answering_s : 0;
  result.problem = tool.Start(words, {.memory_bytes = limits.memory_bytes, .cpu_s = cpu_s});
  if (!result.problem.empty()) return result;
  double time_s = limits.time_s;
  auto deadline = Clock::now() + std::chrono::duration<double>(time_s);
  bool answers = limits.answering_s <= 0;
  tool.Send(input);
  tool.CloseInput();
  while (!tool.has_said_all()) {
    const double left_s = std::chrono::duration<double>(deadline - Clock::now()).count();
    if (left_s <= 0) result.problem = fmt::format("took more than {:g} s", time_s);
    if (tool.out.size() + tool.err.size() > limits.output_bytes)
      result.problem = fmt::format("printed more than {} bytes", limits.output_bytes);
    if (!result.problem.empty()) break;
    tool.Exchange(left_s);
    if (!answers && tool.out.find('\n') != std::string::npos) {
      answers = true;
      time_s = limits.answering_s;
      deadline = Clock::now() + std::chrono::duration<double>(time_s);
    }
  }
  if (result.problem.empty())
    tool.HasEnded(-1);
  else
    tool.Kill();
  result.exit_code = tool.end().exit_code;
  if (tool.end().signal != 0 && result.problem.empty())
    result.problem = fmt::format("was ended by signal {}", tool.end().signal);
  result.out = std::move(tool.out);
  result.err = std::move(tool.err);
  return result;
}

}  // namespace prehend
