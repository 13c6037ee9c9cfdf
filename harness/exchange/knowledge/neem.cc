// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/knowledge/neem.h"

#include <bson/bson.h>

#include <algorithm>

namespace prehend::exchange {
namespace {

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
