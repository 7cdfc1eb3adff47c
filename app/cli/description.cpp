#include "app/cli/description.hpp"

#include <CLI/CLI.hpp>

#include <string_view>

namespace flyball::cli {
namespace {

// "TEXT:{light,dark}" or "FLOAT:FLOAT in [0.5 - 4]", as CLI11 has a type and its check.
void read_type(const std::string& type, OptionDescription& out) {
  const std::size_t colon = type.find(':');
  out.value = type.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string check = type.substr(colon + 1);
  if (check.size() < 2 || check.front() != '{' || check.back() != '}') {
    out.limits = check.starts_with(out.value + " ") ? check.substr(out.value.size() + 1) : check;
    return;
  }
  for (std::size_t from = 1; from < check.size();) {
    const std::size_t to = check.find_first_of(",}", from);
    out.choices.push_back(check.substr(from, to - from));
    from = to + 1;
  }
}

OptionDescription describe(const CLI::Option& option) {
  OptionDescription out;
  for (const std::string& name : option.get_snames())
    out.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    out.names.push_back("--" + name);
  if (out.names.empty()) out.names.push_back(option.get_name(true));
  read_type(option.get_type_size() == 0 ? std::string() : option.get_type_name(), out);
  out.text = option.get_description();
  out.standard = option.get_default_str();
  out.required = option.get_required();
  out.repeated = option.get_items_expected_max() > 1;
  return out;
}

CommandDescription describe_command(const CLI::App& app) {
  CommandDescription out;
  out.summary = app.get_description();
  constexpr std::string_view example = "Example: ";
  const std::string footer = app.get_footer();
  if (const std::size_t at = footer.rfind(example); at != std::string::npos)
    out.example = footer.substr(at + example.size());
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    (option->nonpositional() ? out.options : out.positionals).push_back(describe(*option));
  }
  return out;
}

} // namespace

ProgramDescription describe(const CLI::App& app) {
  ProgramDescription out{describe_command(app), {}};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    out.commands.push_back(describe_command(*command));
    out.commands.back().name = command->get_name();
  }
  return out;
}

} // namespace flyball::cli
