// SPDX-License-Identifier: Apache-2.0
// The three forms of a law: `rest of .. is empty`, `.. do not overlap`, and relations of intervals.
#include "grammar/language/law_parser.h"

namespace prehend::grammar {

using ast::Law;

std::vector<ast::Role> LawParser::ParseRoles(std::string hint) {
  std::vector<ast::Role> roles;
  const Token bracket = Peek();
  Expect("(", std::move(hint));
  do {
    const Place place = Peek().place;
    std::string name = ExpectName("a role's name");
    Expect(":", "every role has a class: object: Movable");
    roles.push_back({std::move(name), ExpectName("a class"), place});
  } while (Accept(","));
  ExpectToClose(bracket);
  return roles;
}

Law LawParser::ParseLaw() {
  Law law;
  law.place = Peek().place;
  law.name = ExpectName("the name of a law");
  law.roles =
      ParseRoles("a law lists its roles: law slides_are_supported(hand: Hand, object: Movable)");
  if (Accept("rest")) {
    ParseCovered(law);
    return law;
  }
  do {
    law.subjects.push_back(ParsePostfix());
  } while (Accept(","));
  if (!Accept("do")) {
    ParseRelated(law);
    return law;
  }
  law.form = Law::Form::kApart;
  Expect("not", "what never happens at the same time: a(x), b(x) do not overlap");
  Expect("overlap", "what never happens at the same time: a(x), b(x) do not overlap");
  return law;
}

// The words `is`, `empty`, `do`, `overlap`, `lie` and `lies` can be names elsewhere: an expression
// never goes on with a name.
void LawParser::ParseCovered(Law& law) {
  constexpr const char* kHint = "say that nothing is left: rest of a(x) outside b(x) is empty";
  law.form = Law::Form::kCovered;
  Expect("of");
  law.subjects.push_back(ParsePostfix());
  Expect("outside");
  do {
    law.others.push_back(ParsePostfix());
  } while (Accept(","));
  Expect("is", kHint);
  Expect("empty", kHint);
}

void LawParser::ParseRelated(Law& law) {
  law.form = Law::Form::kRelated;
  law.relations_place = Peek().place;
  if (Accept("lies") || Accept("lie")) {
    Expect("inside", "a(x) lies inside b(x)");
    law.relations = {"lies inside"};
  } else {
    ParseRelations(law);
  }
  do {
    law.others.push_back(ParsePostfix());
  } while (Accept("or"));
}

void LawParser::ParseRelations(Law& law) {
  do {
    if (At("during"))
      Fail("expected one of Allen's relations, found 'during'",
           "with both ends in it, that is 'lies inside': a(x) lies inside b(x)");
    if (Peek().kind != Token::Kind::kName)
      Fail("expected 'do not overlap', 'lies inside' or one of Allen's relations, found " + Found(),
           "a law says how events lie to each other: a(x) meets b(x)");
    law.relations.push_back(ExpectName("one of Allen's relations"));
  } while (Accept("|"));
}

}  // namespace prehend::grammar
