#include "app/session/quantity.hpp"

#include "app/session/units.hpp"
#include "engine/mechanism/decimal.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace flyball {

namespace {

constexpr int deepest = 50; // parentheses and signs within each other

// In SI units and radians.
struct Value {
  double number = 0;
  Dimension dimension;
  double unit = 0; // where this is a number with a unit behind it, that unit; else 0
};

// Thrown inside the parser only.
struct Mistake {
  std::string text;
};

std::string quoted(std::string_view text) {
  return "“" + std::string(text) + "”";
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
// Part of a unit's or function's name: a letter, or a byte of "°" or "µ".
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
}

std::string dimension_words(const Dimension& d) {
  if (d.none()) return "a plain number";
  if (d == Dimension{.length = 1}) return "a length";
  if (d == Dimension{.mass = 1}) return "a mass";
  if (d == Dimension{.time = 1}) return "a time";
  if (d == Dimension{.angle = 1}) return "an angle";
  return "something else";
}

class Parser {
 public:
  // Of a field in this unit.
  Parser(std::string_view text, const Value& field) : text_(text), field_(field) {}

  Value whole() {
    skip();
    if (text_.empty()) throw Mistake{"Nothing was typed."};
    const Value value = sum();
    if (!text_.empty()) throw unexpected();
    return value;
  }

 private:
  Value sum() {
    Value left = product();
    for (;;) {
      const char sign = take_one_of("+-");
      if (!sign) return left;
      Value right = product();
      meet(left, right);
      left = {sign == '+' ? left.number + right.number : left.number - right.number, left.dimension};
    }
  }

  // A plain number beside one with a unit is in the field's unit.
  void meet(Value& left, Value& right) const {
    if (left.dimension == right.dimension) return;
    Value& plain = left.dimension.none() ? left : right;
    const Value& other = left.dimension.none() ? right : left;
    if (plain.dimension.none() && other.dimension == field_.dimension) {
      plain = {times_unit(plain.number, field_.number), field_.dimension};
      return;
    }
    throw Mistake{"A sum of " + dimension_words(left.dimension) + " and " + dimension_words(right.dimension) +
                  " has no meaning."};
  }

  Value product() {
    Value left = sign();
    for (;;) {
      const char operation = take_one_of("*/");
      if (!operation) return left;
      const Value right = sign();
      if (operation == '*')
        left = {left.number * right.number, left.dimension + right.dimension};
      else if (left.dimension.none() && right.unit != 0)
        left = {left.number / (right.number / right.unit) * right.unit, right.dimension};
      else
        left = {left.number / right.number, left.dimension + right.dimension * -1};
    }
  }

  Value sign() {
    const Depth depth(*this);
    const char sign = take_one_of("+-");
    if (!sign) return quantity();
    Value value = this->sign();
    if (sign == '-') value.number = -value.number;
    return value;
  }

  // A number, a power or a parenthesis, with a unit behind it or not; or a unit alone.
  Value quantity() {
    if (next_unit()) return units();
    const bool number_comes = !text_.empty() && (is_digit(text_[0]) || text_[0] == '.');
    Value value = atom();
    if (take('^')) value = power(value, exponent());
    if (number_comes && word() == "pi") { // "2 pi"
      advance(2);
      value.number *= std::numbers::pi;
    }
    if (!next_unit()) return value;
    const Value unit = units();
    return {times_unit(value.number, unit.number), value.dimension + unit.dimension,
            number_comes ? unit.number : 0};
  }

  double exponent() {
    const bool negative = take('-');
    const Value value = atom();
    if (!value.dimension.none()) throw Mistake{"An exponent has no unit."};
    return negative ? -value.number : value.number;
  }

  static Value power(const Value& base, double exponent) {
    Dimension dimension;
    if (!base.dimension.none()) {
      const auto times = [&](double own) {
        const double product = own * exponent;
        if (product != std::round(product) || std::abs(product) > 100)
          throw Mistake{"That power of a unit has no meaning."};
        return product;
      };
      const Dimension& own = base.dimension;
      dimension = {times(own.length), times(own.mass), times(own.time), times(own.angle)};
    }
    return {std::pow(base.number, exponent), dimension};
  }

  Value atom() {
    const Depth depth(*this);
    if (text_.empty()) throw Mistake{"Something is missing at the end."};
    if (take('(')) return closed();
    if (is_digit(text_[0]) || text_[0] == '.') return {number(), {}};
    const std::string_view name = word();
    if (name.empty()) throw unexpected();
    if (name == "pi") {
      advance(name.size());
      return {std::numbers::pi, {}};
    }
    return function(name);
  }

  Value closed() {
    const Value value = sum();
    if (!take(')')) throw text_.empty() ? Mistake{"A parenthesis is not closed."} : unexpected();
    return {value.number, value.dimension};
  }

  Value function(std::string_view name) {
    using Function = double (*)(double);
    constexpr std::array<std::pair<std::string_view, Function>, 6> known{{
        {"sin", std::sin},
        {"cos", std::cos},
        {"tan", std::tan},
        {"asin", std::asin},
        {"acos", std::acos},
        {"atan", std::atan},
    }};
    const auto* found = std::ranges::find(known, name, &std::pair<std::string_view, Function>::first);
    if (found == known.end() && name != "sqrt" && name != "abs") throw unknown(name);
    advance(name.size());
    if (!take('(')) throw Mistake{"After " + std::string(name) + " comes a parenthesis."};
    const Value value = closed();
    if (name == "sqrt") return power(value, 0.5);
    if (name == "abs") return {std::abs(value.number), value.dimension};
    const bool inverse = name.starts_with('a');
    Dimension rest = value.dimension;
    if (!inverse) rest.angle = 0;
    if (!rest.none())
      throw Mistake{std::string(name) + " is of " + (inverse ? "a plain number." : "an angle.")};
    return {found->second(value.number), inverse ? Dimension{.angle = 1} : Dimension{}};
  }

  double number() {
    double value = 0;
    const auto [end, error] = read_decimal(text_.data(), text_.data() + text_.size(), value);
    if (error == std::errc::invalid_argument) throw unexpected();
    if (error != std::errc()) throw Mistake{"That is no finite number, or smaller than 1e-307."};
    advance(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

  std::string_view word() const {
    std::size_t end = 0;
    while (end < text_.size() && is_letter(text_[end]))
      ++end;
    return text_.substr(0, end);
  }

  bool next_unit() const { return find_unit(word()).has_value(); }

  // "N m/rad", "kg*m^2": as far as units go. What is behind "/" counts only for the unit next to it.
  Value units() {
    Value all{1, {}};
    bool divide = false;
    for (;;) {
      const Unit unit = *find_unit(word());
      advance(unit.name.size());
      const int power = (divide ? -1 : 1) * unit_power();
      all = {all.number * std::pow(unit.factor, power), all.dimension + unit.dimension * power};
      divide = false;
      if (next_unit()) continue;
      const std::string_view before = text_;
      if (const char operation = take_one_of("*/"); !operation) {
        return all;
      } else if (!next_unit()) {
        text_ = before; // it belongs to numbers
        return all;
      } else {
        divide = operation == '/';
      }
    }
  }

  int unit_power() {
    if (!take('^')) return 1;
    const bool negative = take('-');
    if (text_.empty() || !is_digit(text_[0])) throw Mistake{"After ^ comes a whole number."};
    const double power = number();
    if (power != std::round(power) || power > 9) throw Mistake{"That power of a unit has no meaning."};
    return negative ? -static_cast<int>(power) : static_cast<int>(power);
  }

  static Mistake unknown(std::string_view name) {
    if (name == "nan" || name == "inf" || name == "infinity") return {"Expected a finite number."};
    const std::string hint = did_you_mean(name, unit_names()); // a question
    return {quoted(name) + " is no unit known here" + (hint.empty() ? "." : hint)};
  }

  Mistake unexpected() const {
    if (text_[0] == ',') return {"A comma is no decimal point here: write 0.5, not 0,5."};
    const bool fraction = text_.size() > 1 && text_[0] == '.' && is_digit(text_[1]);
    if (fraction || is_digit(text_[0]) || text_[0] == '(' || !word().empty()) {
      const std::string_view name = word();
      if (!name.empty() && name != "pi" && !next_unit()) return unknown(name);
      return {"A sign such as * is missing before " + quoted(text_.substr(0, text_.find(' '))) + "."};
    }
    return {quoted(text_.substr(0, 1)) + " cannot stand there."};
  }

  void skip() { text_.remove_prefix(std::min(text_.find_first_not_of(' '), text_.size())); }
  void advance(std::size_t count) {
    text_.remove_prefix(count);
    skip();
  }
  bool take(char c) {
    if (text_.empty() || text_[0] != c) return false;
    advance(1);
    return true;
  }
  char take_one_of(std::string_view signs) {
    if (text_.empty() || signs.find(text_[0]) == std::string_view::npos) return 0;
    const char sign = text_[0];
    advance(1);
    return sign;
  }

  // A text of ten thousand parentheses must not use up the stack.
  struct Depth {
    explicit Depth(Parser& of) : parser(of) {
      if (++parser.depth_ > deepest) throw Mistake{"Too many parentheses or signs."};
    }
    ~Depth() { --parser.depth_; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;
    Parser& parser;
  };

  std::string_view text_;
  Value field_;
  int depth_ = 0;
};

// Whether the value may stand in the field, radians counting as one where a person leaves them out, and where
// an angle times a radius is an arc.
bool fits(const Dimension& value, const Dimension& field) {
  if (value == field) return true;
  Dimension a = value, b = field;
  a.angle = b.angle = 0;
  return a == b && !a.none() && (value.angle == 0 || (field.angle == 0 && value.angle > 0));
}

} // namespace

std::string plain_signs(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 11> signs{{{"²", "^2"},
                                                                                 {"³", "^3"},
                                                                                 {"·", "*"},
                                                                                 {"⋅", "*"},
                                                                                 {"×", "*"},
                                                                                 {"÷", "/"},
                                                                                 {"−", "-"},
                                                                                 {"π", "pi"},
                                                                                 {"μ", "µ"},
                                                                                 {"\u00A0", " "},
                                                                                 {"\t", " "}}};
  std::string plain;
  while (!text.empty()) {
    const auto* found =
        std::ranges::find_if(signs, [&](const auto& sign) { return text.starts_with(sign.first); });
    plain += found == signs.end() ? text.substr(0, 1) : found->second;
    text.remove_prefix(found == signs.end() ? 1 : found->first.size());
  }
  return plain;
}

Quantity parse_quantity(std::string_view text, std::string_view unit) {
  return parse_quantity(text, unit, unit);
}

Quantity parse_quantity(std::string_view text, std::string_view unit, std::string_view shown) {
  if (unit == "%") { // which no unit is combined with: behind the number, or left out
    const std::size_t end = text.find_last_not_of(' ');
    if (end != std::string_view::npos && text[end] == '%') text = text.substr(0, end);
    return parse_quantity(text, "", "");
  }
  try {
    const auto value_of = [](std::string_view of) {
      return of.empty() ? Value{1, {}} : Parser(plain_signs(of), {1, {}}).whole();
    };
    const Value field = value_of(unit), plain = value_of(shown);
    const std::string typed = plain_signs(text);
    const Value value = Parser(typed, plain).whole();
    if (!std::isfinite(value.number)) return {0, "That is no finite number."};
    if (value.dimension.none())
      return {unit == shown ? value.number : times_unit(value.number, plain.number) / field.number, {}};
    if (!fits(value.dimension, field.dimension)) return {0, "Expected " + expected_quantity(unit) + "."};
    return {value.number / field.number, {}};
  } catch (const Mistake& mistake) {
    return {0, mistake.text};
  }
}

std::string expected_quantity(std::string_view unit) {
  struct Kind {
    std::string_view unit, words;
  };
  constexpr std::array kinds{
      Kind{"", "a plain number, e.g. 2 or 1/3"},
      Kind{"m", "a length, e.g. 0.1 m or 100 mm"},
      Kind{"rad", "an angle, e.g. 0.5 rad or 30 deg"},
      Kind{"deg", "an angle, e.g. 30 deg or 0.5 rad"},
      Kind{"rad/s", "a speed of turning, e.g. 10 rad/s or 300 rpm"},
      Kind{"m/s", "a speed, e.g. 0.5 m/s or 500 mm/s"},
      Kind{"m/s^2", "an acceleration, e.g. 9.81 m/s^2"},
      Kind{"s", "a time, e.g. 10 s or 2 min"},
      Kind{"kg", "a mass, e.g. 2 kg or 500 g"},
      Kind{"kg m^2", "a moment of inertia, e.g. 0.1 kg m^2 or 500 g cm^2"},
      Kind{"kg/m^3", "a density, e.g. 7850 kg/m^3 or 7.85 g/cm^3"},
      Kind{"N", "a force, e.g. 10 N or 2 kN"},
      Kind{"N m", "a torque, e.g. 5 N m or 5000 N mm"},
      Kind{"N/m", "a stiffness, e.g. 1000 N/m or 1 N/mm"},
      Kind{"N m/rad", "a torsional stiffness, e.g. 10 N m/rad or 0.2 N m/deg"},
      Kind{"N s/m", "a damping, e.g. 30 N s/m"},
      Kind{"N m s/rad", "a torsional damping, e.g. 0.1 N m s/rad"},
      Kind{"N s^2/m^2", "a quadratic drag, e.g. 0.02 N s^2/m^2"},
  };
  const auto* found = std::ranges::find(kinds, unit, &Kind::unit);
  return found != kinds.end() ? std::string(found->words) : "a value in " + std::string(unit);
}

} // namespace flyball
