// Drives that give a torque, and Haug's governor in closed form.
#pragma once

#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "tests/catch.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/solutions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball::test {

// The speed that was found of a joint (rad/s, m/s); throws where none was.
inline double speed(const Solution& s, std::string_view joint) {
  INFO(s.message);
  return coordinate(s, joint).speed.value();
}

// That the motion from the drawn pose has come to the speed that was found of a joint, after this time (s),
// within 1e-7 of `size` (rad/s, m/s) and the speed.
inline void expect_same_motion(const Mechanism& m, const Solution& s, const std::string& joint,
                               double duration, double size) {
  SimulationOptions options;
  options.duration = duration;
  const Run motion = simulate(m, options);
  INFO(motion.message);
  const auto track = std::ranges::find(motion.coordinates, joint, &CoordinateTrack::joint);
  REQUIRE(track != motion.coordinates.end());
  const double found = speed(s, joint);
  CHECK_THAT(track->rate.back(), Catch::Matchers::WithinAbs(found, 1e-7 * (size + std::abs(found))));
}

// A joint whose drive gives a torque by a law, or as a number. The search for its speed begins at `guess`.
inline Joint torque_driven(Joint j, double guess, const std::string& law, const std::string& load = "") {
  Drive& drive = j.coordinates[0].drive.emplace();
  drive.speed = guess;
  const auto give = [&](const std::string& key, const std::string& text, std::optional<double>& number) {
    char* end = nullptr;
    number = std::strtod(text.c_str(), &end);
    if (end != text.c_str() + text.size()) {
      number = 0;
      j.formulas.push_back({"drive." + key, text});
    }
  };
  give("torque", law, drive.torque);
  if (!load.empty()) give("load", load, drive.load);
  return j;
}

// A mechanism with the torque of its drive "spin" by this law.
inline Mechanism with_torque(Mechanism m, const std::string& law) {
  for (Joint& joint : m.joints) {
    if (joint.name != "spin") continue;
    joint.coordinates[0].drive->torque = 0;
    std::erase_if(joint.formulas, [](const Formula& f) { return f.key == "drive.torque"; });
    joint.formulas.push_back({"drive.torque", law});
  }
  return m;
}

// Haug's governor as two coordinates, its arms' angle a and the spindle's: m(a), J(a), V(a) and the collar's
// s(a), with derivatives.
struct HaugGovernor {
  static constexpr double arm = 0.16, link_at = 0.08, link = 0.10922, g = standard_gravity;
  double a, s, s1, s2, j, j1, j2, v1, v2, m;

  explicit HaugGovernor(double angle) : a(angle) {
    const double sine = std::sin(a), cosine = std::cos(a), b = link_at;
    const double r = std::sqrt(link * link - b * b * cosine * cosine), r1 = b * b * sine * cosine / r;
    s = b * sine + r;
    s1 = b * cosine + r1;
    s2 = -b * sine + (b * b * (cosine * cosine - sine * sine) - r1 * r1) / r;
    j = 50.125 + 2 * (0.1 + arm * arm * cosine * cosine);
    j1 = -4 * arm * arm * sine * cosine;
    j2 = -4 * arm * arm * (cosine * cosine - sine * sine);
    const double spring = 1000 * (s - 0.15);
    v1 = -2 * g * arm * cosine - g * s1 + spring * s1;
    v2 = 2 * g * arm * sine - g * s2 + spring * s2 + 1000 * s1 * s1;
    m = 2 * (0.1 + arm * arm) + s1 * s1;
  }
  // Where the collar stands at s.
  static HaugGovernor at_collar(double wanted) {
    double angle = 0.78;
    for (int i = 0; i < 50; ++i)
      angle -= (HaugGovernor(angle).s - wanted) / HaugGovernor(angle).s1;
    return HaugGovernor(angle);
  }
  double speed() const { return std::sqrt(2 * v1 / j1); }
  // (m x^2 + c s1^2 x + K)(J x) + w J1 (J1 w x - gain s1), x^3 first.
  std::array<double, 4> characteristic(double damper, double gain) const {
    const double w = speed(), k = v2 - w * w * j2 / 2;
    return {m * j, damper * s1 * s1 * j, k * j + w * j1 * w * j1, -w * j1 * gain * s1};
  }
};

// Of four coefficients, that of x^3 first.
inline std::complex<double> cubic(const std::array<double, 4>& p, std::complex<double> x) {
  return ((p[0] * x + p[1]) * x + p[2]) * x + p[3];
}

} // namespace flyball::test
