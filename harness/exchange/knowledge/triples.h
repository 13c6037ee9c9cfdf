// SPDX-License-Identifier: Apache-2.0
// Statements of subject, predicate and object (RDF 1.1), as Turtle. Names are written short,
// "knowrob:Reaching", with the prefixes of kPrefixes. Tested by
// tests/harness/exchange/knowledge/triples_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::exchange {

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

}  // namespace prehend::exchange
