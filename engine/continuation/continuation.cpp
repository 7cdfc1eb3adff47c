#include "engine/continuation/continuation.hpp"

#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/address.hpp"

namespace flyball {

Family::Family(const System& system, const Mechanism& mechanism, std::string address, double scale)
    : system_(system), mechanism_(mechanism), address_(std::move(address)), scale_(scale) {
  value_ = get_parameter(mechanism_, address_);
  bind(system_, mechanism_, parameters_);
  set_scaling(system_, parameters_, scaling_);
}

void Family::set(double value) {
  if (value == value_) return; // bound already
  set_parameter(mechanism_, address_, value);
  bind(system_, mechanism_, parameters_);
  value_ = value;
}

// With y = N p + r0 + r1 m the constraints are kept to first order whatever p and m are; the balance is then
// H p + b m = -g.
struct Continuation::Bordered {
  Eigen::MatrixXd basis;  // N
  Eigen::VectorXd r0, r1; // range parts: closing the loops, following the parameter
  Eigen::MatrixXd h;      // [H b]: (k, k + 1)
  Eigen::VectorXd g;
  Eigen::VectorXd force, force_rate; // scaled, without multipliers; per scaled parameter
  double residual = 0;

  // Scaled step and parameter from reduced unknowns.
  Eigen::VectorXd expand(const Eigen::VectorXd& reduced, double with_r0) const {
    Eigen::VectorXd full(basis.rows() + 1);
    const Eigen::Index k = basis.cols();
    full.head(basis.rows()) = basis * reduced.head(k) + r1 * reduced[k] + with_r0 * r0;
    full[basis.rows()] = reduced[k];
    return full;
  }
  // The row that projects a full vector on `direction`.
  Eigen::RowVectorXd row(const Eigen::VectorXd& direction) const {
    const Eigen::Index n = basis.rows(), k = basis.cols();
    Eigen::RowVectorXd out(k + 1);
    out.head(k) = direction.head(n).transpose() * basis;
    out[k] = direction.head(n).dot(r1) + direction[n];
    return out;
  }
};

namespace {

// The two right singular vectors (columns) of [H b] that belong to the smallest singular values, zero among
// them.
std::optional<Eigen::MatrixXd> last_right_vectors(const Eigen::MatrixXd& h) {
  const Eigen::Index k = h.rows();
  if (k + 1 < large::from) {
    const auto svd = singular_vectors(h);
    if (!svd) return {};
    return Eigen::MatrixXd(svd->right.rightCols(2));
  }
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(k + 1, k + 1);
  square.topRows(k) = h;
  const auto smallest = large::smallest_singular(square, 2);
  if (!smallest) return {};
  return Eigen::MatrixXd(smallest->right.rowwise().reverse());
}

} // namespace

void Continuation::assemble(const Unknowns& z, double parameter, Bordered& out) {
  const Problem problem = family_.problem();
  // Rates in the parameter by central differences; they steer the steps, the balance itself stays exact.
  const double h = 1e-6 * family_.scale();
  Eigen::VectorXd f[2], phi[2];
  w_.zero_lambda.setZero(problem.system.rows);
  for (int i : {0, 1}) {
    family_.set(parameter + (i == 0 ? h : -h));
    evaluate(problem, {z.q, w_.zero_lambda}, 0, w_);
    f[i] = w_.residual.f;
    phi[i] = w_.residual.phi;
  }
  family_.set(parameter);
  const double per = family_.scale() / (2 * h);
  const Eigen::VectorXd phi_rate = (phi[0] - phi[1]) * per;
  out.force_rate = ((f[0] - f[1]) * per).cwiseProduct(problem.scaling.column);

  evaluate(problem, z, 0, w_);
  out.residual = scaled_residual(problem, w_);
  factor(problem, z, w_);
  if (problem.system.rows > 0)
    w_.residual.f.noalias() -= w_.dense.linearization.constraint.transpose() * z.lambda;
  out.force = w_.residual.f.cwiseProduct(problem.scaling.column);
  out.basis = w_.dense.constraints().basis();
  const Eigen::Index n = problem.system.nv, k = out.basis.cols();
  out.r0 = out.r1 = Eigen::VectorXd::Zero(n);
  if (w_.dense.constraints().rank() > 0) {
    w_.dense.constraints().solve(-w_.residual.phi.cwiseProduct(problem.scaling.row), out.r0);
    w_.dense.constraints().solve(-phi_rate.cwiseProduct(problem.scaling.row), out.r1);
  }
  out.h.resize(k, k + 1);
  out.h.leftCols(k) = large::projected(w_.dense.stiffness(), out.basis);
  // A state without loads has stiffness only, one without stiffness loads only.
  double size = n > 0 ? w_.magnitudes.force.cwiseProduct(problem.scaling.column).maxCoeff() : 0;
  if (k > 0) size = std::max(size, out.h.leftCols(k).cwiseAbs().maxCoeff());
  if (!(size > 0)) size = 1;
  out.h.leftCols(k) /= size;
  out.h.col(k) = out.basis.transpose() * (w_.dense.stiffness() * out.r1 + out.force_rate) / size;
  out.g = out.basis.transpose() * (out.force + w_.dense.stiffness() * out.r0) / size;
}

bool Continuation::correct(const Unknowns& from, double parameter, const Eigen::VectorXd& tangent,
                           double length, BranchState& to, int& iterations) {
  const Problem problem = family_.problem();
  const Eigen::Index n = problem.system.nv;
  to.z = from;
  to.parameter = parameter + length * tangent[n] * family_.scale();
  Eigen::VectorXd predicted = length * tangent.head(n).cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, predicted, to.z.q);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(n + 1); // corrections so far, kept orthogonal to the tangent
  Bordered b;
  for (iterations = 1; iterations <= 12; ++iterations) {
    assemble(to.z, to.parameter, b);
    if (!std::isfinite(b.residual)) return false;
    const Eigen::Index k = b.basis.cols();
    Eigen::MatrixXd m(k + 1, k + 1);
    m.topRows(k) = b.h;
    m.row(k) = b.row(tangent);
    Eigen::VectorXd rhs(k + 1);
    rhs.head(k) = -b.g;
    rhs[k] = -tangent.head(n).dot(b.r0) - tangent.dot(moved);
    const auto solved = solve_square(m, rhs);
    if (!solved) return false;
    const Eigen::VectorXd step = b.expand(*solved, 1);
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size) || size > 1) return false;
    Eigen::VectorXd move = step.head(n).cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, move, to.z.q);
    to.parameter += step[n] * family_.scale();
    moved += step;
    if (problem.system.rows > 0) {
      const Eigen::VectorXd target =
          -(b.force + w_.dense.stiffness() * step.head(n) + b.force_rate * step[n]);
      w_.dense.constraints().multipliers(target, w_.scaled_lambda);
      to.z.lambda = w_.scaled_lambda.cwiseProduct(problem.scaling.row);
    }
    if (size < 1e-9) {
      family_.set(to.parameter);
      evaluate(problem, to.z, 0, w_);
      return scaled_residual(problem, w_) < 1e-8;
    }
  }
  return false;
}

bool Continuation::find_tangent(BranchState& state, const Eigen::VectorXd& previous) {
  Bordered b;
  assemble(state.z, state.parameter, b);
  const Eigen::Index k = b.basis.cols();
  Eigen::MatrixXd m(k + 1, k + 1);
  m.topRows(k) = b.h;
  m.row(k) = b.row(previous);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(k + 1);
  rhs[k] = 1;
  const auto solved = solve_square(m, rhs);
  if (!solved) return false;
  state.tangent = b.expand(*solved, 0);
  const double norm = state.tangent.norm();
  if (!std::isfinite(norm) || norm == 0) return false;
  state.tangent /= norm;
  state.turning = state.tangent[state.tangent.size() - 1];
  m.row(k) = b.row(state.tangent);
  // The determinant's sign with the size of its worst factor, so that it can be followed to zero.
  state.determinant = 0;
  if (k + 1 >= large::from) {
    const auto smallest = large::smallest_singular(m, 1);
    if (!smallest) return false;
    // The size of the rest only scales it.
    state.determinant =
        smallest->sign * smallest->values[0] / m.norm() * std::sqrt(static_cast<double>(k + 1));
    return true;
  }
  const auto values = singular_values(m);
  if (!values) return false;
  Lu lu;
  const bool regular = lu.compute(m) && (*values)[0] > 0;
  state.determinant = regular ? lu.sign_of_determinant() * (*values)[k] / (*values)[0] : 0;
  return true;
}

bool Continuation::start(BranchState& state, double direction) {
  Eigen::VectorXd along = Eigen::VectorXd::Zero(family_.problem().system.nv + 1);
  along[along.size() - 1] = direction < 0 ? -1 : 1;
  return find_tangent(state, along);
}

bool Continuation::step(const BranchState& from, double length, BranchState& to, int& iterations) {
  return correct(from.z, from.parameter, from.tangent, length, to, iterations) &&
         find_tangent(to, from.tangent);
}

bool Continuation::land(BranchState& state) {
  family_.set(state.parameter);
  return newton(family_.problem(), state.z, w_, {}, nullptr).converged;
}

bool Continuation::switch_branch(const BranchState& at, double length, BranchState& to) {
  Bordered b;
  assemble(at.z, at.parameter, b);
  const Eigen::Index k = b.basis.cols();
  if (k == 0) return false;
  const auto null_directions = last_right_vectors(b.h);
  if (!null_directions) return false;
  // The null space is spanned by the branch's own tangent and one more direction: take that orthogonal to the
  // tangent.
  Eigen::VectorXd other = Eigen::VectorXd::Zero(at.tangent.size());
  for (Eigen::Index i : {0, 1}) {
    Eigen::VectorXd v = b.expand(null_directions->col(i), 0);
    v -= at.tangent * at.tangent.dot(v);
    if (v.norm() > other.norm()) other = v;
  }
  if (other.norm() < 1e-6) return false;
  other.normalize();
  int iterations = 0;
  if (!correct(at.z, at.parameter, other, length, to, iterations)) return false;
  return find_tangent(to, length > 0 ? other : Eigen::VectorXd(-other));
}

} // namespace flyball
