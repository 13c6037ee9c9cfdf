// SPDX-License-Identifier: Apache-2.0
#include "render/inventory.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

namespace prehend::render {
namespace {

constexpr std::string_view kDrawnBy = "# drawn_by: ", kSize = "# size: ", kPixels = "# pixels: ",
                           kThings = "# things: ";

std::string Hexadecimal(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::string Padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string RightAligned(std::size_t number, std::size_t width) {
  const std::string text = std::to_string(number);
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// "thing `milk`", "path `reaching`, the 2nd", "bar `table` of milk_on", "the title".
std::string Called(const std::string& name) {
  static const std::map<std::string, std::string> kinds = {{"body", "thing"}, {"leg", "leg of"}};
  std::vector<std::string> parts;
  std::istringstream stream(name);
  for (std::string part; std::getline(stream, part, ':');) parts.push_back(part);
  if (parts.size() < 2) return "the " + name;
  const auto kind = kinds.find(parts[0]);
  std::string text = kind == kinds.end() ? parts[0] : kind->second;
  const bool is_bar = parts[0] == "bar" && parts.size() > 2;
  text += " `" + parts[is_bar ? 2 : 1] + "`";
  if (is_bar) text += " of " + parts[1];
  const std::size_t known = is_bar ? 3 : 2;
  if (parts.size() > known) text += ", number " + parts[known];
  return text;
}

std::string Pixels(std::size_t count) { return std::to_string(count) + " px"; }

std::string BoxText(const ListedThing& thing) {
  if (thing.pixels == 0) return "nowhere";
  return std::to_string(thing.right - thing.left) + " x " +
         std::to_string(thing.bottom - thing.top) + " at (" + std::to_string(thing.left) + ", " +
         std::to_string(thing.top) + "), " + Pixels(thing.pixels);
}

/// How far the edges of the box are apart; 0 if one of them is hardly seen.
int Shift_px(const ListedThing& a, const ListedThing& b) {
  if (std::min(a.pixels, b.pixels) <= kMaxThingPixels) return 0;
  return std::max({std::abs(a.left - b.left), std::abs(a.top - b.top), std::abs(a.right - b.right),
                   std::abs(a.bottom - b.bottom)});
}

bool IsElsewhere(const ListedThing& a, const ListedThing& b) {
  const std::size_t more = std::max(a.pixels, b.pixels) - std::min(a.pixels, b.pixels);
  return more > kMaxThingPixels || Shift_px(a, b) > kMaxThingShift_px;
}

std::string PlaceText(const ListedThing& golden, const ListedThing& drawn) {
  if (Shift_px(golden, drawn) > kMaxThingShift_px)
    return Called(golden.name) + " is elsewhere, " + BoxText(golden) + " became " + BoxText(drawn);
  return Called(golden.name) + " shows " + Pixels(drawn.pixels) + ", expected " +
         Pixels(golden.pixels);
}

/// "label `milk` says ..", "path `reaching` changed colour ..".
std::string LookText(const ListedThing& golden, const ListedThing& drawn) {
  const bool is_text = golden.name.starts_with("label:") || golden.name == "title";
  if (is_text)
    return Called(golden.name) + " says '" + drawn.look + "', expected '" + golden.look + "'";
  const auto color = [](const std::string& look) {
    return look.starts_with('#') ? look.substr(0, 7) : std::string();
  };
  const std::string before = color(golden.look), now = color(drawn.look);
  if (before != now && !before.empty() && !now.empty())
    return Called(golden.name) + " changed colour, " + before + " to " + now + ", " +
           Pixels(drawn.pixels);
  return Called(golden.name) + " changed, " + golden.look + " became " + drawn.look + ", " +
         Pixels(drawn.pixels);
}

/// The things in whose pixels two images of one size differ, most pixels first: "path
/// `transporting` looks different in 6351 px".
std::vector<std::string> DescribePixels(const Image& golden, const ListedPicture& drawn) {
  std::vector<std::pair<std::size_t, std::size_t>> counts(drawn.inventory.list.size());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i].second = i;
  for (std::size_t pixel = 0; pixel < drawn.things.size(); ++pixel) {
    if (PixelDiffers(golden, drawn.image, 3 * pixel)) ++counts[drawn.things[pixel]].first;
  }
  std::ranges::stable_sort(counts, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> texts;
  for (const auto& [count, thing] : counts) {
    if (count > 0)
      texts.push_back(Called(drawn.inventory.list[thing].name) + " looks different in " +
                      Pixels(count));
  }
  return texts;
}

}  // namespace

std::string InventoryText(const Inventory& inventory) {
  std::string text;
  text.append(kDrawnBy).append(inventory.drawn_by).append("\n");
  text.append(kSize).append(std::to_string(inventory.width_px) + " x " +
                            std::to_string(inventory.height_px) + "\n");
  text.append(kPixels).append(Hexadecimal(inventory.pixels) + "\n");
  text.append(kThings).append(Hexadecimal(inventory.things) + "\n");
  std::size_t width = 7;
  for (const ListedThing& thing : inventory.list) width = std::max(width, thing.name.size());
  text += Padded("# thing", width) + "   pixels  left   top right bottom  look\n";
  for (const ListedThing& thing : inventory.list) {
    std::string line = Padded(thing.name, width) + "  " + RightAligned(thing.pixels, 7);
    for (const int edge : {thing.left, thing.top, thing.right})
      line += RightAligned(static_cast<std::size_t>(edge), 6);
    line += RightAligned(static_cast<std::size_t>(thing.bottom), 7);
    if (!thing.look.empty()) line += "  " + thing.look;
    text += line + "\n";
  }
  return text;
}

std::optional<Inventory> ReadInventory(std::string_view text) {
  Inventory inventory;
  std::istringstream lines{std::string(text)};
  const auto header = [&](std::string_view key) -> std::optional<std::string> {
    std::string line;
    if (!std::getline(lines, line) || !line.starts_with(key)) return std::nullopt;
    return line.substr(key.size());
  };
  const auto drawn_by = header(kDrawnBy), size = header(kSize), pixels = header(kPixels),
             things = header(kThings), columns = header("# thing");
  if (!drawn_by || !size || !pixels || !things || !columns) return std::nullopt;
  inventory.drawn_by = *drawn_by;
  if (std::sscanf(size->c_str(), "%d x %d", &inventory.width_px, &inventory.height_px) != 2)
    return std::nullopt;
  inventory.pixels = std::strtoull(pixels->c_str(), nullptr, 16);
  inventory.things = std::strtoull(things->c_str(), nullptr, 16);
  for (std::string line; std::getline(lines, line);) {
    ListedThing thing;
    std::istringstream words(line);
    words >> thing.name >> thing.pixels >> thing.left >> thing.top >> thing.right >> thing.bottom;
    if (!words) return std::nullopt;
    std::getline(words >> std::ws, thing.look);
    inventory.list.push_back(std::move(thing));
  }
  return inventory;
}

std::vector<std::string> DescribeDifferences(const Inventory& golden, const Inventory& drawn) {
  const auto find = [](const Inventory& in, const std::string& name) {
    return std::ranges::find(in.list, name, &ListedThing::name);
  };
  std::vector<std::string> missing, added, changed;
  std::vector<std::pair<int, std::string>> elsewhere;  // by their shift
  for (const ListedThing& before : golden.list) {
    const auto now = find(drawn, before.name);
    if (now == drawn.list.end()) {
      missing.push_back(Called(before.name) + " is missing, expected " + BoxText(before));
    } else if (before.pixels > kMaxThingPixels && now->pixels == 0) {
      missing.push_back(Called(before.name) + " is not seen, expected " + BoxText(before));
    } else if (before.look != now->look) {
      changed.push_back(LookText(before, *now));
    } else if (IsElsewhere(before, *now)) {
      // Things come first, and what goes with them last: a label goes where its thing went.
      const int shift = Shift_px(before, *now);
      const bool is_thing = before.name.starts_with("body:") && shift > kMaxThingShift_px;
      const bool follows = before.name.starts_with("label:");
      elsewhere.emplace_back(is_thing  ? -kMaxPictureSide_px - shift
                             : follows ? 1
                                       : -shift,
                             PlaceText(before, *now));
    }
  }
  for (const ListedThing& now : drawn.list) {
    if (find(golden, now.name) == golden.list.end())
      added.push_back(Called(now.name) + " is new, " + BoxText(now));
  }
  std::ranges::stable_sort(elsewhere, {}, [](const auto& each) { return each.first; });
  for (auto* more : {&added, &changed}) missing.insert(missing.end(), more->begin(), more->end());
  for (auto& [shift, text] : elsewhere) missing.push_back(std::move(text));
  return missing;
}

std::string PixelsText(const Image& golden, const Image& drawn) {
  const ImageDifference found = CompareImages(golden, drawn);
  if (!found.same_size) {
    return "it has " + std::to_string(drawn.width_px) + " x " + std::to_string(drawn.height_px) +
           " pixels, its golden " + std::to_string(golden.width_px) + " x " +
           std::to_string(golden.height_px);
  }
  if (found.AreEqual()) return "";
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%zu of its pixels differ (%.2g %%), at most %zu may; they lie between (%d, %d) and (%d, %d)",
      found.pixels, 300.0 * static_cast<double>(found.pixels) / golden.rgb.size(),
      kMaxDifferingPixels, found.left, found.top, found.right, found.bottom);
  return text;
}

std::vector<std::string> TellApart(const Inventory& golden,
                                   const std::function<Image()>& read_golden_image,
                                   const ListedPicture& drawn) {
  constexpr std::size_t kMostTold = 8, kMostLooks = 3;
  std::vector<std::string> told = DescribeDifferences(golden, drawn.inventory);
  if (golden.pixels == drawn.inventory.pixels && told.empty()) return {};
  if (told.size() > kMostTold) {
    const std::size_t more = told.size() - kMostTold;
    told.resize(kMostTold);
    told.push_back("and " + std::to_string(more) + " more things");
  }
  const Image image = read_golden_image();
  if (!image.rgb.empty()) {
    const std::string pixels = PixelsText(image, drawn.image);
    if (!pixels.empty() && CompareImages(image, drawn.image).same_size) {
      std::vector<std::string> looks = DescribePixels(image, drawn);
      looks.resize(std::min(looks.size(), told.empty() ? kMostLooks : 0));
      told.insert(told.end(), looks.begin(), looks.end());
    }
    if (!pixels.empty()) told.push_back(pixels);
  }
  if (!told.empty() && golden.drawn_by != drawn.inventory.drawn_by)
    told.push_back("the golden was drawn by " + golden.drawn_by + ", this one by " +
                   drawn.inventory.drawn_by);
  return told;
}

}  // namespace prehend::render
