#include "engine/search/phase_search.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace flyball {
namespace {

constexpr int most_coordinates = 60;
constexpr double counts = 1e-6; // of the largest effect of an angle
// Of a central difference of sixth order.
constexpr double difference = 0x1p-7;
constexpr std::array weights{3. / 4, -3. / 20, 1. / 60};

class PhaseSearch {
 public:
  PhaseSearch(const Problem& problem, const Eigen::VectorXd& q, Workspace& w)
      : given_(problem),
        p_(problem.parameters), problem_{problem.system, p_, problem.scaling, problem.cancel}, q_(q), w_(w) {
    for (std::size_t l = 0; l < problem.system.links.size(); ++l)
      if (const Link& link = problem.system.links[l]; finds_speed(link)) {
        links_.push_back(l);
        units_.push_back(link.type == LinkType::revolute ? 1 : p_.length);
      }
  }

  std::vector<TurnedState> run() {
    std::vector<TurnedState> out;
    if (!find_directions()) return out;
    std::vector<Eigen::VectorXd> known;
    for (const double begin : {0., 0.15, -0.15, 0.5, -0.5, 1.2, -1.2, 2.1, -2.1, 3., 1.7}) {
      interruption_point();
      Eigen::VectorXd along(directions_.cols());
      for (Eigen::Index i = 0; i < along.size(); ++i)
        along[i] = begin * (1 - 0.3 * static_cast<double>(i));
      auto found = solve_from(along);
      if (!found || rests(found->z.q)) continue;
      const auto same = [&](const Eigen::VectorXd& other) { return (other - along).norm() < 1e-6; };
      if (std::ranges::any_of(known, same)) continue;
      known.push_back(along);
      out.push_back(std::move(*found));
    }
    return out;
  }

 private:
  // Forces and open loops at time t with all angles `by` further on.
  Eigen::VectorXd effect(const Eigen::VectorXd& by, double t) {
    turn(by);
    const System& system = given_.system;
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.rows);
    forward<double>(system, p_, q_, t, w_.kinematics);
    evaluate_residual<double>(system, p_, q_, none, w_.kinematics, w_.residual);
    Eigen::VectorXd out(system.nv + system.rows);
    out << w_.residual.f.cwiseProduct(given_.scaling.column),
        w_.residual.phi.cwiseProduct(given_.scaling.row);
    for (const CutJoint& cut : system.cuts) // closed at any angle, or tied by their rates
      if (cut.by_rates)
        out.segment(system.nv + cut.first_row, static_cast<Eigen::Index>(cut.rows.size())).setZero();
    return out;
  }

  void turn(const Eigen::VectorXd& by) {
    for (std::size_t i = 0; i < links_.size(); ++i)
      p_.links[links_[i]].start =
          given_.parameters.links[links_[i]].start + by[static_cast<Eigen::Index>(i)] * units_[i];
  }

  // d/dx effect(at + x along, t + x later) at 0.
  Eigen::VectorXd slope(const Eigen::VectorXd& at, const Eigen::VectorXd& along, double later) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(given_.system.nv + given_.system.rows);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double x = difference * static_cast<double>(i + 1);
      out +=
          weights[i] / difference * (effect(at + x * along, x * later) - effect(at - x * along, -x * later));
    }
    return out;
  }

  // V and h.
  bool find_directions() {
    const auto m = static_cast<Eigen::Index>(links_.size());
    const Eigen::Index n = given_.system.nv + given_.system.rows;
    double fastest = 0;
    for (const DrivenCoordinate& d : given_.system.drives) {
      const auto l = static_cast<std::size_t>(d.link);
      if (!finds_speed(given_.system.links[l])) fastest = std::max(fastest, std::abs(p_.links[l].speed));
    }
    constexpr int places = 3; // of no particular angles
    Eigen::MatrixXd by_angles(places * n, m);
    Eigen::VectorXd by_drives = Eigen::VectorXd::Zero(places * n);
    const Eigen::VectorXd found = q_;
    const double later = fastest > 0 ? 1 / fastest : 0;
    for (int place = 0; place < places; ++place) {
      Eigen::VectorXd at(m);
      for (Eigen::Index i = 0; i < m; ++i)
        at[i] = 0.4 * place * std::sin(1.3 + 2.1 * static_cast<double>(i) + place);
      for (Eigen::Index i = 0; i < m; ++i)
        by_angles.block(place * n, i, n, 1) = slope(at, Eigen::VectorXd::Unit(m, i), 0);
      if (later > 0) { // with what is found at rest
        for (const std::size_t l : links_)
          q_[given_.system.links[l].q] = 0;
        by_drives.segment(place * n, n) = slope(at, Eigen::VectorXd::Zero(m), later) * fastest;
        q_ = found;
      }
    }
    turn(Eigen::VectorXd::Zero(m));
    if (!by_angles.allFinite() || !by_drives.allFinite()) return false;
    const auto parts = singular_vectors(by_angles);
    if (!parts || parts->values.size() == 0 || !(parts->values[0] > 0)) return false;
    Eigen::Index rank = 0;
    while (rank < parts->values.size() && parts->values[rank] > counts * parts->values[0])
      ++rank;
    directions_ = parts->right.leftCols(rank);
    const auto given = least_squares(by_angles * directions_, by_drives);
    if (!given) return false;
    drift_ = *given;
    return true;
  }

  // Newton-Raphson on forces and loops, from z. Unlike the balance elsewhere it knows what the multipliers of
  // loops that these angles close do to what turns.
  bool balance(Unknowns& z) {
    const System& system = given_.system;
    const Eigen::Index n = system.nv, rows = system.rows;
    const Eigen::VectorXd &column = given_.scaling.column, &row = given_.scaling.row;
    double last = 1;
    for (int i = 0; i < 60; ++i) {
      evaluate(problem_, z, 0, w_);
      history_.push_back(scaled_residual(problem_, w_));
      linearize(system, p_, z.q, z.lambda, w_.kinematics, w_.residual, linearization_);
      const Eigen::MatrixXd& of_balance = linearization_.constraint;
      matrix_.setZero(n + rows, n + rows);
      matrix_.topLeftCorner(n, n) = column.asDiagonal() * linearization_.stiffness * column.asDiagonal();
      if (rows > 0) {
        const Eigen::MatrixXd all = constraints_of_motion(system, p_, w_.kinematics, of_balance);
        matrix_.topRightCorner(n, rows) = column.asDiagonal() * all.transpose() * row.asDiagonal();
        matrix_.bottomLeftCorner(rows, n) = row.asDiagonal() * of_balance * column.asDiagonal();
      }
      Eigen::VectorXd left(n + rows);
      left << w_.residual.f.cwiseProduct(column), w_.residual.phi.cwiseProduct(row);
      if (!left.allFinite()) return false;
      const auto step = least_squares(matrix_, -left);
      if (!step || !step->allFinite()) return false;
      const double size = largest_size(step->head(n));
      const double part = std::min(1., 3 / std::max(size, 1e-300));
      const Eigen::VectorXd moved = part * step->head(n).cwiseProduct(column);
      retract<double>(system, moved, z.q);
      z.lambda += part * step->tail(rows).cwiseProduct(row);
      if (size < 1e-13 || (size < 1e-9 && size > 0.5 * last)) {
        evaluate(problem_, z, 0, w_);
        return scaled_residual(problem_, w_) < 1e-8 && same_assembly_mode(problem_, w_.kinematics);
      }
      last = size;
    }
    return false;
  }

  // V^T w + h, 1/s, at the balance where the angles are turned so far along V. Nothing where there is none.
  std::optional<Eigen::VectorXd> drift_at(const Eigen::VectorXd& along, Unknowns& z) {
    turn(directions_ * along);
    if (!balance(z)) return {};
    Eigen::VectorXd speeds(directions_.rows());
    for (std::size_t i = 0; i < links_.size(); ++i)
      speeds[static_cast<Eigen::Index>(i)] = z.q[given_.system.links[links_[i]].q] / units_[i];
    return directions_.transpose() * speeds + drift_;
  }

  // What the same balance is with the first of what turns where it was drawn: all may turn on together. Loops
  // that are tied by their rates stay closed as they are.
  void leave_first_as_drawn(const Eigen::VectorXd& along) {
    const bool tied = std::ranges::any_of(
        given_.system.cuts, [](const CutJoint& cut) { return cut.by_rates && cut.type != JointType::gear; });
    Eigen::VectorXd by = directions_ * along;
    const Eigen::VectorXd first = Eigen::VectorXd::Unit(by.size(), 0),
                          together = first - directions_ * (directions_.transpose() * first);
    if (!tied && together[0] > counts) by -= by[0] / together[0] * together;
    turn(by);
  }

  // What rounding of the terms makes of the state (rad, m, 1/s), by the matrix of the last balance().
  Eigen::VectorXd rounding() const {
    const Eigen::Index n = given_.system.nv;
    const auto inverse =
        least_squares_columns(matrix_, Eigen::MatrixXd(Eigen::MatrixXd::Identity(matrix_.rows(), n)));
    Eigen::VectorXd terms = w_.magnitudes.force.cwiseProduct(given_.scaling.column);
    Eigen::VectorXd out = Eigen::VectorXd::Constant(n, 1e-14);
    constexpr double each = 64 * std::numeric_limits<double>::epsilon();
    if (inverse) out += each * (inverse->topRows(n).cwiseAbs() * terms);
    return out.cwiseProduct(given_.scaling.column);
  }

  std::optional<TurnedState> solve_from(Eigen::VectorXd& along) {
    history_.clear();
    Unknowns z{q_, Eigen::VectorXd::Zero(given_.system.rows)};
    auto drift = drift_at(along, z);
    const Eigen::Index count = along.size();
    double last = 1;
    for (int i = 0; i < 60 && drift; ++i) {
      double size = 0;
      for (const std::size_t l : links_)
        size = std::max(size, std::abs(z.q[given_.system.links[l].q]));
      if (drift->norm() <= 1e-14 * size || (last < 1e-12 && drift->norm() <= 1e-10 * size)) {
        leave_first_as_drawn(along);
        if (!balance(z)) return {};
        TurnedState out;
        out.z = z;
        out.error = rounding();
        out.iterations = static_cast<int>(history_.size());
        out.history = history_;
        out.starts.resize(static_cast<Eigen::Index>(p_.links.size()));
        for (std::size_t l = 0; l < p_.links.size(); ++l)
          out.starts[static_cast<Eigen::Index>(l)] = p_.links[l].start;
        return out;
      }
      constexpr double beside = 1e-6;
      Eigen::MatrixXd jacobian(count, count);
      for (Eigen::Index k = 0; k < count; ++k) {
        Unknowns there = z;
        const auto moved = drift_at(along + beside * Eigen::VectorXd::Unit(count, k), there);
        if (!moved) return {};
        jacobian.col(k) = (*moved - *drift) / beside;
      }
      Lu lu;
      if (!lu.compute(jacobian)) return {};
      Eigen::VectorXd step = -lu.solve(*drift);
      constexpr double most = 0.5;
      if (step.norm() > most) step *= most / step.norm();
      last = step.norm();
      if (!std::isfinite(last)) return {};
      along += step;
      drift = drift_at(along, z);
    }
    return {};
  }

  // Whether something of which the angle counts stands still.
  bool rests(const Eigen::VectorXd& q) const {
    double fastest = 0;
    for (const DrivenCoordinate& d : given_.system.drives) {
      const auto l = static_cast<std::size_t>(d.link);
      fastest = std::max(fastest, std::abs(finds_speed(given_.system.links[l]) ? q[given_.system.links[l].q]
                                                                               : p_.links[l].speed));
    }
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (directions_.row(static_cast<Eigen::Index>(i)).norm() > counts &&
          !(std::abs(q[given_.system.links[links_[i]].q]) > 1e-6 * fastest))
        return true;
    return false;
  }

  const Problem& given_;
  Parameters p_;
  const Problem problem_;
  Eigen::VectorXd q_;
  Workspace& w_;
  std::vector<std::size_t> links_; // whose speeds are found
  std::vector<double> units_;      // of these: 1 rad, or the reach
  Eigen::MatrixXd directions_;     // V
  Eigen::VectorXd drift_;          // h, 1/s
  Linearization linearization_;
  Eigen::MatrixXd matrix_;      // of balance()
  std::vector<double> history_; // of solve_from()
};

} // namespace

std::vector<TurnedState> find_turned_states(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  const System& system = problem.system;
  const bool momenta = std::ranges::any_of(system.torques, &DriveTorqueElement::keeps_momentum);
  if (system.torques.empty() || momenta || system.nv > most_coordinates || problem.parameters.phase_free)
    return {};
  return PhaseSearch(problem, q, w).run();
}

} // namespace flyball
