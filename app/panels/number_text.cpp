#include "app/panels/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
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

std::string short_text(double value, int digits) {
  if (!std::isfinite(value)) return "not finite";
  return without_negative_zero(without_trailing_zeros(fmt::format("{:.{}g}", value, digits)));
}

std::string duration_text(double seconds, const NumberStyle& style) {
  if (!style.run_times) return "-- µs";
  const auto digits = [](double x) { return fmt::format("{:.{}f}", x, x < 9.95 ? 1 : 0); };
  if (seconds < 999.5e-6) return digits(seconds * 1e6) + " µs";
  if (seconds < 999.5e-3) return digits(seconds * 1e3) + " ms";
  return digits(seconds) + " s";
}

} // namespace flyball
