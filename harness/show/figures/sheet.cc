// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/base/quoting.h"
#include "harness/show/figures/scene_tiles.h"

namespace prehend::show {
namespace {

constexpr double kMargin_px = 10, kGap_px = 8;

class SheetDrawing {
 public:
  SheetDrawing(const Sheet& sheet, const ChartFormat& format) : sheet_(sheet), format_(format) {}

  std::string Run() {
    // The size is known at the end only: everything is drawn into a group first.
    pugi::xml_document parts;
    svg_ = AddElement(parts, "g");
    y_ = kMargin_px;
    if (!sheet_.title.empty()) Line(sheet_.title, "bold");
    if (sheet_.chart_first) DrawChart();
    for (const TileRow& row : sheet_.rows) DrawTiles(row);
    if (!sheet_.chart_first) DrawChart();
    if (!sheet_.note.empty()) Line(sheet_.note, "normal");
    DrawLegend();
    pugi::xml_document document;
    AddDrawing(document, format_, y_ + kMargin_px).append_copy(svg_);
    return ToText(document, Layout::kIndented);
  }

 private:
  void Text(double x, double y, const std::string& text, const char* weight) {
    AddElement(svg_, "text",
               {{"x", SvgNumber(x)}, {"y", SvgNumber(y)}, {"font-weight", weight}, {"fill", kInk}},
               text);
  }
  void Line(const std::string& text, const char* weight) {
    Text(kMargin_px, y_ + 1.1 * format_.text_px, text, weight);
    y_ += 1.8 * format_.text_px;
  }

  void DrawChart() {
    if (sheet_.chart) y_ += AddChart(svg_, *sheet_.chart, format_, y_);
  }

  void DrawTiles(const TileRow& row) {
    if (!row.heading.empty()) {
      y_ += 0.5 * format_.text_px;
      Line(row.heading, "bold");
    }
    const double width = TileWidth(format_, row.columns), height = row.height_share * width,
                 line_px = 1.3 * format_.text_px;
    for (std::size_t first = 0; first < row.tiles.size();
         first += static_cast<std::size_t>(row.columns)) {
      const std::size_t end =
          std::min(row.tiles.size(), first + static_cast<std::size_t>(row.columns));
      double lines = 1;
      for (std::size_t i = first; i < end; ++i) {
        const Tile& tile = row.tiles[i];
        const double x = kMargin_px + static_cast<double>(i - first) * (width + kGap_px);
        AddElement(svg_, "image",
                   {{"x", SvgNumber(x)},
                    {"y", SvgNumber(y_)},
                    {"width", SvgNumber(width)},
                    {"height", SvgNumber(height)},
                    {"xlink:href", "data:image/png;base64," + Base64(tile.png)}});
        lines = std::max(lines, DrawCaption(tile.caption, x, y_ + height, line_px));
      }
      y_ += height + lines * line_px + 0.9 * format_.text_px;
    }
  }

  /// Returns its number of lines.
  double DrawCaption(const std::string& caption, double x, double top, double line_px) {
    double lines = 0;
    for (std::size_t begin = 0; begin <= caption.size();) {
      const std::size_t end = std::min(caption.find('\n', begin), caption.size());
      ++lines;
      Text(x, top + lines * line_px, caption.substr(begin, end - begin), "normal");
      begin = end + 1;
    }
    return lines;
  }

  void DrawLegend() {
    if (sheet_.legend.empty()) return;
    double x = kMargin_px;
    for (const auto& [name, color] : sheet_.legend) {
      const double width =
          2.6 * format_.text_px + 0.62 * format_.text_px * static_cast<double>(name.size());
      if (x > kMargin_px && x + width > format_.width_px - kMargin_px) {
        x = kMargin_px;
        y_ += 1.6 * format_.text_px;
      }
      AddElement(svg_, "rect",
                 {{"x", SvgNumber(x)},
                  {"y", SvgNumber(y_ + 0.2 * format_.text_px)},
                  {"width", SvgNumber(format_.text_px)},
                  {"height", SvgNumber(format_.text_px)},
                  {"fill", fmt::format("#{:06X}", color)}});
      Text(x + 1.4 * format_.text_px, y_ + 1.1 * format_.text_px, name, "normal");
      x += width;
    }
    y_ += 1.6 * format_.text_px;
  }

  const Sheet& sheet_;
  const ChartFormat& format_;
  double y_ = 0;
  pugi::xml_node svg_;
};

}  // namespace

double TileWidth(const ChartFormat& format, int columns) {
  return (format.width_px - 2 * kMargin_px - (columns - 1) * kGap_px) / columns;
}

std::string SheetSvg(const Sheet& sheet, const ChartFormat& format) {
  return SheetDrawing(sheet, format).Run();
}

std::string LetterOf(std::size_t number) {
  const char last = static_cast<char>('a' + number % 26);
  return number < 26 ? std::string(1, last) : LetterOf(number / 26 - 1) + last;
}

}  // namespace prehend::show
