#include "engine/mechanism/unit.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

struct Symbol {
  std::string_view text;
  Unit unit;
};

constexpr Dimension none{}, length{1, 0, 0}, mass{0, 1, 0}, time_{0, 0, 1}, force{1, 1, -2}, energy{2, 1, -2},
    power{2, 1, -3}, pressure{-1, 1, -2};

constexpr std::array symbols{
    Symbol{"m", {1, length}},
    Symbol{"km", {1e3, length}},
    Symbol{"cm", {1e-2, length}},
    Symbol{"mm", {1e-3, length}},
    Symbol{"um", {1e-6, length}},
    Symbol{"in", {0.0254, length}},
    Symbol{"ft", {0.3048, length}},
    Symbol{"kg", {1, mass}},
    Symbol{"g", {1e-3, mass}},
    Symbol{"mg", {1e-6, mass}},
    Symbol{"t", {1e3, mass}},
    Symbol{"lb", {0.45359237, mass}},
    Symbol{"s", {1, time_}},
    Symbol{"ms", {1e-3, time_}},
    Symbol{"min", {60, time_}},
    Symbol{"h", {3600, time_}},
    Symbol{"rad", {1, none}},
    Symbol{"mrad", {1e-3, none}},
    Symbol{"deg", {std::numbers::pi / 180, none}},
    Symbol{"°", {std::numbers::pi / 180, none}},
    Symbol{"rev", {2 * std::numbers::pi, none}},
    Symbol{"rpm", {std::numbers::pi / 30, {0, 0, -1}}},
    Symbol{"N", {1, force}},
    Symbol{"mN", {1e-3, force}},
    Symbol{"kN", {1e3, force}},
    Symbol{"MN", {1e6, force}},
    Symbol{"lbf", {4.4482216152605, force}},
    Symbol{"J", {1, energy}},
    Symbol{"kJ", {1e3, energy}},
    Symbol{"W", {1, power}},
    Symbol{"kW", {1e3, power}},
    Symbol{"Pa", {1, pressure}},
    Symbol{"kPa", {1e3, pressure}},
    Symbol{"MPa", {1e6, pressure}},
    Symbol{"GPa", {1e9, pressure}},
    Symbol{"bar", {1e5, pressure}},
};

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

// One symbol with its exponent at the beginning of a text.
std::optional<UnitPrefix> read_symbol(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && is_letter(text[end]))
    ++end;
  // More letters or figures make a name of it: "m1" is no metre.
  if (end < text.size() && (std::isdigit(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
    return {};
  const auto found = std::ranges::find(symbols, text.substr(0, end), &Symbol::text);
  if (found == symbols.end()) return {};
  UnitPrefix read{found->unit, end};
  std::size_t at = end + 1;
  if (end < text.size() && text[end] == '^') {
    const bool negative = at < text.size() && text[at] == '-';
    if (negative) ++at;
    if (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
      const double exponent = (text[at] - '0') * (negative ? -1. : 1.);
      read.unit = {std::pow(read.unit.factor, exponent), exponent * read.unit.dimension};
      read.length = at + 1;
    }
  }
  return read;
}

} // namespace

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
    all->unit.dimension = all->unit.dimension + sign * next->unit.dimension;
    all->length = at + 1 + next->length;
  }
}

std::optional<Unit> parse_unit(std::string_view text) {
  if (text.empty()) return Unit{};
  if (text.starts_with("1/")) {
    std::optional<Unit> below = parse_unit(text.substr(2));
    if (below) *below = {1 / below->factor, -1 * below->dimension};
    return below;
  }
  const std::optional<UnitPrefix> read = read_unit(text);
  if (!read || read->length != text.size()) return {};
  return read->unit;
}

std::string dimension_text(const Dimension& dimension) {
  if (dimension == none) return "a number";
  // What mechanics has names for.
  constexpr std::array<std::string_view, 14> usual{"m",     "kg",     "s",   "rad/s",  "m/s",    "m/s^2",   "N",
                                                   "N m",   "N/m",    "N s/m", "kg m^2", "kg/m^3", "N s^2/m^2", "N m s"};
  for (const std::string_view text : usual)
    if (parse_unit(text)->dimension == dimension) return std::string(text);
  std::string above, below;
  const auto add = [&](std::string_view symbol, double exponent) {
    if (exponent == 0) return;
    std::string& to = exponent > 0 ? above : below;
    to += (to.empty() ? "" : " ") + std::string(symbol);
    if (std::abs(exponent) != 1) to += "^" + rounded_text(std::abs(exponent), 6);
  };
  add("kg", dimension.kilogram);
  add("m", dimension.metre);
  add("s", dimension.second);
  if (above.empty()) above = "1";
  return below.empty() ? above : above + "/(" + below + ")";
}

} // namespace flyball
