// The axes of a bearing, x, y and z as columns: unit vectors of the drawn pose.
#pragma once

#include "engine/mechanism/number_rates.hpp"

namespace flyball {

// In N, as `read` reads the mechanism's numbers; see bearing_x_towards.
template <class N>
Eigen::Matrix<N, 3, 3> bearing_axes(const Force& bearing, const NumberReader<N>& read) {
  using Vector = Eigen::Matrix<N, 3, 1>;
  const Vector z = Vector(read(bearing.axis)).normalized(),
               towards = read(bearing.x_axis, Vector(bearing_x_towards(bearing).template cast<N>()));
  Eigen::Matrix<N, 3, 3> axes;
  axes.col(0) = (towards - z * z.dot(towards)).normalized();
  axes.col(1) = z.cross(axes.col(0));
  axes.col(2) = z;
  return axes;
}

inline Mat3 bearing_axes(const Force& bearing) {
  return bearing_axes(bearing, NumberReader<double>());
}

} // namespace flyball
