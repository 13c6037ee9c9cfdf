// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/atomic_file.h"
#include "harness/truth/timeline/event_text.h"

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
    return grammar::DidYouMean(
        name, known, known.empty() ? "" : fmt::format("there are: {}", fmt::join(known, ", ")));
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
  } else if (past.frames() == 0 || played.failure.find(kIsDamaged) != std::string::npos) {
    watched.problem = played.failure.empty() ? "the episode has no frames" : played.failure;
  }
  return watched;
}

Watched Watch(episode::Episode& episode) {
  return Watch(episode.program(), episode.entities(),
               [&](const auto& look) { return episode.EachFrame(look); });
}

using grammar::Dimension;
using grammar::Place;
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
  return QuantityText(truth::SecondsOf(ticks, ticks_per_second), grammar::kSeconds);
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
