#include "app/cli/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flyball::cli {
namespace {

using Commands = std::vector<CommandDescription>;

std::string names_of(const Commands& commands) {
  std::string out;
  for (const CommandDescription& command : commands)
    out += (out.empty() ? "" : " ") + command.name;
  return out;
}

std::string options_of(const CommandDescription& command) {
  std::string out;
  for (const OptionDescription& option : command.options)
    for (const std::string& name : option.names)
      out += (out.empty() ? "" : " ") + name;
  return out;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// Without the characters that quote or divide in the shells' own tables.
std::string within_quotes(const std::string& text, const std::string& without) {
  std::string out;
  for (const char c : first_line(text))
    out += without.find(c) == std::string::npos ? c : ' ';
  return out;
}

// The words of options that are chosen from a list, as branches on the word before.
std::string choices_of(const CommandDescription& command) {
  std::string out;
  for (const OptionDescription& option : command.options)
    if (!option.choices.empty())
      out += fmt::format("        {}) COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n",
                         fmt::join(option.names, "|"), fmt::join(option.choices, " "));
  return out.empty() ? out : "      case $before in\n" + out + "      esac\n";
}

std::string bash_branch(const std::string& label, const CommandDescription& command) {
  return fmt::format("    {})\n{}      options='{}' ;;\n", label, choices_of(command), options_of(command));
}

std::string zsh_arguments(const CommandDescription& command) {
  std::string out;
  for (const OptionDescription& option : command.options)
    for (const std::string& name : option.names) {
      const std::string text = within_quotes(option.text, "'[]:\\");
      const std::string action = option.value.empty() ? ""
                                 : option.choices.empty()
                                     ? ":value:_files"
                                     : fmt::format(":value:({})", fmt::join(option.choices, " "));
      out += fmt::format(" \\\n        '{}{}[{}]{}'", option.repeated ? "*" : "", name, text, action);
    }
  return out + " \\\n        '*:scene:_files'";
}

std::string fish_lines(const CommandDescription& command) {
  const std::string condition = command.name.empty() ? std::string("__fish_use_subcommand")
                                                     : "__fish_seen_subcommand_from " + command.name;
  std::string out;
  for (const OptionDescription& option : command.options) {
    std::string names;
    for (const std::string& name : option.names)
      names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    const std::string value = option.value.empty() ? ""
                              : option.choices.empty()
                                  ? " -r"
                                  : fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
    out += fmt::format("complete -c flyball -n '{}'{}{} -d '{}'\n", condition, names, value,
                       within_quotes(option.text, "'\\"));
  }
  return out;
}

} // namespace

std::string bash_completion(const ProgramDescription& program) {
  std::string branches;
  for (const CommandDescription& command : program.commands)
    branches += bash_branch(command.name, command);
  branches += bash_branch("*", program.program);
  return fmt::format(R"(# bash completion of flyball
_flyball() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options=
  COMPREPLY=()
  case ${{COMP_WORDS[1]}} in
{0}  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{1}' -- "$current"))
  fi
}}
complete -o default -F _flyball flyball
)",
                     branches, names_of(program.commands));
}

std::string zsh_completion(const ProgramDescription& program) {
  std::string commands, branches;
  for (const CommandDescription& command : program.commands) {
    commands += fmt::format("    '{}:{}'\n", command.name, within_quotes(command.summary, "':\\"));
    branches += fmt::format("    {})\n      _arguments{} ;;\n", command.name, zsh_arguments(command));
  }
  // Autoloaded it is called at once, sourced it is only defined.
  return fmt::format(R"(#compdef flyball
compdef _flyball flyball
_flyball() {{
  local -a commands
  commands=(
{0}  )
  if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then
    _describe command commands
    _files
    return
  fi
  case $words[2] in
{1}    *)
      _arguments{2} ;;
  esac
}}
[[ $funcstack[1] == _flyball ]] && _flyball "$@"
)",
                     commands, branches, zsh_arguments(program.program));
}

std::string fish_completion(const ProgramDescription& program) {
  std::string out = "# fish completion of flyball\n";
  for (const CommandDescription& command : program.commands)
    out += fmt::format("complete -c flyball -n __fish_use_subcommand -a {} -d '{}'\n", command.name,
                       within_quotes(command.summary, "'\\"));
  out += fish_lines(program.program);
  for (const CommandDescription& command : program.commands)
    out += fish_lines(command);
  return out;
}

} // namespace flyball::cli
