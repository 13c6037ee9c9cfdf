// SPDX-License-Identifier: Apache-2.0
// Labels from ELAN's annotation format. Tested by tests/harness/exchange/labels/labels_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>

#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;
using grammar::Place;

Place PlaceAt(std::string_view text, std::ptrdiff_t offset) {
  const std::string_view before =
      text.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  return {static_cast<int>(std::ranges::count(before, '\n')) + 1,
          static_cast<int>(before.size() - line_begin) + 1};
}

class EafReader {
 public:
  explicit EafReader(LabelFile& file) : file_(file) {}

  Diagnostics Read() {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed =
        document.load_buffer(file_.text.data(), file_.text.size());
    if (!parsed)
      return {file_.At(PlaceAt(file_.text, parsed.offset),
                       std::string("it is no XML: ") + parsed.description())};
    const pugi::xml_node root = document.child("ANNOTATION_DOCUMENT");
    if (!root)
      return {file_.At(PlaceAt(file_.text, document.first_child().offset_debug()),
                       fmt::format("found <{}>, wanted <ANNOTATION_DOCUMENT>, as ELAN writes it",
                                   document.document_element().name()))};
    const std::string unit = root.child("HEADER").attribute("TIME_UNITS").as_string("milliseconds");
    if (unit != "milliseconds")
      Complain(root.child("HEADER"), "TIME_UNITS: found '" + unit + "', wanted milliseconds",
               "ELAN saves it so after Options > Propagate time offset is not set to frames");
    for (const pugi::xml_node media : root.child("HEADER").children("MEDIA_DESCRIPTOR"))
      WarnOfOrigin(media);
    file_.has_header = root.child("HEADER") || root.child("TIER");
    ReadSlots(root.child("TIME_ORDER"));
    for (const pugi::xml_node tier : root.children("TIER")) ReadAligned(tier);
    for (const pugi::xml_node tier : root.children("TIER")) ReadReferring(tier);
    return std::move(problems_);
  }

 private:
  struct Times {
    double begin_s = 0, end_s = 0;
  };

  void Complain(pugi::xml_node node, std::string message, std::string hint = {}) {
    if (problems_.size() < kMostComplaints)
      problems_.push_back(
          file_.At(PlaceAt(file_.text, node.offset_debug()), std::move(message), std::move(hint)));
  }

  /// ELAN shows the video from there on; its annotations count from there, too.
  void WarnOfOrigin(pugi::xml_node media) {
    const double origin_ms = media.attribute("TIME_ORIGIN").as_double(0);
    if (origin_ms == 0) return;
    file_.warnings.push_back(file_.At(
        PlaceAt(file_.text, media.offset_debug()),
        fmt::format("TIME_ORIGIN: 0 s of the labels is {:g} s of the video", origin_ms / 1000),
        "if the recording began with the video: offset_s of this take in the map or in a file of "
        "takes, 0 if it did not"));
    file_.warnings.back().is_warning = true;
  }

  void ReadSlots(pugi::xml_node order) {
    std::vector<std::pair<std::string, std::optional<double>>> slots;
    std::set<std::string> ids;
    for (const pugi::xml_node slot : order.children("TIME_SLOT")) {
      std::optional<double> time_s;
      if (const pugi::xml_attribute value = slot.attribute("TIME_VALUE")) {
        char* end = nullptr;
        const double milliseconds = std::strtod(value.as_string(), &end);
        if (*value.as_string() == '\0' || *end != '\0' || !(milliseconds >= 0))
          Complain(slot,
                   fmt::format("TIME_VALUE: found '{}', wanted milliseconds", value.as_string()));
        time_s = milliseconds / 1000;
      }
      slots.emplace_back(slot.attribute("TIME_SLOT_ID").as_string(), time_s);
      if (!ids.insert(slots.back().first).second)
        Complain(slot, fmt::format("TIME_SLOT_ID: '{}' is given twice", slots.back().first));
    }
    for (std::size_t i = 0; i < slots.size();) {
      if (slots[i].second) {
        times_[slots[i].first] = *slots[i].second;
        ++i;
        continue;
      }
      std::size_t next = i;
      while (next < slots.size() && !slots[next].second) ++next;
      if (i == 0 || next == slots.size()) return;  // such slots stay unknown
      const double from_s = *slots[i - 1].second, to_s = *slots[next].second;
      const auto parts = static_cast<double>(next - i + 1);
      for (std::size_t k = i; k < next; ++k)
        times_[slots[k].first] = from_s + (to_s - from_s) * static_cast<double>(k - i + 1) / parts;
      i = next;
    }
  }

  std::optional<double> TimeOf(pugi::xml_node annotation, const char* attribute) {
    const std::string slot = annotation.attribute(attribute).as_string();
    const auto found = times_.find(slot);
    if (found != times_.end()) return found->second;
    Complain(annotation,
             fmt::format("{}: there is no time slot '{}' with a time", attribute, slot));
    return std::nullopt;
  }

  void Add(pugi::xml_node annotation, pugi::xml_node tier, const Times& times) {
    const std::string text = annotation.child_value("ANNOTATION_VALUE");
    const bool is_empty = text.find_first_not_of(" \t\n") == std::string::npos;
    (is_empty ? file_.empty : file_.labels)
        .push_back({.begin_s = times.begin_s,
                    .end_s = times.end_s,
                    .text = text,
                    .tier = tier.attribute("TIER_ID").as_string(),
                    .place = PlaceAt(file_.text, annotation.offset_debug())});
  }

  void ReadAligned(pugi::xml_node tier) {
    for (const pugi::xml_node annotation : tier.children("ANNOTATION")) {
      const pugi::xml_node aligned = annotation.child("ALIGNABLE_ANNOTATION");
      if (!aligned) continue;
      const auto begin_s = TimeOf(aligned, "TIME_SLOT_REF1"),
                 end_s = TimeOf(aligned, "TIME_SLOT_REF2");
      if (!begin_s || !end_s) continue;
      by_id_[aligned.attribute("ANNOTATION_ID").as_string()] = {*begin_s, *end_s};
      Add(aligned, tier, {*begin_s, *end_s});
    }
  }

  /// Annotations of tiers that depend on another tier; these may refer to each other.
  void ReadReferring(pugi::xml_node tier) {
    for (const pugi::xml_node annotation : tier.children("ANNOTATION")) {
      const pugi::xml_node referring = annotation.child("REF_ANNOTATION");
      if (!referring) continue;
      const std::string to = referring.attribute("ANNOTATION_REF").as_string();
      const auto found = by_id_.find(to);
      if (found == by_id_.end()) {
        Complain(referring, "ANNOTATION_REF: there is no annotation '" + to + "' before it");
        continue;
      }
      by_id_[referring.attribute("ANNOTATION_ID").as_string()] = found->second;
      Add(referring, tier, found->second);
    }
  }

  LabelFile& file_;
  Diagnostics problems_;
  std::map<std::string, double> times_;
  std::map<std::string, Times> by_id_;
};

}  // namespace

Diagnostics ReadEafLabels(LabelFile& file) { return EafReader(file).Read(); }

}  // namespace prehend::exchange
