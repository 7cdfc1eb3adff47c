// A number with its rate of change (forward-mode differentiation: Griewank and Walther, Evaluating
// Derivatives, 2nd ed., chapter 3).
#pragma once

#include <cmath>
#include <numbers>

namespace flyball {

struct Dual {
  double value = 0, rate = 0;

  constexpr Dual() = default;
  constexpr Dual(double constant) : value(constant) {}
  constexpr Dual(double number, double its_rate) : value(number), rate(its_rate) {}
  explicit operator double() const { return value; }

  friend Dual operator-(Dual a) { return {-a.value, -a.rate}; }
  friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.rate + b.rate}; }
  friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.rate - b.rate}; }
  friend Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.rate * b.value + a.value * b.rate}; }
  friend Dual operator/(Dual a, Dual b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.rate - quotient * b.rate) / b.value};
  }
  Dual& operator+=(Dual b) { return *this = *this + b; }
  Dual& operator-=(Dual b) { return *this = *this - b; }
  Dual& operator*=(Dual b) { return *this = *this * b; }
  Dual& operator/=(Dual b) { return *this = *this / b; }

  // A number that is zero and moves is not zero: what it multiplies may not be left out.
  friend bool operator==(Dual a, Dual b) { return a.value == b.value && a.rate == b.rate; }
  friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
  friend bool operator>(Dual a, Dual b) { return a.value > b.value; }
  friend bool operator<=(Dual a, Dual b) { return a.value <= b.value; }
  friend bool operator>=(Dual a, Dual b) { return a.value >= b.value; }
};

// f(a), where `slope` is f'(a); what does not move has no rate, even where the slope is infinite.
inline Dual chained(Dual a, double value, double slope) {
  return {value, a.rate == 0 ? 0 : slope * a.rate};
}

inline Dual power(Dual a, Dual b) {
  const double value = std::pow(a.value, b.value);
  double rate = a.rate == 0 ? 0 : b.value * std::pow(a.value, b.value - 1) * a.rate;
  if (b.rate != 0) rate += value * std::log(a.value) * b.rate;
  return {value, rate};
}

inline Dual sqrt(Dual a) {
  const double root = std::sqrt(a.value);
  return chained(a, root, 0.5 / root);
}
inline Dual sin(Dual a) {
  return chained(a, std::sin(a.value), std::cos(a.value));
}
inline Dual cos(Dual a) {
  return chained(a, std::cos(a.value), -std::sin(a.value));
}
inline Dual tan(Dual a) {
  const double tangent = std::tan(a.value);
  return chained(a, tangent, 1 + tangent * tangent);
}
inline Dual asin(Dual a) {
  return chained(a, std::asin(a.value), 1 / std::sqrt(1 - a.value * a.value));
}
inline Dual acos(Dual a) {
  return chained(a, std::acos(a.value), -1 / std::sqrt(1 - a.value * a.value));
}
inline Dual atan(Dual a) {
  return chained(a, std::atan(a.value), 1 / (1 + a.value * a.value));
}
inline Dual sinh(Dual a) {
  return chained(a, std::sinh(a.value), std::cosh(a.value));
}
inline Dual cosh(Dual a) {
  return chained(a, std::cosh(a.value), std::sinh(a.value));
}
inline Dual tanh(Dual a) {
  const double t = std::tanh(a.value);
  return chained(a, t, 1 - t * t);
}
inline Dual exp(Dual a) {
  return chained(a, std::exp(a.value), std::exp(a.value));
}
inline Dual log(Dual a) {
  return chained(a, std::log(a.value), 1 / a.value);
}
inline Dual log10(Dual a) {
  return chained(a, std::log10(a.value), 1 / (a.value * std::numbers::ln10));
}
// At corners the rates of these are those on the way on, as of what moves by its rate.
inline Dual abs(Dual a) {
  return {std::abs(a.value), a.value == 0 ? std::abs(a.rate) : a.value < 0 ? -a.rate : a.rate};
}
inline Dual min(Dual a, Dual b) {
  return b.value < a.value || (b.value == a.value && b.rate < a.rate) ? b : a;
}
inline Dual max(Dual a, Dual b) {
  return b.value > a.value || (b.value == a.value && b.rate > a.rate) ? b : a;
}
inline Dual atan2(Dual y, Dual x) {
  const double square = x.value * x.value + y.value * y.value;
  const double turn = x.value * y.rate - y.value * x.rate;
  const bool still = x.rate == 0 && y.rate == 0; // not even where it would have no finite rate
  return {std::atan2(y.value, x.value), still ? 0 : turn / square};
}
inline Dual hypot(Dual a, Dual b) {
  const double length = std::hypot(a.value, b.value);
  // At the origin the way out of it, as of |x| at zero.
  return {length, length == 0 ? std::hypot(a.rate, b.rate) : (a.value * a.rate + b.value * b.rate) / length};
}

} // namespace flyball
