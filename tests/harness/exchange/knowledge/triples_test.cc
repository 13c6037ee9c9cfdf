// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/exchange/knowledge/episode_graph.h"

namespace prehend::exchange {
namespace {

TEST(Triples, ComeBackFromTurtle) {
  const std::vector<Triple> said = {
      {"log:1-a", "rdf:type", Named("knowrob:Reaching")},
      {"log:1-a", "rdfs:label", Text("a \"quoted\"\nlabel \\ with ü")},
      {"log:1-a", "knowrob:startTime", Number(0.1 + 0.2)},
      {"log:2", "prehend:beginTick", Integer(-7)},
      {"log:2", "prehend:openEnd", {"true", "xsd:boolean"}}};
  std::string problem;
  const std::vector<Triple> read = ReadTurtle(ToTurtle(said), problem);
  EXPECT_EQ(problem, "");
  ASSERT_EQ(read.size(), said.size());
  for (std::size_t i = 0; i < said.size(); ++i) {
    EXPECT_EQ(read[i].subject, said[i].subject);
    EXPECT_EQ(read[i].predicate, said[i].predicate);
    EXPECT_EQ(read[i].object.text, said[i].object.text);
    EXPECT_EQ(read[i].object.type, said[i].object.type);
  }
  EXPECT_EQ(std::stod(read[2].object.text), 0.1 + 0.2) << "to the last bit";
}

TEST(Triples, ABrokenDocumentSaysWhere) {
  std::string problem;
  EXPECT_TRUE(ReadTurtle("@prefix a: <http://a/> .\na:b a:c .\n", problem).empty());
  EXPECT_EQ(problem.substr(0, 7), "line 2,") << problem;
}

TEST(Triples, NamesAreShortOrInFull) {
  EXPECT_EQ(FullName("dul:Event"), "http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#Event");
  EXPECT_EQ(ShortName(FullName("log:x-1")), "log:x-1");
  EXPECT_EQ(ShortName("http://elsewhere/x"), "http://elsewhere/x");
}

}  // namespace
}  // namespace prehend::exchange
