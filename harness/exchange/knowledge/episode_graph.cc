// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/knowledge/episode_graph.h"

#include <bson/bson.h>
#include <fmt/format.h>
#include <serd/serd.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/query_events.h"

namespace prehend::exchange {
namespace {

/// "SlowWave" of "slow_wave"; what may not stand in a name is left out.
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

using episode::KeptEntity;

std::string Individual(const std::string& uuid) { return "log:" + uuid; }

bool IsA(const KeptEntity& entity, const char* wanted) {
  return std::ranges::find(entity.classes, wanted) != entity.classes.end();
}

/// "log:UUID" of the event that stands at this place of its timeline.
std::string NameOfEvent(const std::string& episode_uuid, std::size_t index) {
  return Individual(episode::UuidOfEvent(episode_uuid, index));
}

/// Names of the map of a task, and of the task.
std::string NameOfMap(const std::string& task_uuid) {
  return Individual(episode::UuidOf(task_uuid + " map"));
}

/// Collects statements about one subject after another.
class Graph {
 public:
  explicit Graph(const Vocabulary& vocabulary) : vocabulary_(vocabulary) {}

  void Begin(std::string subject) { subject_ = std::move(subject); }
  void Say(std::string predicate, Object object) {
    triples_.push_back({subject_, std::move(predicate), std::move(object)});
  }
  void Is(std::string class_name) { Say("rdf:type", Named(std::move(class_name))); }

  /// Declares a word that the terminology does not have, once.
  void Declare(const std::string& name, const char* type, const char* relation, const char* base) {
    if (vocabulary_.Has(name) || !declared_.insert(name).second) return;
    declarations_.push_back({name, "rdf:type", Named(type)});
    declarations_.push_back({name, relation, Named(base)});
  }

  std::vector<Triple> Taken() {
    std::vector<Triple> all = std::move(declarations_);
    all.insert(all.end(), triples_.begin(), triples_.end());
    return all;
  }

 private:
  const Vocabulary& vocabulary_;
  std::string subject_;
  std::vector<Triple> declarations_, triples_;
  std::set<std::string> declared_;
};

/// Declares a class and its base classes, up to the first that is built in. What kind of thing it
/// is, and whether it can be moved, is said of each thing: another scenario may call a region so.
void DeclareClasses(const KeptEntity& entity, const Vocabulary& vocabulary, Graph& graph) {
  for (std::size_t i = 0; i < entity.classes.size(); ++i) {
    const std::string name = vocabulary.ClassOf(entity.classes[i]);
    if (vocabulary.Has(name)) return;
    const std::string above =
        i + 1 < entity.classes.size() ? vocabulary.ClassOf(entity.classes[i + 1]) : "";
    const bool is_own = !above.empty() && !vocabulary.Has(above);
    graph.Declare(name, "owl:Class", "rdfs:subClassOf", is_own ? above.c_str() : "knowrob:Entity");
  }
}

void AddEntity(const MapOfTask& map, std::size_t number, const std::string& map_name,
               const Vocabulary& vocabulary, Graph& graph) {
  const KeptEntity& entity = map.entities[number];
  DeclareClasses(entity, vocabulary, graph);
  graph.Begin(Individual(entity.uuid));
  graph.Is("owl:NamedIndividual");
  for (const std::string& name : entity.classes) graph.Is(vocabulary.ClassOf(name));
  graph.Say("rdfs:label", Text(entity.name));
  graph.Say("knowrob:inMap", Named(map_name));
  if (entity.part_of >= 0 && entity.part_of < static_cast<int>(map.entities.size())) {
    const auto whole = static_cast<std::size_t>(entity.part_of);
    graph.Say("knowrob:partOf", Named(Individual(map.entities[whole].uuid)));
  }
  constexpr const char* kSizes[] = {"knowrob:depthOfObject", "knowrob:widthOfObject",
                                    "knowrob:heightOfObject"};
  for (std::size_t axis = 0; axis < entity.size_m.size(); ++axis)
    if (entity.size_m[axis] > 0) graph.Say(kSizes[axis], Number(entity.size_m[axis]));
  if (entity.mass_kg > 0) graph.Say("knowrob:massOfObject", Number(entity.mass_kg));
  if (number >= map.poses.size() || !map.poses[number].p_m.allFinite()) return;
  const physics::Pose& X_WE = map.poses[number];
  graph.Say("knowrob:translation",
            Text(fmt::format("{} {} {}", X_WE.p_m.x(), X_WE.p_m.y(), X_WE.p_m.z())));
  graph.Say("knowrob:quaternion",
            Text(fmt::format("{} {} {} {}", X_WE.q.x(), X_WE.q.y(), X_WE.q.z(), X_WE.q.w())));
}

/// Whether an event that the terminology does not have is an action: somebody performs it.
bool IsPerformed(const grammar::NamedEvent& event, const Vocabulary& vocabulary) {
  return std::ranges::any_of(event.roles, [&](const grammar::Role& role) {
    return vocabulary.PropertyOf(role.name) == "knowrob:performedBy";
  });
}

class EventWriter {
 public:
  EventWriter(const EpisodeOfTask& episode, const MapOfTask& map, const Vocabulary& vocabulary,
              Graph& graph)
      : episode_(episode), map_(map), vocabulary_(vocabulary), graph_(graph) {}

  void Write(std::size_t index) {
    const grammar::NamedEvent& event = episode_.timeline.events[index];
    const EventTerm term = vocabulary_.TermOf(event.event);
    const std::string base = !term.base.empty()                ? term.base
                             : IsPerformed(event, vocabulary_) ? "soma:PhysicalAction"
                                                               : "dul:Event";
    graph_.Declare(term.name, "owl:Class", "rdfs:subClassOf", base.c_str());
    graph_.Begin(NameOfEvent(episode_.row.uuid, index));
    graph_.Is("owl:NamedIndividual");
    graph_.Is(term.name);
    graph_.Is(base);
    graph_.Say("knowrob:startTime", Number(SecondsAt(event.interval.begin)));
    graph_.Say("knowrob:endTime", Number(SecondsAt(event.interval.end)));
    graph_.Say("prehend:beginTick", Integer(event.interval.begin));
    graph_.Say("prehend:endTick", Integer(event.interval.end));
    if (event.open_end) graph_.Say("prehend:openEnd", {"true", "xsd:boolean"});
    graph_.Say("knowrob:inEpisode", Named(Individual(episode_.row.uuid)));
    if (!term.relation.empty()) graph_.Say(term.relation, Named(term.concept_name));
    for (const grammar::Role& role : event.roles) AddRole(role);
    for (const grammar::NamedValue& value : event.values) {
      const std::string name = vocabulary_.PropertyOf(value.name);
      graph_.Declare(name, "owl:DatatypeProperty", "rdfs:subPropertyOf", "owl:topDataProperty");
      graph_.Say(name, Number(value.value));
    }
    if (!episode_.composed.contains(event.event)) return;
    for (const auto* part : episode::PartsOf(event, episode_.timeline, map_.entities)) {
      const auto number = static_cast<std::size_t>(part - episode_.timeline.events.data());
      graph_.Say("knowrob:subAction", Named(NameOfEvent(episode_.row.uuid, number)));
    }
  }

 private:
  double SecondsAt(grammar::Tick tick) const {
    return static_cast<double>(tick) / static_cast<double>(episode_.timeline.ticks_per_second);
  }

  void AddRole(const grammar::Role& role) {
    const auto entity = std::ranges::find(map_.entities, role.value, &KeptEntity::name);
    if (entity != map_.entities.end()) {
      const std::string name = vocabulary_.PropertyOf(role.name);
      graph_.Declare(name, "owl:ObjectProperty", "rdfs:subPropertyOf", "dul:hasParticipant");
      graph_.Say(name, Named(Individual(entity->uuid)));
      return;
    }
    // The only role that is no entity is the style of a grasp.
    const std::string style = vocabulary_.StyleOf(role.value);
    graph_.Declare(style, "owl:NamedIndividual", "rdf:type", "knowrob:GraspStyle");
    graph_.Say("knowrob:graspType", Named(style));
  }

  const EpisodeOfTask& episode_;
  const MapOfTask& map_;
  const Vocabulary& vocabulary_;
  Graph& graph_;
};

constexpr const char* kTerminology = "harness/exchange/knowledge/prehend.ttl";
/// Every class of things that is built in is below it.
constexpr const char* kRootOfThings = "knowrob:Entity";

using Environment = std::unique_ptr<SerdEnv, decltype(&serd_env_free)>;

const std::uint8_t* Bytes(const char* text) { return reinterpret_cast<const std::uint8_t*>(text); }
const std::uint8_t* Bytes(const std::string& text) { return Bytes(text.c_str()); }

SerdNode NodeOf(const std::string& name) { return serd_node_from_string(SERD_CURIE, Bytes(name)); }

std::string TextOf(const SerdNode* node) {
  return node && node->buf ? std::string(reinterpret_cast<const char*>(node->buf), node->n_bytes)
                           : std::string();
}

std::size_t Append(const void* bytes, std::size_t count, void* text) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(bytes), count);
  return count;
}

/// What a reader has found so far.
struct Found {
  Environment environment{nullptr, &serd_env_free};
  std::vector<Triple> triples;
  std::string problem;
};

std::string NameOf(const Found& found, const SerdNode* node) {
  if (node->type == SERD_BLANK) return "_:" + TextOf(node);
  SerdNode full = serd_env_expand_node(found.environment.get(), node);
  const std::string name = ShortName(TextOf(full.buf ? &full : node));
  serd_node_free(&full);
  return name;
}

SerdStatus AddPrefix(void* handle, const SerdNode* name, const SerdNode* iri) {
  return serd_env_set_prefix(static_cast<Found*>(handle)->environment.get(), name, iri);
}

SerdStatus AddStatement(void* handle, SerdStatementFlags, const SerdNode*, const SerdNode* subject,
                        const SerdNode* predicate, const SerdNode* object, const SerdNode* type,
                        const SerdNode*) {
  Found& found = *static_cast<Found*>(handle);
  Object said;
  if (object->type == SERD_LITERAL)
    said = {TextOf(object), type && type->buf ? NameOf(found, type) : "xsd:string"};
  else
    said = Named(NameOf(found, object));
  found.triples.push_back({NameOf(found, subject), NameOf(found, predicate), std::move(said)});
  return SERD_SUCCESS;
}

SerdStatus AddError(void* handle, const SerdError* error) {
  Found& found = *static_cast<Found*>(handle);
  if (found.problem.empty())
    found.problem = fmt::format("line {}, column {}: {}", error->line, error->col,
                                reinterpret_cast<const char*>(serd_strerror(error->status)));
  return SERD_SUCCESS;
}

/// A BSON document that frees itself.
class Document {
 public:
  Document() { bson_init(&bson_); }
  ~Document() { bson_destroy(&bson_); }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  Document& Text(const char* key, const std::string& text) {
    bson_append_utf8(&bson_, key, -1, text.c_str(), static_cast<int>(text.size()));
    return *this;
  }
  Document& Number(const char* key, double number) {
    bson_append_double(&bson_, key, -1, number);
    return *this;
  }
  Document& Integer(const char* key, std::int64_t number) {
    bson_append_int64(&bson_, key, -1, number);
    return *this;
  }
  Document& Time(const char* key, std::int64_t milliseconds) {
    bson_append_date_time(&bson_, key, -1, milliseconds);
    return *this;
  }
  Document& Inner(const char* key, const Document& inner) {
    bson_append_document(&bson_, key, -1, &inner.bson_);
    return *this;
  }
  Document& List(const char* key, const std::vector<std::string>& texts) {
    Document list;
    for (std::size_t i = 0; i < texts.size(); ++i) list.Text(std::to_string(i).c_str(), texts[i]);
    bson_append_array(&bson_, key, -1, &list.bson_);
    return *this;
  }
  void AppendTo(std::string& bytes) const {
    bytes.append(reinterpret_cast<const char*>(bson_get_data(&bson_)), bson_.len);
  }

 private:
  bson_t bson_;
};

std::vector<std::string> InFull(const std::vector<std::string>& names) {
  std::vector<std::string> full;
  for (const std::string& name : names) full.push_back(FullName(name));
  return full;
}

void AddValue(Document& document, const char* key, const Object& object) {
  if (object.type.empty())
    document.Text(key, FullName(object.text));
  else if (object.type == "xsd:double")
    document.Number(key, std::stod(object.text));
  else if (object.type == "xsd:integer")
    document.Integer(key, std::stoll(object.text));
  else
    document.Text(key, object.text);
}

bool IsAnnotation(const Triple& triple) {
  return triple.predicate == "rdfs:label" || triple.predicate == "rdfs:comment";
}

}  // namespace

std::vector<Triple> MapTriples(const MapOfTask& map, const Vocabulary& vocabulary) {
  Graph graph(vocabulary);
  const std::string map_name = NameOfMap(map.task.uuid);
  graph.Begin(Individual(map.task.uuid));
  graph.Is("owl:NamedIndividual");
  graph.Is("knowrob:Task");
  graph.Say("rdfs:label", Text(map.scenario));
  graph.Say("prehend:scenario", Text(map.scenario));
  graph.Say("knowrob:taskDescription", Text(map.task.shows));
  graph.Begin(map_name);
  graph.Is("owl:NamedIndividual");
  graph.Is("knowrob:SemanticEnvironmentMap");
  graph.Say("rdfs:label", Text("map of " + map.scenario));
  for (const episode::KeptTask::Asset& asset : map.task.assets)
    graph.Say("prehend:asset", Text(asset.hash + " " + asset.path));
  for (std::size_t i = 0; i < map.entities.size(); ++i)
    AddEntity(map, i, map_name, vocabulary, graph);
  return graph.Taken();
}

std::vector<Triple> EpisodeTriples(const EpisodeOfTask& episode, const MapOfTask& map,
                                   const Vocabulary& vocabulary) {
  Graph graph(vocabulary);
  const episode::EpisodeRow& row = episode.row;
  graph.Begin(Individual(row.uuid));
  graph.Is("owl:NamedIndividual");
  graph.Is("knowrob:Episode");
  graph.Say("rdfs:label", Text(row.scenario));
  graph.Say("knowrob:performedTask", Named(Individual(map.task.uuid)));
  graph.Say("knowrob:performedInMap", Named(NameOfMap(map.task.uuid)));
  graph.Say("knowrob:startTime", Number(0));
  graph.Say("knowrob:endTime",
            Number(static_cast<double>(row.ticks + 1) / static_cast<double>(row.ticks_per_second)));
  graph.Say("prehend:ticksPerSecond", Integer(row.ticks_per_second));
  graph.Say("prehend:recordedIn", Text(episode.file));
  graph.Say("prehend:recordNumber", Integer(row.id));
  graph.Say("prehend:scenario", Text(row.scenario));
  graph.Say("prehend:grammar", Text(row.grammar));
  graph.Say("prehend:stateHash", Text(row.state_hash));
  for (const KeptEntity& entity : map.entities) {
    if (IsA(entity, "Hand") || IsA(entity, "Person"))
      graph.Say("dul:isSettingFor", Named(Individual(entity.uuid)));
  }
  EventWriter writer(episode, map, vocabulary, graph);
  for (std::size_t i = 0; i < episode.timeline.events.size(); ++i) writer.Write(i);
  return graph.Taken();
}

Result<Vocabulary> Vocabulary::Load() {
  const std::string file = Shipped(kTerminology);
  PREHEND_TRY(std::string text, ReadTextFile(file));
  std::string problem;
  const std::vector<Triple> triples = ReadTurtle(text, problem);
  if (!problem.empty())
    return tl::unexpected(grammar::Diagnostics{{.file = file, .message = problem}});
  Vocabulary vocabulary;
  vocabulary.text_ = std::move(text);
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
  return {.name = std::move(name), .base = {}};
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

Object Named(std::string name) { return {std::move(name), ""}; }
Object Text(std::string text) { return {std::move(text), "xsd:string"}; }
Object Number(double number) { return {fmt::format("{}", number), "xsd:double"}; }
Object Integer(std::int64_t number) { return {std::to_string(number), "xsd:integer"}; }

std::string FullName(std::string_view name) {
  const std::size_t colon = name.find(':');
  for (const Prefix& prefix : kPrefixes) {
    if (name.substr(0, colon) == prefix.name)
      return std::string(prefix.iri) + std::string(name.substr(colon + 1));
  }
  return std::string(name);
}

std::string ShortName(std::string_view iri) {
  for (const Prefix& prefix : kPrefixes) {
    if (iri.starts_with(prefix.iri))
      return std::string(prefix.name) + ":" + std::string(iri.substr(prefix.iri.size()));
  }
  return std::string(iri);
}

std::string ToTurtle(const std::vector<Triple>& triples) {
  std::string text;
  const Environment environment(serd_env_new(nullptr), &serd_env_free);
  const std::unique_ptr<SerdWriter, decltype(&serd_writer_free)> writer(
      serd_writer_new(SERD_TURTLE, SERD_STYLE_ABBREVIATED, environment.get(), nullptr, &Append,
                      &text),
      &serd_writer_free);
  for (const Prefix& prefix : kPrefixes) {
    const std::string name(prefix.name), iri(prefix.iri);
    const SerdNode name_node = serd_node_from_string(SERD_LITERAL, Bytes(name)),
                   iri_node = serd_node_from_string(SERD_URI, Bytes(iri));
    serd_env_set_prefix(environment.get(), &name_node, &iri_node);
    serd_writer_set_prefix(writer.get(), &name_node, &iri_node);
  }
  for (const Triple& triple : triples) {
    const SerdNode subject = NodeOf(triple.subject), predicate = NodeOf(triple.predicate);
    const bool is_name = triple.object.type.empty();
    const bool is_string = triple.object.type == "xsd:string";
    const SerdNode object = is_name
                                ? NodeOf(triple.object.text)
                                : serd_node_from_string(SERD_LITERAL, Bytes(triple.object.text));
    const SerdNode type = is_name || is_string ? SERD_NODE_NULL : NodeOf(triple.object.type);
    serd_writer_write_statement(writer.get(), 0, nullptr, &subject, &predicate, &object, &type,
                                nullptr);
  }
  serd_writer_finish(writer.get());
  return text;
}

std::vector<Triple> ReadTurtle(const std::string& text, std::string& problem) {
  Found found;
  found.environment.reset(serd_env_new(nullptr));
  const std::unique_ptr<SerdReader, decltype(&serd_reader_free)> reader(
      serd_reader_new(SERD_TURTLE, &found, nullptr, nullptr, &AddPrefix, &AddStatement, nullptr),
      &serd_reader_free);
  serd_reader_set_error_sink(reader.get(), &AddError, &found);
  serd_reader_read_string(reader.get(), Bytes(text));
  problem = found.problem;
  return problem.empty() ? std::move(found.triples) : std::vector<Triple>();
}

void Hierarchy::Add(const std::vector<Triple>& triples) {
  for (const Triple& triple : triples) {
    if (triple.predicate == "rdfs:subClassOf" || triple.predicate == "rdfs:subPropertyOf")
      above_[triple.subject].insert(triple.object.text);
  }
}

std::vector<std::string> Hierarchy::Above(const std::string& name) const {
  std::vector<std::string> all = {name};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto found = above_.find(all[i]);
    if (found == above_.end()) continue;
    for (const std::string& above : found->second)
      if (std::ranges::find(all, above) == all.end()) all.push_back(above);
  }
  return all;
}

std::string TriplesBson(const std::vector<Triple>& triples, const Hierarchy& hierarchy) {
  std::string bytes;
  for (const Triple& triple : triples) {
    if (IsAnnotation(triple)) continue;
    Document document;
    document.Text("s", FullName(triple.subject)).Text("p", FullName(triple.predicate));
    AddValue(document, "o", triple.object);
    document.List("p*", InFull(hierarchy.Above(triple.predicate)));
    if (triple.object.type.empty())
      document.List("o*", InFull(hierarchy.Above(triple.object.text)));
    document.AppendTo(bytes);
  }
  return bytes;
}

std::string AnnotationsBson(const std::vector<Triple>& triples) {
  std::string bytes;
  for (const Triple& triple : triples) {
    if (!IsAnnotation(triple)) continue;
    Document document;
    document.Text("s", FullName(triple.subject)).Text("p", FullName(triple.predicate));
    document.Text("string", triple.object.text).AppendTo(bytes);
  }
  return bytes;
}

std::string TransformsBson(const std::vector<Transform>& transforms) {
  std::string bytes;
  std::int64_t number = 0;
  for (const Transform& transform : transforms) {
    Document header, translation, rotation, pose, document;
    header.Integer("seq", number++).Time("stamp", transform.milliseconds).Text("frame_id", "world");
    const Eigen::Vector3d& p_m = transform.X_WE.p_m;
    translation.Number("x", p_m.x()).Number("y", p_m.y()).Number("z", p_m.z());
    const Eigen::Quaterniond& q = transform.X_WE.q;
    rotation.Number("x", q.x()).Number("y", q.y()).Number("z", q.z()).Number("w", q.w());
    pose.Inner("translation", translation).Inner("rotation", rotation);
    document.Inner("header", header).Text("child_frame_id", transform.entity);
    document.Inner("transform", pose).AppendTo(bytes);
  }
  return bytes;
}

}  // namespace prehend::exchange
