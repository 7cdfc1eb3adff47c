// Numbers many powers of ten apart: the answer is right to its error estimate, or there is a refusal in
// words. Judged by Newton-Raphson in extended precision from the answer, with a Jacobian of differences.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/torque_parts.hpp"

#include "engine/kkt/problem.hpp"
#include "engine/system/extended.hpp"

#include <Eigen/LU>

#include <map>

using namespace flyball;
using namespace flyball::test;

namespace {

using Real = Extended;
using VectorL = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using MatrixL = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

struct Judgement {
  bool converged = false;
  VectorL q; // one entry a coordinate of q_R
  std::vector<const CoordinateSolution*> coordinates;
};

// For systems of revolute and prismatic links.
class Judge {
 public:
  explicit Judge(const Mechanism& m) : system_(compile(m)) {
    bind(system_, m, parameters_);
    set_scaling(system_, parameters_, scaling_);
    column_ = scaling_.column.cast<Real>();
  }

  Judgement judge(const Solution& s) {
    Eigen::VectorXd start;
    drawn_configuration(system_, parameters_, start);
    Judgement out;
    out.coordinates.resize(static_cast<std::size_t>(system_.nv));
    std::vector<double> labels(out.coordinates.size());
    for (const CoordinateInfo& info : system_.coordinates) {
      const Link& link = system_.links[static_cast<std::size_t>(info.link)];
      if (link.v < 0) continue;
      const CoordinateSolution& c =
          coordinate(s, system_.tree_joints[static_cast<std::size_t>(info.tree_joint)].name, info.index);
      set_coordinate(system_, parameters_, info, c.value, start);
      out.coordinates[static_cast<std::size_t>(link.v)] = &c;
    }
    VectorL q = start.cast<Real>(), lambda = VectorL::Zero(system_.rows);
    const Eigen::Index nv = system_.nv, n = nv + system_.rows;
    // What the multipliers have to balance is their unit.
    const Real load = balance(q, lambda).head(nv).cwiseAbs().maxCoeff(), unit = load > 0 ? load : 1;
    for (int i = 0; i < 30 && !out.converged; ++i) {
      const VectorL f = balance(q, lambda);
      MatrixL jacobian(n, n);
      for (Eigen::Index j = 0; j < n; ++j) {
        // Rates turn with the angle at most some tens of times a radian; reach is the unit of lengths.
        const Real h = 1e-7;
        const auto shifted = [&](Real step) {
          VectorL moved = q, multipliers = lambda;
          if (j < nv)
            moved = displaced(q, VectorL::Unit(nv, j) * step);
          else
            multipliers[j - nv] += step * unit;
          return balance(moved, multipliers);
        };
        jacobian.col(j) = (shifted(h) - shifted(-h)) / (2 * h);
      }
      VectorL rows(n);
      for (Eigen::Index k = 0; k < n; ++k)
        rows[k] = 1 / std::max(jacobian.row(k).cwiseAbs().maxCoeff(), Real(1e-300));
      const MatrixL scaled = rows.asDiagonal() * jacobian;
      const VectorL step = scaled.fullPivLu().solve(-rows.cwiseProduct(f));
      if (!step.allFinite()) break;
      q = displaced(q, step.head(nv));
      lambda += step.tail(system_.rows) * unit;
      const Real size = step.head(nv).size() > 0 ? step.head(nv).cwiseAbs().maxCoeff() : 0;
      if (size > 1e3) break;
      out.converged = i > 0 && size < 1e-17 * std::max(Real(1), q.cwiseAbs().maxCoeff());
    }
    out.q = q;
    // Displacements from the drawn pose, as the configuration holds them; labels are read off likewise.
    drawn_ = start;
    return out;
  }

  // How far the answer is from the judgement, in the coordinate's unit.
  Real distance(const Judgement& judgement, Eigen::Index v) const {
    using std::abs;
    for (const Link& link : system_.links)
      if (link.v == v) return abs(judgement.q[link.q] - Real(drawn_[link.q]));
    return 0;
  }

 private:
  VectorL displaced(const VectorL& q, const VectorL& scaled_step) const {
    VectorL moved = q;
    retract<Real>(system_, scaled_step.cwiseProduct(column_), moved);
    return moved;
  }
  VectorL balance(const VectorL& q, const VectorL& lambda) {
    forward<Real>(system_, parameters_, q, 0, kinematics_);
    evaluate_residual<Real>(system_, parameters_, q, lambda, kinematics_, residual_);
    VectorL f(system_.nv + system_.rows);
    f << residual_.f, residual_.phi;
    return f;
  }

  System system_;
  Parameters parameters_;
  Scaling scaling_;
  VectorL column_;
  Eigen::VectorXd drawn_;
  Kinematics<Real> kinematics_;
  Residual<Real> residual_;
};

} // namespace

TEST_CASE("numbers far apart: right to the estimate, or refused in words") {
  Mechanism cone = conical(0.5, 0.2, 5, 0.1);
  cone.joints[1].coordinates[0].spring = CoordinateSpring{1, 0.3};
  const std::vector<std::tuple<std::string, Mechanism, std::vector<std::string>>> scenes{
      {"pendulum", shipped("pendulum"), {"theta", "d"}},
      {"governor", shipped("governor"), {"slide"}},
      {"conical", cone, {"swing"}}};
  for (const auto& [name, base, springs] : scenes) {
    int solved = 0, all = 0;
    std::map<std::string, int> refusals;
    for (const double length : {1e-6, 1., 1e6})
      for (const double mass : {1e-12, 1., 1e12})
        for (const double speed : {0., 1e-3, 1., 11., 1e3, 1e6})
          for (const double stiffness : {1e-9, 1., 1e4, 1e15}) {
            Mechanism m = heavier(resized(base, length), mass);
            m.joints[0].coordinates[0].drive->speed = speed;
            for (const std::string& spring : springs)
              set_parameter(m, "joints." + spring + ".spring.stiffness", stiffness);
            CAPTURE(name, length, mass, speed, stiffness);
            ++all;
            const Solution s = solve(m);
            CAPTURE(word(s.status), s.message);
            CHECK_FALSE(s.message.empty());
            if (s.status != Status::converged) {
              CHECK(s.coordinates.empty());
              ++refusals[s.message];
              continue;
            }
            ++solved;
            Judge judge(m);
            const Judgement judgement = judge.judge(s);
            CHECK(judgement.converged);
            for (std::size_t v = 0; v < judgement.coordinates.size(); ++v) {
              const CoordinateSolution& c = *judgement.coordinates[v];
              const auto away = static_cast<double>(judge.distance(judgement, static_cast<Eigen::Index>(v)));
              CAPTURE(c.joint, c.value, c.error, away, away / c.error);
              CHECK(std::isfinite(c.value));
              CHECK(std::isfinite(c.error));
              CHECK(away <= c.error);
              if (s.stability_reason == StabilityReason::minimum)
                CHECK(c.error <= 1e-9 * std::max(std::abs(c.value), c.angle ? 1 : length));
            }
          }
    CAPTURE(name, solved, all, refusals);
    CHECK(solved >= all * 8 / 10);
  }
}

TEST_CASE("forces beyond the largest number are refused, not shown") {
  Mechanism m = shipped("pendulum");
  m.joints[0].coordinates[0].drive->speed =
      1e155; // whose square overflows; validation would not let it through
  const Solution s = Analysis(m).solve();
  CHECK(s.status == Status::not_converged);
  CHECK(s.coordinates.empty());
  CHECK_FALSE(s.message.empty());
}

TEST_CASE("a place so far away that stiffnesses overflow ends in words") {
  Mechanism m;
  m.gravity = {0.3, 0.8, -0.3};
  m.bodies = {body("block", 0.01, {-0.2, -0.1, -0.8}, {3e-6, 3e-6, 3e-7})};
  m.joints = {joint(JointType::planar, "plane", "ground", "block", {0.1, -0.4, -1e300}, {0.8, 0.4, 1})};
  m.joints[0].axis2 = {-0.8, -0.6, 0.9};
  const Solution s = Analysis(m).solve(); // which validation would not let through
  CHECK(s.status != Status::converged);
  CHECK_FALSE(s.message.empty());
}

TEST_CASE("a state of which rounding leaves no digit is refused") {
  // A slider-crank on a shaft; its connecting rod's far end has the mass centre 10^12 m away.
  const Vec3 pin(-0.2385, 0.4284, -0.137), knee(-0.3916, 0.0174, -0.137), pivot(-0.195, 0.094, -0.137);
  const Vec3 inertia(0.01, 0.01, 0.01);
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {body("slider", 0.0006, {-0.2385, 1e12, -0.137}, inertia),
              body("rod", 0.828, {-0.3333, 0.2249, -0.1302}, inertia),
              body("shaft", 1, {0.018, 0.036, 0.05}, inertia),
              body("crank", 0.4445, {-0.3109, 0.047, -0.1482}, inertia)};
  m.joints = {revolute("gudgeon", "rod", "slider", pin),
              torque_driven(revolute("spin", "ground", "shaft", {0, 0, 0}, {0, 1, 0}), 8.9,
                            "2.9 N m - 0.33 N m s*rate(spin)"),
              revolute("knee", "crank", "rod", knee),
              sprung(prismatic("slide", "shaft", "slider", pin, {0, 1, 0}), 264.6, 0.0065),
              sprung(revolute("arm", "shaft", "crank", pivot, {0, 0, -1}), 5.48, -0.0872)};
  const Solution s = solve(m);
  CHECK(s.status == Status::not_converged);
  CHECK(s.coordinates.empty());
  CHECK_THAT(s.message, ContainsSubstring("no digit of"));
}
