// The first Lyapunov coefficient of a pair of eigenvalues +-i w: whether x' = F(x) loses its stability softly
// there, to small oscillations, or hard (Kuznetsov, Elements of Applied Bifurcation Theory, 2004,
// sections 3.5 and 5.4),
//
//     l1 = 1/(2 w) Re( <p, C(q, q, q*)> - 2 <p, B(q, A^-1 B(q, q*))> + <p, B(q*, (2 i w - A)^-1 B(q, q))> )
//
// with A, B, C the first three derivatives of F at x = 0, A q = i w q, A^T p = -i w p, <p, q> = 1. On the
// centre manifold x = z q + z* q* + ..., and |z|' = Re(s) |z| + w l1 |z|^3 for a pair s beside the axis:
// below zero the loss is soft. A q scaled by c has an l1 of |c|^2 as much.
#pragma once

#include <Eigen/Core>

#include <complex>
#include <functional>
#include <optional>

namespace flyball {

// F: fills the rate (1/s) at x. False where there is none. The length of x beyond which F is curved is to be
// about one.
using VectorField = std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& rate)>;

struct LyapunovCoefficient {
  std::complex<double> eigenvalue; // 1/s: of A, s with a positive imaginary part w
  double value = 0;                // l1, for |q| = 1
  double error = 0;                // estimated, by what the extrapolations of the derivatives leave open
  Eigen::VectorXcd q;              // |q| = 1
};

// Of the eigenvalue of A next to i `frequency` (rad/s), x of so many entries. Derivatives along directions
// are central differences, extrapolated (Ridders 1982). Nothing where F has no such derivatives, or where A
// or 2 i w - A is singular.
std::optional<LyapunovCoefficient> first_lyapunov_coefficient(const VectorField& field, Eigen::Index size,
                                                              double frequency);

} // namespace flyball
