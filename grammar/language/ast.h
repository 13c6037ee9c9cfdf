// SPDX-License-Identifier: Apache-2.0
// The syntax tree of one grammar file: what was written, names not yet looked up. A value; Dump()
// shows it as text. Tested by tests/grammar/language/parser_test.cc
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/drawing.h"
#include "grammar/base/quantity.h"

namespace prehend::grammar::ast {

/// The text of a call that is written `at least n of E(..)`; its args are n and E(..).
inline constexpr char kAtLeast[] = "at least";

struct Expr {
  enum class Kind {
    kQuantity,  ///< 25 cm
    kName,      ///< a role, a parameter, or `any`; `any Cup` has the class as its arg
    kText,      ///< "in quotes"
    kCall,      ///< text(args)
    kUnary,     ///< text is `not`, `known` or `-`
    kBinary,    ///< text is an arithmetic operator or a comparison
    kChain,     ///< text is `and` or `or`; two or more args
    kEdge,      ///< text is `begins` or `ends`
    kAnchor,    ///< text is `begin` or `end`: the arg's value there
  };
  Kind kind = Kind::kName;
  Place place;
  std::string text;
  Quantity quantity;
  std::vector<Expr> args;
  int depth = 1;
  Place begin, end;  ///< of all of it, with the brackets around it; end: behind it
};

struct Role {
  std::string name;
  std::string class_name;
  Place place;
};

/// `approaching signal receding at most slack [over over] [, [with motion] slower than speed
/// [or within still over still_over] at most idle] [, onset speed]`
struct Approach {
  Expr signal;
  Expr slack;
  std::optional<Expr> over;
  std::optional<Expr> motion;
  std::optional<Expr> speed;
  std::optional<Expr> still;
  std::optional<Expr> still_over;
  std::optional<Expr> idle;
  std::optional<Expr> onset;
};

/// `with name = value`
/// `one hand per object, nearest within t`
struct OnePer {
  Place place;
  Expr one;               ///< the role of which there is one at a time
  std::vector<Expr> per;  ///< the roles that share it
  std::optional<Expr> within;
};

struct Attribute {
  std::string name;
  Place place;
  Expr value;
};

/// `drawn as phase "#D62728" with ghost at end`
struct Drawn {
  Place place;
  Drawing drawing;
};

struct Confirmation {
  Expr by;
  Expr within;
};

/// `label: event(roles) or event(roles)` of a composition; of `all of`, the label may be left out.
struct Part {
  std::string label;
  Place place;
  std::vector<Expr> calls;  ///< an interval of one of them
};

/// `left relation [within t]|relation [within t] right` between two labels of a composition.
struct Relation {
  struct Alternative {
    std::string name;
    Place place;
    std::optional<Expr> within;
  };
  std::string left;
  std::vector<Alternative> alternatives;
  std::string right;
  Place place, right_place;
};

/// `without event(roles) between left and right`, likewise.
struct Absence {
  Expr call;
  std::string left;
  std::string right;
  Place left_place, right_place;
};

struct Definition {
  enum class Form { kWhile, kFromTo, kUntilSince, kRestOf, kCompose, kRepeat, kOtherwise };
  bool is_event = true;
  bool symmetric = false;
  std::string name;
  Place place;
  std::vector<Role> roles;

  Form form = Form::kWhile;
  Expr first;                  ///< while F, from A, until A, rest of E
  Expr second;                 ///< to B, without B, since F
  std::optional<Expr> until;   ///< while A until B
  bool absence = false;        ///< from A without B
  bool each = false;           ///< from each A to B
  std::optional<Expr> within;  ///< from .. within t, all of .. within t, repeat .. within t
  std::optional<Expr> during;
  bool or_drop = false;  ///< `during G or drop`
  std::optional<Approach> approach;
  Expr at_most_back;
  std::vector<Expr> repeated;  ///< repeat E or F
  Expr at_least;               ///< repeat E at least n
  std::optional<Expr> gap;     ///< repeat E .. gap at most t
  std::vector<Expr> outside;
  std::vector<Part> parts;
  std::vector<Relation> relations;
  std::vector<Absence> absences;
  bool all_of = false;           ///< kCompose: all of E, F
  bool first_of_equals = false;  ///< kCompose: compose first a: E, ..

  std::optional<Expr> bridging;
  std::optional<OnePer> one_per;
  std::optional<Expr> lasting;
  std::optional<Expr> lasting_to;  ///< lasting t1 to t2
  std::optional<Expr> requirement;
  std::optional<Confirmation> confirmed;
  std::optional<Expr> style;  ///< with style = style(hand)
  std::vector<Attribute> attributes;
  std::optional<Drawn> drawn;
};

/// `define name(parameters) = body`. A parameter's class may also be a unit, `number` or
/// `position`.
struct Define {
  std::string name;
  Place place;
  std::vector<Role> parameters;
  std::vector<Dimension> dimensions;  ///< of the parameters that are numbers
  Expr body;
};

/// What must hold of the events of every episode.
struct Law {
  enum class Form {
    kCovered,  ///< rest of E outside X, Y is empty
    kRelated,  ///< E, F meets X or Y
    kApart,    ///< E, F do not overlap
  };
  std::string name;
  Place place;
  std::vector<Role> roles;
  Form form = Form::kCovered;
  std::vector<Expr> subjects;          ///< events that it speaks about
  std::vector<std::string> relations;  ///< kRelated: Allen's, or `lies inside` alone
  Place relations_place;
  std::vector<Expr> others;  ///< X, Y
};

struct Param {
  std::string name;
  Place place;
  Quantity value;
};

struct Use {
  std::string name;     ///< of the library, or a path as seen from this file
  std::string variant;  ///< `use name from variant`: `name_from_variant` takes its place
  bool is_path = false;
  Place place;
  std::vector<Param> settings = {};  ///< `use name with param = value`
};

struct File {
  std::string name;
  std::vector<Use> uses;
  std::vector<Param> params;
  std::vector<Define> defines;
  std::vector<Definition> definitions;
  std::vector<Law> laws;
  std::set<std::string> broken;  ///< names of what could not be read
  bool is_incomplete = false;    ///< nor is it known what else is missing
};

std::string Dump(const Expr& expr);
/// What the law says, without its name and roles.
std::string Dump(const Law& law);

}  // namespace prehend::grammar::ast
