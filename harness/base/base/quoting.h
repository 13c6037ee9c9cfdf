// SPDX-License-Identifier: Apache-2.0
// Texts as others read them: shells, spreadsheets, web pages, lines of a width.
#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prehend {

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

// Commands as they can be pasted into a shell. Tested by
// tests/harness/base/base/shell_quote_test.cc and tests/program/command_line_test.cc

/// A word that can be pasted into a POSIX shell: in single quotes if it needs them.
std::string ShellQuoted(std::string_view word);

/// How the program was called, for commands that it prints: $PREHEND_COMMAND, which ./run sets,
/// otherwise "prehend".
std::string ProgramName();

/// A command of this program: {"run", "a b"} is "prehend run 'a b'".
std::string CommandText(const std::vector<std::string>& words);

// Tested by tests/harness/base/base/wrap_text_test.cc

/// No line is longer than `width`, unless a word is. Lines of the text stay lines; those that are
/// begun here begin with `indent` blanks.
std::string Wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

// The cells of a line of comma-separated values. Tested by
// tests/harness/base/base/csv_cells_test.cc

struct CsvCell {
  std::string_view text;        ///< without blanks and quotes around it
  int column = 1;               ///< in bytes, from 1
  std::string_view fault = {};  ///< what is wrong with its quotes, or ""
  bool in_quotes = false;

  std::string Value() const;  ///< of two quotes in quotes one stays
};

/// A cell may stand in quotes, and then hold separators; two quotes are one that does not end it.
std::vector<CsvCell> CsvCellsOf(std::string_view line, char separator);

/// A cell to be written: in quotes where it needs them. A text that a spreadsheet would run
/// ("=cmd|..") gets an apostrophe before it.
std::string AsCsvCell(std::string_view cell);

// Documents of elements (XML, SVG, HTML) as trees of pugixml, which escapes what has to be escaped.
// Tested by tests/harness/base/base/markup_test.cc

/// Adds <name attributes/> as the last child of `parent`.
pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes = {});

/// Adds <name attributes>text</name>, also when the text is empty: HTML reads <i/> as <i>.
pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes,
                          std::string_view text);

/// Adds text as the last child of `parent`.
void AddText(pugi::xml_node parent, std::string_view text);

/// Adds the elements of a text that ToText() made.
void AddMarkup(pugi::xml_node parent, std::string_view markup);

enum class Layout {
  kIndented,  ///< an element per line, and an XML declaration
  kAsItIs,    ///< no white space but that of the texts: in HTML it can be seen
};
std::string ToText(const pugi::xml_document& document, Layout layout);

// Bytes as text, for web pages. Tested by tests/harness/base/base/base64_test.cc

/// RFC 4648, with padding.
std::string Base64(std::string_view bytes);

}  // namespace prehend
