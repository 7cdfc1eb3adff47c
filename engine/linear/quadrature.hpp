// Integrals of functions of one variable.
#pragma once

#include <array>
#include <cmath>

namespace flyball {

namespace quadrature {

// Nodes from the middle outwards and weights of Gauss and Kronrod's pair of 7 and 15 points (Kronrod 1965;
// Piessens et al., QUADPACK, 1983).
inline constexpr std::array<double, 8> nodes{0,
                                             0.207784955007898467600689403773245,
                                             0.405845151377397166906606412076961,
                                             0.586087235467691130294144691693803,
                                             0.741531185599394439863864773280788,
                                             0.864864423359769072789712788640926,
                                             0.949107912342758524526189684047851,
                                             0.991455371120812639206854697526329};
inline constexpr std::array<double, 8> kronrod{
    0.209482141084727828012999174891714, 0.204432940075298892414161999234649,
    0.190350578064785409913256402421014, 0.169004726639267902826583426598550,
    0.140653259715525918745189590510238, 0.104790010322250183839876322541518,
    0.063092092629978553290700663189204, 0.022935322010529224963732008058970};
inline constexpr std::array<double, 4> gauss{
    0.417959183673469387755102040816327, 0.381830050505118944950369775488975,
    0.279705391489276667901467771423780, 0.129484966168869693270611432679082}; // of every second node

struct Sum {
  double value = 0, error = 0, size = 0; // size: of |f|
};

template <class F>
Sum over(const F& f, double a, double b) {
  const double middle = (a + b) / 2, half = (b - a) / 2;
  const double first = f(middle);
  double fine = kronrod[0] * first, coarse = gauss[0] * first, size = std::abs(fine);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double left = f(middle - half * nodes[i]), right = f(middle + half * nodes[i]);
    fine += kronrod[i] * (left + right);
    size += kronrod[i] * (std::abs(left) + std::abs(right));
    if (i % 2 == 0) coarse += gauss[i / 2] * (left + right);
  }
  return {half * fine, std::abs(half * (fine - coarse)), std::abs(half) * size};
}

// Halves where the error is above `allowed`, `depth` times at most.
template <class F>
double halved(const F& f, double a, double b, const Sum& sum, double allowed, int depth) {
  if (!(sum.error > allowed) || depth == 0) return sum.value;
  const double middle = (a + b) / 2;
  return halved(f, a, middle, over(f, a, middle), allowed, depth - 1) +
         halved(f, middle, b, over(f, middle, b), allowed, depth - 1);
}

} // namespace quadrature

// To about 14 digits of the integral of |f|, by halving where the function is not smooth: a jump of its slope
// or curvature costs some evaluations more. Not finite where the function is not.
template <class F>
double integral(const F& f, double from, double to) {
  constexpr double relative = 1e-15;
  constexpr int most_halvings = 48;
  const quadrature::Sum whole = quadrature::over(f, from, to);
  return quadrature::halved(f, from, to, whole, relative * whole.size, most_halvings);
}

} // namespace flyball
