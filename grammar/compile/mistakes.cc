// SPDX-License-Identifier: Apache-2.0
#include "grammar/compile/mistakes.h"

#include <algorithm>

#include "grammar/language/parser.h"

namespace prehend::grammar {

Diagnostics InOrder(Diagnostics diagnostics, const Symbols& symbols) {
  std::erase_if(diagnostics, [](const Diagnostic& d) { return d.message.empty(); });
  const auto file = [&](const Diagnostic& d) {
    const auto found = symbols.files.find(d.file);
    return found == symbols.files.end() ? -1 : found->second;
  };
  std::ranges::stable_sort(diagnostics, {},
                           [&](const Diagnostic& d) { return std::pair(file(d), d.place.line); });
  const auto is_same = [](const Diagnostic& a, const Diagnostic& b) {
    return a.file == b.file && a.place.line == b.place.line && a.place.column == b.place.column &&
           a.message == b.message;
  };
  diagnostics.erase(std::unique(diagnostics.begin(), diagnostics.end(), is_same),
                    diagnostics.end());
  return diagnostics;
}

std::function<std::string(std::string_view)> WhoDefines(const Includer& includer,
                                                        const std::vector<std::string>& known) {
  return [&includer, &known, owners = std::map<std::string, std::string, std::less<>>(),
          next = std::size_t{0}](std::string_view name) mutable {
    for (; next < known.size(); ++next) {
      const std::optional<GrammarText> text = includer ? includer(known[next]) : std::nullopt;
      Diagnostics ignored;
      if (!text) continue;
      for (const ast::Definition& definition : Parse(*text, ignored).definitions) {
        std::string& owner = owners[definition.name];
        const bool is_shorter = owner.empty() || known[next].size() < owner.size();
        if (definition.is_event && is_shorter) owner = known[next];
      }
    }
    const auto found = owners.find(name);
    return found == owners.end() ? std::string() : found->second;
  };
}

void WarnOfUnused(const Source& own, const Symbols& symbols, Diagnostics& warnings) {
  const auto warn = [&](Place place, std::string message, std::string hint) {
    Diagnostic warning =
        DiagnosticAt(own.text.file, own.text.text, place, std::move(message), std::move(hint));
    warning.is_warning = true;
    warnings.push_back(std::move(warning));
  };
  for (const ast::Param& param : own.file.params) {
    if (symbols.used_params.contains(symbols.params.find(param.name)->second)) continue;
    warn(param.place, "the parameter '" + param.name + "' is not used", "use it, or leave it out");
  }
  for (const ast::Define& define : own.file.defines) {
    if (symbols.used_defines.contains(define.name)) continue;
    warn(define.place, "the definition '" + define.name + "' is not used",
         "use it, or leave it out");
  }
  IdVector<RuleId, char> reached(symbols.program.rules.size());
  for (auto rule = symbols.program.schedule.rbegin(); rule != symbols.program.schedule.rend();
       ++rule) {
    if (!reached[*rule] && !symbols.program.rules[*rule].printed) continue;
    reached[*rule] = true;
    for (const Reference& reference : symbols.program.rules[*rule].references)
      reached[reference.rule] = true;
  }
  for (const ast::Definition& definition : own.file.definitions) {
    if (reached[symbols.rules.find(definition.name)->second]) continue;
    warn(definition.place, "no event uses the condition '" + definition.name + "'",
         "make it an event, use it, or leave it out");
  }
}

}  // namespace prehend::grammar
