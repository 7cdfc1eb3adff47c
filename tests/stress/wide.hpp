// Numbers of 113 bits to judge by, and the same with a derivative carried along, so that the engine's own
// templates give the balance and its exact Jacobian in a precision in which 1e15 beside 1e-9 is no hardship.
#pragma once

#include <Eigen/Core>

#include <quadmath.h>

#include <limits>
#include <type_traits>

namespace flyball::stress {

__extension__ typedef __float128 Quad;

struct Wide {
  Quad v;
  Wide() = default;
  template <class T>
  requires std::is_arithmetic_v<T> Wide(T x) : v(x) {}
  static Wide of(Quad x) {
    Wide w;
    w.v = x;
    return w;
  }
  explicit operator double() const { return static_cast<double>(v); }
  explicit operator int() const { return static_cast<int>(v); }

  friend Wide operator+(Wide a, Wide b) { return of(a.v + b.v); }
  friend Wide operator-(Wide a, Wide b) { return of(a.v - b.v); }
  friend Wide operator*(Wide a, Wide b) { return of(a.v * b.v); }
  friend Wide operator/(Wide a, Wide b) { return of(a.v / b.v); }
  Wide operator-() const { return of(-v); }
  Wide& operator+=(Wide b) { return *this = *this + b; }
  Wide& operator-=(Wide b) { return *this = *this - b; }
  Wide& operator*=(Wide b) { return *this = *this * b; }
  Wide& operator/=(Wide b) { return *this = *this / b; }
  friend bool operator==(Wide a, Wide b) { return a.v == b.v; }
  friend bool operator!=(Wide a, Wide b) { return a.v != b.v; }
  friend bool operator<(Wide a, Wide b) { return a.v < b.v; }
  friend bool operator>(Wide a, Wide b) { return a.v > b.v; }
  friend bool operator<=(Wide a, Wide b) { return a.v <= b.v; }
  friend bool operator>=(Wide a, Wide b) { return a.v >= b.v; }
};

inline Wide sqrt(Wide a) {
  return Wide::of(sqrtq(a.v));
}
inline Wide sin(Wide a) {
  return Wide::of(sinq(a.v));
}
inline Wide cos(Wide a) {
  return Wide::of(cosq(a.v));
}
inline Wide tan(Wide a) {
  return Wide::of(tanq(a.v));
}
inline Wide atan2(Wide a, Wide b) {
  return Wide::of(atan2q(a.v, b.v));
}
inline Wide abs(Wide a) {
  return Wide::of(fabsq(a.v));
}
inline Wide widest() {
  return Wide::of(scalbnq(2 - scalbnq(1, -112), 16383));
}
inline bool isfinite(Wide a) {
  return finiteq(a.v) != 0;
}

// v + d e with e^2 = 0.
struct Dual {
  Wide v, d;
  Dual() = default;
  template <class T>
  requires std::is_arithmetic_v<T> Dual(T x) : v(x), d(0) {}
  Dual(Wide value, Wide rate = 0) : v(value), d(rate) {}
  explicit operator int() const { return static_cast<int>(v); }
  explicit operator double() const { return static_cast<double>(v); }

  friend Dual operator+(Dual a, Dual b) { return {a.v + b.v, a.d + b.d}; }
  friend Dual operator-(Dual a, Dual b) { return {a.v - b.v, a.d - b.d}; }
  friend Dual operator*(Dual a, Dual b) { return {a.v * b.v, a.v * b.d + a.d * b.v}; }
  friend Dual operator/(Dual a, Dual b) {
    const Wide q = a.v / b.v;
    return {q, (a.d - q * b.d) / b.v};
  }
  Dual operator-() const { return {-v, -d}; }
  Dual& operator+=(Dual b) { return *this = *this + b; }
  Dual& operator-=(Dual b) { return *this = *this - b; }
  Dual& operator*=(Dual b) { return *this = *this * b; }
  Dual& operator/=(Dual b) { return *this = *this / b; }
  friend bool operator==(Dual a, Dual b) { return a.v == b.v; }
  friend bool operator!=(Dual a, Dual b) { return a.v != b.v; }
  friend bool operator<(Dual a, Dual b) { return a.v < b.v; }
  friend bool operator>(Dual a, Dual b) { return a.v > b.v; }
  friend bool operator<=(Dual a, Dual b) { return a.v <= b.v; }
  friend bool operator>=(Dual a, Dual b) { return a.v >= b.v; }
};

inline Dual sqrt(Dual a) {
  const Wide r = sqrt(a.v);
  return {r, a.d == Wide(0) ? Wide(0) : a.d / (2 * r)};
}
inline Dual sin(Dual a) {
  return {sin(a.v), cos(a.v) * a.d};
}
inline Dual cos(Dual a) {
  return {cos(a.v), -sin(a.v) * a.d};
}
inline Dual tan(Dual a) {
  const Wide t = tan(a.v);
  return {t, (1 + t * t) * a.d};
}
inline Dual atan2(Dual a, Dual b) {
  return {atan2(a.v, b.v), (a.d * b.v - b.d * a.v) / (a.v * a.v + b.v * b.v)};
}
inline Dual abs(Dual a) {
  return a.v < Wide(0) ? -a : a;
}
inline bool isfinite(Dual a) {
  return isfinite(a.v) && isfinite(a.d);
}

} // namespace flyball::stress

namespace Eigen {

template <class S>
struct WideTraits : GenericNumTraits<S> {
  using Real = S;
  using NonInteger = S;
  using Nested = S;
  using Literal = S;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 30
  };
  static S epsilon() { return S(flyball::stress::Wide::of(scalbnq(1, -112))); }
  static S dummy_precision() { return S(flyball::stress::Wide::of(scalbnq(1, -102))); }
  static S highest() { return S(flyball::stress::widest()); }
  static S lowest() { return S(-flyball::stress::widest()); }
  static int digits10() { return FLT128_DIG; }
};
template <>
struct NumTraits<flyball::stress::Wide> : WideTraits<flyball::stress::Wide> {};
template <>
struct NumTraits<flyball::stress::Dual> : WideTraits<flyball::stress::Dual> {};

} // namespace Eigen
