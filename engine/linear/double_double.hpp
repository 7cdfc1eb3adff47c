// Numbers of 106 bits as unevaluated sums of two doubles, of which the second is at most half a unit in the
// last place of the first: T. J. Dekker, A floating-point technique for extending the available precision,
// 1971; Y. Hida, X. S. Li, D. H. Bailey, Algorithms for quad-double precision floating point arithmetic,
// 2001; error bounds by M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds for basic
// building blocks of double-word arithmetic, 2017. Their exponents are those of double: below 1e-290 the
// second part has no room left and digits are lost down to those of a double. Every operation must be rounded
// by itself, as in the ISO modes of compilers: reordered, or contracted across statements, they lose it.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <numbers>

namespace flyball {

struct DoubleDouble {
  double hi, lo; // hi is the sum rounded

  DoubleDouble() = default;
  constexpr DoubleDouble(double x) : hi(x), lo(0) {}
  constexpr DoubleDouble(double first, double second) : hi(first), lo(second) {}
  constexpr explicit operator double() const { return hi; }

  // a + b of any two doubles, exactly (Knuth); where |a| >= |b| in three operations (Dekker).
  static constexpr DoubleDouble sum(double a, double b) {
    const double s = a + b, from_b = s - a;
    return {s, (a - (s - from_b)) + (b - from_b)};
  }
  static constexpr DoubleDouble sum_of_ordered(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  // a b of any two doubles, exactly, by halves of 26 bits (Veltkamp, Dekker): where std::fma is an
  // instruction it saves little, and elsewhere it is a slow call.
  static constexpr DoubleDouble product(double a, double b) {
    constexpr double split = 134217729; // 2^27 + 1
    const double as = split * a, a1 = as - (as - a), a2 = a - a1;
    const double bs = split * b, b1 = bs - (bs - b), b2 = b - b1;
    const double p = a * b;
    return {p, a2 * b2 - (((p - a1 * b1) - a2 * b1) - a1 * b2)};
  }

  friend constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
    const DoubleDouble v = sum_of_ordered(s.hi, s.lo + t.hi);
    return sum_of_ordered(v.hi, v.lo + t.lo);
  }
  friend constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
  friend constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble p = product(a.hi, b.hi);
    return sum_of_ordered(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }
  friend constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
    const double q = a.hi / b.hi;
    const DoubleDouble r = b * q;
    return sum_of_ordered(q, ((a.hi - r.hi) + (a.lo - r.lo)) / b.hi);
  }
  constexpr DoubleDouble operator-() const { return {-hi, -lo}; }
  constexpr DoubleDouble& operator+=(DoubleDouble b) { return *this = *this + b; }
  constexpr DoubleDouble& operator-=(DoubleDouble b) { return *this = *this - b; }
  constexpr DoubleDouble& operator*=(DoubleDouble b) { return *this = *this * b; }
  constexpr DoubleDouble& operator/=(DoubleDouble b) { return *this = *this / b; }
  friend constexpr auto operator<=>(const DoubleDouble&, const DoubleDouble&) = default;
  friend constexpr bool operator==(const DoubleDouble&, const DoubleDouble&) = default;
};

inline DoubleDouble abs(DoubleDouble a) {
  return a.hi < 0 ? -a : a;
}

inline DoubleDouble sqrt(DoubleDouble a) {
  const double root = std::sqrt(a.hi);
  if (!(root > 0 && std::isfinite(root))) return root;
  const DoubleDouble square = DoubleDouble::product(root, root);
  return DoubleDouble::sum_of_ordered(root, (((a.hi - square.hi) - square.lo) + a.lo) / (2 * root));
}

struct SineAndCosine {
  DoubleDouble sine, cosine;
};

// What is left of the angle beyond whole quarter turns, of which 161 bits are taken off, lies within an
// eighth of a turn: its sine is Taylor's series, whose terms from the ninth on need only be doubles.
inline SineAndCosine sine_and_cosine(DoubleDouble angle) {
  constexpr std::array quarter_turn{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110};
  constexpr auto coefficients = [] { // 1, -1/3!, 1/5! ...
    std::array<DoubleDouble, 14> c{};
    c[0] = 1;
    for (std::size_t i = 1; i < c.size(); ++i)
      c[i] = -c[i - 1] / DoubleDouble(static_cast<double>(2 * i * (2 * i + 1)));
    return c;
  }();
  int quarters = 0;
  for (double k; std::abs(k = std::nearbyint(angle.hi / quarter_turn[0])) >= 1;) {
    for (const double part : quarter_turn)
      angle -= DoubleDouble::product(k, part);
    quarters += static_cast<int>(std::fmod(k, 4));
  }
  const DoubleDouble square = angle * angle;
  std::size_t i = coefficients.size();
  double last = 0;
  while (i > 8)
    last = last * square.hi + coefficients[--i].hi;
  DoubleDouble series = last;
  while (i > 1)
    series = series * square + coefficients[--i];
  const DoubleDouble sine = angle + angle * (square * series), cosine = sqrt(1 - sine * sine);
  switch (quarters & 3) {
  case 0: return {sine, cosine};
  case 1: return {cosine, -sine};
  case 2: return {-sine, -cosine};
  default: return {-cosine, sine};
  }
}

inline DoubleDouble sin(DoubleDouble a) {
  return sine_and_cosine(a).sine;
}
inline DoubleDouble cos(DoubleDouble a) {
  return sine_and_cosine(a).cosine;
}
inline DoubleDouble tan(DoubleDouble a) {
  const SineAndCosine s = sine_and_cosine(a);
  return s.sine / s.cosine;
}

// The double angle, and the rest from what turning back by it leaves.
inline DoubleDouble atan2(DoubleDouble y, DoubleDouble x) {
  const double angle = std::atan2(y.hi, x.hi);
  const SineAndCosine s = sine_and_cosine(angle);
  const DoubleDouble along = x * s.cosine + y * s.sine, across = y * s.cosine - x * s.sine;
  if (!(along.hi > 0 && std::isfinite(along.hi))) return angle;
  return angle + across / along;
}

} // namespace flyball

// Each operation and function errs by at most one epsilon, relatively.
template <>
struct std::numeric_limits<flyball::DoubleDouble> : std::numeric_limits<double> {
  static constexpr int digits = 103, digits10 = 30;
  static constexpr flyball::DoubleDouble epsilon() { return 0x1p-102; }
};

template <>
inline constexpr flyball::DoubleDouble std::numbers::pi_v<flyball::DoubleDouble>{0x1.921fb54442d18p+1,
                                                                                 0x1.1a62633145c07p-53};

template <>
struct Eigen::NumTraits<flyball::DoubleDouble> : Eigen::GenericNumTraits<flyball::DoubleDouble> {
  enum { ReadCost = 2, AddCost = 20, MulCost = 25 };
};
