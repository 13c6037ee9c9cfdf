// SPDX-License-Identifier: Apache-2.0
// write_manual FOLDER: the manual page and the completions of bash and zsh, from the tree of
// commands, when the program is built. Tested by tests/install/installed.py
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "harness/cli/cli/command_line.h"

namespace prehend::cli {
namespace {

/// Text in a manual page: a dash stays one, and no line is a request.
std::string Roff(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\\') {
      quoted += "\\\\";
    } else if (c == '-') {
      quoted += "\\-";
    } else {
      if ((c == '.' || c == '\'') && (quoted.empty() || quoted.back() == '\n')) quoted += "\\&";
      quoted += c;
    }
  }
  return quoted;
}

std::string ManualPage(const std::vector<Command>& commands, const ProgramDescription& program) {
  std::string page = fmt::format(
      ".TH PREHEND 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\nprehend \\- tests grammars of "
      "activities\n.SH SYNOPSIS\n.B prehend\n.I COMMAND\n[\n.I OPTIONS\n]\n.SH DESCRIPTION\n{}\n",
      program.version, Roff(program.summary));
  page += ".SH COMMANDS\n";
  for (const Command& command : commands) {
    page += fmt::format(".SS prehend {}\n{}\n", Roff(command.name), Roff(command.summary));
    for (const Option& option : command.options) {
      if (option.unlisted) continue;
      page += fmt::format(".TP\n.B {}{}\n{}\n", Roff(option.name),
                          option.placeholder.empty() ? "" : " " + Roff(option.placeholder),
                          Roff(option.help));
    }
    if (!command.examples.empty()) page += ".PP\nFor example:\n.nf\n";
    for (const std::string& example : command.examples)
      page += fmt::format("    prehend {}\n", Roff(example));
    if (!command.examples.empty()) page += ".fi\n";
  }
  return page + fmt::format(".SH OPTIONS AND EXIT CODES\n.nf\n{}\n.fi\n", Roff(program.footer));
}

/// What may follow each of the words so far: "" -> commands and nouns, "episode" -> its commands.
std::map<std::string, std::set<std::string>> NextWords(const std::vector<Command>& commands) {
  std::map<std::string, std::set<std::string>> next;
  for (const Command& command : commands) {
    std::istringstream words(command.name);
    std::string so_far;
    for (std::string word; words >> word; so_far += (so_far.empty() ? "" : " ") + word)
      next[so_far].insert(word);
    for (const Option& option : command.options)
      if (option.name.starts_with("-")) next[so_far].insert(option.name);
    next[so_far].insert("--help");
  }
  return next;
}

std::string BashCompletion(const std::vector<Command>& commands) {
  std::string cases;
  for (const auto& [so_far, next] : NextWords(commands))
    cases += fmt::format("    '{}') words='{}' ;;\n", so_far, fmt::join(next, " "));
  return R"sh(# Completion of prehend for bash; zsh reads it, too (_prehend).
_prehend() {
  local current=${COMP_WORDS[COMP_CWORD]} so_far=${COMP_WORDS[1]} words=''
  [ "$COMP_CWORD" -gt 1 ] || so_far=''
  case $so_far in
    episode|grammar|scenario)
      if [ "$COMP_CWORD" -gt 2 ]; then so_far="$so_far ${COMP_WORDS[2]}"; fi ;;
  esac
  case $so_far in
)sh" + cases +
         R"sh(  esac
  case $so_far in
    run|check|accept|review|render|figure|explain|score)
      case $current in
        -*) ;;
        *) words="$words $(prehend list 2>/dev/null | sed -n 's/^\([^ ]\{1,\}\).*/\1/p')" ;;
      esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -o bashdefault -F _prehend prehend
)sh";
}

constexpr const char* kZshCompletion = R"(#compdef prehend
# Completion of prehend for zsh, by that of bash.
autoload -U +X bashcompinit && bashcompinit
source /usr/share/bash-completion/completions/prehend
)";

bool WriteAll(const std::string& folder) {
  const std::vector<Command> commands = AllCommands();
  const std::map<std::string, std::string> files = {
      {"prehend.1", ManualPage(commands, DescribeProgram("prehend " PREHEND_VERSION))},
      {"prehend.bash", BashCompletion(commands)},
      {"_prehend", kZshCompletion}};
  bool all = true;
  for (const auto& [name, text] : files)
    all = (std::ofstream(folder + "/" + name) << text).flush().good() && all;
  return all;
}

}  // namespace
}  // namespace prehend::cli

int main(int argc, char** argv) { return argc == 2 && prehend::cli::WriteAll(argv[1]) ? 0 : 3; }
