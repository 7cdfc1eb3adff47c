// A number with its rate of change (forward-mode differentiation: Griewank and Walther, Evaluating
// Derivatives, 2nd ed., chapter 3).
#pragma once

#include <cmath>

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

} // namespace flyball
