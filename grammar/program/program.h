// SPDX-License-Identifier: Apache-2.0
// A compiled grammar: flat, immutable tables that any number of monitors share.
// Expressions are trees of nodes in one array; a node names its arguments by NodeId.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "grammar/base/allen.h"
#include "grammar/base/check.h"
#include "grammar/base/diagnostic.h"
#include "grammar/base/drawing.h"
#include "grammar/base/event.h"
#include "grammar/base/ids.h"
#include "grammar/base/quantity.h"
#include "grammar/base/source.h"
#include "grammar/program/law.h"
#include "grammar/program/operators.h"
#include "grammar/program/thresholds.h"

namespace prehend::grammar {

/// A comparison that is answered by thresholds, when its value is measured.
struct ByThreshold {
  NodeId value;  ///< that is compared; kNone: it is not that simple
  std::array<int, 2> thresholds = {
      kNone,
      kNone};  ///< of a touch between its first and second role, and of one named the other way
  bool when_crossed = false;  ///< true where the threshold is crossed, else where it is not
  int known = kNone;          ///< another one, crossed where there is a value; kNone: always
};

struct Node {
  Op op = Op::kNumber;
  std::array<NodeId, 4> args = {};
  std::array<int, 2> roles = {kNone, kNone};  ///< roles of the rule
  int slot = kNone;                           ///< reference, anchor or class name
  int name = kNone;        ///< kSensorSet: index into Program::sensor_sets; or axes, see Op
  double number = 0;       ///< kNumber, kSensorSet, kTouchIn, kNormalIn, and windows in seconds
  int window = kNone;      ///< index into Program::windows, of a node with a window
  bool needs_end = false;  ///< a value or a comparison of values that is not known before the
                           ///< interval's end is
  bool by_itself = false;  ///< likewise, that may change with time alone, though nothing that it
                           ///< is made of changes
  ByThreshold by_threshold = {};
  int shared = kNone;  ///< nodes with the same number have the same value for the same entities ..
  std::array<int, 2> shared_roles = {kNone, kNone};  ///< .. in these roles
};

/// Thresholds that something measured must have crossed, and such that it must not have.
struct Limits {
  ThresholdSet crossed = 0;
  ThresholdSet not_crossed = 0;
  bool Fit(ThresholdSet measured) const {
    return (measured & crossed) == crossed && (measured & not_crossed) == 0;
  }
};

/// What must be so of one touch and of one hand's grip for a condition to be true: answered by two
/// sets of bits.
struct MeasuredPart {
  int touch = kNone;  ///< reference to the two that touch; kNone: no touch matters
  int first =
      kNone;  ///< role: whom `press[0]` takes for the first of the two, `press[1]` for the second
  bool must_touch = false;
  std::array<Limits, 2> press;
  int hand = kNone;  ///< role; kNone: no grip matters
  Limits grip;
  bool whole = true;     ///< the condition is nothing else
  bool instant = false;  ///< and nothing else decides when the rule's interval begins and ends, and
                         ///< that it is one
  bool is_empty() const { return touch == kNone && hand == kNone; }
};

/// One number per role.
using Binding = std::array<int, kMaxRoles>;
inline constexpr Binding kUnbound = {kNone, kNone, kNone, kNone};

/// Another rule, bound to roles of this one: its role i is roles[i].
struct Reference {
  RuleId rule;
  Binding roles = kUnbound;
};

struct RuleRole {
  std::string name;
  std::string class_name;
};

/// The forms of rules, in the order of RuleForm.
enum class Form : std::uint8_t {
  kTouching,
  kAny,
  kWhile,
  kFromTo,
  kUntilSince,
  kRestOf,
  kCompose,
};

/// `touching`: the fact itself, as frames give it.
struct TouchingRule {};

/// Made for an `any`: so many bindings of the rule of references[0] hold at once. With `one`, made
/// for `one .. per`: one of these bindings at a time, with the entity that it has in that role.
struct AnyRule {
  int one = kNone;      ///< role of the rule of references[0]
  double within_s = 0;  ///< of those that begin so soon after the first, the nearest
  int at_least = 1;
};

/// `while condition until until`; or `repeat`, whose condition is that one of `counted` holds.
struct WhileRule {
  NodeId condition;
  NodeId until;                   ///< kNone: until `condition` is false
  double bridging_s = 0;          ///< gaps up to this length do not end an interval
  int at_least = 0;               ///< intervals of `counted` in each of this; 0: nobody counts
  std::vector<int> counted = {};  ///< references
};

/// `from from to to during during`, or `without` in place of `to`.
struct FromToRule {
  NodeId from;
  NodeId to;
  NodeId during;         ///< kNone: nothing has to hold
  bool or_drop = false;  ///< an interval that does not reach `to` is dropped
  bool absence = false;  ///< `without`: an interval that reaches `to` is dropped
  bool each = false;     ///< `from each`: what comes too late for one may be in time for the next
  double within_s = -1;  ///< how long to wait for `to`; negative: forever
};

/// `approaching`: a signal that must not recede on the way to the end of the interval.
struct Approach {
  NodeId signal;
  double slack = 0;    ///< how far it may recede, in the signal's unit
  double over_s = 0;   ///< its median over so long must not recede; 0: nor must single values
  NodeId motion;       ///< the speed of the movement; kNone: as fast as the signal falls
  double speed = 0;    ///< slower is a pause; in the unit of the motion
  double onset = 0;    ///< likewise: from this speed on a movement begins; 0: at the turning point
  double idle_s = -1;  ///< a longer pause ends the way back; negative: pauses may last
  int hand = kNone;    ///< role: staying within `still_m` is a pause, too
  double still_m = 0;  ///< of each piece of the hand's surface, from where it is
  double still_s = 0;  ///< within half of this before and after
  /// How far before a frame it looks; after a frame it does not look beyond the interval's end.
  double looks_around_s() const { return (over_s > still_s ? over_s : still_s) / 2; }
};

/// `until until since since`: looks back from where `until` becomes true.
struct UntilSinceRule {
  NodeId until;
  NodeId since;
  std::optional<Approach> approach;
  double back_s = 0;  ///< how far it looks back
};

/// `rest of whole outside outside, ..`
struct RestOfRule {
  int whole = kNone;         ///< reference
  std::vector<int> outside;  ///< references
};

/// More parts than this are better composed in steps.
inline constexpr int kMaxParts = 8;

/// `compose` or `all of`: its parts and how they must lie to each other. Or `repeat .. within`.
struct ComposeRule {
  struct Clause {
    int left = 0;
    int right = 0;
    AllenSet relations = 0;
    std::array<double, kAllenNames.size()> within_s = {};  ///< by relation; negative: none was said

    /// `at_most`: seconds in ticks, rounded down.
    template <typename AtMost>
    Relations In(const AtMost& at_most) const {
      Relations in_ticks{.any = relations};
      for (std::size_t i = 0; i < within_s.size(); ++i)
        in_ticks.within[i] = within_s[i] < 0 ? -1 : at_most(within_s[i]);
      return in_ticks;
    }
  };
  /// No interval of part `part` may lie between `left` and `right`, not even in part.
  struct Absence {
    int part = 0;
    int left = 0;
    int right = 0;
  };
  std::vector<int> parts;    ///< references; behind them those of `absences` and other choices
  std::vector<int> lists;    ///< by part: the one for which its intervals can stand
  int count = 0;             ///< of the parts that must be there
  bool has_choices = false;  ///< `a: E or F`: the intervals of a part may overlap
  bool first = false;        ///< `compose first`: of equals the one that begins first
  /// By default for itself; returns its number.
  int AddPart(int reference, int list = kNone) {
    parts.push_back(reference);
    lists.push_back(list == kNone ? static_cast<int>(lists.size()) : list);
    return lists.back();
  }
  std::vector<Clause> clauses;
  std::vector<Absence> absences;
  bool hull = false;  ///< `all of`: from where the first of them begins to where the last one ends
  int at_least = 0;   ///< `repeat .. within`: so many intervals of the parts; 0: one of each
  double within_s = 0;  ///< `hull` or `at_least`: all of it lasts at most so long
  /// The parts with which it may begin: so many.
  std::size_t may_begin() const {
    return hull || at_least > 0 ? static_cast<std::size_t>(count) : 1;
  }
  /// Of those that are equal otherwise the one with the least is taken.
  Tick BySkip(Tick begin) const { return first ? begin : -begin; }
  bool MayBegin(std::size_t part) const {
    return static_cast<std::size_t>(lists[part]) < may_begin();
  }
  /// References that can stand for a part.
  std::vector<int> ChoicesFor(int part) const {
    std::vector<int> choices;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (lists[i] == part) choices.push_back(parts[i]);
    return choices;
  }
};

/// What a rule of one form has and the others have not.
using RuleForm = std::variant<TouchingRule, AnyRule, WhileRule, FromToRule, UntilSinceRule,
                              RestOfRule, ComposeRule>;

/// `with name = value`: a number that the event carries.
struct RuleAttribute {
  std::string name;
  NodeId node;  ///< asked for where the interval ends
  Dimension dimension;
};

/// A rule is part `part` of the composition `rule`.
struct PartOf {
  RuleId rule;
  int part = 0;
};

struct Rule {
  std::string name;
  std::string file;
  Place place;
  std::vector<RuleRole> roles;
  bool printed = false;    ///< an event, not a condition
  bool hidden = false;     ///< made by the compiler
  bool symmetric = false;  ///< bound once per pair, names in alphabetical order

  RuleForm of_form;
  Form form() const { return static_cast<Form>(of_form.index()); }
  /// The part of this form; the rule must have it.
  template <typename Part>
  const Part& As() const {
    PREHEND_DCHECK(std::holds_alternative<Part>(of_form));
    return *std::get_if<Part>(&of_form);
  }
  template <typename Part>
  Part& As() {
    PREHEND_DCHECK(std::holds_alternative<Part>(of_form));
    return *std::get_if<Part>(&of_form);
  }
  /// Null if the rule has another form.
  template <typename Part>
  const Part* If() const {
    return std::get_if<Part>(&of_form);
  }
  /// `without` that may speak of its begin: what came for one begin need not come for the next.
  bool TriesEachBegin() const {
    const auto* from_to = If<FromToRule>();
    return from_to != nullptr && from_to->absence && !anchors.empty();
  }

  double lasting_s = 0;
  double lasting_most_s = -1;  ///< negative: as long as it likes
  NodeId requirement;
  int confirmed_by = kNone;      ///< reference
  int confirmed_within = kNone;  ///< reference
  int style_role = kNone;
  std::vector<RuleAttribute> attributes;  ///< at most kMaxAttributes
  Drawing drawing;

  std::vector<Reference> references;
  std::vector<NodeId> anchors;  ///< whose values are kept from where an interval begins

  /// While this reference is false and known, nothing of this rule begins. kNone: watch every
  /// binding.
  int guard = kNone;
  bool guarded_begin =
      false;  ///< nor where it has just ended: at each moment of beginning it must be true
  int opened_by =
      kNone;  ///< reference: nothing of this rule begins but where that begins; kNone: it may
  bool opened_by_end = false;   ///< where it ends
  std::vector<PartOf> part_of;  ///< compositions that collect its intervals
  bool referenced = false;      ///< another rule asks for its truth
  bool uses_looks = false;      ///< asks for poses, hands or touches of the frames it looks at
  // What its condition asks at every frame, by role: an entity's pose; nothing but a hand's grip.
  std::array<bool, kMaxRoles> watches_pose = {};
  std::array<bool, kMaxRoles> watches_grip = {};
  ThresholdSet watches_press =
      0;  ///< what matters of how entities touch, apart from whether they do
  ThresholdSet watches_grips = 0;  ///< what matters of how far hands are closed
  MeasuredPart measured;           ///< of what must be true where something begins; may be empty
  double looks_around_s =
      0;            ///< its signals ask for poses so long before and after the frames it looks at
  int windows = 0;  ///< in so many windows, one in another
  bool anchors_at_hand =
      false;  ///< there are anchors, and it does not happen that some are known and others are not
};

/// The nodes of the conditions that make its form: `while`, `from`, `to`, `during`, `until`,
/// `since`. None for the forms that are made of other rules.
std::vector<NodeId> ConditionsOf(const Rule& rule);
/// Null if nothing is approached.
const Approach* ApproachOf(const Rule& rule);

/// What stood in the grammar for a node, for explanations.
struct NodeNote {
  std::string text;  ///< "rise({1}) >= lift_rise", {1} being the rule's second role; may be empty,
                     ///< may be cut
  Dimension dimension;
  std::string file;
  Place place;
};

struct ProgramParam {
  std::string name;
  Quantity value;
  bool overridden = false;
  std::string file;
  Place place;
};

/// A window of time around a frame: from `seconds` / 2 before it to as much after it.
struct TimeWindow {
  double seconds = 0;
  bool inside = false;  ///< the frames in it; else to those at its ends, or right beyond them
  friend bool operator==(const TimeWindow&, const TimeWindow&) = default;
};

/// What a program was compiled from.
struct ProgramTexts {
  GrammarText grammar;
  std::map<std::string, GrammarText, std::less<>> used;  ///< by the names that `use` asked for
  Overrides overrides;
};

/// Rule 0 is always `touching`. Event::rule indexes `rules`; only the printed ones appear in
/// output.
struct Program {
  std::string name;
  std::size_t text_hash = 0;  ///< of all texts that it was compiled from
  IdVector<RuleId, Rule> rules;
  std::vector<RuleId> schedule;  ///< rules so that each comes after those it refers to
  IdVector<NodeId, Node> nodes;
  IdVector<NodeId, NodeNote> notes;         ///< of the first so many nodes
  std::vector<std::string> class_names;     ///< for kIsA
  std::vector<NameInSource> sensor_sets;    ///< for kSensorSet
  std::vector<NameInSource> numbered_sets;  ///< "3": sensor sets that are asked for by number
  std::vector<NameInSource> named_classes;  ///< all but the built-in ones
  Diagnostics warnings;                     ///< what Compile() warned of
  std::vector<ProgramParam> params;
  std::vector<Law> laws;  ///< in the order of the files
  std::vector<Threshold>
      thresholds;  ///< at most kMaxThresholds; what is compared with others counts as kAnyChange
  std::vector<TimeWindow> windows;  ///< that nodes ask for, each once
  bool asks_touches = false;     ///< for values of a touch, not only for thresholds it has crossed
  bool recalls_touches = false;  ///< for thresholds that it had crossed in earlier frames
  std::shared_ptr<const ProgramTexts> texts;  ///< that it was compiled from
  bool waits = true;  ///< for what others decide later; false, in tests: steps each frame at once
};

inline constexpr RuleId kTouchingRule(0);

// Whether every number in a compiled program names something of it. Asked once, in every build,
// when a grammar has been compiled: then the engine need not ask at every frame. What it indexes by
// such numbers is checked again in debug builds only (grammar/base/ids.h).
// Tested by tests/grammar/program/check_ids_test.cc

/// Throws std::logic_error, which says what is not so, if a rule, node, reference, role, anchor,
/// name or threshold is named that the program does not have, or if a node is among its own
/// arguments.
void CheckIds(const Program& program);

}  // namespace prehend::grammar
