// SPDX-License-Identifier: Apache-2.0
// What tests of labels share: events, entities, files in a folder of the test.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "harness/exchange/labels/label_map.h"
#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange::of_labels {

namespace fs = std::filesystem;
using grammar::EventSignature;

inline const std::vector<EventSignature> kEvents = {
    {.name = "reaching", .roles = {"hand", "object"}, .classes = {"Hand", "Thing"}},
    {.name = "grasping",
     .roles = {"hand", "object"},
     .classes = {"Hand", "Thing"},
     .has_style = true},
    {.name = "contact", .roles = {"a", "b"}, .classes = {"Entity", "Entity"}, .symmetric = true}};

inline const grammar::EntityInfo kHand = {.name = "right_hand", .classes = {"Hand", "Entity"}},
                                 kCup = {.name = "cup", .classes = {"Thing", "Entity"}},
                                 kTable = {.name = "table", .classes = {"Thing", "Entity"}};

class Labels : public ::testing::Test {
 protected:
  Labels() { fs::create_directories(folder_); }
  ~Labels() override { fs::remove_all(folder_); }

  std::string File(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  /// "0.5..1.5 hold [right]; .."
  std::string Read(const std::string& name, const std::string& text) const {
    const Result<LabelFile> file = ReadLabels(File(name, text));
    if (!file) return grammar::Format(file.error().front());
    std::string all;
    for (const Label& label : file->labels)
      all += fmt::format("{:g}..{:g} {}{}; ", label.begin_s, label.end_s, label.text,
                         label.tier.empty() ? "" : " [" + label.tier + "]");
    return all;
  }
  /// The first message without its folder.
  std::string Problem(const std::string& name, const std::string& text) const {
    const std::string said = Read(name, text);
    const std::size_t at = said.find(name);
    return at == std::string::npos ? said : said.substr(at, said.find('\n') - at);
  }
  Result<LabelMap> Map(const std::string& text) const {
    return ReadLabelMap(File("map.yaml", text), kEvents);
  }
  std::string MapProblem(const std::string& text) const {
    const Result<LabelMap> map = Map(text);
    if (map) return "";
    const std::string said = grammar::Format(map.error().front());
    const std::size_t at = said.find("map.yaml");
    return said.substr(at, said.find('\n') - at);
  }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) /
      ("labels_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

inline grammar::Timeline TruthOf(const Result<LabelReading>& reading) {
  const auto truth = reading->Truth(0, {kHand, kCup, kTable}, 100, 1000);
  if (!truth) ADD_FAILURE() << grammar::Format(truth.error());
  return truth ? *truth : grammar::Timeline{};
}

inline std::string Text(const grammar::Timeline& timeline) {
  std::string text;
  for (const grammar::NamedEvent& event : timeline.events)
    text += fmt::format("{} {}..{}; ", event.Label(), event.interval.begin, event.interval.end);
  return text;
}

}  // namespace prehend::exchange::of_labels
