#include "app/cli/report_error.hpp"

#include "app/cli/command.hpp"
#include "engine/mechanism/safe_text.hpp"

#include <CLI/CLI.hpp>
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

Ending end_with(bool result, const std::filesystem::path& scene, std::string_view reason) {
  if (result) return {};
  return {exit_no_result, fmt::format("{}: {}", scene == "-" ? "standard input" : scene.string(),
                                      reason.empty() ? std::string_view("no result was found") : reason)};
}

int finish(const Ending& ending) {
  if (ending.exit_code == exit_no_result) report_error(ending.reason);
  return ending.exit_code;
}

int report_error(std::string_view message) {
  fmt::print(stderr, "flyball: {}\n", printable(message));
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
  fmt::print(stderr, "{}: {}\nSee {} --help.\n", command, printable_lines(error.what()), command);
  return exit_bad_input;
}

} // namespace flyball::cli
