// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/cells/body_words.h.
#include "harness/exchange/cells/body_words.h"

#include <algorithm>
#include <cctype>

namespace prehend::exchange {

Words WordsIn(const std::string& name) {
  Words words(1);
  char before = ' ';
  for (const char c : name) {
    const bool is_letter = std::isalpha(static_cast<unsigned char>(c)) != 0,
               is_digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    const bool begins = (std::isupper(static_cast<unsigned char>(c)) &&
                         std::islower(static_cast<unsigned char>(before))) ||
                        (is_digit && !std::isdigit(static_cast<unsigned char>(before)));
    if ((begins || !(is_letter || is_digit)) && !words.back().empty()) words.emplace_back();
    if (is_letter || is_digit)
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    before = c;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool AnyOf(const Words& words, const std::set<std::string>& of) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    const bool side = word.size() > 3 && (word[0] == 'l' || word[0] == 'r');
    return of.contains(word) || (side && of.contains(word.substr(1)));
  });
}

bool IsBone(const Words& words) {
  return AnyOf(words, {"hip",   "hips",  "ab",     "chest",  "neck",  "head",  "shoulder",
                       "uarm",  "farm",  "arm",    "thigh",  "shin",  "leg",   "foot",
                       "toe",   "spine", "ankle",  "knee",   "calf",  "elbow", "pelvis",
                       "thumb", "index", "middle", "collar", "pinky", "ring",  "finger"});
}

bool IsHand(const Words& words) {
  return AnyOf(words, {"hand", "glove", "wrist", "palm", "lh", "rh", "gripper", "eef", "ee", "tcp",
                       "righthand", "lefthand"}) &&
         !IsBone(words);
}

bool IsTable(const Words& words) {
  return AnyOf(words, {"table", "desk", "shelf", "bench", "counter", "worktop", "floor", "rack"});
}

}  // namespace prehend::exchange
