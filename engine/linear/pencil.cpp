#include "engine/linear/pencil.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/linear/state_space.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Complex = std::complex<double>;
using Eigenvalues = std::optional<std::vector<Complex>>;

constexpr double massless_inertia = 1e-13; // of the heaviest

void sort_eigenvalues(std::vector<Complex>& s) {
  for (Complex& x : s)
    x += Complex(0, 0); // no negative zeros
  std::ranges::sort(s, [](Complex a, Complex b) {
    if (std::abs(a.imag()) != std::abs(b.imag())) return std::abs(a.imag()) < std::abs(b.imag());
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
}

// E x' = A x, x = (positions, velocities), p' = to_positions u, M u' = -D u - K p: nothing is divided by M.
StateSpace first_order(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                       const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& to_positions) {
  const Eigen::Index n = mass.rows(), positions = to_positions.rows();
  StateSpace out;
  out.e.setIdentity(positions + n, positions + n);
  out.e.bottomRightCorner(n, n) = mass;
  out.a.setZero(positions + n, positions + n);
  out.a.topRightCorner(positions, n) = to_positions;
  out.a.bottomLeftCorner(n, positions) = -stiffness;
  out.a.bottomRightCorner(n, n) = -velocity;
  return out;
}

// What a companion matrix of M^-1 D and M^-1 K has as eigenvalues, by the pencil itself where they are far
// apart: rounding of the companion is that of the largest, or of its square, which leaves slow ones beside a
// fast one few digits. QZ of the pencil in like sizes leaves each its own. With `few_digits` it is spared
// where enough of them are left for the signs of the slow ones' real parts, and told.
Eigenvalues with_digits(Eigenvalues of_companion, const StateSpace& pencil, CancelFlag cancel,
                        bool* few_digits = nullptr) {
  constexpr double apart = 300, far_apart = 1e5; // of whose squares eleven and six digits are left
  if (!of_companion) return {};
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (const Complex s : *of_companion) {
    largest = std::max(largest, std::abs(s));
    if (s != Complex()) smallest = std::min(smallest, std::abs(s));
  }
  if (!(largest > apart * smallest)) return of_companion;
  const auto has_sign = [&](Complex s) {
    return apart * std::abs(s) > largest || std::abs(s.real()) > 1e-3 * std::abs(s);
  };
  if (few_digits && largest < far_apart * smallest && std::ranges::all_of(*of_companion, has_sign)) {
    *few_digits = true;
    return of_companion;
  }
  auto found = poles(pencil, cancel);
  return found && found->size() == of_companion->size() ? found : of_companion;
}

// The same of M x = -mu K x, both symmetric, M = L L^T: eigenvalues of L^-1 K L^-T, whose rounding is that of
// the largest, and where these are far apart of its inverse, whose rounding is that of the smallest.
std::optional<std::vector<double>> squares_of(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& stiffness,
                                              const Eigen::MatrixXd& whitened) {
  const auto squares = symmetric_eigenvalues(whitened);
  if (!squares) return {};
  std::vector<double> out(squares->begin(), squares->end()); // ascending
  constexpr double apart = 1e4;
  const double largest = std::max(std::abs(out.front()), std::abs(out.back()));
  Cholesky k;
  if (!(largest > apart * std::abs(out.front())) || !k.compute((stiffness + stiffness.transpose()) / 2))
    return out;
  const Eigen::MatrixXd half = k.forward(mass);
  const auto inverses = symmetric_eigenvalues(k.forward(half.transpose()));
  if (!inverses || !((*inverses)[0] > 0)) return out;
  const auto n = static_cast<Eigen::Index>(out.size());
  const double least = 1 / (*inverses)[n - 1];
  for (Eigen::Index i = 0; i < n; ++i)
    if (const double mu = 1 / (*inverses)[n - 1 - i]; mu * mu < least * largest)
      out[static_cast<std::size_t>(i)] = mu;
  return out;
}

// Of s^2 + s d + k with d = L^-1 D L^-T, k = L^-1 K L^-T, M = L L^T.
Eigenvalues regular_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                const Eigen::MatrixXd& stiffness, CancelFlag cancel) {
  const Eigen::Index n = velocity.rows();
  Cholesky l;
  if (!l.compute(mass)) return {};
  const auto whiten = [&](const Eigen::MatrixXd& a) {
    const Eigen::MatrixXd half = l.forward(a);
    return Eigen::MatrixXd(l.forward(half.transpose()).transpose());
  };
  const Eigen::MatrixXd d = whiten(velocity), k = whiten(stiffness);
  const double asymmetry = (k - k.transpose()).norm();
  if (d.norm() == 0 && asymmetry <= 1e-12 * k.norm()) { // s^2 = -eigenvalue of k: exact on the axes
    const auto squares = squares_of(mass, stiffness, k);
    if (!squares) return {};
    std::vector<Complex> s;
    for (double mu : *squares) {
      const Complex root = mu >= 0 ? Complex(0, std::sqrt(mu)) : Complex(std::sqrt(-mu), 0);
      s.push_back(root);
      s.push_back(-root);
    }
    return s;
  }
  const auto identity = Eigen::MatrixXd::Identity(n, n);
  return with_digits(eigenvalues(first_order(identity, d, k, identity).a, cancel),
                     first_order(mass, velocity, stiffness, identity), cancel);
}

Eigenvalues singular_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                 const Eigen::MatrixXd& stiffness, CancelFlag cancel) {
  return poles(first_order(mass, velocity, stiffness, Eigen::MatrixXd::Identity(mass.rows(), mass.rows())),
               cancel);
}

Eigen::MatrixXd onto(const Eigen::MatrixXd& z, const Eigen::MatrixXd& a) {
  return z.transpose() * a * z;
}

// Of massless directions z those that feel a spring or damper. The rest have no equation of motion, and would
// make the pencil singular: then any number is an eigenvalue.
std::optional<Eigen::MatrixXd> felt(const Eigen::MatrixXd& z, const Eigen::MatrixXd& velocity,
                                    const Eigen::MatrixXd& stiffness) {
  Eigen::MatrixXd feels(z.cols(), 4 * z.rows());
  feels << (stiffness * z).transpose(), z.transpose() * stiffness, (velocity * z).transpose(),
      z.transpose() * velocity;
  if (feels.isZero(0)) return Eigen::MatrixXd(z.rows(), 0);
  PivotedQr qr;
  if (!qr.compute(feels)) return {};
  const double rounding = 1e-13 * (stiffness.norm() + velocity.norm());
  Eigen::Index rank = 0;
  while (rank < z.cols() && qr.pivot(rank) > rounding)
    ++rank;
  return Eigen::MatrixXd(z * qr.q().leftCols(rank));
}

// Of directions z without mass and damping, beside all others.
struct Followers {
  Eigen::MatrixXd stiffness; // for the others, which those of z that have stiffness follow statically
  Eigen::MatrixXd holds_left, holding; // the rest of z, by rows and by columns
};

std::optional<Followers> follow_statically(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& z,
                                           const Eigen::MatrixXd& others) {
  if (z.cols() == 0) return Followers{stiffness, z, z};
  const auto shape = singular_vectors(onto(z, stiffness));
  if (!shape) return {};
  const Eigen::MatrixXd rows = z * shape->left, columns = z * shape->right,
                        left = rows.transpose() * stiffness, right = stiffness * columns;
  constexpr double none = 1e-12; // beside the coupling
  Eigen::Index stiff = 0;
  while (stiff < z.cols() && shape->values[stiff] > 0 &&
         shape->values[stiff] > none * std::max((left.row(stiff) * others).norm(),
                                                (others.transpose() * right.col(stiff)).norm()))
    ++stiff;
  const Eigen::Index holding = z.cols() - stiff;
  return Followers{stiffness - right.leftCols(stiff) * shape->values.head(stiff).cwiseInverse().asDiagonal() *
                                   left.topRows(stiff),
                   rows.rightCols(holding), columns.rightCols(holding)};
}

// With directions z that have neither mass nor damping, beside the rest r. Where they have stiffness they
// follow statically; where they have none, but forces couple them with the rest, they hold it like the
// multipliers of a constraint: no motion of the rest may change the forces along them.
Eigenvalues condensed_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                  const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& z,
                                  const Eigen::MatrixXd& r, CancelFlag cancel) {
  const auto with = follow_statically(stiffness, z, r);
  if (!with) return {};
  Eigen::MatrixXd m = onto(r, mass), d = onto(r, velocity), k = onto(r, with->stiffness);
  if (with->holding.cols() == 0) return regular_eigenvalues(m, d, k, cancel);
  const bool symmetric = (stiffness - stiffness.transpose()).norm() <= 1e-12 * stiffness.norm();
  const auto along = null_space(with->holds_left.transpose() * stiffness * r);
  const auto across = symmetric ? along : null_space((r.transpose() * stiffness * with->holding).transpose());
  if (!along || !across || along->cols() != across->cols()) return {};
  if (along->cols() == 0) return std::vector<Complex>();
  const auto reduced = [&](const Eigen::MatrixXd& a) {
    return Eigen::MatrixXd(across->transpose() * a * *along);
  };
  m = reduced(m);
  if ((m - m.transpose()).norm() > 1e-12 * m.norm())
    return singular_eigenvalues(m, reduced(d), reduced(k), cancel);
  return regular_eigenvalues((m + m.transpose()) / 2, reduced(d), reduced(k), cancel);
}

// With directions z that have no mass, some of them damped, beside the rest r. Only what has mass has
// velocities of its own, and what is not damped either follows statically: as states they would be infinite
// eigenvalues in Jordan chains, which rounding makes huge ones.
Eigenvalues damped_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                               const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& z,
                               const Eigen::MatrixXd& r, CancelFlag cancel) {
  Eigen::MatrixXd feels(z.cols(), 2 * z.rows());
  feels << (velocity * z).transpose(), z.transpose() * velocity;
  const auto shape = singular_vectors(feels);
  if (!shape) return {};
  const double rounding = 1e-13 * (velocity.norm() + stiffness.norm());
  const auto damped = static_cast<Eigen::Index>((shape->values.array() > rounding).count());
  const Eigen::MatrixXd along = z * shape->left, dampers = along.leftCols(damped);
  Eigen::MatrixXd others(z.rows(), damped + r.cols());
  others << dampers, r;
  const auto with = follow_statically(stiffness, along.rightCols(z.cols() - damped), others);
  if (!with) return {};
  if (with->holding.cols() > 0) {
    Eigen::MatrixXd all(z.rows(), z.cols() + r.cols());
    all << z, r;
    return singular_eigenvalues(onto(all, mass), onto(all, velocity), onto(all, stiffness), cancel);
  }
  const Eigen::Index n = r.cols();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n + damped, 2 * n + damped), b = a;
  const auto fill = [&](Eigen::MatrixXd& into, Eigen::Index row, Eigen::Index column,
                        const Eigen::MatrixXd& left, const Eigen::MatrixXd& of,
                        const Eigen::MatrixXd& right) {
    into.block(row, column, left.cols(), right.cols()) = left.transpose() * of * right;
  };
  a.block(0, n, n, n).setIdentity();
  b.topLeftCorner(n, n).setIdentity();
  fill(b, n, n, r, mass, r);
  fill(b, n, 2 * n, r, velocity, dampers);
  fill(b, 2 * n, 2 * n, dampers, velocity, dampers);
  fill(a, n, 0, r, -with->stiffness, r);
  fill(a, n, n, r, -velocity, r);
  fill(a, n, 2 * n, r, -with->stiffness, dampers);
  fill(a, 2 * n, 0, dampers, -with->stiffness, r);
  fill(a, 2 * n, n, dampers, -velocity, r);
  fill(a, 2 * n, 2 * n, dampers, -with->stiffness, dampers);
  return generalized_eigenvalues(a, b, cancel);
}

// What pencil_eigenvalues() finds, of matrices as measured. `graded`: some of what is not massless is far
// lighter, and far faster, than the rest, which M's inverse would lose.
Eigenvalues finite_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                               const Eigen::MatrixXd& stiffness, bool graded, CancelFlag cancel) {
  const double m = mass.norm(), k = stiffness.norm(), d = velocity.norm();
  if (m == 0) {
    if (d == 0) return std::vector<Complex>();
    const auto z = felt(Eigen::MatrixXd::Identity(mass.rows(), mass.rows()), velocity, stiffness);
    if (!z) return {};
    return damped_eigenvalues(mass, velocity, stiffness, *z, Eigen::MatrixXd(mass.rows(), 0), cancel);
  }
  // Time in units in which mass and stiffness are alike.
  const double rate = k > 0 ? std::sqrt(k / m) : d > 0 ? d / m : 1;
  const Eigen::MatrixXd m1 = mass / m, d1 = velocity / (m * rate), k1 = stiffness / (m * rate * rate);
  interruption_point();
  SymmetricEigen shape;
  if (!shape.compute((m1 + m1.transpose()) / 2)) return {};
  Eigen::Index massless = 0;
  while (massless < m1.rows() && shape.values()[massless] < massless_inertia)
    ++massless;
  Eigenvalues s;
  if (massless == 0) {
    s = graded ? singular_eigenvalues(m1, d1, k1, cancel)
               : regular_eigenvalues((m1 + m1.transpose()) / 2, d1, k1, cancel);
  } else {
    const Eigen::MatrixXd light = shape.vectors().leftCols(massless),
                          r = shape.vectors().rightCols(m1.rows() - massless);
    // A mass of m_z couples gyroscopically like sqrt(m_z m_r): where masses are neglected up to 1e-13, so is
    // the coupling up to its root. As rounding it would be a damper, or hold what it couples.
    const Eigen::MatrixXd gyroscopic = (d1 - d1.transpose()) / 2, coupling = gyroscopic * light;
    Eigen::MatrixXd d2 = d1;
    if (coupling.norm() <= 5e-7 * (d1.norm() + 1)) {
      const Eigen::MatrixXd one_side = coupling * light.transpose();
      d2 -= one_side - one_side.transpose() - light * (light.transpose() * one_side);
    }
    const auto felt_directions = felt(light, d2, k1);
    if (!felt_directions) return {};
    const Eigen::MatrixXd& z = *felt_directions;
    const bool damped = (d2 * z).norm() + (z.transpose() * d2).norm() > 1e-13 * (d1.norm() + 1);
    s = damped ? damped_eigenvalues(m1, d2, k1, z, r, cancel)
               : condensed_eigenvalues(m1, d2, k1, z, r, cancel);
  }
  if (!s) return {};
  for (Complex& x : *s)
    x *= rate;
  sort_eigenvalues(*s);
  return s;
}

constexpr double rounding_of_inertia = 1e-13, light_inertia = 1e-10; // of what it is made of, of the heaviest
constexpr double much_faster = 1e4;   // than the others, whose squares then keep eight digits
constexpr double no_velocity = 1e-13; // of all there is

// 1/s, of a direction by itself.
double own_rate(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                const Eigen::MatrixXd& stiffness, Eigen::Index i) {
  return std::max(std::sqrt(std::abs(stiffness(i, i)) / mass(i, i)), std::abs(velocity(i, i)) / mass(i, i));
}

// The largest of those that are not light.
double rate_of_heavy(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                     const Eigen::MatrixXd& stiffness) {
  const double heaviest = mass.rows() > 0 ? mass.diagonal().maxCoeff() : 0;
  double out = 0;
  for (Eigen::Index i = 0; i < mass.rows(); ++i)
    if (mass(i, i) > 0 && mass(i, i) >= light_inertia * heaviest)
      out = std::max(out, own_rate(mass, velocity, stiffness, i));
  return out;
}

} // namespace

// With x = P p + C c, C cyclic, and the velocities u: p' = P^T u, M u' = -D u - K P p.
Eigenvalues eigenvalues_without_cyclic(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                       const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& cyclic,
                                       double massless, CancelFlag cancel, bool* few_digits) {
  const Eigen::Index n = mass.rows(), positions = n - cyclic.cols();
  const double m = mass.norm(), k = stiffness.norm(), d = velocity.norm();
  if (n == 0 || !(m > 0) || !std::isfinite(m + k + d)) return {};
  if (!(mass.diagonal().minCoeff() > massless * m)) return {};
  const auto all = orthonormal_completion(cyclic);
  if (!all || all->cols() != n) return {};
  const Eigen::MatrixXd p = all->rightCols(positions);
  const double rate = k > 0 ? std::sqrt(k / m) : d > 0 ? d / m : 1;
  // A light part beside a heavy one is as well known as that: each is measured by its own inertia.
  const Eigen::VectorXd own = (mass.diagonal() / m).cwiseSqrt().cwiseInverse();
  const auto equilibrated = [&](const Eigen::MatrixXd& a) {
    return Eigen::MatrixXd(own.asDiagonal() * a * own.asDiagonal());
  };
  const Eigen::MatrixXd inertia = equilibrated((mass + mass.transpose()) / (2 * m));
  Cholesky l;
  if (!l.compute(inertia) || !(l.smallest_pivot() > 1e-13)) return {};
  // Whitened: M = L L^T, u = L^-T w.
  const auto whiten = [&](const Eigen::MatrixXd& a) {
    const Eigen::MatrixXd half = l.forward(a);
    return Eigen::MatrixXd(l.forward(half.transpose()).transpose());
  };
  const Eigen::MatrixXd forces = own.asDiagonal() * (stiffness * p) / (m * rate * rate),
                        moved = own.asDiagonal() * p, damping = equilibrated(velocity) / (m * rate);
  const StateSpace whitened = first_order(Eigen::MatrixXd::Identity(n, n), whiten(damping), l.forward(forces),
                                          l.forward(moved).transpose()),
                   pencil = first_order(inertia, damping, forces, moved.transpose());
  auto s = with_digits(eigenvalues(whitened.a, cancel), pencil, cancel, few_digits);
  if (!s) return {};
  for (Complex& x : *s)
    x *= rate;
  sort_eigenvalues(*s);
  return s;
}

Eigen::VectorXd units_of_inertia(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                                 const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& made_of,
                                 std::vector<Eigen::Index>* fast) {
  const double heaviest = mass.rows() > 0 ? mass.diagonal().maxCoeff() : 0;
  const double others = rate_of_heavy(mass, velocity, stiffness);
  Eigen::VectorXd units = Eigen::VectorXd::Ones(mass.rows());
  bool any_light = false;
  for (Eigen::Index i = 0; i < mass.rows(); ++i) {
    const bool is_light = mass(i, i) < light_inertia * heaviest;
    if (!(mass(i, i) > rounding_of_inertia * made_of[i])) continue;
    if (is_light && others > 0 && own_rate(mass, velocity, stiffness, i) > much_faster * others) {
      if (fast) fast->push_back(i);
      continue;
    }
    units[i] = std::sqrt(heaviest / mass(i, i));
    any_light |= is_light;
  }
  return any_light ? units : Eigen::VectorXd::Ones(mass.rows());
}

MeasuredPencil measured_pencil(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                               const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& made_of) {
  std::vector<Eigen::Index> fast;
  Eigen::VectorXd units = units_of_inertia(mass, velocity, stiffness, made_of, &fast);
  const double others = rate_of_heavy(mass, velocity, stiffness),
               heaviest = mass.rows() > 0 ? mass.diagonal().maxCoeff() : 0;
  const bool known =
      std::ranges::any_of(fast, [&](Eigen::Index i) { return mass(i, i) >= massless_inertia * heaviest; });
  if (known && velocity.isZero(0)) fast.clear();
  for (const Eigen::Index i : fast)
    units[i] = std::sqrt(heaviest / std::max(std::abs(stiffness(i, i)) / (others * others),
                                             std::abs(velocity(i, i)) / others));
  const auto measured = [&](const Eigen::MatrixXd& a) {
    return Eigen::MatrixXd(units.asDiagonal() * a * units.asDiagonal());
  };
  MeasuredPencil out{measured(mass), measured(velocity), measured(stiffness)};
  const double none = no_velocity * (out.velocity.norm() + heaviest * others);
  out.graded = !fast.empty() && (known || std::ranges::any_of(fast, [&](Eigen::Index i) {
                                   return out.velocity.row(i).norm() + out.velocity.col(i).norm() > none;
                                 }));
  if (out.graded) {
    if (!known) out.known = much_faster * others;
    return out;
  }
  for (const Eigen::Index i : fast) {
    out.mass.row(i).setZero();
    out.mass.col(i).setZero();
  }
  return out;
}

Eigenvalues pencil_eigenvalues(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& velocity,
                               const Eigen::MatrixXd& stiffness, CancelFlag cancel,
                               const Eigen::VectorXd& made_of) {
  if (mass.rows() == 0) return std::vector<Complex>();
  const double m = mass.norm(), k = stiffness.norm(), d = velocity.norm();
  if (!std::isfinite(m + k + d)) return {};
  if (made_of.size() > 0) {
    const MeasuredPencil in = measured_pencil(mass, velocity, stiffness, made_of);
    Eigenvalues s = finite_eigenvalues(in.mass, in.velocity, in.stiffness, in.graded, cancel);
    if (s) std::erase_if(*s, [&](Complex x) { return x.real() < 0 && std::abs(x) > in.known; });
    return s;
  }
  return finite_eigenvalues(mass, velocity, stiffness, false, cancel);
}

} // namespace flyball
