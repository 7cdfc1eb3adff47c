#include "app/cli/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace flyball::cli {
namespace {

// As text that roff takes for nothing else.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool begins = out.empty() || out.back() == '\n';
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

// What an option takes, as it stands behind its name.
std::string taken(const OptionDescription& option) {
  if (option.value.empty()) return "";
  std::string word = option.value;
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
  return italic(word) + (option.repeated ? " ..." : "");
}

std::string explained(const OptionDescription& option) {
  std::string out = plain(sentence(option.text));
  if (!option.limits.empty()) out += " A value " + plain(sentence(option.limits));
  if (!option.choices.empty()) {
    out += " One of ";
    for (std::size_t i = 0; i < option.choices.size(); ++i)
      out += (i == 0 ? "" : i + 1 == option.choices.size() ? " and " : ", ") + bold(option.choices[i]);
    out += ".";
  }
  if (!option.standard.empty()) out += " Default: " + bold(option.standard) + ".";
  if (option.required) out += " Required.";
  return out;
}

std::string entries(const char* title, const std::vector<OptionDescription>& options) {
  if (options.empty()) return "";
  std::string out = fmt::format(".SH {}\n", title);
  for (const OptionDescription& option : options) {
    std::string names;
    for (const std::string& name : option.names)
      names += (names.empty() ? "" : ", ") + (name.starts_with('-') ? bold(name) : italic(name));
    const std::string value = option.names.front().starts_with('-') ? taken(option) : "";
    out += fmt::format(".TP\n{}{}{}\n{}\n", names, value.empty() ? "" : " ", value, explained(option));
  }
  return out;
}

std::string synopsis(const CommandDescription& command) {
  std::string out = ".SH SYNOPSIS\n" + bold("flyball");
  if (!command.name.empty()) out += " " + bold(command.name);
  for (const OptionDescription& positional : command.positionals)
    out += positional.required ? " " + italic(positional.names.front())
                               : " [" + italic(positional.names.front()) + "]";
  return out + " [" + italic("options") + "]\n";
}

std::string head(const std::string& page, const std::string& name, const std::string& summary) {
  std::string title = page;
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(".TH {} 1 \"{}\" \"flyball {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", plain(title),
                     FLYBALL_DATE, FLYBALL_VERSION, plain(name), plain(summary));
}

std::string tail(const CommandDescription& command) {
  std::string out =
      ".SH EXIT STATUS\n.TP\n0\nDone; also where the state found is unstable.\n.TP\n1\nNo result: no "
      "steady state, or none was found; the reason is printed.\n.TP\n2\nUsage, scene file or "
      "address is wrong.\n";
  if (!command.example.empty()) out += ".SH EXAMPLE\n.EX\n" + plain(command.example) + "\n.EE\n";
  return out;
}

} // namespace

std::string man_page(const CommandDescription& command) {
  std::string summary = command.summary.substr(0, command.summary.find('\n'));
  return head("flyball-" + command.name, "flyball-" + command.name, summary) + synopsis(command) +
         ".SH DESCRIPTION\n" + plain(sentence(command.summary)) + "\n" +
         entries("ARGUMENTS", command.positionals) + entries("OPTIONS", command.options) + tail(command) +
         ".SH SEE ALSO\n.BR flyball (1)\n";
}

std::string man_page(const ProgramDescription& program) {
  const CommandDescription& alone = program.program;
  std::string out = head("flyball", "flyball", "steady states of mechanisms driven at constant speed") +
                    ".SH SYNOPSIS\n" + bold("flyball") + " [" + italic("scene") + "] [" + italic("options") +
                    "]\n.br\n" + bold("flyball") + " " + italic("command") + " " + italic("scene") + " [" +
                    italic("options") + "]\n.SH DESCRIPTION\n" + plain(alone.summary) + "\n.SH COMMANDS\n";
  for (const CommandDescription& command : program.commands)
    out += ".TP\n.BR flyball\\-" + plain(command.name) + " (1)\n" + plain(sentence(command.summary)) + "\n";
  return out + entries("ARGUMENTS", alone.positionals) + entries("OPTIONS", alone.options) +
         ".SH ENVIRONMENT\n.TP\n" + bold("FLYBALL_OFFSCREEN") +
         "\nWhat draws without a display: " + bold("osmesa") + " or " + bold("egl") +
         ". Default: OSMesa where it is installed, else EGL.\n" + tail(alone);
}

} // namespace flyball::cli
