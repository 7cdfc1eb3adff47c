// What subcommands have in common: a scene file, --set address=value, --vary ranges.
#pragma once

#include "engine/mechanism/body_point.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
} // namespace CLI

namespace flyball::cli {

struct SceneArgument {
  std::filesystem::path file;
  std::vector<std::string> settings; // "address=value"

  void add_to(CLI::App& command);
  // Reads, applies the settings and validates; warnings go to standard error. Throws SceneError that names
  // the file.
  Mechanism load() const;
  // An error of the scene, with the file beside.
  SceneError in_file(const SceneError& error) const;
};

// A check for options: a finite number above zero.
CLI::Validator above_zero();

// "name=1.5" as a pair. Throws SceneError naming the option.
std::pair<std::string, double> parse_assignment(std::string_view option, std::string_view text);
// "body", or "body:x,y,z" (m, world coordinates of the drawn pose): a point whose motion is asked for. Throws
// SceneError naming the option.
BodyPoint parse_point(std::string_view option, std::string_view text);
// Adds the repeatable option --point.
void add_points(CLI::App& command, std::vector<std::string>& points);
// Adds the repeatable option --start.
CLI::Option* add_start(CLI::App& command, std::vector<std::string>& start);
// A finite number, all of the text. Throws SceneError naming the option.
double parse_number(std::string_view option, std::string_view text);

// "address=from:to", two different ends; or, where `count` is wanted, "address=from:to:count".
struct Range {
  std::string address;
  double from = 0, to = 0;
  int count = 1;
};
// With ends in SI units. Throws SceneError naming the option.
Range parse_range(std::string_view option, std::string_view text, bool count = false);
// With ends as --set takes values: numbers in SI units, or expressions with units and the scene's parameters.
Range parse_range(const Mechanism& mechanism, std::string_view option, std::string_view text,
                  bool count = false);

} // namespace flyball::cli
