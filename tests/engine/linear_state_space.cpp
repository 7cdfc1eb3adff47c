// Poles, zeros and responses of systems that are known by their polynomials.
#include "engine/linear/spectral.hpp"
#include "engine/linear/state_space.hpp"
#include "tests/catch.hpp"
#include "tests/support/dice.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;
using Complex = std::complex<double>;

namespace {

// gain (s - z_1) ... / ((s - p_1) ...) of real zeros and poles, as a chain of first-order parts, states mixed
// at random and of sizes far apart.
StateSpace chain(const std::vector<double>& poles, const std::vector<double>& zeros, double gain,
                 Dice& dice) {
  const auto n = static_cast<Eigen::Index>(poles.size());
  StateSpace x;
  x.a.setZero(n, n);
  x.b.setZero(n, 1);
  x.c.setZero(1, n);
  x.d.setConstant(1, 1, gain);
  // The part i has 1 / (s - p), or (s - z) / (s - p) = 1 + (p - z) / (s - p), of what those before put out.
  for (Eigen::Index i = 0; i < n; ++i) {
    const double p = poles[static_cast<std::size_t>(i)];
    x.a.row(i) = x.c.row(0);
    x.a(i, i) = p;
    x.b(i, 0) = x.d(0, 0);
    if (static_cast<std::size_t>(i) < zeros.size()) {
      x.c(0, i) = p - zeros[static_cast<std::size_t>(i)];
    } else {
      x.c.setZero();
      x.c(0, i) = 1;
      x.d.setZero();
    }
  }
  Eigen::MatrixXd mix(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      mix(i, j) = dice.between(-1, 1) + (i == j ? 2 : 0);
  for (Eigen::Index j = 0; j < n; ++j)
    mix.col(j) *= dice.decade(-3, 3);
  const Eigen::MatrixXd back = *least_squares_columns(mix, Eigen::MatrixXd::Identity(n, n));
  return {{}, back * x.a * mix, back * x.b, x.c * mix, x.d};
}

void check_real(std::vector<Complex> found, std::vector<double> wanted, double tolerance) {
  REQUIRE(found.size() == wanted.size());
  std::ranges::sort(found, {}, [](Complex s) { return s.real(); });
  std::ranges::sort(wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    CHECK(std::abs(found[i] - wanted[i]) < tolerance * (1 + std::abs(wanted[i])));
  }
}

} // namespace

TEST_CASE("poles, zeros, gain and response are those of the polynomials", "[state-space]") {
  Dice dice(7);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    std::vector<double> poles, zeros;
    const int n = 1 + dice.below(6), m = dice.below(n + 1);
    for (int i = 0; i < n; ++i)
      poles.push_back(-1 - 2 * i - dice.between(0, 1));
    for (int i = 0; i < m; ++i)
      zeros.push_back(0.7 - 1.7 * i + dice.between(0, 0.9));
    const double gain = dice.sign() * dice.decade(-3, 3);
    const StateSpace x = chain(poles, zeros, gain, dice);
    check_real(*flyball::poles(x), poles, 1e-8);
    const auto found = flyball::zeros(x, 0, 0);
    REQUIRE(found);
    check_real(*found, zeros, 1e-7);
    const auto value = [&](Complex s) {
      Complex h = gain;
      for (const double z : zeros)
        h *= s - z;
      for (const double p : poles)
        h /= s - p;
      return h;
    };
    for (const Complex s : {Complex(0, 0.3), Complex(0, 4), Complex(0, 12)}) {
      const auto h = transfer(x, s);
      REQUIRE(h);
      CHECK(std::abs((*h)(0, 0) - value(s)) < 1e-8 * std::abs(value(s)));
    }
    const auto dc = static_gain(x);
    REQUIRE(dc);
    CHECK(std::abs((*dc)(0, 0) - value(0).real()) < 1e-10 * std::abs(value(0)));
    // The same with an E in front of the states' rates.
    StateSpace y = x;
    y.e.setIdentity(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double factor = dice.decade(-2, 2);
      y.e.row(i) *= factor;
      y.a.row(i) *= factor;
      y.b.row(i) *= factor;
    }
    check_real(*flyball::poles(y), poles, 1e-7);
    CHECK(std::abs((*transfer(y, {0, 2}))(0, 0) - value({0, 2})) < 1e-9 * std::abs(value({0, 2})));
  }
}

TEST_CASE("complex zeros, and systems that transfer nothing", "[state-space]") {
  // (s^2 + 4) / (s + 1)^3 in the form of a controller.
  StateSpace x;
  x.a.setZero(3, 3);
  x.a << -3, -3, -1, 1, 0, 0, 0, 1, 0;
  x.b.setZero(3, 1);
  x.b(0, 0) = 1;
  x.c.resize(1, 3);
  x.c << 1, 0, 4;
  x.d.setZero(1, 1);
  const auto found = zeros(x, 0, 0);
  REQUIRE(found);
  REQUIRE(found->size() == 2);
  CHECK(std::abs(found->front() - Complex(0, 2)) < 1e-12);
  x.c.setZero();
  CHECK_FALSE(zeros(x, 0, 0));
  x.c << 0, 0, 1;
  x.b.setZero();
  CHECK_FALSE(zeros(x, 0, 0));
  // An integrator has no static gain and no value at its pole.
  StateSpace integrator{{},
                        Eigen::MatrixXd::Zero(1, 1),
                        Eigen::MatrixXd::Ones(1, 1),
                        Eigen::MatrixXd::Ones(1, 1),
                        Eigen::MatrixXd::Zero(1, 1)};
  CHECK_FALSE(static_gain(integrator));
  CHECK_FALSE(transfer(integrator, 0));
  CHECK(zeros(integrator, 0, 0)->empty());
  // What integrates and is not felt does not matter: 1 / (s + 2), of a rate whose angle goes on.
  const bool massless = GENERATE(false, true);
  StateSpace turning{Eigen::MatrixXd::Identity(3, 3), Eigen::MatrixXd(3, 3), Eigen::MatrixXd(3, 1),
                     Eigen::MatrixXd(1, 3), Eigen::MatrixXd::Zero(1, 1)};
  turning.a << 0, 3, 1e3, 0, -2, 0, 0, 5e-4, -1e-4; // the third as many units, and the first feels both
  turning.b << 7, 1, 0;
  turning.c << 0, 1, 0;
  if (massless) turning.e(2, 2) = 0;
  REQUIRE(static_gain(turning));
  CHECK(std::abs((*static_gain(turning))(0, 0) - 0.5) < 1e-13);
  turning.c << 0, 0, 1;
  CHECK(std::abs((*static_gain(turning))(0, 0) - 2.5) < 1e-12);
  turning.c << 1e-3, 1, 0;
  CHECK_FALSE(static_gain(turning));
  // Without states there is the feed-through alone.
  StateSpace direct{{}, {}, Eigen::MatrixXd(0, 1), Eigen::MatrixXd(1, 0), Eigen::MatrixXd::Constant(1, 1, 3)};
  CHECK((*static_gain(direct))(0, 0) == 3);
  CHECK((*transfer(direct, {0, 1}))(0, 0) == Complex(3));
}
