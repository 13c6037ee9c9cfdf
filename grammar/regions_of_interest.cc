// SPDX-License-Identifier: Apache-2.0
// See RegionsOf() in grammar/contents.h. Tested by tests/grammar/contents_test.cc
#include <algorithm>
#include <optional>
#include <set>

#include "grammar/contents.h"
#include "grammar/program/program.h"

namespace prehend::grammar {
namespace {

/// A larger region is none: "whatever the height".
constexpr double kRoom_m = 3;

/// Walks through the conditions of an event, and through those to which they refer.
class RegionFinder {
 public:
  explicit RegionFinder(const Program& program) : program_(program) {}

  /// `roles`: for each role of the rule that of the event, or kNone.
  void Visit(const Rule& rule, const Binding& roles) {
    for (const NodeId node : ConditionsOf(rule)) Visit(rule, roles, node);
    Visit(rule, roles, rule.requirement);
    if (const auto* any = rule.If<AnyRule>(); any != nullptr && !rule.references.empty())
      Follow(rule, roles, 0);
    if (const auto* rest = rule.If<RestOfRule>()) Follow(rule, roles, rest->whole);
  }

  const std::vector<RegionOfInterest>& regions() const { return regions_; }

 private:
  void Visit(const Rule& rule, const Binding& roles, NodeId index) {
    if (index == kNone) return;
    const Node& node = program_.nodes[index];
    const bool refers = node.op == Op::kHolds || node.op == Op::kBegins || node.op == Op::kEnds;
    if (refers && node.slot != kNone) Follow(rule, roles, node.slot);
    AddRegion(rule, roles, node);
    for (const NodeId arg : node.args) Visit(rule, roles, arg);
  }

  /// Not into other events, which have regions of their own.
  void Follow(const Rule& rule, const Binding& roles, int slot) {
    const Reference& reference = rule.references[static_cast<std::size_t>(slot)];
    const Rule& other = program_.rules[reference.rule];
    if (other.printed) return;
    Binding inner = kUnbound;
    for (std::size_t i = 0; i < other.roles.size(); ++i)
      if (reference.roles[i] != kNone)
        inner[i] = roles[static_cast<std::size_t>(reference.roles[i])];
    if (visited_.emplace(reference.rule, inner).second) Visit(other, inner);
  }

  void AddRegion(const Rule& rule, const Binding& roles, const Node& node) {
    const bool solid = node.op == Op::kSolidInSphere, cylinder = node.op == Op::kInCylinder;
    if (!solid && !cylinder && node.op != Op::kInSphere) return;
    RegionOfInterest region;
    if (cylinder) region.shape = RegionOfInterest::Shape::kCylinder;
    const auto radius_m = NumberOf(node.args[solid ? 1 : 2]);
    const auto height_m = cylinder ? NumberOf(node.args[3]) : std::optional(0.0);
    const auto inside = solid ? RoleOf(roles, node) : PlaceOf(roles, node.args[0]);
    if (!radius_m || !height_m || !inside) return;
    region.radius_m = *radius_m;
    region.height_m = *height_m;
    region.inside = *inside;
    const bool fits = std::max(region.radius_m, region.height_m) <= kRoom_m;
    if (!fits || !SetMiddle(rule, roles, node.args[solid ? 0 : 1], region)) return;
    if (std::ranges::find(regions_, region) == regions_.end()) regions_.push_back(region);
  }

  bool SetMiddle(const Rule& rule, const Binding& roles, NodeId index, RegionOfInterest& region) {
    using enum RegionOfInterest::Middle;
    const Node& node = program_.nodes[index];
    NodeId place = index;
    if (node.op == Op::kAhead) {
      const auto ahead_m = NumberOf(node.args[0]);
      const auto hand = RoleOf(roles, node);
      if (!ahead_m || !hand) return false;
      region.middle = kAhead;
      region.ahead_m = *ahead_m;
      region.role = *hand;
      return true;
    }
    if (node.op == Op::kAtBegin) {
      region.middle = kAtBegin;
      place = rule.anchors[static_cast<std::size_t>(node.slot)];
    } else if (node.op == Op::kAtEnd) {
      region.middle = kAtEnd;
      place = node.args[0];
    }
    const auto role = PlaceOf(roles, place);
    region.role = role.value_or(0);
    return role.has_value();
  }

  std::optional<double> NumberOf(NodeId index) const {
    const Node& node = program_.nodes[index];
    return node.op == Op::kNumber ? std::optional(node.number) : std::nullopt;
  }
  static std::optional<int> RoleOf(const Binding& roles, const Node& node) {
    if (node.roles[0] == kNone) return std::nullopt;
    const int role = roles[static_cast<std::size_t>(node.roles[0])];
    return role == kNone ? std::nullopt : std::optional(role);
  }
  std::optional<int> PlaceOf(const Binding& roles, NodeId index) const {
    const Node& node = program_.nodes[index];
    return node.op == Op::kPosition ? RoleOf(roles, node) : std::nullopt;
  }

  const Program& program_;
  std::set<std::pair<RuleId, Binding>> visited_;
  std::vector<RegionOfInterest> regions_;
};

}  // namespace

std::vector<RegionOfInterest> RegionsOf(const Program& program, std::string_view event) {
  for (const Rule& rule : program.rules) {
    if (!rule.printed || rule.name != event) continue;
    Binding roles = kUnbound;
    for (std::size_t i = 0; i < rule.roles.size(); ++i) roles[i] = static_cast<int>(i);
    RegionFinder finder(program);
    finder.Visit(rule, roles);
    return finder.regions();
  }
  return {};
}

}  // namespace prehend::grammar
