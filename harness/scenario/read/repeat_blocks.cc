// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/yaml/value_format.h"
#include "harness/scenario/format/limits.h"
#include "harness/scenario/read/read_parts.h"

namespace prehend::scenario {
namespace {

bool IsBlock(const YamlNode& stage) {
  return stage.kind == YamlNode::Kind::kMapping &&
         (stage.Find("repeat") != nullptr || stage.Find("steps") != nullptr);
}

class Writer {
 public:
  Writer(DiagnosticList& errors, std::vector<YamlNode>& stages)
      : errors_(errors), stages_(stages) {}

  /// False after an error, so that a block inside of a block is reported once.
  bool Add(const std::vector<YamlNode>& stages) {
    for (const YamlNode& stage : stages) {
      if (stages_.size() > kMaxBeats) return true;  // its format reports it
      if (!IsBlock(stage))
        stages_.push_back(stage);
      else if (!AddBlock(stage))
        return false;
    }
    return true;
  }

 private:
  static std::string Remedy(const YamlNode& unknown) {
    if (unknown.kind == YamlNode::Kind::kScalar)
      return "known: repeat, steps; 'repeat: 3' says how often";
    return "what is repeated is a list below 'steps:', like '- repeat: 3' and below it "
           "'steps: [{right_hand: {close_to: 1}}]'";
  }

  bool AddBlock(const YamlNode& block) {
    const YamlNode *count = block.Find("repeat"), *steps = block.Find("steps");
    for (const YamlNode& child : block.children) {
      if (&child == count || &child == steps) continue;
      errors_.Add(child.key_where, fmt::format("unknown key '{}' in a repeated block", child.key),
                  Remedy(child));
      return false;
    }
    if (!count || !steps) {
      errors_.Add(block.where,
                  fmt::format("a repeated block needs '{}'", count ? "steps" : "repeat"),
                  "like {repeat: 3, steps: [..]}");
      return false;
    }
    int times = 0;
    if (!Integer<int>(1, kMaxRepeats).Read(*count, errors_, times)) return false;
    if (steps->kind != YamlNode::Kind::kSequence || steps->children.empty()) {
      errors_.Add(steps->where, "steps: expected a list of stages");
      return false;
    }
    for (int i = 0; i < times; ++i)
      if (!Add(steps->children)) return false;
    return true;
  }

  DiagnosticList& errors_;
  std::vector<YamlNode>& stages_;
};

}  // namespace

YamlNode WithoutRepeats(const YamlNode& scenario, DiagnosticList& errors) {
  YamlNode written = scenario;
  for (YamlNode& child : written.children) {
    if (child.key != "script" || child.kind != YamlNode::Kind::kSequence) continue;
    if (std::ranges::none_of(child.children, IsBlock)) continue;
    const std::vector<YamlNode> stages = std::move(child.children);
    child.children.clear();
    Writer(errors, child.children).Add(stages);
  }
  return written;
}

}  // namespace prehend::scenario
