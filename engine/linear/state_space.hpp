// Linear time-invariant systems E x' = A x + B u, y = C x + D u: poles, zeros and how they answer to sines.
#pragma once

#include "engine/linear/interruption.hpp"

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <vector>

namespace flyball {

// n states, m inputs, p outputs. E may be singular, as where massless parts follow at once.
struct StateSpace {
  Eigen::MatrixXd e, a; // (n, n); an empty E stands for the identity
  Eigen::MatrixXd b;    // (n, m)
  Eigen::MatrixXd c;    // (p, n)
  Eigen::MatrixXd d;    // (p, m)
};

// The same in other units of the states, powers of two, in which rows and columns of A are alike in size
// (Parlett and Reinsch, Balancing a matrix for calculation of eigenvalues and eigenvectors, 1969). Of a
// system without E.
StateSpace balanced(StateSpace system);

// The finite s with det(A - s E) = 0 (1/s), by size of the imaginary part. Nothing where the iteration does
// not converge, as of a singular pencil.
std::optional<std::vector<std::complex<double>>> poles(const StateSpace& system, CancelFlag cancel = nullptr);

// The s at which the pencil [A - s E, b; c, d] of one input and one output loses rank: invariant zeros, those
// of the transfer function and what cancels against poles. Of a system without E, by taking off a state for
// each order by which poles outnumber them (Emami-Naeini and Van Dooren, Computation of zeros of linear
// multivariable systems, 1982), so that no zero at infinity shows as a large one. Nothing where the transfer
// function vanishes altogether, where there is an E, or the iteration does not converge.
std::optional<std::vector<std::complex<double>>> zeros(const StateSpace& system, Eigen::Index input,
                                                       Eigen::Index output);

// H(s) = C (s E - A)^-1 B + D, (p, m). Nothing at a pole.
std::optional<Eigen::MatrixXcd> transfer(const StateSpace& system, std::complex<double> s);

// H(0), (p, m): what a constant input comes to in the end, where all poles lie to the left. Nothing where A
// is singular to rounding, as something integrates that an output feels; what none feels, as the common angle
// of shafts that turn on, does not matter.
std::optional<Eigen::MatrixXd> static_gain(const StateSpace& system);

} // namespace flyball
