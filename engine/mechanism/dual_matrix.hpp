// Dual numbers in vectors and matrices: what Eigen asks of a scalar.
#pragma once

#include "engine/mechanism/dual.hpp"

#include <Eigen/Core>

namespace flyball {

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
inline Dual atan2(Dual y, Dual x) {
  const double turn = y.rate * x.value - x.rate * y.value;
  return {std::atan2(y.value, x.value), turn == 0 ? 0 : turn / (x.value * x.value + y.value * y.value)};
}
inline Dual abs(Dual a) {
  return a.value < 0 ? -a : a;
}

// The numbers of a mechanism that calculations with S take: their rates, too, where S has rates.
template <class S>
struct NumberFor {
  using type = double;
};
template <>
struct NumberFor<Dual> {
  using type = Dual;
};
template <class S>
using NumberOf = typename NumberFor<S>::type;

} // namespace flyball

namespace Eigen {

template <>
struct NumTraits<flyball::Dual> : NumTraits<double> {
  using Real = flyball::Dual;
  using NonInteger = flyball::Dual;
  using Nested = flyball::Dual;
  using Literal = flyball::Dual;
  enum { RequireInitialization = 1, ReadCost = 2, AddCost = 2, MulCost = 4 };
};

} // namespace Eigen
