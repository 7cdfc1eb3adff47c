#include "app/cli/scene_argument.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include <charconv>
#include <cmath>

namespace flyball::cli {

double parse_number(std::string_view option, std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value))
    throw SceneError(std::string(option), "expected a finite number, not \"" + std::string(text) + "\"");
  return value;
}

std::pair<std::string, double> parse_assignment(std::string_view option, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throw SceneError(std::string(option), "expected name=value, not \"" + std::string(text) + "\"");
  std::string name(text.substr(0, equals));
  const double value = parse_number(std::string(option) + " " + name, text.substr(equals + 1));
  return {std::move(name), value};
}

void SceneArgument::add_to(CLI::App& command) {
  command.add_option("scene", file, "Scene file (-: standard input)")->required();
  command.add_option("--set", settings, "Change a number: address=value, such as joints.spin.drive.speed=12")
      ->take_all()
      ->allow_extra_args(false);
}

Mechanism SceneArgument::load() const {
  Mechanism mechanism = load_scene(file);
  if (settings.empty()) return mechanism;
  try {
    for (const std::string& text : settings) {
      const auto [address, value] = parse_assignment("--set", text);
      set_parameter(mechanism, address, value);
    }
    validate(mechanism);
  } catch (const SceneError& error) {
    throw SceneError(file.string() + ": " + error.where(), error.expected());
  }
  return mechanism;
}

} // namespace flyball::cli
