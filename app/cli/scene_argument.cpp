#include "app/cli/scene_argument.hpp"

#include "app/cli/report_error.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/decimal.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>

namespace flyball::cli {

double parse_number(std::string_view option, std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = read_decimal(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value))
    throw SceneError(std::string(option), "expected a finite number in SI units (m, rad, kg, s, N), not \"" +
                                              std::string(text) + "\"");
  return value;
}

CLI::Validator above_zero() {
  return {[](std::string& text) -> std::string {
            double value = 0;
            const char* end = text.data() + text.size();
            const auto [rest, error] = read_decimal(text.data(), end, value);
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

BodyPoint parse_point(std::string_view option, std::string_view text) {
  const auto fail = [&] {
    return SceneError(std::string(option),
                      "expected body, or body:x,y,z in metres, not \"" + std::string(text) + "\"");
  };
  // Names may have colons, coordinates none.
  const std::size_t colon = text.rfind(':');
  BodyPoint point{std::string(text.substr(0, colon)), std::nullopt};
  if (point.body.empty()) throw fail();
  if (colon == std::string_view::npos) return point;
  Vec3 at;
  std::string_view rest = text.substr(colon + 1);
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? rest.find(',') : std::string_view::npos;
    if (i < 2 && comma == std::string_view::npos) throw fail();
    at[i] = parse_number(std::string(option) + " " + point.body, rest.substr(0, comma));
    rest = i < 2 ? rest.substr(comma + 1) : std::string_view{};
  }
  point.at = at;
  return point;
}

void add_points(CLI::App& command, std::vector<std::string>& points) {
  command
      .add_option("--point", points,
                  "Position, velocity and acceleration of a body's mass centre, or of a point of it in world "
                  "coordinates of the drawn pose (m): body, or body:x,y,z; may be given again")
      ->take_all()
      ->allow_extra_args(false);
}

void SceneArgument::add_to(CLI::App& command) {
  command.add_option("scene", file, "Scene file (-: standard input)")->required();
  command
      .add_option("--set", settings,
                  "Change a number: address=value, such as joints.spin.drive.speed=12, parameters.L=0.2 or "
                  "parameters.L=\"20 cm\"")
      ->take_all()
      ->allow_extra_args(false);
}

CLI::Option* add_start(CLI::App& command, std::vector<std::string>& start) {
  return command
      .add_option("--start", start, "Start elsewhere than drawn: joint=value, or joint.index=value (rad, m)")
      ->take_all()
      ->allow_extra_args(false);
}

SceneError SceneArgument::in_file(const SceneError& error) const {
  return {file.string() + ": " + error.where(), error.expected()};
}

namespace {

// A number in SI units, or an expression with units and the scene's parameters: "18 cm", "2*L".
double parse_value(const Mechanism& mechanism, std::string_view option, const std::string& address,
                   std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = read_decimal(text.data(), end, value);
  if (error == std::errc() && rest == end && std::isfinite(value)) return value;
  const std::string unit = parameter_unit(mechanism, address);
  if (text.starts_with('=')) text.remove_prefix(1);
  return evaluate_expression(mechanism, text, unit, std::string(option) + " " + address);
}

} // namespace

Mechanism SceneArgument::load() const {
  Mechanism mechanism = load_scene(file);
  try {
    for (const std::string& text : settings) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || equals == 0)
        throw SceneError("--set", "expected address=value, not \"" + text + "\"");
      const std::string address = text.substr(0, equals);
      set_parameter(mechanism, address,
                    parse_value(mechanism, "--set", address, std::string_view(text).substr(equals + 1)));
    }
    if (!settings.empty()) validate(mechanism);
  } catch (const SceneError& error) {
    throw in_file(error);
  }
  for (const SceneError& warning : find_warnings(mechanism))
    report_warning(file, warning);
  return mechanism;
}

namespace {

using ParseNumber = std::function<double(const std::string& address, std::string_view text)>;

Range range_of(std::string_view option, std::string_view text, bool count, const ParseNumber& parse) {
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
  range.from = parse(range.address, parts[0]);
  range.to = parse(range.address, parts[1]);
  const std::string where = std::string(option) + " " + range.address;
  if (count) {
    const double n = parse_number(where, parts[2]);
    if (n != std::floor(n) || n < 1 || n > 1e9)
      throw SceneError(where, "expected a whole number of values from 1 to 1000000000");
    range.count = static_cast<int>(n);
  } else if (range.from == range.to) {
    throw SceneError(where, "expected two different ends");
  }
  return range;
}

} // namespace

Range parse_range(std::string_view option, std::string_view text, bool count) {
  return range_of(option, text, count, [&](const std::string& address, std::string_view number) {
    return parse_number(std::string(option) + " " + address, number);
  });
}

Range parse_range(const Mechanism& mechanism, std::string_view option, std::string_view text, bool count) {
  return range_of(option, text, count, [&](const std::string& address, std::string_view number) {
    return parse_value(mechanism, option, address, number);
  });
}

} // namespace flyball::cli
