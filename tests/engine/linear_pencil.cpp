// Eigenvalues of M q'' + D q' + K q = 0 whose numbers are far apart, against characteristic polynomials.
#include "engine/linear/pencil.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <complex>
#include <utility>

using namespace flyball;
using Complex = std::complex<double>;

TEST_CASE("what is fast costs no digits of what is slow beside it") {
  // x1 of a body, x2 of a heavy one that hangs on it: the first is light, or its joint far stiffer.
  const double heavy = 2;
  const std::pair<double, double> kinds[] = {{1e-3, 1}, {1e-6, 1}, {1e-9, 1},  {1e-12, 1},
                                             {1, 1e4},  {1, 1e8},  {1e-6, 1e4}};
  for (const auto& kind : kinds)
    for (const bool damped : {false, true}) {
      const double light = kind.first, stiff = kind.second;
      CAPTURE(light, stiff, damped);
      const double k1 = 30 * stiff, k2 = 50, c1 = damped ? std::sqrt(stiff) : 0, c2 = damped ? 0.5 : 0;
      const Eigen::MatrixXd mass{{light + heavy, heavy}, {heavy, heavy}};
      const Eigen::MatrixXd velocity = Eigen::Vector2d(c1, c2).asDiagonal(),
                            stiffness = Eigen::Vector2d(k1, k2).asDiagonal();
      const auto found = pencil_eigenvalues(mass, velocity, stiffness, nullptr, mass.diagonal());
      REQUIRE(found);
      REQUIRE(found->size() == 4);
      const auto characteristic = [&](Complex s) {
        return (light * s * s + c1 * s + k1) * (heavy * s * s + c2 * s + k2) + heavy * s * s * (c2 * s + k2);
      };
      int slow = 0;
      for (const Complex s : *found) {
        if (!damped) CHECK(s.real() == 0);
        if (std::abs(s) > 10) continue; // of the light body's
        ++slow;
        const Complex step = 1e-4 * s,
                      slope = (characteristic(s + step) - characteristic(s - step)) / (2. * step);
        CHECK(std::abs(characteristic(s) / slope) < 1e-12 * std::abs(s));
      }
      CHECK(slow == 2);
    }
}

TEST_CASE("of a shaft that torques turn what is fast costs no digits either") {
  // The same two bodies, on a slide whose position does not matter, of 3 kg and with a damper.
  for (const double light : {1e-3, 1e-6, 1e-9}) {
    CAPTURE(light);
    const double shaft = 3, heavy = 2, k1 = 30, k2 = 50, c0 = 1, c1 = 1, c2 = 0.5;
    const Eigen::MatrixXd mass{{shaft + light + heavy, light + heavy, heavy},
                               {light + heavy, light + heavy, heavy},
                               {heavy, heavy, heavy}};
    const Eigen::MatrixXd velocity = Eigen::Vector3d(c0, c1, c2).asDiagonal(),
                          stiffness = Eigen::Vector3d(0, k1, k2).asDiagonal();
    const auto found =
        eigenvalues_without_cyclic(mass, velocity, stiffness, Eigen::Vector3d::UnitX(), 1e-13, nullptr);
    REQUIRE(found);
    REQUIRE(found->size() == 5);
    // From the far end to the shaft: where each body is, and the force that pulls it on.
    const auto characteristic = [&](Complex s) {
      const Complex force2 = -(c2 * s + k2), at1 = force2 / (heavy * s * s) - 1., // x2 = 1
          force1 = force2 + light * s * s * at1, at0 = at1 + force1 / (c1 * s + k1);
      return (shaft * s * s + c0 * s) * at0 + force1;
    };
    for (const Complex s : *found) {
      if (std::abs(s) > 100) continue;
      const Complex step = 1e-4 * s,
                    slope = (characteristic(s + step) - characteristic(s - step)) / (2. * step);
      CHECK(std::abs(characteristic(s) / slope) < 5e-13 * std::abs(s));
    }
  }
}
