// Seeded random numbers, the same with every standard library: the distributions of those differ.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace flyball::test {

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}

  double between(double from, double to) {
    return from + (to - from) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
  }
  double decade(double from, double to) { return std::pow(10, between(from, to)); }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(count)); }
  bool chance(double probability) { return between(0, 1) < probability; }
  double sign() { return chance(0.5) ? 1 : -1; }

  // In a cube around zero with edges of twice `half`.
  Vec3 box(double half) {
    const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
    return {x, y, z};
  }
  // Of length 1, every way as likely.
  Vec3 direction() {
    for (;;)
      if (const Vec3 v = box(1); v.norm() > 0.2 && v.norm() < 1) return v.normalized();
  }
  // Of length 1, at right angles to the axis.
  Vec3 across(const Vec3& axis) {
    for (;;)
      if (const Vec3 v = axis.normalized().cross(direction()); v.norm() > 0.2) return v.normalized();
  }
  Quat rotation() {
    const Vec3 axis = direction();
    const double angle = between(-3, 3);
    return Quat(Eigen::AngleAxisd(angle, axis)).normalized();
  }

  template <class T>
  const T& one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
  }
  template <class T>
  void shuffle(std::vector<T>& list) {
    for (int i = static_cast<int>(list.size()) - 1; i > 0; --i)
      std::swap(list[static_cast<std::size_t>(i)], list[static_cast<std::size_t>(below(i + 1))]);
  }

 private:
  std::mt19937 engine_;
};

} // namespace flyball::test
