// SPDX-License-Identifier: Apache-2.0
// A recorded task and its episodes as statements (docs/knowledge.md): a semantic map of the
// entities, and the events with their participants. Tested by tests/program/knowledge_test.cc
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/episode/episodes/episode_file.h"
#include "physics/base/pose.h"

namespace prehend::exchange {

// Statements of subject, predicate and object (RDF 1.1), as Turtle. Names are written short,
// "knowrob:Reaching", with the prefixes of kPrefixes. Tested by
// tests/harness/exchange/knowledge/triples_test.cc

struct Prefix {
  std::string_view name, iri;
};
inline constexpr Prefix kPrefixes[] = {
    {"rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#"},
    {"rdfs", "http://www.w3.org/2000/01/rdf-schema#"},
    {"owl", "http://www.w3.org/2002/07/owl#"},
    {"xsd", "http://www.w3.org/2001/XMLSchema#"},
    {"dul", "http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#"},
    {"soma", "http://www.ease-crc.org/ont/SOMA.owl#"},
    {"knowrob", "http://knowrob.org/kb/knowrob.owl#"},
    {"prehend", "http://prehend.local/prehend.owl#"},
    {"log", "http://prehend.local/log.owl#"}};

/// What a statement says of its subject: another name, or a value with its type.
struct Object {
  std::string text;
  std::string type;  ///< "xsd:double"; empty: `text` is a name
};
Object Named(std::string name);
Object Text(std::string text);
Object Number(double number);
Object Integer(std::int64_t number);

struct Triple {
  std::string subject, predicate;
  Object object;
};

/// "knowrob:Reaching" in full.
std::string FullName(std::string_view name);
/// The other way round; a name without a prefix stays as it is.
std::string ShortName(std::string_view iri);

/// A document with its prefixes. Statements of one subject that follow each other are joined.
std::string ToTurtle(const std::vector<Triple>& triples);

/// The statements of a document, names in short; or nothing, and why not in `problem`.
std::vector<Triple> ReadTurtle(const std::string& text, std::string& problem);

/// How an event is written down.
struct EventTerm {
  std::string name;      ///< "knowrob:Reaching"
  std::string base;      ///< a class of DUL or SOMA above it; of another grammar's event empty
  std::string relation;  ///< to `concept_name`: "dul:executesTask", "dul:isClassifiedBy"; or empty
  std::string concept_name;  ///< "knowrob:ReachingTask"
};

class Vocabulary {
 public:
  /// Reads harness/exchange/knowledge/prehend.ttl of what ships.
  static Result<Vocabulary> Load();

  /// The terminology as it stands in its file.
  const std::string& text() const { return text_; }

  EventTerm TermOf(const std::string& event) const;
  /// "knowrob:performedBy" of "hand".
  std::string PropertyOf(const std::string& role) const;
  /// "knowrob:WrapStyle" of "wrap".
  std::string StyleOf(const std::string& style) const;
  /// "knowrob:MilkCarton". A class that is called like a word that means something else gets
  /// "Object" behind it.
  std::string ClassOf(const std::string& name) const;
  /// Whether the terminology has this name.
  bool Has(const std::string& name) const { return known_.contains(name); }

 private:
  std::string text_;
  std::map<std::string, EventTerm> events_;
  std::map<std::string, std::string> roles_, styles_;
  std::set<std::string> known_, things_;
};

/// A task as a map shows it. Entities stand in the order of their numbers.
struct MapOfTask {
  episode::KeptTask task;
  std::string scenario;
  std::vector<episode::KeptEntity> entities;
  std::vector<physics::Pose> poses;  ///< when an episode begins; missing ones are left out
};

std::vector<Triple> MapTriples(const MapOfTask& map, const Vocabulary& vocabulary);

/// An episode with what was recognised in it.
struct EpisodeOfTask {
  episode::EpisodeRow row;
  std::string file;  ///< in which it is recorded
  grammar::Timeline timeline;
  std::set<std::string> composed;  ///< events that consist of others
};

std::vector<Triple> EpisodeTriples(const EpisodeOfTask& episode, const MapOfTask& map,
                                   const Vocabulary& vocabulary);

// An episode as the collections of a NEEM (narrative-enabled episodic memory): triples, tf and
// annotations as BSON, as mongodump writes them. Tested by
// tests/harness/exchange/knowledge/neem_test.cc

/// Which classes and properties are below which.
class Hierarchy {
 public:
  void Add(const std::vector<Triple>& triples);
  /// The name itself, then everything above it.
  std::vector<std::string> Above(const std::string& name) const;

 private:
  std::map<std::string, std::set<std::string>> above_;
};

/// One document per statement: s, p, o, and p*, o* with what stands above p and o.
std::string TriplesBson(const std::vector<Triple>& triples, const Hierarchy& hierarchy);

/// One document per label or comment: s, p, string.
std::string AnnotationsBson(const std::vector<Triple>& triples);

/// A pose of an entity at a time, in the world.
struct Transform {
  std::int64_t milliseconds = 0;  ///< since 1970
  std::string entity;             ///< in full
  physics::Pose X_WE;
};
/// One document per transform: header (seq, stamp, frame_id), child_frame_id, transform.
std::string TransformsBson(const std::vector<Transform>& transforms);

}  // namespace prehend::exchange
