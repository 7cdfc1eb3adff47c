// What goes wrong, in one line on standard error: `flyball: governor.json: joints.spin.axis: expected ...`.
#pragma once

#include "engine/mechanism/error.hpp"

#include <filesystem>
#include <string_view>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace flyball::cli {

// Prints the line and returns exit_bad_input.
int report_error(std::string_view message);
int report_error(const SceneError& error);
// For an error about a scene that was read from `file` but whose `where` does not say so, as when compiling.
int report_error(const std::filesystem::path& file, const SceneError& error);

// Something to be told that stops nothing: `flyball: warning: robot.json: bodies.arm.inertia: ...`.
void report_warning(const std::filesystem::path& file, const SceneError& warning);

// Prints help and version to standard output (exit 0); for a mistake on the command line, what it is and
// which --help explains it.
int report_usage(const CLI::App& app, const CLI::ParseError& error);

} // namespace flyball::cli
