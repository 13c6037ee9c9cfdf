// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/language/dump_file.h"

#include <string_view>
#include <utility>

namespace prehend::grammar::ast {
namespace {

std::string Joined(const std::vector<Expr>& args, const std::string& separator) {
  std::string text;
  for (const Expr& arg : args) text += (text.empty() ? "" : separator) + Dump(arg);
  return text;
}

std::string DumpUntil(const Definition& d) {
  std::string text = "until " + Dump(d.first) + " since " + Dump(d.second);
  if (d.approach) {
    const Approach& a = *d.approach;
    text += " approaching " + Dump(a.signal) + " receding at most " + Dump(a.slack);
    if (a.over) text += " over " + Dump(*a.over);
    if (a.speed) {
      const std::string motion = a.motion ? "with " + Dump(*a.motion) + " " : "";
      text += ", " + motion + "slower than " + Dump(*a.speed);
      if (a.still) text += " or within " + Dump(*a.still) + " over " + Dump(*a.still_over);
      text += " at most " + Dump(*a.idle);
    }
    if (a.onset) text += ", onset " + Dump(*a.onset);
  }
  return text + " at most " + Dump(d.at_most_back) + " back";
}

std::string DumpCompose(const Definition& d) {
  std::string text = d.all_of ? "all of " : d.first_of_equals ? "compose first " : "compose ";
  for (const Part& part : d.parts) {
    text += (&part == &d.parts.front() ? "" : ", ") + part.label +
            (part.label.empty() ? "" : ": ") + Joined(part.calls, " or ");
  }
  std::string comma = " where ";
  for (const Relation& relation : d.relations) {
    text += std::exchange(comma, ", ") + relation.left + " ";
    for (const Relation::Alternative& one : relation.alternatives) {
      text += (&one == &relation.alternatives.front() ? "" : "|") + one.name;
      if (one.within) text += " within " + Dump(*one.within);
    }
    text += " " + relation.right;
  }
  for (const Absence& absence : d.absences)
    text += std::exchange(comma, ", ") + "without " + Dump(absence.call) + " between " +
            absence.left + " and " + absence.right;
  return text + (d.within ? " within " + Dump(*d.within) : "");
}

std::string DumpForm(const Definition& d) {
  switch (d.form) {
    case Definition::Form::kWhile:
      return "while " + Dump(d.first) + (d.until ? " until " + Dump(*d.until) : "");
    case Definition::Form::kFromTo: {
      std::string text = (d.each ? "from each " : "from ") + Dump(d.first) +
                         (d.absence ? " without " : " to ") + Dump(d.second);
      if (d.within) text += " within " + Dump(*d.within);
      if (d.during) text += " during " + Dump(*d.during) + (d.or_drop ? " or drop" : "");
      return text;
    }
    case Definition::Form::kUntilSince:
      return DumpUntil(d);
    case Definition::Form::kRestOf:
      return "rest of " + Dump(d.first) + " outside " + Joined(d.outside, ", ");
    case Definition::Form::kCompose:
      return DumpCompose(d);
    case Definition::Form::kOtherwise:
      return "otherwise";
    case Definition::Form::kRepeat:
      return "repeat " + Joined(d.repeated, " or ") + " at least " + Dump(d.at_least) +
             (d.gap ? ", gap at most " + Dump(*d.gap) : " within " + Dump(*d.within));
  }
  return {};
}

std::string DumpDrawing(const Drawing& drawing) {
  std::string text;
  if (drawing.as == DrawnAs::kPhase) text += " as phase";
  if (drawing.as == DrawnAs::kGrasp) text += " as grasp";
  if (drawing.as == DrawnAs::kSupport) text += " as support";
  if (drawing.color) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    text += " \"#";
    for (int shift = 20; shift >= 0; shift -= 4) text += kDigits[*drawing.color >> shift & 15];
    text += '"';
  }
  if (drawing.as == DrawnAs::kNothing) text += " without row";
  if (drawing.ghost == Ghost::kNoGhost) text += " without ghost";
  if (drawing.ghost == Ghost::kAtEnd) text += " with ghost at end";
  return text;
}

std::string DumpHead(const std::string& name, const std::vector<Role>& roles) {
  std::string text = name + "(";
  for (const Role& role : roles)
    text += (&role == &roles.front() ? "" : ", ") + role.name + ": " + role.class_name;
  return text + ") ";
}

std::string DumpDefinition(const Definition& d) {
  std::string text = d.symmetric ? "symmetric event " : d.is_event ? "event " : "condition ";
  text += DumpHead(d.name, d.roles) + DumpForm(d);
  if (d.bridging) text += " bridging " + Dump(*d.bridging);
  if (d.one_per) {
    text += " one " + Dump(d.one_per->one) + " per " + Joined(d.one_per->per, " and ");
    if (d.one_per->within) text += ", nearest within " + Dump(*d.one_per->within);
  }
  if (d.lasting) text += " lasting " + Dump(*d.lasting);
  if (d.lasting_to) text += " to " + Dump(*d.lasting_to);
  if (d.requirement) text += " requires " + Dump(*d.requirement);
  if (d.confirmed)
    text += " confirmed by " + Dump(d.confirmed->by) + " within " + Dump(d.confirmed->within);
  if (d.style) text += " with style = style(" + Dump(*d.style) + ")";
  for (const Attribute& attribute : d.attributes)
    text += " with " + attribute.name + " = " + Dump(attribute.value);
  if (d.drawn) text += " drawn" + DumpDrawing(d.drawn->drawing);
  return text + "\n";
}

std::string DumpDefine(const Define& define) {
  std::string text = "define " + define.name + "(";
  for (const Role& parameter : define.parameters) {
    text += (&parameter == &define.parameters.front() ? "" : ", ") + parameter.name + ": " +
            parameter.class_name;
  }
  return text + ") = " + Dump(define.body) + "\n";
}

std::string DumpSettings(const Use& use) {
  std::string text;
  for (const Param& setting : use.settings)
    text += (text.empty() ? " with " : ", ") + setting.name + " = " + QuantityText(setting.value);
  return text;
}

}  // namespace

std::string Dump(const File& file) {
  std::string text = "grammar " + file.name + "\n";
  for (const Use& use : file.uses)
    text += "use " + (use.is_path ? '"' + use.name + '"' : use.name) +
            (use.variant.empty() ? "" : " from " + use.variant) + DumpSettings(use) + "\n";
  for (const Param& param : file.params)
    text += "param " + param.name + " = " + QuantityText(param.value) + "\n";
  for (const Define& define : file.defines) text += DumpDefine(define);
  for (const Definition& definition : file.definitions) text += DumpDefinition(definition);
  for (const Law& law : file.laws)
    text += "law " + DumpHead(law.name, law.roles) + Dump(law) + "\n";
  return text;
}

}  // namespace prehend::grammar::ast
