// SPDX-License-Identifier: Apache-2.0
// What a picture shows, thing by thing, as a value and as text. Two pictures that differ are told
// apart by their things: "path `transporting` changed colour", and not "812 pixels differ".
// Tested by tests/render/inventory_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/picture.h"

namespace prehend::render {

/// One thing of a picture: something in the scene, a label, a bar of the strip, the title.
struct ListedThing {
  std::string name;  ///< without spaces, unique: "body:milk", "path:reaching", "path:reaching:2",
                     ///< "label:milk", "bar:phase:reaching", "title"
  std::size_t pixels = 0;                        ///< in which it is in front
  int left = 0, top = 0, right = 0, bottom = 0;  ///< the box around them, right and bottom excluded
  std::string look;                              ///< colour, text, times; one line, may be empty
};

struct Inventory {
  std::string drawn_by;  ///< Painter::Fingerprint()
  int width_px = 0, height_px = 0;
  std::uint64_t pixels = 0;  ///< PixelHash() of the picture
  std::uint64_t things = 0;  ///< hash of the thing at each pixel
  std::vector<ListedThing> list;
};

/// A picture, its inventory, and the thing that is in front at each pixel.
struct ListedPicture {
  Image image;  ///< empty if it could not be drawn
  Inventory inventory;
  std::vector<std::uint32_t> things;  ///< rows from the top; indices into inventory.list
};

std::string InventoryText(const Inventory& inventory);
/// nullopt if the text is damaged.
std::optional<Inventory> ReadInventory(std::string_view text);

/// A thing's pixels and the edges of its box may differ by as much: on processors without fused
/// multiply-add a pixel in a million has another thing in front.
inline constexpr std::size_t kMaxThingPixels = 4;
inline constexpr int kMaxThingShift_px = 1;

/// How the things of two pictures differ, most telling first: "path `transporting` changed colour,
/// #17a5ab to #2ba5ab, 6351 px". Empty if they do not.
std::vector<std::string> DescribeDifferences(const Inventory& golden, const Inventory& drawn);

/// The gate of golden pictures: what tells a picture from its golden, most telling first, things
/// before numbers of pixels; empty if nothing does. The golden's image is read only if the hashes
/// of the pixels differ; an empty one tells nothing.
std::vector<std::string> TellApart(const Inventory& golden,
                                   const std::function<Image()>& read_golden_image,
                                   const ListedPicture& drawn);

/// "812 of its pixels differ (0.16 %), at most 20 may; they lie between (430, 82) and (470, 120)",
/// or that the sizes differ. Empty if the images are equal enough.
std::string PixelsText(const Image& golden, const Image& drawn);

}  // namespace prehend::render
