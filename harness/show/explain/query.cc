// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "grammar/base/diagnostic.h"

namespace prehend::show {
namespace {

using grammar::Binding;
using grammar::InstanceId;
using grammar::kNone;
using grammar::ReplayMonitor;
using grammar::RuleId;

// Fills the open roles from `role` on with everybody whose class fits.
void Fill(ReplayMonitor& past, RuleId rule, Binding& entities, std::size_t role,
          std::vector<InstanceId>& instances) {
  const std::size_t roles = past.program().rules[rule].roles.size();
  if (instances.size() >= kMaxBindings) return;
  if (role == roles) {
    const InstanceId instance = past.InstanceOf(rule, entities);
    if (instance != kNone &&
        std::find(instances.begin(), instances.end(), instance) == instances.end())
      instances.push_back(instance);
    return;
  }
  if (entities[role] != kNone) return Fill(past, rule, entities, role + 1, instances);
  for (int entity = 0; entity < static_cast<int>(past.entity_table().entities.size()); ++entity) {
    if (std::find(entities.begin(), entities.end(), entity) != entities.end()) continue;
    entities[role] = entity;
    Fill(past, rule, entities, role + 1, instances);
    entities[role] = kNone;
  }
}

using grammar::Rule;

struct Word {
  std::string text;
  int column = 1;
};

class AskReader {
 public:
  AskReader(const std::string& option, const std::string& text, const grammar::Program& program,
            const grammar::EntityTable& entity_table)
      : option_(option), text_(text), program_(program), entity_table_(entity_table) {}

  Result<Ask> Read() {
    const std::size_t at = text_.find('@');
    const std::vector<Word> words = Words(text_.substr(0, at));
    if (words.empty()) {
      Complain(1, "found no event, wanted one of the grammar's", "for example: " + Example());
    } else if (FindRule(words.front())) {
      for (std::size_t i = 1; i < words.size(); ++i) ReadRole(words[i], i - 1);
    }
    if (at != std::string::npos) ReadTime(text_.substr(at + 1), static_cast<int>(at) + 2);
    if (!diagnostics_.empty()) return tl::unexpected(std::move(diagnostics_));
    return ask_;
  }

 private:
  static std::vector<Word> Words(const std::string& text) {
    std::vector<Word> words;
    bool open = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool separates = std::string_view(" \t(),").find(text[i]) != std::string_view::npos;
      if (!separates && !open) words.push_back({"", static_cast<int>(i) + 1});
      if (!separates) words.back().text += text[i];
      open = !separates;
    }
    return words;
  }

  void Complain(int column, std::string message, std::string hint = {}) {
    diagnostics_.push_back(
        grammar::DiagnosticAt(option_, text_, {1, column}, std::move(message), std::move(hint)));
  }

  static std::string Hint(const std::string& name, const std::vector<std::string>& known) {
    const std::string near = grammar::NearestName(name, known);
    if (!near.empty()) return fmt::format("did you mean '{}'?", near);
    return known.empty() ? "" : fmt::format("there are: {}", fmt::join(known, ", "));
  }

  std::string Example() const {
    for (const Rule& rule : program_.rules) {
      if (rule.printed) return rule.name + "@1.2s";
    }
    return "reaching@1.2s";
  }

  bool FindRule(const Word& word) {
    std::vector<std::string> names;
    for (const grammar::RuleId id : grammar::IdsOf(program_.rules)) {
      const Rule& rule = program_.rules[id];
      if (rule.hidden) continue;
      if (rule.name == word.text) ask_.rule = id;
      names.push_back(rule.name);
    }
    if (ask_.rule != kNone) return true;
    std::sort(names.begin(), names.end());
    Complain(word.column,
             fmt::format("found '{}', wanted an event or condition of grammar '{}'", word.text,
                         program_.name),
             Hint(word.text, names));
    return false;
  }

  void ReadRole(const Word& word, std::size_t place) {
    const Rule& rule = program_.rules[ask_.rule];
    const std::size_t equals = word.text.find('=');
    std::string entity = word.text;
    int column = word.column;
    if (equals != std::string::npos) {
      const std::string role = word.text.substr(0, equals);
      std::vector<std::string> roles;
      for (const grammar::RuleRole& known : rule.roles) roles.push_back(known.name);
      const auto found = std::find(roles.begin(), roles.end(), role);
      if (found == roles.end()) {
        return Complain(column, fmt::format("found '{}', wanted a role of '{}'", role, rule.name),
                        Hint(role, roles));
      }
      place = static_cast<std::size_t>(found - roles.begin());
      entity = word.text.substr(equals + 1);
      column += static_cast<int>(equals) + 1;
    }
    if (place >= rule.roles.size()) {
      return Complain(column, fmt::format("found '{}', but '{}' has {} roles", entity, rule.name,
                                          rule.roles.size()));
    }
    if (entity != "any") ReadEntity(rule, place, entity, column);
  }

  void ReadEntity(const Rule& rule, std::size_t place, const std::string& entity, int column) {
    std::vector<std::string> names;
    for (const grammar::EntityInfo& member : entity_table_.entities) names.push_back(member.name);
    const auto found = std::find(names.begin(), names.end(), entity);
    if (found == names.end()) {
      return Complain(column, fmt::format("found '{}', wanted an entity of the episode", entity),
                      Hint(entity, names));
    }
    const int index = static_cast<int>(found - names.begin());
    const std::vector<std::string>& classes = entity_table_.entities[index].classes;
    const std::string& wanted = rule.roles[place].class_name;
    if (std::find(classes.begin(), classes.end(), wanted) == classes.end()) {
      return Complain(column,
                      fmt::format("found '{}', a {}; the role '{}' of '{}' wants a {}", entity,
                                  classes.front(), rule.roles[place].name, rule.name, wanted));
    }
    if (ask_.entities[place] != kNone) {
      return Complain(column, fmt::format("the role '{}' is named twice", rule.roles[place].name));
    }
    if (std::find(ask_.entities.begin(), ask_.entities.end(), index) != ask_.entities.end()) {
      return Complain(column, fmt::format("'{}' cannot play two roles of one event", entity));
    }
    ask_.entities[place] = index;
  }

  void ReadTime(std::string text, int column) {
    const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
    column += static_cast<int>(first);
    text = text.substr(first, text.find_last_not_of(" \t") + 1 - first);
    double value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string unit = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
    unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
    const bool is_time = parsed.ec == std::errc() && std::isfinite(value) && value >= 0;
    if (!is_time || (!unit.empty() && unit != "s" && unit != "ms")) {
      return Complain(column,
                      fmt::format("found '{}', wanted a time from the episode's begin", text),
                      "for example: @1.24s, @1240 ms");
    }
    ask_.time_s = unit == "ms" ? value / 1000 : value;
  }

  const std::string& option_;
  const std::string& text_;
  const grammar::Program& program_;
  const grammar::EntityTable& entity_table_;
  grammar::Diagnostics diagnostics_;
  Ask ask_;
};

}  // namespace

std::vector<InstanceId> BindingsThatFit(ReplayMonitor& past, RuleId rule, const Binding& wanted) {
  const grammar::Rule& asked = past.program().rules[rule];
  std::vector<InstanceId> instances;
  for (const InstanceId instance : past.InstancesOf(rule)) {
    const Binding& entities = past.EntitiesOf(instance);
    const auto fits = [&](const Binding& open) {
      for (std::size_t i = 0; i < asked.roles.size(); ++i) {
        if (open[i] != kNone && open[i] != entities[i]) return false;
      }
      return true;
    };
    const bool either_way = asked.symmetric && fits({wanted[1], wanted[0], wanted[2], wanted[3]});
    if (instances.size() < kMaxBindings && (fits(wanted) || either_way))
      instances.push_back(instance);
  }
  Binding entities = wanted;
  if (instances.empty()) Fill(past, rule, entities, 0, instances);
  return instances;
}

Result<Ask> ParseAsk(const std::string& option, const std::string& text,
                     const grammar::Program& program, const grammar::EntityTable& entity_table) {
  return AskReader(option, text, program, entity_table).Read();
}

Watched Watch(const std::shared_ptr<const grammar::Program>& program,
              const grammar::EntityTable& entities, const PlayFrames& play) {
  Watched watched;
  watched.past = std::make_unique<grammar::ReplayMonitor>(program, entities);
  grammar::ReplayMonitor& past = *watched.past;
  bool too_long = false;
  const episode::Episode::End played = play([&](const grammar::Frame& frame) {
    too_long = too_long || past.frames() >= kMaxFrames;
    if (!too_long) past.Advance(frame);
  });
  past.Finish(played.tick);
  watched.failure = played.failure;
  if (!past.error().empty()) {
    watched.problem = "the grammar cannot be evaluated on this episode: " + past.error();
  } else if (too_long) {
    watched.problem = fmt::format(
        "the episode has more than {} frames, and all of them would have to be remembered",
        kMaxFrames);
  } else if (past.frames() == 0) {
    watched.problem = played.failure.empty() ? "the episode has no frames" : played.failure;
  }
  return watched;
}

Watched Watch(episode::Episode& episode) {
  return Watch(episode.program(), episode.entities(),
               [&](const auto& look) { return episode.EachFrame(look); });
}

}  // namespace prehend::show
