// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/knowledge/triples.h"

#include <fmt/format.h>
#include <serd/serd.h>

#include <algorithm>
#include <memory>

namespace prehend::exchange {
namespace {

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

}  // namespace

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

}  // namespace prehend::exchange
