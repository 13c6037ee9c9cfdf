// SPDX-License-Identifier: Apache-2.0
#include "harness/show/chart/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace prehend::show {
namespace {

/// Okabe and Ito's palette without yellow, which is pale on white ("Color Universal Design", 2008).
constexpr std::array<const char*, 6> kColors = {"#0072B2", "#D55E00", "#009E73",
                                                "#CC79A7", "#56B4E9", "#000000"};
constexpr std::array<const char*, 4> kDashes = {"none", "6 3", "2 3", "8 3 2 3"};
constexpr double kFoot = 5.6;              ///< height of times and legend, in heights of the text
constexpr double kPageFoot = 3.6;          ///< without legend
constexpr std::size_t kMostPoints = 1500;  ///< of a curve; more cannot be seen
constexpr std::size_t kMostNameLines = 3;  ///< of a row
constexpr double kMargin_px = 10;
constexpr double kLeastBar_px = 2.5;                 ///< a frame would cover it
constexpr double kLetter = 0.6, kBoldLetter = 0.68;  ///< width, in heights of the text
constexpr double kLine = 1.35;                       ///< from one line of a text to the next

std::string Number(double value) { return SvgNumber(value); }
std::string ColorText(std::uint32_t color) { return fmt::format("#{:06X}", color); }

/// Whether dark text can be read on it: its luminance (ITU-R BT.709).
bool IsLight(std::uint32_t color) {
  const double red = color >> 16 & 255, green = color >> 8 & 255, blue = color & 255;
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 140;
}

class Drawing {
 public:
  Drawing(const Chart& chart, const ChartFormat& format) : chart_(chart), format_(format) {
    std::size_t longest = 0;
    for (const Row& row : chart.rows) {
      std::vector<std::string>& lines =
          names_.emplace_back(BrokenLines(row.name, LettersIn(0.42 * format.width_px, kLetter)));
      if (lines.size() > kMostNameLines) {  // the ends tell apart what begins alike
        lines.erase(lines.begin() + kMostNameLines - 1, lines.end() - 1);
        lines.back() = "…" + lines.back();
      }
      for (const std::string& line : lines) longest = std::max(longest, line.size());
    }
    left_ = 20 + std::clamp(WidthOf(longest, kLetter), 50.0, 0.5 * format.width_px);
    right_ = format.width_px - 14;
    title_ = BrokenLines(chart.title, LettersIn(right_, kBoldLetter));
    for (const Row& row : chart.rows) headings_ += row.heading.empty() ? 0 : 1;
    for (const Panel& panel : chart.panels) heads_.push_back(HeadOf(panel));
    LayOutLegend();
  }

  double Height() const {
    double height = Top() + HeadingPx() * headings_ + FootPx();
    for (std::size_t i = 0; i < chart_.rows.size(); ++i) height += RowPx(i);
    for (const Head& head : heads_) height += GapPx(head) + PanelPx();
    return height;
  }
  double Left() const { return left_; }
  double PerSecond() const { return (right_ - left_) / (chart_.to_s - chart_.from_s); }

  void AddTo(pugi::xml_node svg) {
    svg_ = svg;
    // Above the rows; a long title begins further left.
    if (!chart_.title.empty()) BoldLines("title", title_, 1.4 * format_.text_px);
    double y = Top();
    DrawTimes(y, Height() - FootPx());
    DrawMarks(Height() - FootPx());
    for (std::size_t i = 0; i < chart_.rows.size(); ++i) {
      if (const std::string& heading = chart_.rows[i].heading; !heading.empty()) {
        Text("group", 4, y + 1.2 * format_.text_px, heading, "start", "bold");
        y += HeadingPx();
      }
      DrawRow(i, y, RowPx(i));
      y += RowPx(i);
    }
    for (std::size_t i = 0; i < chart_.panels.size(); ++i) {
      y += GapPx(heads_[i]);
      DrawHead(chart_.panels[i], heads_[i], y);
      DrawPanel(chart_.panels[i], y, PanelPx());
      y += PanelPx();
    }
    DrawLegend(Height() - 0.8 * format_.text_px - more_lines_ * LegendPx());
  }

 private:
  /// What stands above a panel: its name, and on the right of it or below it what its curves are.
  struct Head {
    std::vector<std::string> name;
    std::vector<std::pair<double, double>> keys;  ///< of the curves: from the left, line
    double lines = 1;
  };

  double WidthOf(std::size_t letters, double letter) const {
    return letter * format_.text_px * static_cast<double>(letters);
  }
  std::size_t LettersIn(double width_px, double letter) const {
    return static_cast<std::size_t>(std::max(8.0, width_px / (letter * format_.text_px)));
  }

  double RowPx(std::size_t row) const {
    const double lines = static_cast<double>(names_[row].size());
    return std::max({1.9, 0.8 * chart_.rows[row].lanes, kLine * lines + 0.55}) * format_.text_px;
  }
  double PanelPx() const { return format_.panel_texts * format_.text_px; }
  double HeadingPx() const { return 1.7 * format_.text_px; }
  bool InPage() const { return !format_.page_class.empty(); }
  double LegendPx() const { return 1.5 * format_.text_px; }
  double FootPx() const {
    return (InPage() ? kPageFoot : kFoot) * format_.text_px + more_lines_ * LegendPx();
  }
  double GapPx(const Head& head) const {
    return (1.6 + kLine * (head.lines - 1)) * format_.text_px;
  }
  double Top() const {
    const double more_lines = static_cast<double>(title_.size()) - 1;
    return (chart_.title.empty() ? 8 : (2.4 + kLine * more_lines) * format_.text_px) +
           (chart_.marks.empty() ? 0 : 1.3 * format_.text_px);
  }

  double X(double time_s) const {
    const double share = (time_s - chart_.from_s) / (chart_.to_s - chart_.from_s);
    return left_ + std::clamp(share, 0.0, 1.0) * (right_ - left_);
  }

  /// In a page by its class, else as it looks.
  void Paint(pugi::xml_node node, const std::string& style,
             std::initializer_list<std::pair<const char*, const char*>> look) const {
    if (InPage() && !style.empty()) node.append_attribute("class").set_value(style.c_str());
    for (const auto& [key, value] : look)
      if (!InPage()) node.append_attribute(key).set_value(value);
  }
  void Text(const std::string& style, double x, double y, const std::string& text,
            const char* anchor, const char* weight = "normal", const char* color = kInk) {
    Paint(AddElement(svg_, "text", {{"x", Number(x)}, {"y", Number(y)}, {"text-anchor", anchor}},
                     text),
          style, {{"font-weight", weight}, {"fill", color}});
  }
  void Line(const std::string& style, double x1, double y1, double x2, double y2, const char* color,
            const char* width = "1", const char* dash = nullptr) {
    const pugi::xml_node line = AddElement(
        svg_, "line",
        {{"x1", Number(x1)}, {"y1", Number(y1)}, {"x2", Number(x2)}, {"y2", Number(y2)}});
    Paint(line, style, {{"stroke", color}, {"stroke-width", width}});
    if (dash) Paint(line, "", {{"stroke-dasharray", dash}});
  }

  /// Begins over the axis, or further left if it is long.
  void BoldLines(const std::string& style, const std::vector<std::string>& lines, double y) {
    std::size_t longest = 0;
    for (const std::string& line : lines) longest = std::max(longest, line.size());
    const double x = std::clamp(right_ - WidthOf(longest, kBoldLetter), 4.0, left_);
    for (std::size_t i = 0; i < lines.size(); ++i)
      Text(style, x, y + kLine * format_.text_px * static_cast<double>(i), lines[i], "start",
           "bold");
  }

  /// For the script of the page, which zooms.
  static void AddTimes(pugi::xml_node node, double begin_s, double end_s) {
    const auto exact = [](double time_s) {
      return fmt::format("{}", std::round(1e5 * time_s) / 1e5);
    };
    node.append_attribute("data-begin").set_value(exact(begin_s).c_str());
    node.append_attribute("data-end").set_value(exact(end_s).c_str());
  }

  /// Top and height of what is in a lane, or over the whole row.
  static std::pair<double, double> Place(double y, double height, int lane, int lanes) {
    if (lanes == 1 || lane < 0) return {y + 2, height - 4};
    const double pitch = height / lanes;
    return {y + pitch * lane + (lane == 0 ? 2 : 1), pitch - 3};
  }

  void DrawRow(std::size_t index, double y, double height) {
    const Row& row = chart_.rows[index];
    const std::vector<std::string>& name = names_[index];
    for (std::size_t i = 0; i < name.size(); ++i) {
      const double line = static_cast<double>(i) - 0.5 * static_cast<double>(name.size() - 1);
      Text(row.style, left_ - 8, y + 0.5 * height + (0.35 + kLine * line) * format_.text_px,
           name[i], "end");
    }
    for (const Bar& bar : row.bars) {
      if (IsShown(bar)) DrawBar(bar, row, y, height);
    }
    for (const Hatch& hatch : row.hatches) DrawHatch(hatch, row, y, height);
  }

  void DrawBar(const Bar& bar, const Row& row, double y, double height) {
    const double x = X(bar.begin_s), width = BarPx(bar);
    const auto [top, tall] = Place(y, height, bar.lane, row.lanes);
    pugi::xml_node node = AddElement(svg_, "rect",
                                     {{"x", Number(x)},
                                      {"y", Number(top)},
                                      {"width", Number(width)},
                                      {"height", Number(tall)},
                                      {"fill", ColorText(bar.color)}});
    const char* const bare = width > kLeastBar_px ? "#FFFFFF" : "none";
    Paint(node, bar.style, {{"stroke", bar.frame.empty() ? bare : bar.frame.c_str()}});
    if (InPage()) {
      AddTimes(node, bar.begin_s, bar.end_s);
      if (!row.id.empty()) {
        node.append_attribute("data-event").set_value(row.id.c_str());
        node.append_attribute("data-lane").set_value(bar.lane);
      }
      AddElement(node, "title", {}, bar.tip);
    }
    if (!bar.frame.empty()) Paint(node, "", {{"stroke-width", "2"}});
    if (HasText(bar)) {
      Text("in_bar", x + width / 2, y + 0.5 * height + 0.35 * format_.text_px, bar.text, "middle",
           "normal", IsLight(bar.color) ? "#000000" : "#FFFFFF");
      if (InPage()) AddTimes(svg_.last_child(), bar.begin_s, bar.end_s);
    }
  }

  /// Slanted lines in a frame: readable in print and on any colour.
  void DrawHatch(const Hatch& hatch, const Row& row, double y, double height) {
    if (hatch.end_s <= chart_.from_s || hatch.begin_s >= chart_.to_s) return;
    const double step_px = 5, x = X(hatch.begin_s), width = std::max(3.0, X(hatch.end_s) - x);
    const auto [top, tall] = Place(y, height, hatch.lane, row.lanes);
    std::string path =
        fmt::format("M{:.2f},{:.2f}h{:.2f}v{:.2f}h{:.2f}z", x, top, width, tall, -width);
    // Each line leaves the frame where it meets its right or upper side.
    for (double from = x - tall + step_px; from < x + width; from += step_px) {
      const double first = std::max(from, x), last = std::min(from + tall, x + width);
      path += fmt::format("M{:.2f},{:.2f}L{:.2f},{:.2f}", first, top + tall - (first - from), last,
                          top + tall - (last - from));
    }
    const pugi::xml_node node = AddElement(svg_, "path", {{"d", path}});
    Paint(node, "hatch", {{"fill", "none"}, {"stroke", kInk}, {"stroke-width", "1"}});
    if (InPage()) AddTimes(node, hatch.begin_s, hatch.end_s);
  }

  /// A dashed line behind everything, with its letter above. Letters at one place are one text.
  void DrawMarks(double bottom) {
    const double top = Top();
    double right_end = 0;
    for (const Mark& mark : chart_.marks) {
      if (mark.time_s < chart_.from_s || mark.time_s > chart_.to_s) continue;
      const double x = X(mark.time_s);
      Line(mark.style, x, top - 2, x, bottom, kInk, "1", "4 3");
      if (mark.letter.empty()) continue;
      const double letter_px = 0.75 * format_.text_px * static_cast<double>(mark.letter.size());
      const double letter_x =
          std::min(std::max(x, right_end + letter_px / 2), format_.width_px - letter_px / 2);
      Text("axis", letter_x, top - 0.35 * format_.text_px, mark.letter, "middle", "bold");
      right_end = letter_x + letter_px / 2 + 1;
    }
  }

  void DrawPanel(const Panel& panel, double top, double height) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Curve& curve : panel.curves) {
      for (const auto& [time_s, value] : curve.points) {
        if (time_s < chart_.from_s || time_s > chart_.to_s || !std::isfinite(value)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
    if (!(least <= most)) least = 0, most = 1;
    if (most - least < 1e-9) most = least + 1;
    const double room = 0.06 * (most - least);
    least -= room;
    most += room;
    const auto y_of = [&](double value) {
      return top + height - (value - least) / (most - least) * height;
    };
    for (const double tick : RoundTicks(least, most, 4)) {
      Line("grid", left_, y_of(tick), right_, y_of(tick), "#DDDDDD");
      Text("axis", left_ - 8, y_of(tick) + 0.35 * format_.text_px, Number(tick), "end");
    }
    Line("base", left_, top, left_, top + height, kInk);
    for (std::size_t i = 0; i < panel.curves.size(); ++i)
      DrawCurve(panel.curves[i], y_of, kColors[i % kColors.size()], kDashes[i % kDashes.size()]);
  }

  Head HeadOf(const Panel& panel) const {
    const auto key_px = [&](const Curve& curve) {
      return WidthOf(curve.name.size(), kLetter) + 34;
    };
    Head head{.name = {panel.name}};
    double x = right_;
    for (const Curve& curve : panel.curves) {
      x -= key_px(curve);
      head.keys.emplace_back(x, 0);
    }
    const bool has_no_key = panel.curves.size() == 1 && panel.curves[0].name.empty();
    if (has_no_key) head.keys.clear();
    const double name_px = WidthOf(panel.name.size(), kBoldLetter);
    if (name_px <= (has_no_key ? right_ : x) - left_) return head;
    head.name = BrokenLines(panel.name, LettersIn(right_, kBoldLetter));
    double line = static_cast<double>(head.name.size());
    x = kMargin_px;
    for (std::size_t i = 0; i < head.keys.size(); ++i) {
      const double width = key_px(panel.curves[i]);
      if (x > kMargin_px && x + width > format_.width_px) x = kMargin_px, ++line;
      head.keys[i] = {x, line};
      x += width;
    }
    head.lines = line + (has_no_key ? 0 : 1);
    return head;
  }

  void DrawHead(const Panel& panel, const Head& head, double top) {
    const auto y_of = [&](double line) {
      return top - (0.1 + kLine * (head.lines - 1 - line)) * format_.text_px;
    };
    for (std::size_t i = 0; i < head.keys.size(); ++i) {
      const auto [x, line] = head.keys[i];
      const double y = y_of(line) - 0.3 * format_.text_px;
      Line(panel.curves[i].style, x, y, x + 22, y, kColors[i % kColors.size()], "2",
           kDashes[i % kDashes.size()]);
      Text("axis", x + 26, y_of(line), panel.curves[i].name, "start");
    }
    BoldLines("axis", head.name, y_of(0));
  }

  template <typename YOf>
  void DrawCurve(const Curve& curve, const YOf& y_of, const char* color, const char* dash) {
    const std::size_t step = curve.points.size() / kMostPoints + 1;
    std::string points;
    for (std::size_t i = 0; i < curve.points.size(); i += step) {
      const auto& [time_s, value] = curve.points[i];
      if (!std::isfinite(value)) DrawLine(points, curve.style, color, dash);
      if (time_s < chart_.from_s || time_s > chart_.to_s || !std::isfinite(value)) continue;
      points += fmt::format("{:.2f},{:.2f} ", X(time_s), y_of(value));
    }
    DrawLine(points, curve.style, color, dash);
  }

  /// Through these points, which are empty afterwards.
  void DrawLine(std::string& points, const std::string& style, const char* color,
                const char* dash) {
    if (points.empty()) return;
    points.pop_back();
    Paint(
        AddElement(svg_, "polyline", {{"points", points}}), style,
        {{"fill", "none"}, {"stroke", color}, {"stroke-width", "1.6"}, {"stroke-dasharray", dash}});
    points.clear();
  }

  bool IsShown(const Bar& bar) const {
    return bar.end_s > chart_.from_s && bar.begin_s < chart_.to_s;
  }
  double BarPx(const Bar& bar) const {
    return std::max(kLeastBar_px, X(bar.end_s) - X(bar.begin_s));
  }
  bool HasText(const Bar& bar) const {
    return WidthOf(bar.text.size(), 0.62) < BarPx(bar) - 6 || (InPage() && !bar.text.empty());
  }

  /// What the colours mean whose bars are too short for their texts, in lines.
  void LayOutLegend() {
    std::map<std::string, std::uint32_t> unnamed;
    for (const Row& row : chart_.rows)
      for (const Bar& bar : row.bars)
        if (IsShown(bar) && !HasText(bar) && !bar.kind.empty()) unnamed[bar.kind] = bar.color;
    const auto width_of = [&](const std::string& kind) {
      return 3 * format_.text_px + WidthOf(kind.size(), 0.62);
    };
    double begin = left_, x = left_;
    for (const auto& [kind, color] : unnamed) x += width_of(kind);
    if (x > format_.width_px) begin = kMargin_px;
    x = begin;
    for (const auto& [kind, color] : unnamed) {
      const double width = width_of(kind);
      if (x > begin && x + width > format_.width_px) x = begin, ++more_lines_;
      keys_.push_back({x, more_lines_ * LegendPx(), kind, color});
      x += width;
    }
  }
  void DrawLegend(double top) {
    for (const Key& key : keys_) {
      const double y = top + key.down;
      AddElement(svg_, "rect",
                 {{"x", Number(key.x)},
                  {"y", Number(y - 0.8 * format_.text_px)},
                  {"width", Number(format_.text_px)},
                  {"height", Number(0.9 * format_.text_px)},
                  {"fill", ColorText(key.color)}});
      Text("", key.x + 1.4 * format_.text_px, y, key.kind, "start");
    }
  }

  void DrawTimes(double top, double bottom) {
    Line("base", left_, bottom, right_, bottom, kInk);
    std::vector<AxisTick> ticks = chart_.ticks;
    const double room = (right_ - left_) / (4 * format_.text_px);
    const int most = static_cast<int>(std::clamp(room, 3.0, 10.0));
    if (ticks.empty())
      for (const double tick : RoundTicks(chart_.from_s, chart_.to_s, most))
        ticks.emplace_back(tick, Number(tick));
    for (const auto& [at, text] : ticks) {
      Line("grid", X(at), top, X(at), bottom, "#EEEEEE");
      if (!InPage()) Line("", X(at), bottom, X(at), bottom + 4, kInk);
      const double most_x = format_.width_px - WidthOf(text.size(), kLetter) / 2;
      Text("axis", std::min(X(at), most_x), bottom + 4 + 1.1 * format_.text_px, text, "middle");
    }
    const double half_px = WidthOf(chart_.axis.size(), kLetter) / 2;
    Text("name", std::min((left_ + right_) / 2, format_.width_px - half_px),
         bottom + 8 + 2.3 * format_.text_px, chart_.axis, "middle");
  }

  const Chart& chart_;
  const ChartFormat& format_;
  double left_ = 0, right_ = 0, headings_ = 0, more_lines_ = 0;
  std::vector<std::string> title_;
  std::vector<std::vector<std::string>> names_;  ///< of the rows, in lines
  std::vector<Head> heads_;                      ///< of the panels
  pugi::xml_node svg_;
  struct Key {
    double x = 0, down = 0;
    std::string kind;
    std::uint32_t color = 0;
  };
  std::vector<Key> keys_;
};

}  // namespace

std::vector<double> RoundTicks(double from, double to, int most) {
  const double raw = (to - from) / most, power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (auto i = static_cast<long>(std::ceil(from / step - 1e-9));
       static_cast<double>(i) * step <= to + 1e-9 * step; ++i)
    ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

std::vector<std::string> BrokenLines(const std::string& text, std::size_t most) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > most) {
      const std::size_t space = text.rfind(' ', begin + most),
                        inside = text.find_last_of("_(,/", begin + most - 1);
      end = begin + most;
      while (end > begin + 1 && (text[end] & 0xC0) == 0x80) --end;  // not inside a letter of UTF-8
      if (inside != std::string::npos && inside > begin) end = inside + (text[inside] != '(');
      if (space != std::string::npos && space > begin) end = space;
    }
    lines.push_back(text.substr(begin, end - begin));
    begin = end + (end == text.size() || text[end] == ' ' || text[end] == '\n' ? 1 : 0);
  }
  return lines;
}

std::string SvgNumber(double value) { return fmt::format("{:.6g}", value); }

pugi::xml_node AddDrawing(pugi::xml_document& document, const ChartFormat& format,
                          double height_px) {
  const pugi::xml_node svg =
      AddElement(document, "svg",
                 {{"xmlns", "http://www.w3.org/2000/svg"},
                  {"xmlns:xlink", "http://www.w3.org/1999/xlink"},
                  {"width", SvgNumber(format.width_px)},
                  {"height", SvgNumber(height_px)},
                  {"viewBox", "0 0 " + SvgNumber(format.width_px) + " " + SvgNumber(height_px)},
                  {"font-family", "DejaVu Sans, Arial, sans-serif"},
                  {"font-size", SvgNumber(format.text_px)}});
  if (!format.transparent)
    AddElement(svg, "rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "#FFFFFF"}});
  return svg;
}

double AddChart(pugi::xml_node svg, const Chart& chart, const ChartFormat& format, double top_px) {
  Drawing drawing(chart, format);
  drawing.AddTo(AddElement(svg, "g", {{"transform", "translate(0 " + SvgNumber(top_px) + ")"}}));
  return drawing.Height();
}

std::string ChartForPage(const Chart& chart, const ChartFormat& format, const std::string& label) {
  pugi::xml_document document;
  Drawing drawing(chart, format);
  drawing.AddTo(AddElement(
      document, "svg",
      {{"class", format.page_class},
       {"viewBox", "0 0 " + SvgNumber(format.width_px) + " " + SvgNumber(drawing.Height())},
       {"role", "img"},
       {"aria-label", label},
       {"data-left", SvgNumber(drawing.Left())},
       {"data-from", SvgNumber(chart.from_s)},
       {"data-end", SvgNumber(chart.to_s)},
       {"data-per-second", SvgNumber(drawing.PerSecond())}}));
  return ToText(document, Layout::kAsItIs);
}

std::string ChartSvg(const Chart& chart, const ChartFormat& format) {
  pugi::xml_document document;
  Drawing drawing(chart, format);
  drawing.AddTo(AddDrawing(document, format, drawing.Height()));
  return ToText(document, Layout::kIndented);
}

}  // namespace prehend::show
