#include "engine/solve/eigenvector_descent.hpp"

#include "engine/linear/largest.hpp"

namespace flyball {
namespace {

double potential_at(const Problem& problem, const Eigen::VectorXd& q, Workspace& w, double& magnitude) {
  forward<double>(problem.system, problem.parameters, q, 0, w.kinematics);
  const Potential u = amended_potential(problem.system, problem.parameters, q, w.kinematics);
  magnitude = u.magnitude;
  return u.value;
}

} // namespace

DescentOutcome descend_by_eigenvectors(const Problem& problem, Unknowns& z, Workspace& w,
                                       std::vector<double>* history) {
  DescentOutcome outcome;
  double radius = 0.25, magnitude = 0, travelled = 0;
  double u = potential_at(problem, z.q, w, magnitude);
  Eigen::VectorXd direction, gradient, moved;
  ReducedHessian hessian;
  for (int i = 0; i < 2000; ++i) {
    outcome.iterations = i;
    if (problem.cancelled()) return {DescentEnd::cancelled, i};
    factor_with_multipliers(problem, z, w);
    if (history) history->push_back(scaled_residual(problem, w));
    const Eigen::MatrixXd& basis = w.dense.constraints().basis();
    if (basis.cols() == 0) return {DescentEnd::minimum, i};
    gradient = basis.transpose() * w.residual.f.cwiseProduct(problem.scaling.column);
    hessian.factor(w.dense.reduced(), w.dense.noise(), true);
    if (!hessian.decompose()) return {DescentEnd::stalled, i};

    // In equilibrated coordinates: step along each eigenvector against the gradient, with |eigenvalue|.
    const Eigen::VectorXd g = gradient.cwiseProduct(hessian.scale());
    Eigen::VectorXd y = Eigen::VectorXd::Zero(g.size());
    const double force = largest(w.magnitudes.force.cwiseProduct(problem.scaling.column));
    double slope = 0, lowest = 0;
    Eigen::Index lowest_index = 0;
    bool down = false;
    const double rounding = tolerance::potential_rounding * magnitude;
    for (Eigen::Index k = 0; k < g.size(); ++k) {
      const double mu = hessian.eigenvalues()[k];
      const double along = hessian.eigenvectors().col(k).dot(g);
      if (mu < lowest) {
        lowest = mu;
        lowest_index = k;
      }
      const Eigen::VectorXd along_vector =
          basis * hessian.eigenvectors().col(k).cwiseProduct(hessian.scale());
      const double length = along_vector.lpNorm<Eigen::Infinity>();
      if (length == 0) continue; // what feels nothing at all
      double distance = std::abs(along / mu) * length;
      if (std::abs(mu) <= ReducedHessian::zero) {
        // Nothing resists here. A force that pushes this way has a long way to go.
        if (!(std::abs(along) > tolerance::neutral_force * force * length)) continue;
        distance = radius;
      } else if (distance > tolerance::short_step && along * along < rounding * std::abs(mu)) {
        // Nothing resists here either, but what is left of the gradient looks like curvature. A long step
        // without a gain that can be measured would only wander.
        continue;
      }
      const double stride = std::copysign(std::min(distance, radius), along) / length;
      y -= hessian.eigenvectors().col(k) * stride;
      slope -= along * stride;
    }
    Eigen::VectorXd step = basis * y.cwiseProduct(hessian.scale());
    double size = step.lpNorm<Eigen::Infinity>();
    bool saddle = lowest < -ReducedHessian::zero && size < tolerance::saddle_step;
    Eigen::VectorXd off;
    if (saddle) {
      off = basis * hessian.eigenvectors().col(lowest_index).cwiseProduct(hessian.scale());
      const double amplitude = 0.1 / off.lpNorm<Eigen::Infinity>();
      saddle = -lowest * amplitude * amplitude > 20 * rounding; // else flat to rounding
    }
    if (saddle) {
      // Step off along the most unstable direction, on the side the gradient leans to, if it does.
      const Eigen::VectorXd v = hessian.eigenvectors().col(lowest_index);
      step = off;
      Eigen::Index biggest = 0;
      step.cwiseAbs().maxCoeff(&biggest);
      double side = v.dot(g) > 0 ? -1 : 1;
      if (std::abs(v.dot(g)) < 1e-9 * std::abs(lowest)) side = step[biggest] > 0 ? 1 : -1;
      step *= side * 0.1 / step.lpNorm<Eigen::Infinity>();
      size = 0.1;
      slope = 0;
      down = true;
    } else if (size < tolerance::converged_step) {
      return {DescentEnd::minimum, i};
    }
    double fraction = std::min(1., radius / size);
    bool accepted = false;
    for (int tries = 0; tries < 40; ++tries, fraction /= 2) {
      moved = z.q;
      w.step = fraction * step.cwiseProduct(problem.scaling.column);
      retract<double>(problem.system, w.step, moved);
      if (!assemble(problem, moved, 0, w)) continue;
      double new_magnitude = 0;
      const double next = potential_at(problem, moved, w, new_magnitude);
      const double wanted = down ? 0. : tolerance::sufficient_decrease * fraction * slope;
      if (std::isfinite(next) &&
          (next <= u + wanted || (next <= u + rounding && fraction * size < tolerance::short_step))) {
        u = std::min(u, next);
        magnitude = new_magnitude;
        accepted = true;
        break;
      }
    }
    if (!accepted) return {size < tolerance::stalled_step ? DescentEnd::minimum : DescentEnd::stalled, i};
    travelled += fraction * size;
    radius = fraction * size >= 0.99 * radius ? std::min(0.5, 2 * radius)
                                              : std::max(1e-3, std::min(radius, 2 * fraction * size));
    z.q = moved;
    if (travelled > 400) return {DescentEnd::unbounded, i};
  }
  return outcome;
}

} // namespace flyball
