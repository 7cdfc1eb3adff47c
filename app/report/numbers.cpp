#include "app/report/numbers.hpp"

#include "app/session/number_text.hpp"
#include "app/session/units.hpp"
#include "engine/mechanism/address.hpp"

namespace flyball {
namespace {

constexpr const char* minus = "\u2212";
constexpr const char* narrow_space = "\u202f"; // at which no line ends
constexpr const char* space = "\u00a0";

std::string with_minus(std::string_view number) {
  return number.starts_with('-') ? minus + std::string(number.substr(1)) : std::string(number);
}

Html with_unit(const Html& number, std::string_view unit) {
  if (unit.empty()) return number;
  std::string words = written_unit(unit);
  for (std::size_t at = words.find(' '); at != std::string::npos; at = words.find(' ', at + 1))
    words.replace(at, 1, space);
  return number + (unit == "°" || unit == "%" ? Html(narrow_space) : Html(space)) + words;
}

} // namespace

Html written_number(std::string_view number) {
  const std::size_t e = number.find('e');
  // Words such as "not finite" are no powers of ten.
  const bool power = e != std::string_view::npos && e > 0 && number[e - 1] >= '0' && number[e - 1] <= '9';
  if (!power) return with_minus(number);
  std::string exponent(number.substr(e + 1));
  const bool negative = exponent.starts_with('-');
  exponent.erase(0, exponent.find_first_not_of("+-0"));
  if (exponent.empty()) return with_minus(number.substr(0, e)); // 10 to the 0
  return Html(with_minus(number.substr(0, e))) + narrow_space + "×" + narrow_space + "10" +
         element("sup", (negative ? minus : "") + exponent);
}

Html quantity(double value, std::string_view unit, int digits) {
  return with_unit(written_number(short_text(value, digits)), unit);
}

Html quantity_within(double value, double error, std::string_view unit) {
  return with_unit(written_number(value_text(value, error, {})), unit);
}

Html magnitude(double value, std::string_view unit) {
  return with_unit(written_number(size_text(value, {})), unit);
}

Html vector_quantity(const Vec3& v, std::string_view unit, int digits, const OpenDirections& open) {
  Html inner = "(";
  for (int i = 0; i < 3; ++i)
    inner += Html(i > 0 ? ",\u2002" : "") + Html(open.component(i) ? "≈" : "") +
             written_number(short_text(v[i], digits));
  return with_unit(inner + ")", unit);
}

Html rate_quantity(const Mechanism& mechanism, double rate, std::string_view of, std::string_view address) {
  const std::string per = parameter_unit(mechanism, address), unit(of);
  const bool compound = per.find_first_of(" /") != std::string::npos;
  return quantity(rate, per.empty() ? unit : unit + (compound ? "/(" + per + ")" : "/" + per), 4);
}

Html duration(double seconds) {
  return element("time", duration_text(seconds, {}));
}

std::string_view coordinate_unit_of(bool angle) {
  return angle ? "rad" : "m";
}
std::string_view force_unit_of(bool angle) {
  return angle ? "N m" : "N";
}

} // namespace flyball
