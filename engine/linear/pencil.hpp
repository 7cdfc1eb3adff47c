// Eigenvalues of the linearised motion M q'' + D q' + K q = 0.
#pragma once

#include <Eigen/Core>

#include <atomic>
#include <complex>
#include <limits>
#include <optional>
#include <vector>

namespace flyball {

// Units (n) in which each direction has as much inertia as the heaviest, all 1 where none is much lighter: a
// light part beside a heavy one is as well known as that. `made_of` (n): what the diagonal entries of M are
// sums of; of one that is only rounding of these nothing is known, and it keeps its unit. So does a light
// direction that by itself is far faster than the others (`fast`, if asked for): as large an eigenvalue would
// leave nothing of theirs.
Eigen::VectorXd units_of_inertia(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                 const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& made_of,
                                 std::vector<Eigen::Index>* fast = nullptr);

// M, D and K in units in which nothing is lost beside the heaviest: those of units_of_inertia(), and of light
// directions that are far faster than the others those in which what acts on them is as large as on these.
struct MeasuredPencil {
  Eigen::MatrixXd mass, velocity, stiffness;
  // Damping or coriolis forces act along such directions: M's inverse would lose them, QZ does not. Else they
  // count as massless (0), but where nothing is damped and M knows them, which keeps roots on the axes.
  bool graded = false;
  double known = std::numeric_limits<double>::infinity(); // 1/s: what dies out faster is theirs, not listed
};
MeasuredPencil measured_pencil(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                               const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& made_of);

// Finite eigenvalues (1/s, by size of the imaginary part) of the pencil s^2 M + s D + K, each (n, n) in units
// of one kind. M may be singular in any direction (massless coordinates): directions without mass and damping
// are condensed statically, others leave as infinite eigenvalues. What is massless is asked of the
// measured_pencil() where `made_of` is given, else beside the heaviest; of what is fast beside the others in
// this what grows is told. Nothing where an entry is not
// finite, the iteration does not converge, or `cancel` is set.
std::optional<std::vector<std::complex<double>>> pencil_eigenvalues(const Eigen::MatrixXd& mass,
                                                                    const Eigen::MatrixXd& velocity,
                                                                    const Eigen::MatrixXd& stiffness,
                                                                    const std::atomic<bool>* cancel = nullptr,
                                                                    const Eigen::VectorXd& made_of = {});

// The same where the orthonormal columns of `cyclic`, which K takes to nothing, are left out as positions:
// each has an eigenvalue zero, and these are not among the result. M must be positive definite, else nothing:
// a diagonal entry below `massless` of its size is rounding. `few_digits`, where given: their signs alone are
// asked for, and it is set where those far below the largest have few digits.
std::optional<std::vector<std::complex<double>>>
eigenvalues_without_cyclic(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                           const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& cyclic, double massless,
                           const std::atomic<bool>* cancel, bool* few_digits = nullptr);

} // namespace flyball
