// SPDX-License-Identifier: Apache-2.0
// A drawing as a file: SVG as it is, PNG and PDF by rsvg-convert. Tested by
// tests/harness/show/pictures/svg_file_test.cc
#pragma once

#include <filesystem>
#include <string>

namespace prehend::show {

/// Empty, or why no drawing can have this name: "found 'a.gif', wanted a file NAME.svg, ..".
std::string WhyNoDrawingFile(const std::string& path);

/// Writes a drawing as what the file's ending says. Returns "", or what went wrong; then an older
/// file is as it was. PNG has twice the pixels of the drawing's size.
std::string WriteDrawing(const std::filesystem::path& path, const std::string& svg);

}  // namespace prehend::show
