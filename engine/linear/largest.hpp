// The largest entry of what may have none: a mechanism whose coordinates are all driven has no forces along
// free ones, and Eigen's reductions of nothing are undefined.
#pragma once

#include <Eigen/Core>

namespace flyball {

// Zero where `values` is empty.
template <class Derived>
double largest(const Eigen::DenseBase<Derived>& values) {
  return values.size() > 0 ? values.maxCoeff() : 0.;
}

// The largest magnitude; zero where `values` is empty.
template <class Derived>
double largest_size(const Eigen::MatrixBase<Derived>& values) {
  return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.;
}

} // namespace flyball
