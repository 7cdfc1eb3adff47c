// Dual numbers in vectors and matrices: what Eigen asks of a scalar.
#pragma once

#include "engine/mechanism/dual.hpp"

#include <Eigen/Core>

namespace flyball {

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
