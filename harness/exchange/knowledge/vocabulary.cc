// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/knowledge/vocabulary.h. Tested by
// tests/harness/exchange/knowledge/vocabulary_test.cc
#include "harness/exchange/knowledge/vocabulary.h"

#include <cctype>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

constexpr const char* kTerminology = "harness/exchange/knowledge/prehend.ttl";
/// Every class of things that is built in is below it.
constexpr const char* kRootOfThings = "knowrob:Entity";

}  // namespace

std::string CamelCase(std::string_view words) {
  std::string name;
  bool begins = true;
  for (const char c : words) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '_' || c == '-' || c == ' ') {
      begins = true;
    } else if (byte < 128 && std::isalnum(byte)) {
      name += begins ? static_cast<char>(std::toupper(byte)) : c;
      begins = false;
    }
  }
  return name;
}

Result<Vocabulary> Vocabulary::Load(const std::string& root) {
  const std::string file = InProjectOrShipped(root, kTerminology);
  Result<std::string> text = ReadTextFile(file);
  if (!text) return tl::unexpected(text.error());
  std::string problem;
  const std::vector<Triple> triples = ReadTurtle(*text, problem);
  if (!problem.empty())
    return tl::unexpected(grammar::Diagnostics{
        {.file = file, .place = {}, .message = problem, .source_line = {}, .hint = {}}});
  Vocabulary vocabulary;
  vocabulary.text_ = std::move(*text);
  std::map<std::string, EventTerm> terms;  // by their names
  std::map<std::string, std::string> event_names;
  vocabulary.things_.insert(kRootOfThings);
  for (const auto& [subject, predicate, object] : triples) {
    vocabulary.known_.insert(subject);
    EventTerm& term = terms[subject];
    term.name = subject;
    if (predicate == "rdfs:subClassOf") {
      if (term.base.empty()) term.base = object.text;
      if (vocabulary.things_.contains(object.text)) vocabulary.things_.insert(subject);
    } else if (predicate == "prehend:executedTask") {
      term.relation = "dul:executesTask";
      term.concept_name = object.text;
    } else if (predicate == "prehend:classification") {
      term.relation = "dul:isClassifiedBy";
      term.concept_name = object.text;
    } else if (predicate == "prehend:eventName") {
      event_names[object.text] = subject;
    } else if (predicate == "prehend:roleName") {
      vocabulary.roles_[object.text] = subject;
    } else if (predicate == "prehend:styleName") {
      vocabulary.styles_[object.text] = subject;
    }
  }
  for (const auto& [event, name] : event_names) {
    EventTerm term = terms[name];
    // The class of DUL or SOMA: a kind of grasping is an action, too.
    while (term.base.starts_with("knowrob:")) term.base = terms[term.base].base;
    vocabulary.events_[event] = std::move(term);
  }
  return vocabulary;
}

EventTerm Vocabulary::TermOf(const std::string& event) const {
  const auto found = events_.find(event);
  if (found != events_.end()) return found->second;
  std::string name = "knowrob:" + CamelCase(event);
  if (known_.contains(name)) name += "Event";
  return {.name = std::move(name), .base = {}, .relation = {}, .concept_name = {}};
}

std::string Vocabulary::PropertyOf(const std::string& role) const {
  const auto found = roles_.find(role);
  if (found != roles_.end()) return found->second;
  std::string name = CamelCase(role);
  name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  name = "knowrob:" + name;
  return known_.contains(name) ? name + "Role" : name;
}

std::string Vocabulary::StyleOf(const std::string& style) const {
  const auto found = styles_.find(style);
  return found != styles_.end() ? found->second : "knowrob:" + CamelCase(style) + "Style";
}

std::string Vocabulary::ClassOf(const std::string& name) const {
  const std::string short_name = "knowrob:" + CamelCase(name);
  const bool means_another = known_.contains(short_name) && !things_.contains(short_name);
  return means_another ? short_name + "Object" : short_name;
}

}  // namespace prehend::exchange
