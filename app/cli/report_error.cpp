#include "app/cli/report_error.hpp"

#include "app/cli/command.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace flyball::cli {

namespace {

// The command line so far: "flyball", or "flyball solve" where a subcommand was recognised.
std::string spoken_command(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* command : app.get_subcommands())
    words += ' ' + command->get_name();
  return words;
}

} // namespace

int report_error(std::string_view message) {
  fmt::print(stderr, "flyball: {}\n", message);
  return exit_bad_input;
}

int report_error(const SceneError& error) {
  return report_error(error.what());
}

int report_error(const std::filesystem::path& file, const SceneError& error) {
  return report_error(fmt::format("{}: {}", file.string(), error.what()));
}

void report_warning(const std::filesystem::path& file, const SceneError& warning) {
  fmt::print(stderr, "flyball: warning: {}: {}\n", file.string(), warning.what());
}

int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
  const std::string command = spoken_command(app);
  fmt::print(stderr, "{}: {}\nSee {} --help.\n", command, error.what(), command);
  return exit_bad_input;
}

} // namespace flyball::cli
