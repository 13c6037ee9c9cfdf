// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/motion/read_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "physics/base/pose.h"

namespace prehend::scenario {
namespace {

using grammar::Diagnostics;
using grammar::Place;

constexpr std::size_t kMaxReportedRows = 20;
constexpr double kMaxFrame_s = 1;

struct Word {
  std::string_view text;
  int column = 1;  ///< in bytes, from 1
};

std::vector<Word> WordsOf(std::string_view line) {
  std::vector<Word> words;
  for (std::size_t begin = line.find_first_not_of(" \t"); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line.find_first_not_of(" \t", end);
  }
  return words;
}

const std::vector<std::string>& ChannelNames() {
  static const std::vector<std::string> names = {"Xposition", "Yposition", "Zposition",
                                                 "Xrotation", "Yrotation", "Zrotation"};
  return names;
}

/// Goes through the non-empty lines. The first error in the hierarchy ends it, since what follows
/// could be misread; of the errors in rows twenty are shown.
class BvhReader {
 public:
  BvhReader(const std::string& path, std::string text, const BvhLimits& limits) : limits_(limits) {
    bvh.file = path;
    bvh.text = std::move(text);
  }

  void Read() {
    if (!Expect("HIERARCHY") || !ReadHierarchy()) return;
    const auto frames = HeaderNumber("Frames:", 2, static_cast<double>(limits_.frames));
    if (!frames) return;
    const Place counted = at_;
    if (*frames != std::floor(*frames))
      return Complain(at_, fmt::format("Frames: expected a whole number, found {}", *frames));
    const auto frame_time = HeaderNumber("Frame Time:", 0, kMaxFrame_s);
    if (!frame_time) return;
    if (*frame_time <= 0) return Complain(at_, "Frame Time: expected a number above 0, found 0");
    bvh.frame_time_s = *frame_time;
    while (diagnostics.size() < kMaxReportedRows && NextLine()) TakeRow();
    if (diagnostics.empty() && static_cast<double>(bvh.rows.size()) != *frames)
      Complain(counted,
               fmt::format("Frames: {} are announced, {} follow", *frames, bvh.rows.size()));
  }

  BvhFile bvh;
  Diagnostics diagnostics;

 private:
  void Complain(Place place, std::string message, std::string hint = {}) {
    diagnostics.push_back(
        grammar::DiagnosticAt(bvh.file, bvh.text, place, std::move(message), std::move(hint)));
  }

  /// Advances to the next line with words; false at the end.
  bool NextLine() {
    const std::string_view text = bvh.text;
    while (next_ < text.size()) {
      const std::size_t end = std::min(text.find('\n', next_), text.size());
      words_ = WordsOf(text.substr(next_, end - next_));
      at_ = {++line_, words_.empty() ? 1 : words_.front().column};
      next_ = end + 1;
      if (!words_.empty()) return true;
    }
    words_.clear();
    return false;
  }

  Place PlaceOf(const Word& word) const { return {line_, word.column}; }

  bool Wrong(const std::string& wanted) {
    constexpr std::size_t kMaxShown = 6;
    std::string line;
    for (std::size_t i = 0; i < std::min(words_.size(), kMaxShown); ++i)
      line += (i > 0 ? " " : "") + std::string(words_[i].text);
    if (words_.size() > kMaxShown) line += " ..";
    const std::string found = line.empty() ? "the end of the file" : "'" + line + "'";
    Complain(at_, fmt::format("expected {}, found {}", wanted, found));
    return false;
  }

  /// A line with only this word.
  bool Expect(const char* word) {
    const bool found = NextLine() && words_.size() == 1 && words_.front().text == word;
    return found || Wrong(fmt::format("'{}'", word));
  }

  std::optional<double> Number(const Word& word, double least, double most) {
    const auto value = NumberFrom<double>(word.text);
    if (!value || !std::isfinite(*value)) {
      Complain(PlaceOf(word), fmt::format("expected a number, found '{}'", word.text));
    } else if (*value < least || *value > most) {
      Complain(PlaceOf(word),
               fmt::format("expected a number from {} to {}, found {}", least, most, word.text));
    } else {
      return value;
    }
    return std::nullopt;
  }

  /// A line like `Frame Time: 0.0333`; blanks within the key do not matter.
  std::optional<double> HeaderNumber(std::string_view key, double least, double most) {
    const std::vector<Word> wanted = WordsOf(key);
    if (!NextLine() || words_.size() != wanted.size() + 1 ||
        !std::equal(wanted.begin(), wanted.end(), words_.begin(),
                    [](const Word& a, const Word& b) { return a.text == b.text; })) {
      Wrong(fmt::format("'{}' and a number", key));
      return std::nullopt;
    }
    at_ = PlaceOf(words_.back());
    return Number(words_.back(), least, most);
  }

  /// The roots, each from ROOT to its closing brace, and the line MOTION.
  bool ReadHierarchy() {
    do {
      if (!NextLine() || words_.front().text != "ROOT" || !OpenJoint())
        return diagnostics.empty() ? Wrong("'ROOT' and a name") : false;
      while (!open_.empty()) {
        if (!NextLine()) return Wrong("'}'");
        if (!TakeHierarchyLine()) return false;
      }
    } while (IsNext("ROOT"));
    return Expect("MOTION");
  }

  /// Whether the next line with words begins with this one. Advances to nothing.
  bool IsNext(std::string_view word) const {
    const std::string_view rest =
        std::string_view(bvh.text).substr(std::min(next_, bvh.text.size()));
    const std::size_t begin = rest.find_first_not_of(" \t\n");
    return begin != std::string_view::npos && rest.substr(begin).starts_with(word);
  }

  bool TakeHierarchyLine() {
    const std::string_view word = words_.front().text;
    const bool in_end_site = bvh.joints[static_cast<std::size_t>(open_.back())].name.empty();
    if (word == "}") {
      if (words_.size() > 1) return Wrong("nothing else on the line of a '}'");
      open_.pop_back();
      return true;
    }
    if (word == "OFFSET") return TakeOffset();
    if (in_end_site) return Wrong("'OFFSET' or '}' in an end site");
    if (word == "CHANNELS") return TakeChannels();
    if (word == "JOINT" || word == "End") return OpenJoint();
    return Wrong("'OFFSET', 'CHANNELS', 'JOINT', 'End Site' or '}'");
  }

  /// `ROOT name`, `JOINT name` or `End Site`, and the brace on this or the next line.
  bool OpenJoint() {
    BvhJoint joint{.parent = open_.empty() ? -1 : open_.back()};
    bool braced = words_.back().text == "{";
    const std::size_t words = words_.size() - (braced ? 1 : 0);
    if (words < 2) return Wrong(fmt::format("'{}' and a name", words_.front().text));
    joint.place = PlaceOf(words_[1]);
    if (words_.front().text != "End") {
      for (std::size_t i = 1; i < words; ++i)
        joint.name += (i > 1 ? " " : "") + std::string(words_[i].text);
      if (!names_.insert(joint.name).second) {
        Complain(joint.place, fmt::format("a second joint is called '{}'", joint.name));
        return false;
      }
    } else if (words != 2 || words_[1].text != "Site") {
      return Wrong("'End Site'");
    }
    if (bvh.joints.size() == kMaxBvhJoints || open_.size() == kMaxBvhDepth) {
      Complain(joint.place,
               fmt::format("more than {} joints, or deeper than {}", kMaxBvhJoints, kMaxBvhDepth));
      return false;
    }
    if (!braced && !Expect("{")) return false;
    open_.push_back(static_cast<int>(bvh.joints.size()));
    bvh.joints.push_back(std::move(joint));
    return true;
  }

  bool TakeOffset() {
    if (words_.size() != 4) return Wrong("'OFFSET' and three numbers");
    for (int axis = 0; axis < 3; ++axis) {
      const auto value =
          Number(words_[static_cast<std::size_t>(axis) + 1], -kMaxBvhValue, kMaxBvhValue);
      if (!value) return false;
      bvh.joints[static_cast<std::size_t>(open_.back())].offset[axis] = *value;
    }
    return true;
  }

  bool TakeChannels() {
    BvhJoint& joint = bvh.joints[static_cast<std::size_t>(open_.back())];
    const std::vector<std::string>& names = ChannelNames();
    if (words_.size() < 2) return Wrong("'CHANNELS', how many, and their names");
    const auto count = Number(words_[1], 0, static_cast<double>(names.size()));
    if (!count) return false;
    if (!joint.channels.empty()) return Wrong("'CHANNELS' once for each joint");
    if (static_cast<double>(words_.size() - 2) != *count) {
      Complain(PlaceOf(words_[1]),
               fmt::format("CHANNELS: {} are announced, {} follow", *count, words_.size() - 2));
      return false;
    }
    joint.first_value = bvh.values_per_row;
    for (std::size_t i = 2; i < words_.size(); ++i) {
      const auto known = std::find(names.begin(), names.end(), words_[i].text);
      if (known == names.end()) return UnknownChannel(words_[i]);
      const int index = static_cast<int>(known - names.begin());
      const BvhChannel channel{.turns = index >= 3, .axis = index % 3};
      const auto same = [&](const BvhChannel& c) {
        return c.turns == channel.turns && c.axis == channel.axis;
      };
      if (std::any_of(joint.channels.begin(), joint.channels.end(), same)) {
        Complain(PlaceOf(words_[i]), fmt::format("'{}' is given twice", words_[i].text));
        return false;
      }
      joint.channels.push_back(channel);
    }
    bvh.values_per_row += joint.channels.size();
    return true;
  }

  bool UnknownChannel(const Word& word) {
    Complain(PlaceOf(word), fmt::format("no channel is called '{}'", word.text),
             grammar::DidYouMean(word.text, ChannelNames(),
                                 fmt::format("{}", fmt::join(ChannelNames(), ", "))));
    return false;
  }

  void TakeRow() {
    if (words_.size() != bvh.values_per_row) {
      return Complain(PlaceOf(words_.back()),
                      fmt::format("expected {} values, as many as the hierarchy has channels, "
                                  "found {}",
                                  bvh.values_per_row, words_.size()),
                      "every frame is one line");
    }
    if (bvh.rows.size() == limits_.frames)
      return Complain(at_, fmt::format("more than {} frames", limits_.frames));
    std::vector<double> row;
    for (const Word& word : words_) {
      const auto value = Number(word, -kMaxBvhValue, kMaxBvhValue);
      if (!value) return;
      row.push_back(*value);
    }
    bvh.rows.push_back(std::move(row));
    bvh.places.push_back(at_);
  }

  const BvhLimits limits_;
  std::size_t next_ = 0;  ///< where the next line begins
  int line_ = 0;
  Place at_{1, 1};
  std::vector<Word> words_;
  std::vector<int> open_;  ///< joints whose braces are open
  std::set<std::string> names_;
};

}  // namespace

Result<BvhFile> ReadBvh(const std::string& path, const BvhLimits& limits) {
  PREHEND_TRY(std::string text, ReadTextFile(path, limits.bytes));
  BvhReader reader(path, std::move(text), limits);
  reader.Read();
  if (!reader.diagnostics.empty()) return tl::unexpected(std::move(reader.diagnostics));
  return std::move(reader.bvh);
}

std::vector<JointPose> JointPosesAt(const BvhFile& bvh, std::size_t frame) {
  const std::vector<double>& row = bvh.rows[frame];
  std::vector<JointPose> poses;
  poses.reserve(bvh.joints.size());
  for (const BvhJoint& joint : bvh.joints) {
    JointPose parent;
    if (joint.parent >= 0) parent = poses[static_cast<std::size_t>(joint.parent)];
    Eigen::Vector3d offset = joint.offset;
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const double value = row[joint.first_value + i];
      const int axis = joint.channels[i].axis;
      if (joint.channels[i].turns) {
        turn = turn * Eigen::AngleAxisd(value * physics::kRadPerDeg, Eigen::Vector3d::Unit(axis));
      } else {
        offset[axis] = value;
      }
    }
    poses.push_back({parent.p + parent.q * offset, (parent.q * turn).normalized()});
  }
  return poses;
}

}  // namespace prehend::scenario
