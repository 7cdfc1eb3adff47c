// Seeded random mechanisms that settle near their drawn pose, and what an isometry must do to them.
#pragma once

#include "app/document/isometry.hpp"
#include "app/document/part.hpp"
#include "engine/report/analysis.hpp"
#include "tests/catch.hpp"

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace flyball::test {

// The same numbers with every standard library.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  double between(double from, double to) {
    return from + (to - from) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
  }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(count)); }
  bool chance(double probability) { return between(0, 1) < probability; }
  Vec3 box(double half) {
    const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;)
      if (const Vec3 v = box(1); v.norm() > 0.2) return v;
  }
  Quat rotation() { return Quat(Eigen::AngleAxisd(between(-3, 3), direction().normalized())); }
  template <class T>
  const T& one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
  }

 private:
  std::mt19937 engine_;
};

struct RandomOptions {
  // What acts along the components of spherical and free joints is the same along all three, so that it can
  // be turned into any direction.
  bool alike = false;
};

// A table on the ground, at rest or turning about the vertical, with up to four bodies on it by joints of
// all types, springs on every coordinate, stops, loops, gears, and forces of all types. No names end in
// digits.
Mechanism random_mechanism(std::uint32_t seed, const RandomOptions& options = {});

// All its bodies, joints and forces.
Selection everything_of(const Mechanism& mechanism);

// Checks that the second mechanism settles as the image of the first: every body, and every coordinate that
// stands for one of the first. `rename` gives the parts' names in the second. False where the first has no
// steady state to compare with.
bool check_settles_as_image(const Mechanism& first, const Mechanism& second, const Isometry& isometry,
                            const std::function<std::string(const std::string&)>& rename);

} // namespace flyball::test
