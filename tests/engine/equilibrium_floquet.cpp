// Stability where the linearised motion turns with the drives: multipliers against closed forms.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/stability/floquet.hpp"
#include "engine/stability/periodic_motion.hpp"
#include "engine/system/common_period.hpp"

#include <complex>
#include <random>

using namespace flyball;
using namespace flyball::test;

namespace {

using Complex = std::complex<double>;

// Two springs on arms of a turntable pull at a bead: in the table's frame the bead's stiffness is that along
// the springs, 2 k, and that across them, 2 k (R - L) / R.
struct Turntable {
  double speed = 20, radius = 1, stiffness = 50, free_length = 2, mass = 1; // rad/s, m, N/m, m, kg
  double along() const { return 2 * stiffness; }
  double across() const { return 2 * stiffness * (radius - free_length) / radius; }
};

void add_turntable(const Turntable& t, Mechanism& m) {
  m.bodies.push_back(body("table", 1, Vec3::Zero(), Vec3(1, 1, 1)));
  Joint spin = revolute("spin", "ground", "table", Vec3::Zero(), Vec3::UnitZ());
  spin.coordinates[0].drive = Drive{t.speed};
  m.joints.push_back(spin);
  for (const double side : {1., -1.}) {
    Force f;
    f.name = side > 0 ? "east" : "west";
    f.type = ForceType::spring;
    f.bodies = {"table", "bead"};
    f.points = {Vec3(side * t.radius, 0, 0), Vec3::Zero()};
    f.stiffness = t.stiffness;
    f.free_length = t.free_length;
    m.forces.push_back(f);
  }
}

// The bead on a fixed slide: m x'' + c x' + (k_0 + k_2 cos 2 w t) x = 0, Mathieu's equation.
Mechanism mathieu(const Turntable& t, double damping = 0) {
  Mechanism m;
  m.name = "Mathieu";
  m.bodies.push_back(body("bead", t.mass, Vec3::Zero()));
  add_turntable(t, m);
  Joint slide = prismatic("x", "ground", "bead", Vec3::Zero(), Vec3::UnitX());
  slide.coordinates[0].damping = damping;
  m.joints.push_back(slide);
  return m;
}

// The bead free in the plane: the rotating saddle.
Mechanism saddle(const Turntable& t) {
  Mechanism m;
  m.name = "Rotating saddle";
  m.bodies.push_back(body("carriage", 0, Vec3::Zero()));
  m.bodies.push_back(body("bead", t.mass, Vec3::Zero()));
  add_turntable(t, m);
  m.joints.push_back(prismatic("x", "ground", "carriage", Vec3::Zero(), Vec3::UnitX()));
  m.joints.push_back(prismatic("y", "carriage", "bead", Vec3::Zero(), Vec3::UnitY()));
  return m;
}

// Characteristic values of Mathieu's equation x'' + (a - 2 q cos 2 tau) x = 0, by size: eigenvalues of the
// tridiagonal matrices of their Fourier series (Abramowitz and Stegun, 20.2). Between the (2 i)th and the (2
// i + 1)st motions stay bounded, beyond them they grow.
std::vector<double> characteristic_values(double q) {
  constexpr int n = 40;
  std::vector<double> all;
  for (const int kind : {0, 1, 2, 3}) { // even and odd, of period pi and 2 pi
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      const double order = kind == 0 ? 2. * i : kind == 1 ? 2. * (i + 1) : 2. * i + 1;
      m(i, i) = order * order;
      if (i + 1 < n) m(i, i + 1) = m(i + 1, i) = kind == 0 && i == 0 ? std::sqrt(2.) * q : q;
    }
    if (kind == 2) m(0, 0) += q;
    if (kind == 3) m(0, 0) -= q;
    const auto values = symmetric_eigenvalues(m).value();
    all.insert(all.end(), values.begin(), values.end());
  }
  std::ranges::sort(all);
  return all;
}

double largest(const Solution& s) {
  REQUIRE(s.floquet);
  return std::abs(s.floquet->multipliers.front());
}

} // namespace

TEST_CASE("common_period: the shortest time of whole turns", "[floquet]") {
  const double turn = 2 * std::numbers::pi;
  CHECK(common_period({3}, 64).value() == Approx(turn / 3));
  CHECK(common_period({3, 6}, 64).value() == Approx(turn / 3));
  CHECK(common_period({4, -6}, 64).value() == Approx(turn / 2));
  CHECK(common_period({15, 10, 6}, 64).value() == Approx(turn));
  CHECK_FALSE(common_period({1, std::numbers::sqrt2}, 1000));
  CHECK_FALSE(common_period({1, 65}, 64));
  CHECK_FALSE(common_period({}, 64));
}

TEST_CASE("Floquet: Mathieu's equation is bounded between its characteristic values", "[floquet]") {
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * std::uniform_real_distribution(0., 1.)(random);
  };
  int grows = 0, bounded = 0;
  for (int i = 0; i < 60; ++i) {
    Turntable t;
    t.radius = uniform(0.5, 2);
    t.free_length = uniform(0.2, 1.4) * t.radius;
    t.stiffness = uniform(10, 100);
    t.mass = uniform(0.2, 3);
    t.speed = uniform(0.5, 2.5) * std::sqrt(t.stiffness / t.mass);
    const double unit = t.mass * t.speed * t.speed;
    const double a = (t.along() + t.across()) / 2 / unit, q = (t.along() - t.across()) / 4 / unit;
    const std::vector<double> edges = characteristic_values(q);
    const auto above = std::ranges::upper_bound(edges, a);
    if (above == edges.begin() || std::abs(*above - a) < 1e-4 || std::abs(*std::prev(above) - a) < 1e-4)
      continue;
    const bool inside = (above - edges.begin()) % 2 == 1;
    const Solution s = solve(mathieu(t), nearest());
    INFO(s.message << " a " << a << " q " << q);
    REQUIRE(s.status == Status::converged);
    CHECK(s.stability_reason == StabilityReason::floquet);
    CHECK(s.stable == inside);
    CHECK(s.floquet->period == Approx(2 * std::numbers::pi / t.speed));
    if (inside) CHECK(largest(s) == Approx(1).margin(1e-9));
    (inside ? bounded : grows) += 1;
  }
  CHECK(grows > 5);
  CHECK(bounded > 20);
}

TEST_CASE("Floquet: damping takes c / 2 m off every growth rate of Mathieu's equation", "[floquet]") {
  Turntable t;
  t.free_length = 0.8;
  t.mass = 0.5;
  t.speed = std::sqrt(t.stiffness / t.mass);
  const double damping = 0.6;
  const Solution without = solve(mathieu(t), nearest()), with = solve(mathieu(t, damping), nearest());
  // With x = exp(-c t / 2 m) y the stiffness of y is less by c^2 / 4 m^2: at small damping hardly.
  CHECK(without.floquet->growth.front() + without.floquet->growth.back() == Approx(0).margin(1e-9));
  CHECK(with.floquet->growth.front() + with.floquet->growth.back() == Approx(-damping / t.mass));
  CHECK(with.floquet->growth.front() ==
        Approx(without.floquet->growth.front() - damping / (2 * t.mass)).margin(2e-2));
}

TEST_CASE("Floquet: a loop whose null space turns with the drive", "[floquet]") {
  // The bead moves in a plane that leans against the table's: on two slides of the ground, or on three of the
  // table and tied to the ground, so that the directions that are free turn in the table's coordinates.
  const double lean = 0.3;
  const Vec3 down(0, std::cos(lean), -std::sin(lean)), normal(0, std::sin(lean), std::cos(lean));
  for (const double speed : {5., 7.8, 8.7, 9.5, 20.}) {
    Turntable t;
    t.speed = speed;
    t.free_length = 0.5;
    const auto with = [&](std::vector<Joint> slides, std::vector<Body> carriages) {
      Mechanism m;
      m.name = "Leaning bead";
      m.gravity.setZero();
      m.bodies = std::move(carriages);
      m.bodies.push_back(body("bead", t.mass, Vec3::Zero()));
      add_turntable(t, m);
      m.joints.insert(m.joints.end(), slides.begin(), slides.end());
      return m;
    };
    const Solution plain = solve(with({prismatic("x", "ground", "across", Vec3::Zero(), Vec3::UnitX()),
                                       prismatic("s", "across", "bead", Vec3::Zero(), down)},
                                      {body("across", 0, Vec3::Zero())}),
                                 nearest());
    const Solution tied = solve(with({prismatic("u", "table", "first", Vec3::Zero(), Vec3::UnitX()),
                                      prismatic("v", "first", "second", Vec3::Zero(), Vec3::UnitY()),
                                      prismatic("w", "second", "bead", Vec3::Zero(), Vec3::UnitZ()),
                                      distance("tie", "ground", "bead", -3 * normal, Vec3::Zero())},
                                     {body("first", 0, Vec3::Zero()), body("second", 0, Vec3::Zero())}),
                                nearest());
    CAPTURE(speed, tied.message, plain.message);
    REQUIRE(tied.floquet);
    REQUIRE(plain.floquet);
    CHECK(tied.stable == plain.stable);
    REQUIRE(tied.floquet->growth.size() == plain.floquet->growth.size());
    CHECK(tied.floquet->period == Approx(plain.floquet->period));
    for (std::size_t i = 0; i < plain.floquet->growth.size(); ++i)
      CHECK(std::abs(tied.floquet->growth[i] - plain.floquet->growth[i]) < 1e-7);
  }
}

namespace {

// Mathieu's bead on two slides of the table, tied to a far point of the ground: the direction that is free
// makes a whole turn in the table's coordinates.
Mechanism tied_bead(const Turntable& t) {
  Mechanism m;
  m.name = "Tied bead";
  m.gravity.setZero();
  m.bodies = {body("first", 0, Vec3::Zero()), body("bead", t.mass, Vec3::Zero())};
  add_turntable(t, m);
  m.joints.push_back(prismatic("u", "table", "first", Vec3::Zero(), Vec3::UnitX()));
  m.joints.push_back(prismatic("v", "first", "bead", Vec3::Zero(), Vec3::UnitY()));
  m.joints.push_back(distance("tie", "ground", "bead", Vec3(0, -4, 0), Vec3::Zero()));
  return m;
}

} // namespace

TEST_CASE("Floquet: a null space that makes a whole turn with the drive", "[floquet]") {
  // The tie carries no force, so that the bead moves as on a slide that stands still.
  for (const double speed : {5., 7.8, 8.7, 9.5, 20.}) {
    Turntable t;
    t.speed = speed;
    t.free_length = 0.5;
    const Solution plain = solve(mathieu(t), nearest()), tied = solve(tied_bead(t), nearest());
    CAPTURE(speed, tied.message, plain.message);
    REQUIRE(tied.floquet);
    REQUIRE(plain.floquet);
    CHECK(tied.stable == plain.stable);
    CHECK(tied.floquet->period == Approx(plain.floquet->period));
    REQUIRE(tied.floquet->multipliers.size() == plain.floquet->multipliers.size());
    for (const Complex mu : plain.floquet->multipliers)
      CHECK(std::ranges::any_of(tied.floquet->multipliers,
                                [&](Complex other) { return std::abs(other - mu) < 1e-8 * std::abs(mu); }));
  }
}

TEST_CASE("PeriodicMotion: a basis that comes back mirrored has twice the period", "[floquet]") {
  // After half a turn the table looks the same and the line that is free is the same, the other way along.
  Turntable t;
  t.free_length = 0.5;
  const Mechanism m = tied_bead(t);
  const System system = compile_for_drives(m);
  Parameters parameters;
  bind(system, m, parameters);
  Scaling scaling;
  set_scaling(system, parameters, scaling);
  const Problem problem{system, parameters, scaling};
  Eigen::VectorXd q;
  drawn_configuration(system, parameters, q);
  Workspace w;
  const double turn = 2 * std::numbers::pi / t.speed;
  const auto motion = PeriodicMotion::sample(problem, q, turn / 2, 1, w);
  REQUIRE(motion);
  CHECK(motion->period() == Approx(turn));
  const auto whole = PeriodicMotion::sample(problem, q, turn, 1, w);
  REQUIRE(whole);
  for (const double part : {0., 0.2, 0.7}) {
    Eigen::MatrixXd a, b;
    REQUIRE(motion->state_matrix(part * turn, a));
    REQUIRE(whole->state_matrix(part * turn, b));
    CHECK((a - b).norm() < 1e-9 * b.norm());
  }
}

TEST_CASE("Floquet: a rotating saddle holds what it carries where it turns fast enough", "[floquet]") {
  // In the table's frame m (x'' - 2 w y' - w^2 x) + k x = 0 and the like: eigenvalues of a constant pencil.
  Turntable t;
  for (const double speed : {2., 6., 9.9, 10.1, 14., 25.}) {
    t.speed = speed;
    const Solution s = solve(saddle(t), nearest());
    INFO(s.message << " speed " << speed);
    REQUIRE(s.floquet);
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a.topRightCorner<2, 2>().setIdentity();
    a(2, 0) = speed * speed - t.along() / t.mass;
    a(3, 1) = speed * speed - t.across() / t.mass;
    a(2, 3) = 2 * speed;
    a(3, 2) = -2 * speed;
    double growth = -1e9;
    const std::vector<Complex> all = eigenvalues(a).value();
    for (const Complex x : all)
      growth = std::max(growth, x.real());
    CHECK(s.floquet->growth.front() == Approx(growth).margin(1e-7));
    CHECK(s.stable == (speed > 10));
  }
}

namespace {

// Blades with lag hinges on a hub that two springs hold: ground resonance (Coleman and Feingold, NACA report
// 1351).
struct Rotor {
  int blades = 4;
  double speed = 30, hub_mass = 50, hub_stiffness_x = 3e4, hub_stiffness_y = 5e4, hub_damping = 20;
  double mass = 3, hinge = 0.15, length = 0.8, inertia = 0.3, lag_stiffness = 150, lag_damping = 1;
};

Mechanism rotor(const Rotor& r) {
  Mechanism m;
  m.name = "Ground resonance";
  m.bodies.push_back(body("carriage", 0, Vec3::Zero()));
  m.bodies.push_back(body("hub", r.hub_mass, Vec3::Zero()));
  m.bodies.push_back(body("head", 0, Vec3::Zero()));
  const auto slide = [&](const char* name, const char* parent, const char* child, const Vec3& axis,
                         double k) {
    Joint j = prismatic(name, parent, child, Vec3::Zero(), axis);
    j.coordinates[0].spring = CoordinateSpring{k, 0};
    j.coordinates[0].damping = r.hub_damping;
    m.joints.push_back(j);
  };
  slide("x", "ground", "carriage", Vec3::UnitX(), r.hub_stiffness_x);
  slide("y", "carriage", "hub", Vec3::UnitY(), r.hub_stiffness_y);
  Joint spin = revolute("spin", "hub", "head", Vec3::Zero(), Vec3::UnitZ());
  spin.coordinates[0].drive = Drive{r.speed};
  m.joints.push_back(spin);
  for (int i = 0; i < r.blades; ++i) {
    const double angle = 2 * std::numbers::pi * i / r.blades;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const std::string name = "blade" + std::to_string(i);
    m.bodies.push_back(
        body(name, r.mass, (r.hinge + r.length) * out, Vec3(r.inertia / 2, r.inertia / 2, r.inertia)));
    Joint lag = revolute("lag" + std::to_string(i), "head", name, r.hinge * out, Vec3::UnitZ());
    lag.coordinates[0].spring = CoordinateSpring{r.lag_stiffness, 0};
    lag.coordinates[0].damping = r.lag_damping;
    m.joints.push_back(lag);
  }
  return m;
}

// The largest growth rate in multiblade coordinates, whose coefficients are constant: x, y, and the cosine
// and sine parts of the lag; what all blades do alike leaves the hub alone.
double multiblade_growth(const Rotor& r) {
  const double s = r.mass * r.length, w = r.speed, n = r.blades;
  const double i = r.inertia + r.mass * r.length * r.length;
  const double k = r.lag_stiffness + r.hinge * s * w * w;
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero(), d = m, c = m; // x, y, cos, sin
  m(0, 0) = m(1, 1) = r.hub_mass + n * r.mass;
  m(0, 3) = -s * n / 2;
  m(1, 2) = s * n / 2;
  m(2, 1) = s;
  m(3, 0) = -s;
  m(2, 2) = m(3, 3) = i;
  d(0, 0) = d(1, 1) = r.hub_damping;
  d(2, 2) = d(3, 3) = r.lag_damping;
  d(2, 3) = 2 * w * i;
  d(3, 2) = -2 * w * i;
  c(0, 0) = r.hub_stiffness_x;
  c(1, 1) = r.hub_stiffness_y;
  c(2, 2) = c(3, 3) = k - w * w * i;
  c(2, 3) = w * r.lag_damping;
  c(3, 2) = -w * r.lag_damping;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(8, 8);
  a.topRightCorner(4, 4).setIdentity();
  a.bottomLeftCorner(4, 4) = -m.inverse() * c;
  a.bottomRightCorner(4, 4) = -m.inverse() * d;
  double growth = -r.lag_damping / (2 * i);
  const std::vector<Complex> all = eigenvalues(a).value();
  for (const Complex x : all)
    growth = std::max(growth, x.real());
  return growth;
}

} // namespace

TEST_CASE("Floquet: ground resonance as in multiblade coordinates", "[floquet]") {
  bool resonates = false, rests = false;
  for (const int blades : {3, 4, 5})
    for (const double speed : {6., 18., 26., 29., 32., 36., 45., 70.}) {
      Rotor r;
      r.blades = blades;
      r.speed = speed;
      const Solution s = solve(rotor(r));
      INFO(s.message << " blades " << blades << " speed " << speed);
      REQUIRE(s.status == Status::converged);
      REQUIRE(s.floquet);
      const double growth = multiblade_growth(r);
      CHECK(s.floquet->growth.front() == Approx(growth).epsilon(1e-7).margin(1e-8));
      CHECK(s.stable == (growth < 0));
      CHECK(s.stability_reason == StabilityReason::floquet);
      (growth > 0 ? resonates : rests) = true;
    }
  CHECK(resonates);
  CHECK(rests);
}

TEST_CASE("Floquet: two blades on a hub with one spring have no constant coefficients, and still a verdict",
          "[floquet]") {
  Rotor r;
  r.blades = 2;
  r.speed = 29;
  const Solution s = solve(rotor(r));
  REQUIRE(s.status == Status::converged);
  REQUIRE(s.floquet);
  // Liouville: the product of all multipliers is exp of minus the mean trace of the damping.
  double sum = 0;
  for (const double g : s.floquet->growth)
    sum += g;
  REQUIRE(s.floquet->growth.size() == 8);
  CHECK(sum < 0);
}

TEST_CASE("Floquet: drives without a common period leave the verdict open and say so", "[floquet]") {
  Turntable t;
  Mechanism m = mathieu(t, 0.5);
  // A second table about the same bead, at an incommensurable speed.
  m.bodies.push_back(body("other", 1, Vec3::Zero(), Vec3(1, 1, 1)));
  Joint spin = revolute("spin2", "ground", "other", Vec3::Zero(), Vec3::UnitZ());
  spin.coordinates[0].drive = Drive{t.speed * std::numbers::sqrt2};
  m.joints.push_back(spin);
  for (std::size_t i : {0u, 1u}) {
    Force f = m.forces[i];
    f.name += "2";
    f.bodies.front() = "other";
    m.forces.push_back(f);
  }
  const Solution open = solve(m, nearest());
  REQUIRE(open.status == Status::converged);
  CHECK_FALSE(open.stable);
  CHECK(open.stability_reason == StabilityReason::varying);
  CHECK(open.message.find("no common period") != std::string::npos);
  set_parameter(m, "joints.spin2.drive.speed", 1.5 * t.speed);
  const Solution closed = solve(m, nearest());
  REQUIRE(closed.floquet);
  CHECK(closed.stability_reason == StabilityReason::floquet);
  CHECK(closed.floquet->period == Approx(4 * std::numbers::pi / t.speed));
}

TEST_CASE("Floquet: a drive that turns what is round has no share in the period", "[floquet]") {
  // The same table, and far away a round disc at an incommensurable speed.
  Turntable t;
  t.free_length = 0.8;
  Mechanism m = mathieu(t, 0.5);
  const Solution alone = solve(m, nearest());
  m.bodies.push_back(body("disc", 1, Vec3(5, 0, 0), Vec3(1, 1, 2)));
  Joint spin = revolute("spin2", "ground", "disc", Vec3(5, 0, 0), Vec3::UnitZ());
  spin.coordinates[0].drive = Drive{std::numbers::pi};
  m.joints.push_back(spin);
  const Solution beside = solve(m, nearest());
  REQUIRE(alone.floquet);
  REQUIRE(beside.floquet);
  CHECK(beside.floquet->growth.front() == Approx(alone.floquet->growth.front()));
}

TEST_CASE("Floquet: what does not turn is judged as before", "[floquet]") {
  for (const std::string name : {"governor", "pendulum", "rate_gyro", "conical_pendulum"}) {
    const Solution s = solve(shipped(name));
    INFO(name << ": " << s.message);
    CHECK_FALSE(s.floquet);
    CHECK(s.stability_reason != StabilityReason::floquet);
    CHECK(s.stability_reason != StabilityReason::varying);
  }
}

namespace {

std::vector<double> specials_of(const ResponseDiagram& d, SpecialPointType type) {
  std::vector<double> out;
  for (const SpecialPoint& s : d.special)
    if (s.type == type) out.push_back(s.at.parameter);
  std::ranges::sort(out);
  return out;
}

} // namespace

TEST_CASE("branches: onset speeds of Mathieu's equation are where its characteristic values say",
          "[floquet]") {
  Turntable t;
  t.free_length = 0.6;
  t.mass = 0.5;
  // The speeds at which a = k_0 / m w^2 is the i-th characteristic value of q = k_2 / 4 m w^2.
  const auto onset = [&](std::size_t i, double low, double high) {
    return static_cast<double>(root(
        [&](long double speed) {
          const double unit = t.mass * static_cast<double>(speed * speed);
          const double a = (t.along() + t.across()) / 2 / unit, q = (t.along() - t.across()) / 4 / unit;
          return characteristic_values(q)[i] - a;
        },
        low, high));
  };
  std::vector<double> wanted;
  for (const std::size_t i : {1u, 2u, 3u, 4u})
    wanted.push_back(onset(i, 3, 60));
  std::ranges::sort(wanted);
  const double low = 0.9 * wanted.front(), high = 1.2 * wanted.back();
  const ResponseDiagram d = follow_branches(mathieu(t), "joints.spin.drive.speed", low, high);
  const std::vector<double> found = specials_of(d, SpecialPointType::parametric);
  INFO(d.message);
  REQUIRE(found.size() >= wanted.size());
  for (const double speed : wanted) {
    const double nearest =
        *std::ranges::min_element(found, {}, [&](double x) { return std::abs(x - speed); });
    CHECK(nearest == Approx(speed).epsilon(0).margin(1e-8 * (high - low)));
  }
  CHECK(specials_of(d, SpecialPointType::hopf).empty());
}

TEST_CASE("branches: ground resonance begins and ends where the multiblade eigenvalues cross", "[floquet]") {
  Rotor r;
  const auto growth = [&](long double speed) {
    Rotor at = r;
    at.speed = static_cast<double>(speed);
    return multiblade_growth(at);
  };
  std::vector<double> wanted;
  for (double speed = 15; speed < 45; speed += 0.25)
    if (growth(speed) * growth(speed + 0.25) < 0)
      wanted.push_back(static_cast<double>(root(growth, speed, speed + 0.25)));
  REQUIRE_FALSE(wanted.empty());
  const ResponseDiagram d = follow_branches(rotor(r), "joints.spin.drive.speed", 15, 45);
  const std::vector<double> found = specials_of(d, SpecialPointType::hopf);
  INFO(d.message);
  REQUIRE(found.size() == wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    CHECK(found[i] == Approx(wanted[i]).epsilon(0).margin(1e-7));
}

// A rotor a millimetre out of balance that turns in a sleeve, which two damped bearings hold: its motion dies
// out at some 100 1/s, and a turn takes a minute.
TEST_CASE("a motion that has died out long before a turn is over is stable", "[floquet]") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("rotor", 10, {0.05, 0.051, 0}, {5e-4, 0.83, 0.83}), body("slide", 0, {-0.65, 0.05, 0}),
              body("yoke", 0, {-0.65, 0.05, 0}), body("sleeve", 0, {0.05, 0.05, 0})};
  Joint tilt = joint(JointType::universal, "tilt", "yoke", "sleeve", {0.05, 0.05, 0}, {0, 1, 0});
  tilt.axis2 = {0, 0, 1};
  m.joints = {prismatic("up", "ground", "slide", {-0.65, 0.05, 0}, {0, 1, 0}),
              prismatic("across", "slide", "yoke", {-0.65, 0.05, 0}, {0, 0, 1}), tilt,
              driven(revolute("spin", "sleeve", "rotor", {-0.45, 0.05, 0}, {1, 0, 0}), 0.1)};
  for (const double x : {-0.45, 0.55}) {
    Force& bearing = m.forces.emplace_back();
    bearing.name = x < 0 ? "left" : "right";
    bearing.type = ForceType::bearing;
    bearing.bodies = {"ground", "sleeve"};
    bearing.at = Vec3(x, 0.05, 0);
    bearing.axis = Vec3::UnitX();
    bearing.bearing_stiffness = {1e6, 0, 0, 1e6};
    bearing.bearing_damping = {1e3, 0, 0, 1e3};
  }
  const Solution s = solve(m);
  CAPTURE(s.message);
  REQUIRE(s.status == Status::converged);
  CHECK(s.stable == true);
  REQUIRE(s.floquet);
  CHECK(largest(s) == 0);
  CHECK(s.floquet->error < 1e-200);
}

TEST_CASE("Floquet: of a slow table with much damping nothing is left after a turn, which costs nothing",
          "[floquet]") {
  // m x'' + c x' + (k + 100 N/m cos 2 w t) x = 0 with a turn of 10^5 s.
  Turntable t;
  t.speed = 2 * std::numbers::pi / 1e5;
  const auto damped = [&](double spring) {
    Mechanism m = mathieu(t, 30);
    for (Joint& joint : m.joints)
      if (joint.name == "x") joint.coordinates[0].spring = CoordinateSpring{.stiffness = spring};
    return solve(m);
  };
  const Solution stable = damped(200);
  INFO(stable.message);
  REQUIRE(stable.floquet);
  CHECK(stable.stable == true);
  CHECK(largest(stable) == 0);
  CHECK(stable.floquet->error < 1e-17);
  CHECK(stable.floquet->growth.empty());
  // With less it is pushed away in a part of the turn, and that does not contract.
  const Solution pushed = damped(20);
  CHECK(pushed.stable != true);
}
