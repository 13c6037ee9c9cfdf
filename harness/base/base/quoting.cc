// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/quoting.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <sstream>

#include "harness/base/base/text_file.h"

namespace prehend {

namespace {

/// Of the quote at `open`; npos if there is none.
std::size_t ClosingQuote(std::string_view line, std::size_t open) {
  std::size_t quote = line.find('"', open + 1);
  while (quote < line.size() - 1 && line[quote + 1] == '"') quote = line.find('"', quote + 2);
  return quote;
}

}  // namespace

std::string Base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63u];
  }
  return text;
}

pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes) {
  pugi::xml_node element = parent.append_child(name);
  for (const auto& [key, value] : attributes)
    element.append_attribute(key).set_value(ReadableText(value).c_str());
  return element;
}

pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes,
                          std::string_view text) {
  const pugi::xml_node element = AddElement(parent, name, attributes);
  AddText(element, text);
  return element;
}

void AddText(pugi::xml_node parent, std::string_view text) {
  parent.append_child(pugi::node_pcdata).set_value(ReadableText(text).c_str());
}

void AddMarkup(pugi::xml_node parent, std::string_view markup) {
  parent.append_buffer(markup.data(), markup.size(), pugi::parse_default, pugi::encoding_utf8);
}

std::string ToText(const pugi::xml_document& document, Layout layout) {
  std::ostringstream text;
  const unsigned flags = layout == Layout::kIndented
                             ? pugi::format_indent
                             : pugi::format_raw | pugi::format_no_declaration;
  document.save(text, "  ", flags, pugi::encoding_utf8);
  return std::move(text).str();
}

std::string CsvCell::Value() const {
  std::string value(text);
  for (std::size_t at = 0; in_quotes && (at = value.find("\"\"", at)) != value.npos; ++at)
    value.erase(at, 1);
  return value;
}

std::vector<CsvCell> CsvCellsOf(std::string_view line, char separator) {
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = std::min(line.find(separator, begin), line.size());
    std::string_view fault;
    const std::size_t open = line.find_first_not_of(' ', begin);
    std::size_t quote = std::string_view::npos;
    if (open != std::string_view::npos && line[open] == '"') {
      quote = ClosingQuote(line, open);
      if (quote == std::string_view::npos) {
        fault = "its quote is not closed";
      } else {
        end = std::min(line.find(separator, quote), line.size());
        if (line.substr(quote + 1, end - quote - 1).find_first_not_of(' ') !=
            std::string_view::npos)
          fault = "there is more after its closing quote";
      }
    }
    const bool in_quotes = quote != std::string_view::npos && fault.empty();
    std::size_t first = in_quotes ? open + 1 : begin, last = in_quotes ? quote : end;
    while (first < last && (line[first] == ' ' || (line[first] == '"' && !fault.empty()))) ++first;
    while (last > first && line[last - 1] == ' ') --last;
    cells.push_back(
        {line.substr(first, last - first), static_cast<int>(first) + 1, fault, in_quotes});
    begin = end + 1;
  }
  return cells;
}

std::string AsCsvCell(std::string_view cell) {
  double number = 0;
  const std::string_view digits = cell.substr(cell.starts_with('+') ? 1 : 0);
  const char* const end = digits.data() + digits.size();
  const bool is_number = std::from_chars(digits.data(), end, number).ptr == end;
  const bool is_run = !cell.empty() &&
                      std::string_view("=+-@").find(cell.front()) != std::string_view::npos &&
                      !is_number;
  std::string text = is_run ? "'" : "";
  if (cell.find_first_of(",;\"\t\n") == std::string_view::npos) return text.append(cell);
  text.insert(0, "\"");
  for (const char c : cell) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

std::string ShellQuoted(std::string_view word) {
  constexpr std::string_view kUnquoted =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,@%+";
  if (!word.empty() && word.find_first_not_of(kUnquoted) == word.npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string ProgramName() {
  const char* const called = std::getenv("PREHEND_COMMAND");
  return called && *called ? ShellQuoted(called) : "prehend";
}

std::string CommandText(const std::vector<std::string>& words) {
  std::string text = ProgramName();
  for (const std::string& word : words) text += " " + ShellQuoted(word);
  return text;
}

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
