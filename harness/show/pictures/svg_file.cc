// SPDX-License-Identifier: Apache-2.0
#include "harness/show/pictures/svg_file.h"

#include "harness/base/base/atomic_file.h"
#include "harness/base/process/child_process.h"

namespace prehend::show {

std::string WhyNoDrawingFile(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".svg" || ending == ".png" || ending == ".pdf"
             ? ""
             : "found '" + path + "', wanted a file NAME.svg, NAME.png or NAME.pdf";
}

std::string WriteDrawing(const std::filesystem::path& path, const std::string& svg) {
  if (path.extension() == ".svg") return WriteTextFile(path, svg);
  const std::string format = path.extension() == ".pdf" ? "pdf" : "png";
  const ToolResult drawn =
      RunTool({"rsvg-convert", "--format=" + format, "--zoom=2", "--background-color=white"}, svg);
  if (drawn.Succeeded()) return WriteTextFile(path, drawn.out);
  std::string why = drawn.problem.empty() ? "rsvg-convert: " + drawn.err : drawn.problem;
  if (why.ends_with("is not installed")) why += "; Debian's package librsvg2-bin has it";
  return path.string() + ": " + why + "; a file NAME.svg needs no other program";
}

}  // namespace prehend::show
