#include "engine/stability/routh.hpp"

#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"

namespace flyball {

std::optional<LinearPencil> at_given_momenta(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                             const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& kept) {
  const auto all = orthonormal_completion(kept);
  if (!all || all->cols() != mass.rows()) return {};
  LinearPencil out;
  out.directions = all->rightCols(mass.rows() - kept.cols());
  const Eigen::MatrixXd& x = out.directions;
  const auto beside = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& left,
                          const Eigen::MatrixXd& right) {
    return Eigen::MatrixXd(left.transpose() * (a * right));
  };
  Cholesky turning;
  const Eigen::MatrixXd of_kept = beside(mass, kept, kept);
  if (!turning.compute((of_kept + of_kept.transpose()) / 2) || !(turning.smallest_pivot() > 0)) return {};
  const Eigen::MatrixXd mass_up = turning.solve(beside(mass, kept, x)),
                        velocity_up = turning.solve(beside(velocity, kept, x)),
                        mass_down = beside(mass, x, kept), velocity_down = beside(velocity, x, kept);
  out.mass = large::projected(mass, x) - mass_down * mass_up;
  out.velocity = large::projected(velocity, x) - mass_down * velocity_up - velocity_down * mass_up;
  out.mass_terms = mass.norm();
  out.velocity_terms = velocity.norm();
  out.stiffness = large::projected(stiffness, x) - velocity_down * velocity_up;
  return out;
}

} // namespace flyball
