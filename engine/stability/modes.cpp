#include "engine/stability/modes.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/stability.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// In units of time that make M and K alike.
struct TimedMotion : ReducedMotion {
  double rate = 1; // 1/s per unit of s
};

TimedMotion timed_motion(const FactoredState& at) {
  TimedMotion out{reduced_motion(at.problem, at.z, at.w)};
  const double m = out.mass.norm(), k = out.stiffness.norm();
  if (m > 0 && k > 0) out.rate = std::sqrt(k / m);
  out.velocity *= out.rate;
  out.mass *= out.rate * out.rate;
  return out;
}

// The directions that s^2 M + s D + K takes to nothing, at most `count`, orthonormal after equilibration: by
// block inverse iteration on the singular vectors (Golub and Van Loan, Matrix Computations, section 8.2).
struct Shapes {
  Eigen::MatrixXcd vectors;
  std::vector<double> residuals; // relative
};

// Five steps from random vectors; false where the matrix cannot be factored.
bool iterate(const Eigen::MatrixXcd& beside, Eigen::MatrixXcd& x) {
  ComplexLu lu, adjoint;
  if (!lu.compute(beside) || !adjoint.compute(beside.adjoint())) return false;
  std::mt19937 random(1);
  for (Complex& entry : x.reshaped())
    entry = static_cast<double>(random()) / 2147483648. - 1;
  for (int iteration = 0; iteration < 5; ++iteration) {
    const Eigen::MatrixXcd y = adjoint.solve(x);
    x = lu.solve(y);
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      x.col(j) /= x.col(j).norm();
      for (int twice = 0; twice < 2; ++twice)
        for (Eigen::Index i = 0; i < j; ++i)
          x.col(j) -= x.col(i) * x.col(i).dot(x.col(j));
      x.col(j) /= x.col(j).norm();
    }
  }
  return x.allFinite();
}

Shapes null_shapes(const TimedMotion& motion, Complex s, Eigen::Index count) {
  const Eigen::Index n = motion.mass.rows();
  Eigen::MatrixXcd a = s * s * motion.mass.cast<Complex>() + s * motion.velocity.cast<Complex>() +
                       motion.stiffness.cast<Complex>();
  const Eigen::MatrixXd terms = std::norm(s) * motion.mass.cwiseAbs() +
                                std::abs(s) * motion.velocity.cwiseAbs() + motion.stiffness.cwiseAbs();
  Eigen::VectorXd scale(n);
  const double largest = n > 0 ? terms.maxCoeff() : 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double size = terms.row(i).maxCoeff();
    scale[i] = size > 1e-40 * largest ? 1 / std::sqrt(size) : 1; // else nothing but rounding
  }
  a = scale.asDiagonal() * a * scale.asDiagonal();
  Eigen::MatrixXcd x(n, count);
  // At the eigenvalue itself the matrix cannot be factored; a little beside it the vectors are the same. That
  // little may meet a zero pivot itself.
  double shift = std::numeric_limits<double>::epsilon();
  bool found = false;
  for (int tries = 0; tries < 4 && !found; ++tries, shift *= 3) {
    Eigen::MatrixXcd beside = a;
    beside.diagonal().array() += shift;
    found = iterate(beside, x);
  }
  if (!found) return {Eigen::MatrixXcd(n, 0), {}};
  Shapes out;
  for (Eigen::Index j = 0; j < count; ++j)
    out.residuals.push_back((a * x.col(j)).norm() / std::max(1., a.norm()));
  out.vectors = scale.asDiagonal() * x;
  return out;
}

} // namespace

double natural_frequency(Complex eigenvalue) {
  return std::abs(eigenvalue);
}
double damped_frequency(Complex eigenvalue) {
  return std::abs(eigenvalue.imag());
}
double damping_ratio(Complex eigenvalue) {
  const double size = std::abs(eigenvalue);
  return size > 0 ? 0 - eigenvalue.real() / size : 0; // never -0
}
double hertz(double angular_frequency) {
  return angular_frequency / (2 * std::numbers::pi);
}

VibrationMode describe_mode(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXcd& scaled,
                            Complex s, double residual) {
  VibrationMode mode;
  mode.eigenvalue = s;
  mode.frequency = damped_frequency(s);
  mode.natural_frequency = natural_frequency(s);
  mode.damping_ratio = damping_ratio(s);
  mode.residual = residual;
  mode.reach = problem.parameters.length;
  // What a torque drives takes part with its angle or slide, though it is scaled as a speed.
  Eigen::VectorXcd measured = scaled;
  for (const DriveTorqueElement& torque : problem.system.torques) {
    const Link& link = problem.system.links[static_cast<std::size_t>(torque.link)];
    measured[link.v] *=
        problem.scaling.column[link.v] / (link.type == LinkType::revolute ? 1 : problem.parameters.length);
  }
  Eigen::Index largest = 0;
  measured.cwiseAbs().maxCoeff(&largest);
  Eigen::VectorXcd shape = scaled / measured[largest];
  if (problem.system.torques.empty()) shape[largest] = 1;
  shape = shape.cwiseProduct(problem.scaling.column.cast<Complex>());
  mode.shape.assign(shape.begin(), shape.end());
  for (const CoordinateInfo& c : problem.system.coordinates) {
    const Link& link = problem.system.links[static_cast<std::size_t>(c.link)];
    if (link.v < 0) continue;
    const TreeJoint& joint = problem.system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
    const Complex part = finds_speed(link)
                             ? shape[link.v]
                             : coordinate_change(problem.system, problem.parameters, q, c, shape);
    mode.amplitudes.push_back({joint.name, c.index, coordinate_count(joint.type), c.angle, part});
  }
  return mode;
}

const ModeAmplitude* VibrationMode::leading() const {
  const ModeAmplitude* most = nullptr;
  double size = 0;
  for (std::size_t i = 0; i < amplitudes.size(); ++i)
    if (const double mine = std::abs(measured(i)); mine > size * (1 + 1e-6)) {
      most = &amplitudes[i];
      size = mine;
    }
  return most;
}

void keep_nearest(std::vector<Complex>& eigenvalues, std::size_t most) {
  if (eigenvalues.size() <= most) return;
  std::vector<std::size_t> nearest(eigenvalues.size());
  std::iota(nearest.begin(), nearest.end(), std::size_t{0});
  std::ranges::stable_sort(nearest, {}, [&](std::size_t i) { return std::abs(eigenvalues[i]); });
  nearest.resize(most);
  std::ranges::sort(nearest);
  for (std::size_t i = 0; i < most; ++i)
    eigenvalues[i] = eigenvalues[nearest[i]];
  eigenvalues.resize(most);
}

void sort_modes(std::vector<VibrationMode>& modes) {
  std::ranges::stable_sort(modes, [](const VibrationMode& a, const VibrationMode& b) {
    return a.frequency != b.frequency ? a.frequency < b.frequency : a.eigenvalue.real() > b.eigenvalue.real();
  });
}

std::vector<VibrationMode> find_modes(const FactoredState& at, std::size_t most) {
  const Stability stability = find_stability(at, true);
  const TimedMotion motion = timed_motion(at);
  const Eigen::VectorXd of_balance = motion.unit.cwiseQuotient(at.problem.scaling.column);
  if (!stability.eigenvalues || stability.floquet)
    return {};                                        // a motion that turns with the drives has no shapes
  std::vector<Complex> left = *stability.eigenvalues; // by size of the imaginary part
  double largest = 0;
  for (const Complex s : left)
    largest = std::max(largest, std::abs(s));
  // Of a conjugate pair one; rounding takes a double zero apart, either way.
  std::erase_if(left, [](Complex s) { return s.imag() < 0; });
  keep_nearest(left, most);
  const auto zero = [&](Complex s) { return std::abs(s) <= 1e-7 * largest; };
  const auto alike = [&](Complex a, Complex b) {
    return (zero(a) && zero(b)) || std::abs(a - b) <= 1e-9 * std::abs(a) + 1e-12 * largest;
  };
  std::vector<VibrationMode> modes;
  while (!left.empty()) {
    const Complex s = left.front();
    std::vector<Complex> cluster;
    std::erase_if(left, [&](Complex other) {
      if (!alike(s, other)) return false;
      cluster.push_back(other);
      return true;
    });
    const auto count = std::min<Eigen::Index>(static_cast<Eigen::Index>(cluster.size()), motion.mass.rows());
    const Shapes shapes = null_shapes(motion, s / motion.rate, count);
    for (Eigen::Index j = 0; j < shapes.vectors.cols(); ++j) {
      const double residual = shapes.residuals[static_cast<std::size_t>(j)];
      if (j > 0 && !(residual <= 1e-10)) break;
      modes.push_back(describe_mode(at.problem, at.z.q,
                                    of_balance.cwiseProduct(motion.basis * shapes.vectors.col(j)),
                                    cluster[static_cast<std::size_t>(j)], residual));
    }
  }
  sort_modes(modes);
  return modes;
}

Eigen::VectorXd along_mode(const Problem& problem, const Eigen::VectorXd& q, const VibrationMode& mode,
                           double amplitude, double phase, double t, Workspace& w) {
  const Complex turn = std::polar(1., phase);
  Eigen::VectorXd moved;
  for (int halving = 0; halving < 12; ++halving, amplitude /= 2) {
    w.step.resize(problem.system.nv);
    for (Eigen::Index i = 0; i < w.step.size(); ++i)
      w.step[i] = amplitude * (mode.shape[static_cast<std::size_t>(i)] * turn).real();
    for (const DriveTorqueElement& torque : problem.system.torques) // there the configuration has a speed
      w.step[problem.system.links[static_cast<std::size_t>(torque.link)].v] = 0;
    moved = q;
    retract<double>(problem.system, w.step, moved);
    if (assemble(problem, moved, t, w)) return moved;
  }
  return q;
}

StabilityEvidence stability_evidence(const FactoredState& at) {
  StabilityEvidence out;
  const Stability verdict = find_stability(at, true);
  out.potential = has_potential(at.problem, at.z, at.w.dense.stiffness(), at.w.elsewhere());
  ReducedHessian energy;
  energy.factor(at.w.dense.reduced(), at.w.dense.noise(), out.potential);
  out.null = energy.null_count();
  if (out.potential && !energy.positive_definite() && energy.size() > 0) {
    if (energy.decompose())
      out.downhill = static_cast<int>((energy.eigenvalues().array() < -ReducedHessian::zero).count());
  }
  if (verdict.floquet || verdict.floquet_failure) {
    out.reason = verdict.floquet
                     ? "The linearised motion turns with the drives: the multipliers of a period alone judge."
                     : "The linearised motion turns with the drives, and no multipliers tell of it.";
    out.agree = verdict.floquet.has_value();
    return out;
  }
  if (!verdict.eigenvalues) {
    out.agree = false;
    out.reason = "The eigenvalues were not found: the iteration for them does not converge.";
    return out;
  }
  std::vector<Complex> eigenvalues = *verdict.eigenvalues;
  double largest = 0;
  for (const Complex s : eigenvalues)
    largest = std::max(largest, std::abs(s));
  // The smallest belong to null directions and are zero but for rounding.
  std::ranges::sort(eigenvalues, {}, [](Complex s) { return std::abs(s); });
  for (std::size_t i = 0; i < eigenvalues.size(); ++i) {
    const Complex s = eigenvalues[i];
    const bool of_null = i < static_cast<std::size_t>(verdict.null_eigenvalues) &&
                         std::abs(s) < tolerance::null_eigenvalue * largest;
    if (of_null || std::abs(s.real()) <= real_part_rounding(s, largest))
      ++out.standing;
    else if (s.real() > 0)
      ++out.growing;
  }

  const auto directions = [](int count) {
    return count == 1 ? std::string("one direction") : std::to_string(count) + " directions";
  };
  if (!out.potential) {
    out.reason =
        "There is no potential here (drag, a bearing, a damper between parts that turn against each other, a "
        "drive that gives a torque, or drives that ride on moving parts): the eigenvalues alone judge.";
  } else if (at.problem.parameters.dampers_drive) {
    out.reason = "Some damper gives energy where it hardly moves: the eigenvalues alone judge.";
  } else if (out.downhill > 0 && out.growing > 0) {
    out.reason = "Both say unstable: the amended potential falls in " + directions(out.downhill) + ", and " +
                 (out.growing == 1 ? std::string("one eigenvalue grows.")
                                   : std::to_string(out.growing) + " eigenvalues grow.");
  } else if (out.downhill > 0 && verdict.stable == false) {
    out.agree = false;
    out.reason = "The amended potential falls in " + directions(out.downhill) +
                 ", and no eigenvalue tells of it: that direction has no mass. The state is unstable.";
  } else if (out.downhill > 0) {
    out.agree = false;
    out.reason = "The amended potential falls in " + directions(out.downhill) +
                 ", yet no eigenvalue grows: gyroscopic forces hold the state. Any damping of that motion "
                 "would make it unstable.";
  } else if (out.growing > 0) {
    out.agree = false;
    out.reason = "An eigenvalue grows although the amended potential does not fall to second order: the "
                 "state is too close to singular to tell.";
  } else if (out.null > 0) {
    out.reason = "The amended potential is flat in " + directions(out.null) +
                 " to second order; no eigenvalue grows. Neither criterion decides.";
  } else {
    out.reason = "Both say stable: a strict minimum of the amended potential, and no eigenvalue grows.";
  }
  return out;
}

} // namespace flyball
