#include "engine/mechanism/unit.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

namespace flyball {
namespace {

std::span<const Unit> units() {
  constexpr double degree = std::numbers::pi / 180, turn = 2 * std::numbers::pi;
  constexpr Dimension length{.length = 1}, angle{.angle = 1}, time{.time = 1}, mass{.mass = 1},
      turning{.time = -1, .angle = 1}, force{.length = 1, .mass = 1, .time = -2},
      torque{.length = 2, .mass = 1, .time = -2}, power{.length = 2, .mass = 1, .time = -3},
      pressure{.length = -1, .mass = 1, .time = -2};
  static constexpr std::array all{
      Unit{"m", 1, length},
      Unit{"mm", 1e-3, length},
      Unit{"cm", 1e-2, length},
      Unit{"km", 1e3, length},
      Unit{"um", 1e-6, length},
      Unit{"µm", 1e-6, length},
      Unit{"in", 0.0254, length},
      Unit{"ft", 0.3048, length},
      Unit{"rad", 1, angle},
      Unit{"mrad", 1e-3, angle},
      Unit{"deg", degree, angle},
      Unit{"°", degree, angle},
      Unit{"rev", turn, angle},
      Unit{"turn", turn, angle},
      Unit{"s", 1, time},
      Unit{"ms", 1e-3, time},
      Unit{"min", 60, time},
      Unit{"h", 3600, time},
      Unit{"Hz", turn, turning}, // one turn a second
      Unit{"rpm", turn / 60, turning},
      Unit{"kg", 1, mass},
      Unit{"g", 1e-3, mass},
      Unit{"mg", 1e-6, mass},
      Unit{"t", 1e3, mass},
      Unit{"lb", 0.45359237, mass},
      Unit{"N", 1, force},
      Unit{"mN", 1e-3, force},
      Unit{"kN", 1e3, force},
      Unit{"MN", 1e6, force},
      Unit{"lbf", 4.4482216152605, force},
      Unit{"J", 1, torque},
      Unit{"kJ", 1e3, torque},
      Unit{"W", 1, power},
      Unit{"kW", 1e3, power},
      Unit{"Pa", 1, pressure},
      Unit{"kPa", 1e3, pressure},
      Unit{"MPa", 1e6, pressure},
      Unit{"GPa", 1e9, pressure},
      Unit{"bar", 1e5, pressure},
      // As many write them in one word.
      Unit{"Nm", 1, torque},
      Unit{"kNm", 1e3, torque},
      Unit{"mNm", 1e-3, torque},
      Unit{"Nmm", 1e-3, torque},
      Unit{"Ncm", 1e-2, torque},
      Unit{"Ns", 1, {.length = 1, .mass = 1, .time = -1}},
      Unit{"Nms", 1, {.length = 2, .mass = 1, .time = -1}},
  };
  return all;
}

bool is_unit_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

// One symbol with its exponent at the beginning of a text.
std::optional<UnitPrefix> read_symbol(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && is_unit_letter(text[end]))
    ++end;
  // More letters or figures make a name of it: "m1" is no metre.
  if (end < text.size() && (std::isdigit(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
    return {};
  const std::optional<Unit> found = find_unit(text.substr(0, end));
  if (!found) return {};
  UnitPrefix read{{"", found->factor, found->dimension}, end};
  std::size_t at = end + 1;
  if (end < text.size() && text[end] == '^') {
    const bool negative = at < text.size() && text[at] == '-';
    if (negative) ++at;
    if (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
      const double exponent = (text[at] - '0') * (negative ? -1. : 1.);
      read.unit = {"", std::pow(read.unit.factor, exponent), read.unit.dimension * exponent};
      read.length = at + 1;
    }
  }
  return read;
}

} // namespace

std::optional<Unit> find_unit(std::string_view name) {
  const std::span<const Unit> all = units();
  const auto found = std::ranges::find(all, name, &Unit::name);
  return found == all.end() ? std::nullopt : std::optional(*found);
}

std::span<const std::string_view> unit_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Unit& unit : units())
      all.push_back(unit.name);
    return all;
  }();
  return names;
}

double times_unit(double number, double unit) {
  const double parts = std::round(1 / unit);
  const bool whole = unit < 1 && std::abs(1 / unit - parts) <= 1e-12 * parts;
  if (!whole) return number * unit;
  // 5.1 mm is 0.0051 m and not the neighbour that rounding twice may give.
  const double quotient = number / parts;
  const double tidy = std::strtod(rounded_text(quotient, 15).c_str(), nullptr);
  return std::abs(tidy - quotient) <= 4e-16 * std::abs(quotient) ? tidy : quotient;
}

std::optional<UnitPrefix> read_unit(std::string_view text) {
  std::optional<UnitPrefix> all = read_symbol(text);
  if (!all) return {};
  for (;;) {
    const std::size_t at = all->length;
    if (at >= text.size() || (text[at] != '/' && text[at] != ' ')) return all;
    const double sign = text[at] == '/' ? -1 : 1;
    const std::optional<UnitPrefix> next = read_symbol(text.substr(at + 1));
    if (!next) return all;
    all->unit.factor *= sign > 0 ? next->unit.factor : 1 / next->unit.factor;
    all->unit.dimension = all->unit.dimension + next->unit.dimension * sign;
    all->length = at + 1 + next->length;
  }
}

std::optional<Unit> parse_unit(std::string_view text) {
  if (text.empty()) return Unit{};
  if (text.starts_with("1/")) {
    std::optional<Unit> below = parse_unit(text.substr(2));
    if (below) *below = {"", 1 / below->factor, below->dimension * -1};
    return below;
  }
  const std::optional<UnitPrefix> read = read_unit(text);
  if (!read || read->length != text.size()) return {};
  return read->unit;
}

std::string dimension_text(const Dimension& of) {
  const Dimension dimension = of.without_angle();
  if (dimension.none()) return "a number";
  // What mechanics has names for.
  constexpr std::array<std::string_view, 14> usual{"m",      "kg",     "s",         "rad/s", "m/s",
                                                   "m/s^2",  "N",      "N m",       "N/m",   "N s/m",
                                                   "kg m^2", "kg/m^3", "N s^2/m^2", "N m s"};
  for (const std::string_view text : usual)
    if (parse_unit(text)->dimension.without_angle() == dimension) return std::string(text);
  std::string above, below;
  const auto add = [&](std::string_view symbol, double exponent) {
    if (exponent == 0) return;
    std::string& to = exponent > 0 ? above : below;
    to += (to.empty() ? "" : " ") + std::string(symbol);
    if (std::abs(exponent) != 1) to += "^" + rounded_text(std::abs(exponent), 6);
  };
  add("kg", dimension.mass);
  add("m", dimension.length);
  add("s", dimension.time);
  if (above.empty()) above = "1";
  return below.empty() ? above : above + "/(" + below + ")";
}

} // namespace flyball
