#include "app/session/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace flyball {

namespace {

std::string without_trailing_zeros(std::string text) {
  const auto exponent = text.find('e');
  std::string tail = exponent == std::string::npos ? "" : text.substr(exponent);
  std::string head = text.substr(0, exponent);
  if (head.find('.') != std::string::npos) {
    head.erase(head.find_last_not_of('0') + 1);
    if (head.back() == '.') head.pop_back();
  }
  return head + tail;
}

// "-0.00" is no number a person wants to read.
std::string without_negative_zero(std::string text) {
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

} // namespace

std::string value_text(double value, double error, const NumberStyle& style) {
  if (!std::isfinite(value)) return "not finite";
  const bool known = std::isfinite(error) && error > 0;
  if (value == 0 && !known) return "0";
  const double size = std::max(std::abs(value), known ? error : style.noise);
  const int leading = size > 0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
  const int last = known ? static_cast<int>(std::floor(std::log10(std::max(error, style.noise)))) : -300;
  // Decimal places: down to the error's first digit, but no more digits than wanted.
  const int places = std::max(-last, 0);
  const int most = std::max(style.most_digits - 1 - leading, 0);
  if (leading >= style.most_digits || (leading < -6 && last < leading))
    return fmt::format("{:.{}e}", value, std::clamp(leading - last, 0, style.most_digits - 1));
  return without_negative_zero(
      fmt::format("{:.{}f}", value, std::min({places, most, style.most_digits - 1})));
}

std::string magnitude_text(double value, const NumberStyle& style) {
  if (!std::isfinite(value)) return "unknown";
  if (std::abs(value) < style.noise) return fmt::format("< {}", short_text(style.noise, 1));
  return fmt::format("{:.1e}", value);
}

std::string size_text(double value, const NumberStyle& style) {
  const double size = std::abs(value);
  return size >= 1e-3 && size < 1e4 ? short_text(value, 2) : magnitude_text(value, style);
}

std::string short_text(double value, int digits) {
  if (!std::isfinite(value)) return "not finite";
  return without_negative_zero(without_trailing_zeros(fmt::format("{:.{}g}", value, digits)));
}

std::string rough_text(double value) {
  if (!std::isfinite(value) || value == 0 || std::abs(value) >= 1e6) return short_text(value, 3);
  const double unit = std::pow(10., std::floor(std::log10(std::abs(value))) - 2);
  return short_text(std::round(value / unit) * unit, 6);
}

std::string duration_text(double seconds, const NumberStyle& style) {
  if (!style.run_times) return "-- µs";
  const auto digits = [](double x) { return fmt::format("{:.{}f}", x, x < 9.95 ? 1 : 0); };
  if (seconds < 999.5e-6) return digits(seconds * 1e6) + " µs";
  if (seconds < 999.5e-3) return digits(seconds * 1e3) + " ms";
  return digits(seconds) + " s";
}

std::pair<std::size_t, std::size_t> number_at(std::string_view text, std::size_t at) {
  const auto is_digit = [&](std::size_t i) {
    return i < text.size() && ((text[i] >= '0' && text[i] <= '9') || text[i] == '.');
  };
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0;
  };
  std::pair<std::size_t, std::size_t> found{0, 0};
  bool any = false, signed_place = true; // a sign here belongs to the number after it
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t begin = i;
    if (signed_place && (text[i] == '-' || text[i] == '+') && is_digit(i + 1)) ++i;
    if (is_digit(i)) {
      while (is_digit(i))
        ++i;
      const std::size_t sign = i + 1 < text.size() && (text[i + 1] == '-' || text[i + 1] == '+') ? 1 : 0;
      if (i < text.size() && (text[i] == 'e' || text[i] == 'E') && is_digit(i + 1 + sign)) {
        i += 1 + sign;
        while (is_digit(i))
          ++i;
      }
      if (any && begin > at) return found;
      found = {begin, i};
      any = true;
      signed_place = false;
    } else if (is_letter(i)) { // with its power: "m/s^2", "m2"
      while (is_letter(i) || is_digit(i) || (i < text.size() && text[i] == '^'))
        ++i;
      signed_place = false;
    } else {
      if (text[i] != ' ') signed_place = text[i] != ')';
      ++i;
    }
  }
  return found;
}

} // namespace flyball
