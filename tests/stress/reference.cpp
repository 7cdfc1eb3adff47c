#include "tests/stress/reference.hpp"

#include "tests/stress/wide.hpp"

#include "engine/kkt/problem.hpp"
#include "engine/report/report.hpp"
#include "engine/solve/drive_cuts.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

namespace flyball::stress {
namespace {

using VectorW = Eigen::Matrix<Wide, Eigen::Dynamic, 1>;
using MatrixW = Eigen::Matrix<Wide, Eigen::Dynamic, Eigen::Dynamic>;
using ConfigurationW = Configuration<Dual>;

constexpr double rounding = 1e-13; // rows of redundant loops, given in double precision, differ by this much

double largest(const VectorW& v) {
  double worst = 0;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const auto x = static_cast<double>(abs(v[i]));
    if (!(x <= worst)) worst = x; // keeps what is not a number
  }
  return worst;
}

// Rows and columns brought to entries of at most one, a few times over.
void equilibrate(MatrixW& a, VectorW& left, VectorW& right) {
  left.setOnes(a.rows());
  right.setOnes(a.cols());
  for (int sweep = 0; sweep < 4; ++sweep) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Wide size = a.row(i).cwiseAbs().maxCoeff();
      if (!(size > Wide(0))) continue;
      const Wide s = 1 / sqrt(size);
      a.row(i) *= s;
      left[i] *= s;
    }
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      const Wide size = a.col(j).cwiseAbs().maxCoeff();
      if (!(size > Wide(0))) continue;
      const Wide s = 1 / sqrt(size);
      a.col(j) *= s;
      right[j] *= s;
    }
  }
}

} // namespace

struct Reference::State {
  System system;
  Parameters parameters;
  Scaling scaling;
  VectorW column, row;

  struct Balance {
    VectorW f, phi;    // scaled
    MatrixW jacobian;  // scaled, of phi
    MatrixW stiffness; // scaled, of f
  };

  // At multipliers (per row, unscaled).
  void evaluate(const ConfigurationW& q, const VectorW& lambda, Balance& out) const {
    const int n = system.nv;
    out.f.resize(n);
    out.phi.resize(system.rows);
    out.jacobian.resize(system.rows, n);
    out.stiffness.resize(n, n);
    Configuration<Dual> multipliers(system.rows);
    for (int i = 0; i < system.rows; ++i)
      multipliers[i] = Dual(lambda[i]);
    Kinematics<Dual> kinematics;
    Residual<Dual> residual;
    const auto pass = [&](const ConfigurationW& at, int j) {
      forward<Dual>(system, parameters, at, 0, kinematics);
      evaluate_residual<Dual>(system, parameters, at, multipliers, kinematics, residual);
      for (int i = 0; i < n; ++i)
        out.stiffness(i, j) = residual.f[i].d * column[i];
      for (int i = 0; i < system.rows; ++i)
        out.jacobian(i, j) = residual.phi[i].d * row[i];
      if (j > 0) return;
      for (int i = 0; i < n; ++i)
        out.f[i] = residual.f[i].v * column[i];
      for (int i = 0; i < system.rows; ++i)
        out.phi[i] = residual.phi[i].v * row[i];
    };
    for (const Link& link : system.links) {
      if (link.v < 0) continue;
      ConfigurationW moving = q;
      if (link.type != LinkType::spherical) {
        moving[link.q].d = column[link.v];
        pass(moving, link.v);
        continue;
      }
      const Wide w = q[link.q].v, x = q[link.q + 1].v, y = q[link.q + 2].v, z = q[link.q + 3].v;
      // Half the product of the turn's axis and the quaternion.
      const std::array<std::array<Wide, 4>, 3> rate{{{-x, w, -z, y}, {-y, z, w, -x}, {-z, -y, x, w}}};
      for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 4; ++i)
          moving[link.q + i].d = rate[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] / 2;
        pass(moving, link.v + k);
      }
    }
  }

  // Largest terms of each equation, scaled; for measuring an imbalance by.
  Magnitudes magnitudes(const ConfigurationW& q, const VectorW& lambda) const {
    Eigen::VectorXd at(system.nq), multipliers(system.rows);
    for (int i = 0; i < system.nq; ++i)
      at[i] = static_cast<double>(q[i].v);
    for (int i = 0; i < system.rows; ++i)
      multipliers[i] = static_cast<double>(lambda[i]);
    Kinematics<double> kinematics;
    Magnitudes out;
    forward<double>(system, parameters, at, 0, kinematics);
    evaluate_magnitudes(system, parameters, at, multipliers, kinematics, out);
    return out;
  }
};

Reference::Reference(const Mechanism& mechanism) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.system = compile_for_drives(mechanism);
  bind(s.system, mechanism, s.parameters);
  set_scaling(s.system, s.parameters, s.scaling);
  s.column = s.scaling.column.cast<Wide>();
  s.row = s.scaling.row.cast<Wide>();
}
Reference::~Reference() = default;

ReferenceState Reference::settle(const Solution& solution) const {
  const State& s = *state_;
  const System& system = s.system;
  ReferenceState out;
  out.coordinates.resize(solution.coordinates.size());
  if (system.nv == 0) {
    out.converged = true;
    return out;
  }
  Eigen::VectorXd start;
  drawn_configuration(system, s.parameters, start);
  set_start(system, s.parameters, start_values(solution.coordinates), start);
  ConfigurationW q = start.cast<Dual>();
  for (const Link& link : system.links) { // quaternions of unit length in 113 bits, too
    if (link.v < 0 || link.type != LinkType::spherical) continue;
    Wide square = 0;
    for (int k = 0; k < 4; ++k)
      square += q[link.q + k].v * q[link.q + k].v;
    for (int k = 0; k < 4; ++k)
      q[link.q + k].v /= sqrt(square);
  }
  // Along directions that nothing resists the answer is one of many.
  const double flat = solution.neutral.empty() ? 1e-26 : 1e-10;

  State::Balance balance;
  VectorW lambda = VectorW::Zero(system.rows), step;
  double previous = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 60; ++i) {
    lambda.setZero(system.rows);
    s.evaluate(q, lambda, balance);
    const VectorW f = balance.f;
    MatrixW range(system.nv, 0), basis = MatrixW::Identity(system.nv, system.nv);
    step.setZero(system.nv);
    if (system.rows > 0) {
      const double open = largest(balance.phi);
      if (!std::isfinite(open)) break;
      // Rows of small parts count like others; what rounding makes of a row that should be zero does not.
      MatrixW rows = balance.jacobian;
      const Wide most = rows.cwiseAbs().maxCoeff();
      for (Eigen::Index r = 0; r < rows.rows(); ++r) {
        const Wide size = rows.row(r).cwiseAbs().maxCoeff();
        if (size > Wide(1e-9) * most) rows.row(r) /= size;
      }
      Eigen::ColPivHouseholderQR<MatrixW> qr(rows.transpose());
      qr.setThreshold(Wide(std::clamp(10 * open, rounding, 1e-3)));
      const Eigen::Index rank = most > Wide(rounding) ? qr.rank() : 0;
      const MatrixW all = qr.householderQ();
      range = all.leftCols(rank);
      basis = all.rightCols(system.nv - rank);
      if (rank > 0) {
        const MatrixW across = balance.jacobian * range;
        const Eigen::HouseholderQR<MatrixW> least(across);
        step = range * least.solve(-balance.phi);
        // Multipliers of least norm that balance the forces across the loops.
        const MatrixW square = (across.transpose() * across).eval();
        const VectorW scaled = across * square.fullPivLu().solve(-(range.transpose() * f));
        lambda = scaled.cwiseProduct(s.row);
        s.evaluate(q, lambda, balance);
        out.opening = largest(balance.phi + balance.jacobian * step);
      }
    }
    if (i == 0) {
      const Magnitudes size = s.magnitudes(q, lambda);
      const VectorW left = basis.transpose() * f;
      const Eigen::VectorXd terms = size.force.cwiseProduct(s.scaling.column);
      for (Eigen::Index k = 0; k < left.size(); ++k) {
        double scale = 0;
        for (Eigen::Index j = 0; j < terms.size(); ++j)
          scale += std::abs(static_cast<double>(basis(j, k))) * terms[j];
        if (scale > 0)
          out.imbalance = std::max(out.imbalance, std::abs(static_cast<double>(left[k])) / scale);
      }
      out.imbalance = std::max(out.imbalance, largest(balance.phi));
    }
    if (basis.cols() > 0) {
      MatrixW reduced = basis.transpose() * balance.stiffness * basis;
      const VectorW rhs = -(basis.transpose() * (f + balance.stiffness * step));
      VectorW left, right;
      equilibrate(reduced, left, right);
      Eigen::FullPivLU<MatrixW> lu(reduced);
      lu.setThreshold(Wide(flat));
      out.singular = lu.rank() < reduced.rows();
      const VectorW pivots = lu.matrixLU().diagonal().cwiseAbs();
      out.softest = static_cast<double>(pivots.minCoeff() / lu.maxPivot());
      step += basis * right.cwiseProduct(lu.solve(left.cwiseProduct(rhs)));
    }
    const double size = largest(step);
    if (!std::isfinite(size)) break;
    const double taken = std::min(size, 0.3);
    out.distance += taken;
    ConfigurationW move(system.nv);
    for (int k = 0; k < system.nv; ++k)
      move[k] = Dual(step[k] * s.column[k] * Wide(size > 0 ? taken / size : 1));
    retract<Dual>(system, move, q);
    // On to the last digit: answers near zero are known to far less than 1e-26.
    const bool stands = size == 0 || (size < 1e-12 && size > previous / 2);
    out.converged = stands || size < 1e-26;
    if (stands) break;
    previous = size;
  }

  for (std::size_t c = 0; c < system.reported.size() && c < out.coordinates.size(); ++c) {
    if (system.reported[c].cut >= 0) continue; // follows from the others
    const CoordinateInfo& info = system.coordinates[static_cast<std::size_t>(system.reported[c].coordinate)];
    const Link& link = system.links[static_cast<std::size_t>(info.link)];
    if (link.v < 0) continue;
    const Wide value = solution.coordinates[c].value;
    ReferenceCoordinate& x = out.coordinates[c];
    if (link.type != LinkType::spherical) {
      x.away = static_cast<double>(abs(value - q[link.q].v));
      x.uncertainty = static_cast<double>(4 * abs(step[link.v]) * s.column[link.v]);
      x.unit = static_cast<double>(s.column[link.v]);
      continue;
    }
    const Vec3T<Dual> r =
        rotation_vector<Dual>(link, s.parameters.links[static_cast<std::size_t>(info.link)], q);
    const int k = info.index - link.coordinate;
    const Wide length = r.norm().v, turn = 8 * atan2(Wide(1), Wide(1));
    x.away = static_cast<double>(abs(value - r[k].v));
    if (length > Wide(3)) // half a turn may be told from either side
      x.away = std::min(x.away, static_cast<double>(abs(value - r[k].v * (1 - turn / length))));
    for (int j = 0; j < 3; ++j)
      x.uncertainty += static_cast<double>(8 * abs(step[link.v + j]));
  }
  return out;
}

} // namespace flyball::stress
