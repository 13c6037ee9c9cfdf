// SPDX-License-Identifier: Apache-2.0
// One function per form of a definition, then its modifiers in any order.
#include "grammar/language/parser.h"

#include <algorithm>

#include "grammar/language/expression_parser.h"

namespace prehend::grammar {
namespace {

using ast::Definition;
using ast::Expr;

constexpr std::size_t kMaxDefinitions = 1000;

class Parser : public LawParser {
 public:
  using LawParser::LawParser;

  ast::File ParseFile() {
    ast::File file;
    try {
      if (AtEnd()) Fail("the file is empty", "a grammar starts with `grammar NAME`");
      Expect("grammar", "a grammar starts with `grammar NAME`");
      file.name = ExpectName("the grammar's name");
    } catch (const ParseStop&) {
      SkipToItem();
    }
    while (!AtEnd()) {
      const std::size_t start = Position();
      const bool is_use = At("use");
      try {
        ParseItem(file);
      } catch (const ParseStop&) {
        const std::string name = NameOfItem(start);
        const bool is_head = BeginsLine() && (At(":", 3) || At(":", 4) || At("=", 1) || At("=", 2));
        file.is_incomplete |= is_use || name.empty() || is_head;
        file.broken.insert(name);
        SkipToItem();
      }
    }
    return file;
  }

  std::optional<Quantity> ParseOnlyQuantity() {
    try {
      const Quantity quantity = ParseSignedQuantity();
      if (!AtEnd()) Fail("expected nothing after the value, found " + Found());
      return quantity;
    } catch (const ParseStop&) {
      return std::nullopt;
    }
  }

 private:
  template <typename T>
  T Whole(T item) {
    if (!AtEnd() && !AtItem()) ExpectItem();
    return item;
  }

  void ExpectItem() {
    const std::string message =
        "expected 'use', 'param', 'define', 'condition', 'event' or 'law', found " + Found();
    if (Correct(message)) return;
    Fail(message, At(",") && Peek(1).kind == Token::Kind::kNumber ? "decimals have a point: 2.5"
                                                                  : WordHint());
  }

  void ParseItem(ast::File& file) {
    const Place place = Peek().place;
    if (Accept("use")) {
      ParseUse(file, place);
      while (At(",") && Peek(1).kind == Token::Kind::kName) {
        Complain(Peek().place, "a 'use' names one grammar", "a line for each: use " + Peek(1).text);
        ParseUse(file, Take().place);
      }
    } else if (Accept("param")) {
      const Place name_place = Peek().place;
      std::string name = ExpectName("a parameter's name");
      Expect("=", "a number and its unit: param " + name + " = 5 cm");
      file.params.push_back(Whole(ast::Param{std::move(name), name_place, ParseSignedQuantity()}));
    } else if (At("define") || At("event") || At("condition") || At("symmetric") || At("law")) {
      if (file.definitions.size() + file.defines.size() + file.laws.size() == kMaxDefinitions) {
        SkipToEnd();
        FailAt(place, "more than " + std::to_string(kMaxDefinitions) + " definitions in one file");
      }
      if (Accept("define")) {
        file.defines.push_back(Whole(ParseDefine()));
      } else if (Accept("law")) {
        file.laws.push_back(Whole(ParseLaw()));
      } else {
        file.definitions.push_back(Whole(ParseDefinition()));
      }
    } else if (Accept("grammar")) {
      FailAt(place, "a second 'grammar' line",
             "one file holds one grammar; `use NAME` reads another one");
    } else {
      ExpectItem();
    }
  }

  void ParseUse(ast::File& file, Place place) {
    ast::Use use{.is_path = Peek().kind == Token::Kind::kText, .place = place};
    if (use.is_path) {
      if (Peek().text.empty()) Fail("an empty file name");
      use.name = Take().text;
    } else {
      use.name = ExpectName("a grammar's name, or its file in quotes");
      if (Accept("from")) use.variant = ExpectName("what it is made from: use contact from motion");
    }
    if (Accept("with")) {
      do {
        use.settings.push_back(ParseSetting());
      } while (Accept(","));
    }
    if (!At(",")) use = Whole(std::move(use));
    file.uses.push_back(std::move(use));
  }

  // reach_radius = 25 cm
  ast::Param ParseSetting() {
    ast::Param setting;
    setting.place = Peek().place;
    setting.name = ExpectName("a parameter's name");
    Expect("=");
    setting.value = ParseSignedQuantity();
    return setting;
  }

  // define above(a, b: Thing, gap: cm) = height(a) > height(b) + gap
  ast::Define ParseDefine() {
    ast::Define define;
    define.place = Peek().place;
    define.name = ExpectName("the name of a value or test");
    const Token bracket = Peek();
    if (Accept("(")) {
      do {
        ParseParameter(define);
      } while (Accept(","));
      ExpectToClose(bracket);
    }
    Expect("=", "a value or a test: define NAME(a: Movable) = F");
    define.body = ParseExpr();
    return define;
  }

  void ParseParameter(ast::Define& define) {
    ast::Role parameter{.class_name = "Entity", .place = Peek().place};
    Dimension dimension;
    parameter.name = ExpectName("a parameter's name");
    if (Accept(":")) {
      parameter.class_name = Peek().text;
      if (Peek().kind == Token::Kind::kName && FindUnit(Peek().text) != nullptr) {
        double si = 1;
        dimension = ParseDimension(si);
        parameter.class_name = "number";
      } else {
        ExpectName("a class, a unit, 'number' or 'position'");
      }
    }
    define.parameters.push_back(std::move(parameter));
    define.dimensions.push_back(dimension);
  }

  Definition ParseDefinition() {
    Definition definition;
    definition.symmetric = Accept("symmetric");
    definition.is_event = definition.symmetric || !Accept("condition");
    if (definition.is_event) Expect("event");
    definition.place = Peek().place;
    definition.name = ExpectName("the name of an event or condition");
    definition.roles =
        ParseRoles("an event lists its roles: event grasping(hand: Hand, object: Thing)");
    ParseForm(definition);
    while (ParseModifier(definition)) {
    }
    return definition;
  }

  void ParseForm(Definition& definition) {
    if (Accept("while")) {
      definition.form = Definition::Form::kWhile;
      definition.first = ParseExpr();
      if (Accept("until")) definition.until = ParseExpr();
    } else if (Accept("from")) {
      ParseFromTo(definition);
    } else if (Accept("until")) {
      ParseUntil(definition);
    } else if (Accept("rest")) {
      definition.form = Definition::Form::kRestOf;
      Expect("of");
      definition.first = ParsePostfix();
      Expect("outside");
      do {
        definition.outside.push_back(ParsePostfix());
      } while (Accept(","));
    } else if (Accept("compose")) {
      ParseCompose(definition);
    } else if (At("all") && At("of", 1)) {
      SkipOne();
      SkipOne();
      ParseAllOf(definition);
    } else if (Accept("repeat")) {
      ParseRepeat(definition);
    } else if (Accept("otherwise")) {
      definition.form = Definition::Form::kOtherwise;
    } else {
      Fail(
          "expected 'while', 'from', 'until', 'rest', 'compose', 'all of', 'repeat' or "
          "'otherwise', found " +
              Found(),
          WordHint(true));
    }
  }

  void ParseFromTo(Definition& definition) {
    definition.form = Definition::Form::kFromTo;
    definition.each = Accept("each");
    definition.first = ParseExpr();
    definition.absence = Accept("without");
    if (!definition.absence)
      Expect("to",
             "say what ends it: from A to B, or what must not come: from A without B within t");
    definition.second = ParseExpr();
    if (Accept("within")) {
      definition.within = ParseSum();
    } else if (definition.absence) {
      Fail("expected 'within', found " + Found(),
           "say how long to wait: from A without B within 2 s");
    }
    if (!Accept("during")) return;
    definition.during = ParseExpr();
    definition.or_drop = AtOrDrop();
    if (!definition.or_drop) return;
    if (definition.absence)
      Complain(Peek().place, "'or drop' belongs to 'from .. to'",
               "what does not hold 'during' an absence drops it always");
    SkipOne();
    SkipOne();
  }

  void ParseUntil(Definition& definition) {
    definition.form = Definition::Form::kUntilSince;
    definition.first = ParseExpr();
    Expect("since");
    definition.second = ParseExpr();
    if (Accept("approaching")) definition.approach = ParseApproach();
    if (!At("at"))
      Fail("expected 'at most .. back', found " + Found(),
           "say how far back to look: at most 10 s back");
    ExpectAtMost();
    definition.at_most_back = ParseSum();
    Expect("back");
  }

  ast::Approach ParseApproach() {
    ast::Approach approach;
    approach.signal = ParseSum();
    Expect("receding");
    ExpectAtMost();
    approach.slack = ParseSum();
    if (Accept("over")) approach.over = ParseSum();
    if (!At(",") || !At("onset", 1)) ParsePause(approach);
    if (At(",") && At("onset", 1)) {
      SkipOne();
      SkipOne();
      approach.onset = ParseSum();
    }
    return approach;
  }

  void ParsePause(ast::Approach& approach) {
    Accept(",");
    if (Accept("with")) {
      approach.motion = ParseSum();
      if (!At("slower"))
        Fail("expected 'slower', found " + Found(), "with surface_speed(hand) slower than 1 cm/s");
    }
    if (!Accept("slower")) return;
    Expect("than");
    approach.speed = ParseSum();
    if (Accept("or")) {
      Expect("within", "or within 2.5 mm over 0.5 s");
      approach.still = ParseSum();
      Expect("over", "or within 2.5 mm over 0.5 s");
      approach.still_over = ParseSum();
    }
    ExpectAtMost();
    approach.idle = ParseSum();
  }

  // E or F
  std::vector<Expr> ParseChoice() {
    std::vector<Expr> calls;
    do {
      calls.push_back(ParsePostfix());
    } while (Accept("or"));
    return calls;
  }

  void ParseCompose(Definition& definition) {
    definition.form = Definition::Form::kCompose;
    definition.first_of_equals = At("first") && !At(":", 1);  // it may be a label, too
    if (definition.first_of_equals) SkipOne();
    do {
      const Place place = Peek().place;
      std::string label = ExpectName("a label");
      Expect(":", "a composition labels its parts: compose reach: reaching(hand, object), ...");
      definition.parts.push_back({std::move(label), place, ParseChoice()});
    } while (Accept(","));
    Expect("where", "say how the parts follow each other: where reach before|meets grasp, ...");
    ParseRelations(definition);
  }

  // all of moved(hand, plate), moved(hand, cup) within 60 s
  void ParseAllOf(Definition& definition) {
    definition.form = Definition::Form::kCompose;
    definition.all_of = true;
    do {
      const Place place = Peek().place;
      std::string label;
      if (At(":", 1)) {
        label = ExpectName("a label");
        SkipOne();
      }
      definition.parts.push_back({std::move(label), place, ParseChoice()});
    } while (Accept(","));
    if (Accept("where")) ParseRelations(definition);
    Expect("within", "say how long all of it lasts at most: all of E, F within 60 s");
    definition.within = ParseSum();
  }

  void ParseRelations(Definition& definition) {
    do {
      const Place place = Peek().place;
      if (Accept("without")) {
        ast::Absence absence{.call = ParsePostfix(), .left = {}, .right = {}};
        Expect("between", "without touching(hand, cup) between a and b");
        absence.left_place = Peek().place;
        absence.left = ExpectName("a label");
        Expect("and");
        absence.right_place = Peek().place;
        absence.right = ExpectName("a label");
        definition.absences.push_back(std::move(absence));
        continue;
      }
      ast::Relation relation{.left = {}, .alternatives = {}, .right = {}, .place = place};
      relation.left = ExpectName("a label");
      do {
        if (At("during"))
          Fail("expected one of Allen's relations, found 'during'",
               "'during' is called 'inside' here, for it begins a clause of 'from .. to'");
        const Place named = Peek().place;
        relation.alternatives.push_back({ExpectName("one of Allen's relations"), named, {}});
        if (Accept("within")) relation.alternatives.back().within = ParseSum();
      } while (Accept("|"));
      relation.right_place = Peek().place;
      relation.right = ExpectName("a label");
      definition.relations.push_back(std::move(relation));
    } while (Accept(","));
  }

  // repeat stroke(hand, object) at least 3, gap at most 0.3 s
  void ParseRepeat(Definition& definition) {
    constexpr const char* kExample = "repeat stroke(hand, object) at least 3, gap at most 0.3 s";
    definition.form = Definition::Form::kRepeat;
    definition.repeated = ParseChoice();
    Expect("at", kExample);
    Expect("least", kExample);
    definition.at_least = ParseSum();
    if (Accept("within")) {
      definition.within = ParseSum();
      return;
    }
    Expect(",", kExample);
    Expect("gap", kExample);
    ExpectAtMost();
    definition.gap = ParseSum();
  }

  template <typename T>
  void Once(std::optional<T>& slot, T value, const Token& word) {
    if (slot)
      FailAt(word.place, "a second '" + word.text + "' in one definition", "keep one of the two");
    slot = std::move(value);
  }

  bool ParseModifier(Definition& definition) {
    const Token word = Peek();
    if (Accept("bridging")) {
      Once(definition.bridging, ParseSum(), word);
    } else if (At("one") && Peek(1).kind == Token::Kind::kName) {
      Once(definition.one_per, ParseOnePer(), word);
    } else if (Accept("lasting")) {
      Once(definition.lasting, ParseSum(), word);
      if (Accept("to")) definition.lasting_to = ParseSum();
    } else if (Accept("requires")) {
      Once(definition.requirement, ParseExpr(), word);
    } else if (Accept("confirmed")) {
      Expect("by");
      ast::Confirmation confirmation;
      confirmation.by = ParsePostfix();
      Expect(
          "within",
          "say how long to wait: confirmed by grasping(hand, object) within contact(hand, object)");
      confirmation.within = ParsePostfix();
      Once(definition.confirmed, std::move(confirmation), word);
    } else if (Accept("with")) {
      ParseAttribute(definition);
    } else if (Accept("drawn")) {
      Once(definition.drawn, ParseDrawn(word.place), word);
    } else {
      return false;
    }
    return true;
  }

  // `one` and `per` are no keywords: nothing else begins with a name here.
  ast::OnePer ParseOnePer() {
    static const std::string kExample =
        "one hand per object; or: one object per hand, nearest within 100 ms";
    ast::OnePer one_per{.place = Peek().place, .one = {}, .per = {}, .within = {}};
    SkipOne();
    one_per.one = ParsePrimary();
    Expect("per", kExample);
    do {
      one_per.per.push_back(ParsePrimary());
    } while (Accept("and"));
    if (Accept(",")) {
      Expect("nearest", kExample);
      Expect("within", kExample);
      one_per.within = ParseSum();
    }
    return one_per;
  }

  // `with name = value` may follow, so `with ghost` alone is not enough.
  ast::Drawn ParseDrawn(Place place) {
    ast::Drawn drawn{.place = place, .drawing = {}};
    Drawing& drawing = drawn.drawing;
    if (Accept("as")) drawing.as = ParseDrawnAs();
    if (Peek().kind == Token::Kind::kText) drawing.color = ParseColor();
    if (Accept("without")) {
      const bool row = drawing.as == DrawnAs::kRow;
      const bool ghost = drawing.as == DrawnAs::kPhase;
      if (row && Accept("row")) {
        drawing.as = DrawnAs::kNothing;
      } else if (ghost && Accept("ghost")) {
        drawing.ghost = Ghost::kNoGhost;
      } else {
        Fail(std::string(row     ? "expected 'row'"
                         : ghost ? "expected 'ghost'"
                                 : "expected nothing after 'without'") +
                 ", found " + Found(),
             "what is drawn as something has no row: drawn without row; drawn as phase without "
             "ghost");
      }
    } else if (At("with") && At("ghost", 1) && At("at", 2)) {
      if (drawing.as != DrawnAs::kPhase)
        Fail("only a phase has a ghost", "drawn as phase with ghost at end");
      SkipOne();
      SkipOne();
      SkipOne();
      if (Accept("end")) {
        drawing.ghost = Ghost::kAtEnd;
      } else {
        Expect("begin", "a ghost stands where the event begins or where it ends");
      }
    }
    return drawn;
  }

  DrawnAs ParseDrawnAs() {
    if (Accept("phase")) return DrawnAs::kPhase;
    if (Accept("grasp")) return DrawnAs::kGrasp;
    if (Accept("support")) return DrawnAs::kSupport;
    Fail("expected 'phase', 'grasp' or 'support', found " + Found(),
         "any other event is drawn in a row of its own");
  }

  std::uint32_t ParseColor() {
    const std::string& text = Peek().text;
    const bool is_color = text.size() == 7 && text[0] == '#' &&
                          text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (!is_color)
      Fail("expected a colour, found " + Found(), "red, green and blue in two digits: \"#D62728\"");
    return static_cast<std::uint32_t>(std::stoul(Take().text.substr(1), nullptr, 16));
  }

  // `style` is a word of the language only because of `with style = style(hand)`.
  void ParseAttribute(Definition& definition) {
    const Token name = Peek();
    if (!Accept("style")) {
      definition.attributes.push_back({ExpectName("an attribute's name"), name.place, {}});
      Expect("=");
      definition.attributes.back().value = ParseSum();
      return;
    }
    Expect("=");
    Expect("style", "a style comes from the hand: with style = style(hand)");
    const Token bracket = Peek();
    Expect("(");
    Expr role = ParsePrimary();
    ExpectToClose(bracket);
    Once(definition.style, std::move(role), name);
  }
};

/// The place of the first word if it begins a scenario; line 0 otherwise.
Place ScenarioIn(std::string_view text) {
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view here = text.substr(0, text.find('\n'));
    if (here.starts_with("scenario:")) return {line, 1};
    if (!here.empty() && here.front() != '#' && here.front() != '\r') break;
    text.remove_prefix(std::min(text.size(), here.size() + 1));
  }
  return {0, 0};
}

}  // namespace

ast::File Parse(const GrammarText& grammar, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.size();
  if (const Place place = ScenarioIn(grammar.text); place.line > 0) {
    diagnostics.push_back(DiagnosticAt(grammar.file, grammar.text, place,
                                       "expected a grammar, found a scenario",
                                       "the name of a scenario's file ends in .yaml"));
    return {};
  }
  Parser parser(grammar, diagnostics);
  if (diagnostics.size() != before && diagnostics.back().place.line == 0) return {};  // no text
  return parser.ParseFile();
}

std::optional<Quantity> ParseQuantity(const GrammarText& text, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.size();
  Parser parser(text, diagnostics);
  if (diagnostics.size() != before) return std::nullopt;
  return parser.ParseOnlyQuantity();
}

}  // namespace prehend::grammar
