// SPDX-License-Identifier: Apache-2.0
// Of all rules of a program, only the events are visible here.
#include "grammar/contents.h"

#include <algorithm>

#include "grammar/program/program.h"

namespace prehend::grammar {

const std::string& GrammarName(const Program& program) { return program.name; }

bool SameTexts(const Program& a, const Program& b) {
  return a.name == b.name && a.text_hash == b.text_hash;
}

std::vector<std::string> EventNames(const Program& program) {
  std::vector<std::string> names;
  for (const Rule& rule : program.rules) {
    if (rule.printed) names.push_back(rule.name);
  }
  return names;
}

bool HasEvent(const Program& program, std::string_view name) {
  return std::ranges::any_of(program.rules,
                             [&](const Rule& rule) { return rule.printed && rule.name == name; });
}

std::vector<EventSignature> EventSignatures(const Program& program) {
  std::vector<EventSignature> events;
  for (const Rule& rule : program.rules) {
    if (!rule.printed) continue;
    EventSignature& event = events.emplace_back();
    event.name = rule.name;
    event.has_style = rule.style_role != kNone;
    event.symmetric = rule.symmetric;
    event.composed = rule.form() == Form::kCompose;
    event.drawing = rule.drawing;
    for (const RuleRole& role : rule.roles) {
      event.roles.push_back(role.name);
      event.classes.push_back(role.class_name);
    }
    for (const RuleAttribute& attribute : rule.attributes)
      event.attributes.push_back(attribute.name);
  }
  return events;
}

const Diagnostics& CompileWarnings(const Program& program) { return program.warnings; }

const std::vector<NameInSource>& NamedClasses(const Program& program) {
  return program.named_classes;
}
const std::vector<NameInSource>& NamedSensorSets(const Program& program) {
  return program.sensor_sets;
}
const std::vector<NameInSource>& NumberedSensorSets(const Program& program) {
  return program.numbered_sets;
}

}  // namespace prehend::grammar
