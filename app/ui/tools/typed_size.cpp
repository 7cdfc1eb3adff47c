#include "app/ui/tools/typed_size.hpp"

#include "app/session/quantity.hpp"
#include "app/session/units.hpp"
#include "app/ui/commands.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace flyball {

namespace {

bool is_typed_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

} // namespace

bool take_typed_key(std::string& typed, const KeyPress& key) {
  constexpr std::string_view first = "0123456789.-(", others = "+*/^) ";
  if (key.ctrl) return false;
  if (key.key == keys::backspace) {
    if (typed.empty()) return false;
    typed.pop_back();
    return true;
  }
  if (key.key < ' ' || key.key > '~') return false;
  const char c = static_cast<char>(key.key);
  if (first.find(c) != std::string_view::npos) {
    typed += c;
    return true;
  }
  if (typed.empty()) return false;
  if (is_typed_letter(c)) // keys are told as capitals
    typed += key.shift ? c : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  else if (others.find(c) != std::string_view::npos)
    typed += c;
  return true; // others are of no use in a number, and no commands in the middle of one
}

std::string typed_text(const std::string& typed, const std::string& unit) {
  return typed + "_" + (std::ranges::any_of(typed, is_typed_letter) ? "" : " " + unit);
}

std::optional<double> typed_length(const std::string& typed, const DisplayUnits& units,
                                   std::string* mistake) {
  const Quantity length = parse_quantity(typed, "m", shown_unit("m", units).text);
  std::string why = length.mistake;
  if (why.empty() && !(length.value > 0)) why = "Expected more than zero.";
  if (mistake) *mistake = why;
  return why.empty() ? std::optional(length.value) : std::nullopt;
}

} // namespace flyball
