// The extended numbers of residuals, both kinds of them, against 113 bits.
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/stress/numbers.hpp"
#include "tests/stress/wide.hpp"

#include "engine/system/extended.hpp"
#include "engine/system/residual.hpp"
#include "engine/system/rotation_vector.hpp"

using namespace flyball;
using namespace flyball::stress;

namespace {

Quad exact(long double x) {
  return x;
}
Quad exact(DoubleDouble x) {
  return static_cast<Quad>(x.hi) + static_cast<Quad>(x.lo);
}

// A number of 106 bits and more that 113 bits hold.
DoubleDouble pair_of(Quad x) {
  const auto hi = static_cast<double>(x);
  return {hi, static_cast<double>(x - hi)};
}

Quad any(Dice& dice, double lowest_power, double highest_power) {
  const Quad size = scalbnq(1, static_cast<int>(dice.between(lowest_power, highest_power)));
  const Quad digits = dice.between(0.5, 1) + scalbnq(dice.between(-1, 1), -32) +
                      scalbnq(dice.between(-1, 1), -64) + scalbnq(dice.between(-1, 1), -96);
  return exact(pair_of(dice.between(-1, 1) < 0 ? -digits * size : digits * size));
}

// What is not a number is larger than all.
double larger(double a, double b) {
  return std::isnan(b) ? std::numeric_limits<double>::infinity() : std::max(a, b);
}

// The largest relative error seen, in units of epsilon, where what the judge or the theory cannot tell is
// allowed beside it.
struct Worst {
  double seen = 0;
  void see(DoubleDouble found, Quad wanted, Quad beside = 0) {
    const Quad epsilon = exact(std::numeric_limits<DoubleDouble>::epsilon());
    const Quad error = fabsq(exact(found) - wanted);
    const Quad allowed = epsilon * fabsq(wanted) + fabsq(beside);
    if (error != 0) seen = larger(seen, static_cast<double>(error / allowed));
  }
};

} // namespace

TEST_CASE("two doubles calculate to the last of 103 bits") {
  Dice dice(1);
  Worst sum, difference, product, quotient, root;
  int order = 0;
  for (int i = 0; i < 200000; ++i) {
    const Quad x = any(dice, -300, 300);
    // Alike in size in two of three, and in one all but opposite: then digits cancel.
    Quad y = i % 3 == 0 ? any(dice, -300, 300) : x * fabsq(any(dice, -3, 3));
    if (i % 3 == 1) y = -x * (1 + any(dice, -110, -1));
    const DoubleDouble a = pair_of(x), b = pair_of(y);
    y = exact(b);
    const Quad size = fabsq(x) + fabsq(y), rounded = scalbnq(size, -112); // by the judge
    sum.see(a + b, x + y, rounded);
    difference.see(b - a, y - x, rounded);
    product.see(a * b, x * y);
    quotient.see(a / b, x / y);
    root.see(sqrt(abs(a)), sqrtq(fabsq(x)));
    order += (a < b) != (x < y) || (a == b) != (x == y) || (a < -b) != (x < -y) || (a >= -b) != (x >= -y);
  }
  CHECK(sum.seen <= 1);
  CHECK(difference.seen <= 1);
  CHECK(product.seen <= 1);
  CHECK(quotient.seen <= 1);
  CHECK(root.seen <= 1);
  CHECK(order == 0);
  CHECK(sqrt(DoubleDouble(0)) == 0);
  CHECK(std::isnan(static_cast<double>(sqrt(DoubleDouble(-1)))));
}

TEST_CASE("functions of two doubles are right to 103 bits") {
  Dice dice(2);
  Worst sine, cosine, tangent, angle, huge;
  for (int i = 0; i < 20000; ++i) {
    Quad x = any(dice, -60, 3);
    if (i % 4 == 1) x = any(dice, 3, 40);
    if (i % 4 == 2)
      x = 2 * atan2q(1, 1) * static_cast<int>(dice.between(-1000, 1000)) * (1 + any(dice, -100, -10));
    const DoubleDouble a = pair_of(x);
    x = exact(a);
    const Quad lost = scalbnq(x, -150); // whole turns are taken off by 161 bits
    sine.see(sin(a), sinq(x), lost);
    cosine.see(cos(a), cosq(x), lost);
    tangent.see(tan(a), tanq(x), lost * (1 + tanq(x) * tanq(x)));
    const Quad y = any(dice, -60, 60), along = any(dice, -60, 60);
    angle.see(atan2(pair_of(y), pair_of(along)), atan2q(y, along));
    const Quad far = any(dice, 60, 100); // the largest numbers of scenes
    huge.see(sin(pair_of(far)), sinq(far), scalbnq(far, -150));
  }
  CHECK(sine.seen <= 1);
  CHECK(cosine.seen <= 1);
  CHECK(tangent.seen <= 1);
  CHECK(angle.seen <= 1);
  CHECK(huge.seen <= 1);
  for (const auto& [y, x] : {std::pair(0., 1.), {0., -1.}, {1., 0.}, {-1., 0.}, {0., 0.}, {3., -3.}}) {
    CAPTURE(y, x);
    CHECK(static_cast<double>(fabsq(exact(atan2(DoubleDouble(y), DoubleDouble(x))) - atan2q(y, x))) < 1e-30);
  }
  CHECK(std::isnan(static_cast<double>(sin(DoubleDouble(std::numeric_limits<double>::infinity())))));
}

TEST_CASE("the coefficient of rotation vectors is the same by its series and by its formula") {
  for (const double n : {0.1, 0.2, 0.2499}) {
    CAPTURE(n);
    const Quad length = n, series = InverseJacobianCoefficients<Wide>(n).b.v;
    const Quad formula = 1 / (length * length) - 1 / (2 * length * tanq(length / 2));
    CHECK(static_cast<double>(fabsq(series - formula)) < 1e-30);
  }
}

namespace {

using stress::Dual; // of 113 bits, not that of expressions

template <class S>
struct Evaluated {
  Configuration<S> q, moved;
  Residual<S> residual;
};

// The balance where refine() evaluates it, and the configuration a step further.
template <class S>
Evaluated<S> evaluate(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                      const Eigen::VectorXd& lambda, const Eigen::VectorXd& step, double t) {
  Evaluated<S> out;
  out.q = q.cast<S>();
  for (const Link& link : system.links)
    if (link.v >= 0 && link.type == LinkType::spherical) out.q.template segment<4>(link.q).normalize();
  Kinematics<S> kinematics;
  forward<S>(system, parameters, out.q, t, kinematics);
  evaluate_residual<S>(system, parameters, out.q, lambda.cast<S>(), kinematics, out.residual);
  out.moved = out.q;
  retract<S>(system, step.cast<S>(), out.moved);
  return out;
}

// The largest error relative to sizes.
template <class S>
double error_of(const Configuration<S>& found, const Configuration<Dual>& wanted,
                const Eigen::VectorXd& size) {
  double worst = 0;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const auto error = static_cast<double>(fabsq(exact(found[i]) - wanted[i].v.v));
    if (error != 0) worst = larger(worst, error / size[i]);
  }
  return worst;
}

struct Loss {
  double force = 0, phi = 0, moved = 0;
  template <class S>
  void see(const Evaluated<S>& found, const Evaluated<Dual>& wanted, const Magnitudes& size) {
    force = std::max(force, error_of(found.residual.f, wanted.residual.f, size.force));
    phi = std::max(phi, error_of(found.residual.phi, wanted.residual.phi, size.phi));
    Eigen::VectorXd reach(wanted.moved.size());
    for (Eigen::Index i = 0; i < reach.size(); ++i)
      reach[i] = 1 + std::abs(static_cast<double>(wanted.moved[i].v));
    moved = std::max(moved, error_of(found.moved, wanted.moved, reach));
  }
};

} // namespace

TEST_CASE("the balance loses no digits in either kind of extended numbers") {
  Loss of_long, of_pairs;
  int springs = 0, balls = 0, loops = 0, drives = 0;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    INFO("seed " << seed);
    reference::RandomOptions options;
    options.loops = static_cast<int>(seed % 3);
    options.drives = seed % 4 == 3 ? reference::RandomDrives::none : reference::RandomDrives::several;
    options.steady = false;
    const Mechanism m = reference::random_mechanism(seed, options);
    const System system = compile(m);
    Parameters parameters;
    bind(system, m, parameters);
    Dice dice(seed);
    const auto random = [&](int count, double size) -> Eigen::VectorXd {
      return Eigen::VectorXd::NullaryExpr(count, [&] { return dice.between(-size, size); });
    };
    Eigen::VectorXd q;
    drawn_configuration(system, parameters, q);
    // Near the drawn pose, and far from it.
    retract<double>(system, random(system.nv, seed % 2 == 0 ? 0.1 : 2), q);
    const Eigen::VectorXd lambda = random(system.rows, 20), step = random(system.nv, 0.5);
    const double t = dice.between(-2, 2);
    Kinematics<double> kinematics;
    forward<double>(system, parameters, q, t, kinematics);
    Magnitudes size;
    evaluate_magnitudes(system, parameters, q, lambda, kinematics, size);
    const auto wanted = evaluate<stress::Dual>(system, parameters, q, lambda, step, t);
    of_long.see(evaluate<long double>(system, parameters, q, lambda, step, t), wanted, size);
    of_pairs.see(evaluate<DoubleDouble>(system, parameters, q, lambda, step, t), wanted, size);
    springs += !system.springs.empty();
    balls += std::ranges::any_of(system.links, [](const Link& l) { return l.type == LinkType::spherical; });
    loops += !system.cuts.empty();
    drives += system.drives.size() > 1;
  }
  for (const double error : {of_long.force, of_long.phi, of_long.moved})
    CHECK(error < 2e-18);
  for (const double error : {of_pairs.force, of_pairs.phi, of_pairs.moved})
    CHECK(error < 1e-30);
  CHECK(springs > 200);
  CHECK(balls > 200);
  CHECK(loops > 200);
  CHECK(drives > 150);
}
