// The eigenvalues of largest size of an operator that is known by its products alone, by Lanczos' and
// Arnoldi's methods with implicit restarts (Sorensen, Implicit application of polynomial filters in a k-step
// Arnoldi method, 1992) as Spectra has them.
//
// One run sees one vector of each eigenspace. What was found is therefore taken out and the rest asked again,
// until it has nothing larger: so repeated eigenvalues come as often as they are.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>

namespace flyball {

// y = A x; y comes in the size of x.
using Product = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

// By size, the largest first; fewer than `count` where the operator (size, size) has fewer. Nothing where the
// iteration does not converge or an entry is not finite.
struct SymmetricPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors; // orthonormal columns
};
std::optional<SymmetricPairs> largest_symmetric(Eigen::Index size, Eigen::Index count,
                                                const Product& product);

// At least `count`, and both of a complex pair.
struct ComplexPairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors; // columns of length one
};
std::optional<ComplexPairs> largest_of_any(Eigen::Index size, Eigen::Index count, const Product& product);

} // namespace flyball
