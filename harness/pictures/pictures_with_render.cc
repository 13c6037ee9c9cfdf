// SPDX-License-Identifier: Apache-2.0
// Draws and compares pictures, with render/. Tested by tests/program/acceptance_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "harness/pictures/compose_picture.h"
#include "harness/pictures/draw_image.h"
#include "harness/pictures/pictures.h"
#include "harness/run/event_time.h"

namespace prehend::harness {

namespace {

double SecondsOf(const render::Picture& picture, const RunResult& run) {
  return static_cast<double>(picture.snapshot.tick) /
         static_cast<double>(run.timeline.ticks_per_second);
}

/// What a list of pictures says of one, also if it has no title.
std::string CaptionOf(const render::Picture& picture, const RunResult& run) {
  return picture.title.empty() ? fmt::format("{:.3f} s", SecondsOf(picture, run)) : picture.title;
}

/// Puts an image into a larger one, which it does not leave.
void Paste(const render::Image& image, int left, int top, render::Image& onto) {
  for (int y = 0; y < image.height_px; ++y) {
    const auto from = image.rgb.begin() + 3ll * y * image.width_px;
    std::copy(from, from + 3ll * image.width_px,
              onto.rgb.begin() + 3ll * (1ll * (top + y) * onto.width_px + left));
  }
}

/// Draws one entry; returns an error text or "".
std::string DrawOne(render::Painter& painter, const Scenario& scenario, const RunResult& run,
                    const PictureYaml& entry, const PictureFormat& format, const std::string& file,
                    std::vector<WrittenPicture>& written) {
  if (!painter.error().empty()) return painter.error();
  if (run.recording.empty()) return "the run recorded nothing to draw";
  const render::Picture picture = ComposePicture(scenario, run, entry, format);
  const render::Image image = DrawImage(painter, picture, format);
  if (image.rgb.empty()) return painter.error();
  if (!render::WritePng(image, file)) return "cannot write " + file;
  written.push_back({file, CaptionOf(picture, run), FindEventTime(entry.at.value, run).missed});
  return "";
}

}  // namespace

bool CanDrawPictures() { return true; }

void PrepareToDraw() { render::Painter::LoadLibrary(); }

PictureResult DrawPictures(const Scenario& scenario, const RunResult& run,
                           const std::string& directory, const PictureFormat& format) {
  PictureResult result;
  if (scenario.pictures.empty()) return result;
  render::Painter painter;
  for (std::size_t i = 0; i < scenario.pictures.size(); ++i) {
    const std::string suffix = i == 0 ? "" : fmt::format("-{}", i + 1);
    const std::string file = fmt::format("{}/{}{}.png", directory, scenario.name, suffix);
    const std::string error =
        DrawOne(painter, scenario, run, scenario.pictures[i], format, file, result.pictures);
    if (!error.empty() && result.error.empty()) result.error = error;
  }
  return result;
}

PictureResult DrawPicture(const Scenario& scenario, const RunResult& run, const PictureYaml& entry,
                          const std::string& file, const PictureFormat& format) {
  PictureResult result;
  render::Painter painter;
  result.error = DrawOne(painter, scenario, run, entry, format, file, result.pictures);
  return result;
}

PictureResult DrawSheet(const Scenario& scenario, const RunResult& run,
                        const std::vector<PictureYaml>& entries, int columns,
                        const std::string& file, const PictureFormat& format) {
  std::vector<SheetEntry> sheet;
  for (std::size_t i = 0; i < entries.size(); ++i)
    sheet.push_back({&scenario, &run, entries[i], {}});
  return DrawSheet(sheet, columns, file, format);
}

PictureResult DrawSheet(const std::vector<SheetEntry>& entries, int columns,
                        const std::string& file, const PictureFormat& format) {
  PictureResult result;
  render::Painter painter;
  result.error = painter.error();
  if (std::ranges::any_of(entries,
                          [](const SheetEntry& entry) { return entry.run->recording.empty(); }))
    result.error = "the run recorded nothing to draw";
  if (!result.error.empty()) return result;
  const int rows = (static_cast<int>(entries.size()) + columns - 1) / columns;
  render::Image sheet{columns * format.width_px, rows * format.height_px, {}};
  sheet.rgb.assign(3ull * sheet.width_px * sheet.height_px, 255);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& [scenario, run, entry, title] = entries[i];
    render::Picture picture = ComposePicture(*scenario, *run, entry, format);
    if (format.title) {
      const char letter = static_cast<char>('a' + i % 26);
      picture.title = title.empty() ? fmt::format("{}  ·  {}  ·  {:.3f} s", letter, entry.at.value,
                                                  SecondsOf(picture, *run))
                                    : fmt::format("{}  ·  {}", letter, title);
    }
    const render::Image image = painter.Draw(picture);
    if (image.rgb.empty()) {
      result.error = painter.error();
      return result;
    }
    Paste(image, static_cast<int>(i) % columns * format.width_px,
          static_cast<int>(i) / columns * format.height_px, sheet);
    result.pictures.push_back(
        {file, CaptionOf(picture, *run), FindEventTime(entry.at.value, *run).missed});
  }
  if (!render::WritePng(sheet, file)) result.error = "cannot write " + file;
  return result;
}

PictureDifference ComparePicture(const std::string& golden_file, const std::string& drawn_file) {
  const render::Image golden = render::ReadPng(golden_file), drawn = render::ReadPng(drawn_file);
  if (golden.rgb.empty()) return {golden_file + " cannot be read"};
  const render::ImageDifference found = render::CompareImages(golden, drawn);
  if (!found.same_size) {
    return {fmt::format("it has {} x {} pixels, its golden {} x {}", drawn.width_px,
                        drawn.height_px, golden.width_px, golden.height_px)};
  }
  if (found.AreEqual()) return {.text = "", .same_size = true};
  return {.text = fmt::format(
              "{} of its pixels differ ({:.2g} %), at most {} may; they lie between ({}, {}) and "
              "({}, {})",
              found.pixels, 300.0 * found.pixels / golden.rgb.size(), render::kMaxDifferingPixels,
              found.left, found.top, found.right, found.bottom),
          .same_size = true};
}

bool WritePictureDifference(const std::string& golden_file, const std::string& drawn_file,
                            const std::string& file) {
  const render::Image golden = render::ReadPng(golden_file), drawn = render::ReadPng(drawn_file);
  if (golden.rgb.empty() || !render::CompareImages(golden, drawn).same_size) return false;
  return render::WritePng(PaleWithRed(golden, drawn), file);
}

}  // namespace prehend::harness
