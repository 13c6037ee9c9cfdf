// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/wrap_text.h"

#include <algorithm>

namespace prehend {

std::string Wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string wrapped;
  std::size_t column = 0;
  bool begins_line = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    if (!begins_line && column + 1 + end > width) {
      wrapped += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!begins_line) {
      wrapped += " ";
      ++column;
    }
    wrapped += text.substr(0, end);
    column += end;
    begins_line = end < text.size() && text[end] == '\n';
    if (begins_line) {
      wrapped += "\n";
      column = 0;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return wrapped;
}

}  // namespace prehend
