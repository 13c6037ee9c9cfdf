// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/phrasing.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "harness/truth/timeline/event_text.h"

namespace prehend::show {

using grammar::Dimension;
using grammar::InstanceId;
using grammar::kNone;
using grammar::Place;
using grammar::ReplayMonitor;
using grammar::Rule;
using grammar::Tick;

std::string QuantityText(double value, const Dimension& dimension, int digits) {
  const auto with = [&](double scaled, const char* unit) {
    return fmt::format("{:.{}g}{}", scaled, digits, unit);
  };
  // Rounding noise is no value.
  if (std::abs(value) < 1e-9) value = 0;
  if (dimension == grammar::kPlain) return with(value, "");
  const bool small = std::abs(value) < 1;
  if (dimension == grammar::kMetres) return small ? with(value * 1000, " mm") : with(value, " m");
  if (dimension == grammar::kMetresPerSecond)
    return small ? with(value * 1000, " mm/s") : with(value, " m/s");
  if (dimension == grammar::kSeconds) return small ? with(value * 1000, " ms") : with(value, " s");
  if (dimension == grammar::kRadians) return with(value * 180 / std::numbers::pi, " deg");
  if (dimension == grammar::Quotient(grammar::kRadians, grammar::kSeconds))
    return with(value * 180 / std::numbers::pi, " deg/s");
  return with(value, (" " + grammar::DimensionText(dimension)).c_str());
}

ValueTexts Compared(double value, double limit, const Dimension& dimension) {
  ValueTexts texts;
  for (const int digits : {3, 6, 12, 17}) {
    texts = {QuantityText(value, dimension, digits), QuantityText(limit, dimension, digits)};
    if (value == limit || texts.value != texts.limit) break;
  }
  // Only what has to be told apart is written out.
  const std::string short_limit = QuantityText(limit, dimension);
  if (short_limit != texts.value) texts.limit = short_limit;
  return texts;
}

std::string At(Tick tick, Tick ticks_per_second) {
  return truth::SecondsText(tick, ticks_per_second) + " s";
}

std::string Duration(Tick ticks, Tick ticks_per_second) {
  return QuantityText(static_cast<double>(ticks) / static_cast<double>(ticks_per_second),
                      grammar::kSeconds);
}

const std::string& RuleName(ReplayMonitor& past, InstanceId instance) {
  return past.RuleOf(instance).name;
}

std::string Label(ReplayMonitor& past, InstanceId instance) {
  const Rule& rule = past.RuleOf(instance);
  const auto& entities = past.EntitiesOf(instance);
  const bool is_any = rule.form() == grammar::Form::kAny;
  const Rule& named = is_any ? past.program().rules[rule.references[0].rule] : rule;
  std::string roles;
  for (std::size_t i = 0; i < named.roles.size(); ++i) {
    const int role = is_any ? rule.references[0].roles[i] : static_cast<int>(i);
    const std::string class_name =
        named.hidden ? " " + named.roles[i].class_name : "";  // `any Cup`
    roles +=
        (i == 0 ? "" : ", ") +
        (role == kNone ? "any" + class_name : past.entity_table().entities[entities[role]].name);
  }
  const int at_least = is_any ? rule.As<grammar::AnyRule>().at_least : 1;
  const std::string how_many = at_least > 1 ? fmt::format("at least {} of ", at_least) : "";
  return how_many + rule.name + "(" + roles + ")";
}

std::string Source(const std::string& file, const Place& place) {
  const std::size_t slash = file.rfind('/');
  return fmt::format("{}:{}", slash == std::string::npos ? file : file.substr(slash + 1),
                     place.line);
}

namespace {

// Of what the grammar says in one expression; of a chain of conditions nothing.
std::string WrittenText(ReplayMonitor& past, InstanceId instance, grammar::NodeId node) {
  const std::string& written = NoteOf(past.program(), node).text;
  std::string text;
  for (std::size_t i = 0; i < written.size(); ++i) {
    // "{1}": a role is one digit.
    const bool is_role = written[i] == '{' && i + 2 < written.size() && written[i + 2] == '}';
    if (!is_role) {
      text += written[i];
      continue;
    }
    text += past.entity_table().entities[past.EntitiesOf(instance)[written[i + 1] - '0']].name;
    i += 2;
  }
  return text;
}

}  // namespace

std::string ClauseText(ReplayMonitor& past, InstanceId instance, grammar::NodeId node) {
  using grammar::Op;
  const grammar::Node& n = past.program().nodes[node];
  std::string text = WrittenText(past, instance, node);
  if (!text.empty()) return text;
  const auto part = [&](grammar::NodeId arg) {
    const Op op = past.program().nodes[arg].op;
    const bool needs_brackets =
        (op == Op::kAnd || op == Op::kOr) && op != n.op && NoteOf(past.program(), arg).text.empty();
    const std::string inner = ClauseText(past, instance, arg);
    return needs_brackets ? "(" + inner + ")" : inner;
  };
  if (n.op == Op::kNot) return "not " + part(n.args[0]);
  if (n.op == Op::kAnd) return part(n.args[0]) + " and " + part(n.args[1]);
  if (n.op == Op::kOr) return part(n.args[0]) + " or " + part(n.args[1]);
  return text;
}

}  // namespace prehend::show
