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

CLI::Validator above_zero() {
  return {[](std::string& text) -> std::string {
            double value = 0;
            const char* end = text.data() + text.size();
            const auto [rest, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc() && rest == end && std::isfinite(value) && value > 0) return {};
            return "expected a number above zero, not " + text;
          },
          "above zero"};
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

Range parse_range(std::string_view option, std::string_view text, bool count) {
  const auto fail = [&] {
    return SceneError(std::string(option), std::string("expected address=from:to") + (count ? ":count" : "") +
                                               ", not \"" + std::string(text) + "\"");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) throw fail();
  std::vector<std::string_view> parts;
  for (std::size_t from = equals + 1;;) {
    const std::size_t colon = text.find(':', from);
    parts.push_back(text.substr(from, colon == std::string_view::npos ? colon : colon - from));
    if (colon == std::string_view::npos) break;
    from = colon + 1;
  }
  if (parts.size() != (count ? 3u : 2u)) throw fail();
  Range range;
  range.address = text.substr(0, equals);
  const std::string where = std::string(option) + " " + range.address;
  range.from = parse_number(where, parts[0]);
  range.to = parse_number(where, parts[1]);
  if (count) {
    const double n = parse_number(where, parts[2]);
    if (n != std::floor(n) || n < 1 || n > 1e7)
      throw SceneError(where, "expected a whole number of values from 1 to 10000000");
    range.count = static_cast<int>(n);
  }
  return range;
}

} // namespace flyball::cli
