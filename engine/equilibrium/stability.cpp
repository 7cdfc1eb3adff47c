#include "engine/equilibrium/stability.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;

void sort_eigenvalues(std::vector<Complex>& s) {
  for (Complex& x : s)
    x += Complex(0, 0); // no negative zeros
  std::ranges::sort(s, [](Complex a, Complex b) {
    if (std::abs(a.imag()) != std::abs(b.imag())) return std::abs(a.imag()) < std::abs(b.imag());
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
}

// Of s^2 + s d + k with d = L^-1 D L^-T, k = L^-1 K L^-T, M = L L^T.
std::vector<Complex> regular_eigenvalues(const Eigen::LLT<Eigen::MatrixXd>& mass,
                                         const Eigen::MatrixXd& velocity, const Eigen::MatrixXd& stiffness) {
  const Eigen::Index n = velocity.rows();
  const auto l = mass.matrixL();
  const auto whiten = [&](const Eigen::MatrixXd& a) {
    const Eigen::MatrixXd half = l.solve(a);
    return Eigen::MatrixXd(l.solve(half.transpose()).transpose());
  };
  const Eigen::MatrixXd d = whiten(velocity), k = whiten(stiffness);
  std::vector<Complex> s;
  const double asymmetry = (k - k.transpose()).norm();
  if (d.norm() == 0 && asymmetry <= 1e-12 * k.norm()) { // s^2 = -eigenvalue of k: exact on the axes
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
    for (double mu : eigen.eigenvalues()) {
      const Complex root = mu >= 0 ? Complex(0, std::sqrt(mu)) : Complex(std::sqrt(-mu), 0);
      s.push_back(root);
      s.push_back(-root);
    }
    return s;
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = -k;
  companion.bottomRightCorner(n, n) = -d;
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(companion, false);
  for (Eigen::Index i = 0; i < 2 * n; ++i)
    s.push_back(eigen.eigenvalues()[i]);
  return s;
}

std::vector<Complex> singular_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                          const Eigen::MatrixXd& stiffness) {
  const Eigen::Index n = mass.rows();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, 2 * n), b = a;
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -stiffness;
  a.bottomRightCorner(n, n) = -velocity;
  b.topLeftCorner(n, n).setIdentity();
  b.bottomRightCorner(n, n) = mass;
  const Eigen::GeneralizedEigenSolver<Eigen::MatrixXd> eigen(a, b, false);
  std::vector<Complex> s;
  for (Eigen::Index i = 0; i < 2 * n; ++i)
    if (std::abs(eigen.betas()[i]) > 1e-12 * std::abs(eigen.alphas()[i]))
      s.push_back(eigen.alphas()[i] / eigen.betas()[i]);
  return s;
}

Eigen::MatrixXd onto(const Eigen::MatrixXd& z, const Eigen::MatrixXd& a) {
  return z.transpose() * a * z;
}

// Of massless directions z those that feel a spring or damper. The rest have no equation of motion, and would
// make the pencil singular: then any number is an eigenvalue.
Eigen::MatrixXd felt(const Eigen::MatrixXd& z, const Eigen::MatrixXd& velocity,
                     const Eigen::MatrixXd& stiffness) {
  Eigen::MatrixXd feels(z.cols(), 4 * z.rows());
  feels << (stiffness * z).transpose(), z.transpose() * stiffness, (velocity * z).transpose(),
      z.transpose() * velocity;
  if (feels.isZero(0)) return Eigen::MatrixXd(z.rows(), 0);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(feels);
  const double rounding = 1e-13 * (stiffness.norm() + velocity.norm());
  Eigen::Index rank = 0;
  while (rank < z.cols() && std::abs(qr.matrixQR()(rank, rank)) > rounding)
    ++rank;
  return z * Eigen::MatrixXd(qr.householderQ()).leftCols(rank);
}

// Whether a way (scaled) along the directions without stiffness leads to another balanced state, the rest
// giving way as it must: a bob that turns about the vertical goes along an arc.
bool stays_balanced(const Problem& problem, const Unknowns& z, const Eigen::MatrixXd& flat,
                    const Eigen::VectorXd& way, Workspace& w) {
  Unknowns moved = z;
  Eigen::VectorXd step = way;
  for (int i = 0; i < 8; ++i) {
    w.step = step.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, w.step, moved.q);
    if (!assemble(problem, moved.q, 0, w)) return false;
    evaluate_with_multipliers(problem, moved, w);
    const Eigen::MatrixXd& basis = w.constraints.basis();
    const Eigen::VectorXd left = basis.transpose() * w.residual.f.cwiseProduct(problem.scaling.column);
    const double force = w.magnitudes.force.cwiseProduct(problem.scaling.column).maxCoeff();
    if (left.size() == 0 || left.lpNorm<Eigen::Infinity>() <= 1e-9 * force) return true;
    factor(problem, moved, w);
    const Eigen::HouseholderQR<Eigen::MatrixXd> across(basis.transpose() * flat);
    const Eigen::MatrixXd all = across.householderQ();
    const auto rest = all.rightCols(std::max<Eigen::Index>(0, all.cols() - flat.cols()));
    if (rest.cols() == 0) return false;
    const Eigen::MatrixXd stiffness = basis.transpose() * w.scaled_stiffness * basis * rest;
    step = basis * (rest * stiffness.colPivHouseholderQr().solve(-left));
    if (!(step.lpNorm<Eigen::Infinity>() <= way.lpNorm<Eigen::Infinity>())) return false;
  }
  return false;
}

} // namespace

std::vector<Complex> pencil_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                        const Eigen::MatrixXd& stiffness) {
  if (mass.rows() == 0) return {};
  const double m = mass.norm(), k = stiffness.norm(), d = velocity.norm();
  if (!std::isfinite(m + k + d)) return {};
  if (m == 0) {
    if (d == 0) return {};
    const Eigen::MatrixXd z = felt(Eigen::MatrixXd::Identity(mass.rows(), mass.rows()), velocity, stiffness);
    return singular_eigenvalues(onto(z, mass), onto(z, velocity), onto(z, stiffness));
  }
  // Time in units in which mass and stiffness are alike.
  const double rate = k > 0 ? std::sqrt(k / m) : d > 0 ? d / m : 1;
  const Eigen::MatrixXd m1 = mass / m, d1 = velocity / (m * rate), k1 = stiffness / (m * rate * rate);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> shape((m1 + m1.transpose()) / 2);
  Eigen::Index massless = 0;
  while (massless < m1.rows() && shape.eigenvalues()[massless] < 1e-13)
    ++massless;
  std::vector<Complex> s;
  if (massless == 0) {
    s = regular_eigenvalues(Eigen::LLT<Eigen::MatrixXd>((m1 + m1.transpose()) / 2), d1, k1);
  } else {
    const Eigen::MatrixXd z = felt(shape.eigenvectors().leftCols(massless), d1, k1);
    const Eigen::MatrixXd r = shape.eigenvectors().rightCols(m1.rows() - massless);
    const bool damped = (d1 * z).norm() + (z.transpose() * d1).norm() > 1e-13 * (d1.norm() + 1);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> condensed;
    if (z.cols() > 0) condensed.compute(onto(z, k1));
    if (!damped && (z.cols() == 0 || condensed.rank() == z.cols())) {
      Eigen::MatrixXd kc = r.transpose() * k1 * r;
      if (z.cols() > 0) kc -= r.transpose() * k1 * z * condensed.solve(z.transpose() * k1 * r);
      s = regular_eigenvalues(Eigen::LLT<Eigen::MatrixXd>(r.transpose() * m1 * r), r.transpose() * d1 * r,
                              kc);
    } else {
      Eigen::MatrixXd all(m1.rows(), z.cols() + r.cols());
      all << z, r;
      s = singular_eigenvalues(onto(all, m1), onto(all, d1), onto(all, k1));
    }
  }
  for (Complex& x : s)
    x *= rate;
  sort_eigenvalues(s);
  return s;
}

bool has_potential(const Problem& problem, const Unknowns& z, Workspace& w) {
  if (!problem.system.conservative) return false;
  if (problem.system.single_drives) return true;
  const Eigen::MatrixXd k = w.scaled_stiffness;
  if ((k - k.transpose()).norm() > 1e-9 * k.norm()) return false;
  // Second differences of U + lambda . Phi, whose gradient is f.
  const auto lagrangian = [&](int i, double step) {
    Eigen::VectorXd q = z.q;
    w.step.setZero(problem.system.nv);
    w.step[i] = step * problem.scaling.column[i];
    retract<double>(problem.system, w.step, q);
    forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
    w.zero_lambda.setZero(problem.system.rows);
    evaluate_residual<double>(problem.system, problem.parameters, q, w.zero_lambda, w.kinematics, w.residual);
    return amended_potential(problem.system, problem.parameters, q, w.kinematics).value +
           z.lambda.dot(w.residual.phi);
  };
  const double h = 1e-3;
  bool agrees = true;
  for (int i = 0; i < problem.system.nv && agrees; ++i) {
    const double second = (lagrangian(i, h) - 2 * lagrangian(i, 0) + lagrangian(i, -h)) / (h * h);
    agrees = std::abs(second - k(i, i)) <= 1e-3 * k.norm();
  }
  evaluate(problem, z, 0, w);
  factor(problem, z, w);
  return agrees;
}

Stability find_stability(const Problem& problem, const Unknowns& z, bool with_eigenvalues, Workspace& w) {
  Stability out;
  evaluate(problem, z, 0, w);
  factor(problem, z, w);
  const bool potential = has_potential(problem, z, w);
  const Eigen::MatrixXd basis = w.constraints.basis();
  ReducedHessian energy; // symmetric where there is a potential, whatever Newton used
  const Eigen::MatrixXd reduced = basis.transpose() * w.scaled_stiffness * basis;
  w.noise.resize(basis.cols());
  for (Eigen::Index i = 0; i < basis.cols(); ++i)
    w.noise[i] =
        1e-15 * basis.col(i).cwiseAbs2().dot(w.magnitudes.force.cwiseProduct(problem.scaling.column));
  energy.factor(reduced, w.noise, potential);
  const bool minimum = potential && energy.positive_definite();
  if (minimum) {
    out.stable = true;
    out.reason = StabilityReason::minimum;
  }

  // Directions nothing resists: without stiffness here, and still in balance some way along.
  const Eigen::MatrixXd flat = basis * energy.null_basis();
  int flat_count = 0;
  const auto stays_along = [&](const Eigen::VectorXd& direction) {
    return stays_balanced(problem, z, flat, 0.05 * direction, w) &&
           stays_balanced(problem, z, flat, -0.11 * direction, w);
  };
  // What holds for a mixture of many holds for each.
  const bool all = flat.cols() > few_flat && stays_along(mixture_of(flat));
  for (Eigen::Index c = 0; c < flat.cols(); ++c) {
    Eigen::VectorXd direction = flat.col(c);
    const double size = direction.lpNorm<Eigen::Infinity>();
    if (!(size > 0)) continue;
    direction /= size;
    if (!all && !stays_along(direction)) continue;
    ++flat_count;
    for (int i = 0; i < problem.system.nv; ++i)
      if (std::abs(direction[i]) > 1e-6 && std::ranges::find(out.neutral, i) == out.neutral.end())
        out.neutral.push_back(i);
  }
  std::ranges::sort(out.neutral);
  if (flat.cols() > 0) {
    evaluate(problem, z, 0, w);
    factor(problem, z, w);
  }

  double most_negative = 0;
  if (potential && !minimum && energy.size() > 0) {
    energy.decompose();
    most_negative = energy.eigenvalues()[0];
  }
  if (minimum && !with_eigenvalues) return out;

  linearize_motion(problem.system, problem.parameters, z.q, w.kinematics, w.linearization);
  const auto& s = problem.scaling.column;
  const Eigen::MatrixXd mass =
      basis.transpose() * s.asDiagonal() * w.linearization.mass * s.asDiagonal() * basis;
  const Eigen::MatrixXd velocity =
      basis.transpose() * s.asDiagonal() * w.linearization.velocity * s.asDiagonal() * basis;
  Eigen::MatrixXd stiffness = reduced;
  if (potential) stiffness = (reduced + reduced.transpose()) / 2;
  out.eigenvalues = pencil_eigenvalues(mass, velocity, stiffness);
  if (minimum) return out;

  // Eigenvalues that belong to flat directions are zero but for rounding: leave the smallest out.
  std::vector<Complex> moving = *out.eigenvalues;
  std::ranges::sort(moving, [](Complex a, Complex b) { return std::abs(a) < std::abs(b); });
  const double largest = moving.empty() ? 0 : std::abs(moving.back());
  for (int i = 0;
       i < 2 * static_cast<int>(flat.cols()) && !moving.empty() && std::abs(moving.front()) < 1e-5 * largest;
       ++i)
    moving.erase(moving.begin());
  bool right = false, left = !moving.empty() || flat.cols() == 0;
  for (Complex x : moving) {
    const double tolerance = 1e-8 * std::abs(x) + 1e-12 * largest;
    if (x.real() > tolerance) right = true;
    if (x.real() >= -tolerance) left = false;
  }
  // A massless direction with negative stiffness has no finite eigenvalue to tell of it.
  if (mass.rows() > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> shape((mass + mass.transpose()) / 2);
    Eigen::Index massless = 0;
    while (massless < mass.rows() && shape.eigenvalues()[massless] < 1e-13 * std::max(mass.norm(), 1e-300))
      ++massless;
    if (massless > 0) {
      const Eigen::MatrixXd zz = shape.eigenvectors().leftCols(massless);
      const Eigen::MatrixXd kzz = zz.transpose() * (stiffness + stiffness.transpose()) * zz;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> local(kzz, Eigen::EigenvaluesOnly);
      if (local.eigenvalues()[0] < -1e-10 * std::max(stiffness.norm(), 1e-300)) right = true;
    }
  }
  // Where the energy falls nowhere it grows nowhere either, whatever rounding makes of the eigenvalues.
  const bool falls = !potential || most_negative < -ReducedHessian::zero;
  if (right && falls) {
    out.stable = false;
    out.reason = StabilityReason::unstable;
  } else if (flat_count > 0) {
    out.reason = StabilityReason::neutral;
  } else if (flat.cols() > 0) {
    out.reason = StabilityReason::marginal;
  } else if (left) {
    out.stable = true;
    out.reason = StabilityReason::asymptotic;
  } else if (potential && most_negative < -ReducedHessian::zero) {
    out.reason = StabilityReason::gyroscopic_only;
  } else {
    out.reason = StabilityReason::marginal;
  }
  return out;
}

} // namespace flyball
