// SPDX-License-Identifier: Apache-2.0
#include <bson/bson.h>
#include <gtest/gtest.h>

#include "harness/exchange/knowledge/episode_graph.h"

namespace prehend::exchange {
namespace {

/// Each document as JSON.
std::vector<std::string> DocumentsOf(const std::string& bytes) {
  std::vector<std::string> documents;
  bson_reader_t* reader =
      bson_reader_new_from_data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  bool at_end = false;
  while (const bson_t* document = bson_reader_read(reader, &at_end)) {
    char* json = bson_as_relaxed_extended_json(document, nullptr);
    documents.push_back(json);
    bson_free(json);
  }
  EXPECT_TRUE(at_end);
  bson_reader_destroy(reader);
  return documents;
}

TEST(Neem, StatementsCarryWhatStandsAboveThem) {
  Hierarchy hierarchy;
  hierarchy.Add({{"knowrob:Cup", "rdfs:subClassOf", Named("knowrob:Dish")},
                 {"knowrob:Dish", "rdfs:subClassOf", Named("knowrob:Thing")}});
  const auto documents = DocumentsOf(TriplesBson({{"log:1", "rdf:type", Named("knowrob:Cup")},
                                                  {"log:1", "rdfs:label", Text("a label")},
                                                  {"log:1", "knowrob:startTime", Number(0.5)}},
                                                 hierarchy));
  ASSERT_EQ(documents.size(), 2u) << "labels are annotations";
  EXPECT_NE(documents[0].find("\"o*\" : [ \"http://knowrob.org/kb/knowrob.owl#Cup\", "
                              "\"http://knowrob.org/kb/knowrob.owl#Dish\", "
                              "\"http://knowrob.org/kb/knowrob.owl#Thing\" ]"),
            std::string::npos)
      << documents[0];
  EXPECT_NE(documents[1].find("\"o\" : 0.5"), std::string::npos) << documents[1];
  EXPECT_EQ(DocumentsOf(AnnotationsBson({{"log:1", "rdfs:label", Text("a label")}})).size(), 1u);
}

TEST(Neem, ATransformIsThatOfTf) {
  physics::Pose pose;
  pose.p_m = {1, 2, 3};
  const auto documents =
      DocumentsOf(TransformsBson({{1500, "log:x", pose}, {1600, "log:x", pose}}));
  ASSERT_EQ(documents.size(), 2u);
  EXPECT_NE(documents[1].find("\"seq\" : 1"), std::string::npos) << documents[1];
  EXPECT_NE(documents[0].find("\"frame_id\" : \"world\""), std::string::npos) << documents[0];
  EXPECT_NE(documents[0].find("\"z\" : 3.0"), std::string::npos) << documents[0];
}

}  // namespace
}  // namespace prehend::exchange
