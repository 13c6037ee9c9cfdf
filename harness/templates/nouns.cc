// SPDX-License-Identifier: Apache-2.0
// See harness/templates/nouns.h
#include "harness/templates/nouns.h"

#include <algorithm>

namespace prehend::harness {

const std::vector<Noun>& Nouns() {
  static const std::vector<Noun> nouns = {
      {"carton", "class: MilkCarton, box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4"},
      {"milk", "class: MilkCarton, box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4"},
      {"box", "class: Box, box: {size_m: [0.06, 0.10, 0.12]}, mass_kg: 0.3"},
      {"bottle", "class: Bottle, cylinder: {radius_m: 0.033, length_m: 0.22}, mass_kg: 0.4"},
      {"cup", "class: Cup, mug: {radius_m: 0.04, height_m: 0.10, handle_m: 0}, mass_kg: 0.25"},
      {"mug", "class: Mug, mug: {radius_m: 0.04, height_m: 0.10, handle_m: 0}, mass_kg: 0.3"},
      {"glass", "class: Glass, mug: {radius_m: 0.033, height_m: 0.13, handle_m: 0}, mass_kg: 0.25"},
      {"can", "class: Can, cylinder: {radius_m: 0.033, length_m: 0.12}, mass_kg: 0.35"},
      {"jar", "class: Jar, cylinder: {radius_m: 0.035, length_m: 0.12}, mass_kg: 0.4"},
      {"ball", "class: Ball, sphere: {radius_m: 0.035}, mass_kg: 0.15"},
      {"apple", "class: Apple, sphere: {radius_m: 0.035}, mass_kg: 0.15"},
      {"orange", "class: Orange, sphere: {radius_m: 0.035}, mass_kg: 0.18, color: orange"},
      {"cube", "class: Cube, box: {size_m: [0.06, 0.06, 0.06]}, mass_kg: 0.15"},
      {"block", "class: Block, box: {size_m: [0.05, 0.07, 0.09]}, mass_kg: 0.2"},
      {"sponge", "class: Sponge, box: {size_m: [0.07, 0.11, 0.10]}, mass_kg: 0.12, color: yellow"},
  };
  return nouns;
}

const Noun* FindNoun(std::string_view word) {
  for (const Noun& noun : Nouns()) {
    const bool plural =
        word.size() == noun.word.size() + 1 && word.ends_with('s') && word.starts_with(noun.word);
    if (word == noun.word || plural || (word == "boxes" && noun.word == "box")) return &noun;
  }
  return nullptr;
}

}  // namespace prehend::harness
