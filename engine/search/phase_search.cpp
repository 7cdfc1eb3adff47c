#include "engine/search/phase_search.hpp"

#include "engine/kkt/configuration_difference.hpp"
#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/central_difference.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/search/most_turned.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/stability.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace flyball {
namespace {

constexpr double counts = 1e-6;     // of the largest effect of an angle
constexpr double first_drift = 0.2; // of the angles, in the first of slow steps

class PhaseSearch {
 public:
  PhaseSearch(const Problem& problem, const Eigen::VectorXd& q, Workspace& w)
      : given_(problem),
        p_(problem.parameters), problem_{problem.system, p_, problem.scaling, problem.cancel}, q_(q), w_(w) {
    for (std::size_t l = 0; l < problem.system.links.size(); ++l)
      if (finds_speed(problem.system.links[l])) links_.push_back(l);
    found_ = static_cast<Eigen::Index>(links_.size());
    for (const DrivenCoordinate& d : problem.system.drives)
      if (const auto l = static_cast<std::size_t>(d.link); !finds_speed(problem.system.links[l]))
        links_.push_back(l);
    for (const std::size_t l : links_)
      units_.push_back(problem.system.links[l].type == LinkType::revolute ? 1 : p_.length);
  }

  // Until one is `enough`, which is asked of each.
  void run(const std::function<bool(const TurnedState&)>& enough) {
    if (!find_directions()) return;
    const Eigen::Index count = directions_.cols();
    std::vector<TurnedState> found;
    const auto take = [&](Eigen::VectorXd along, Way way) { // whether to go on
      interruption_point();
      auto state = solve_from(along, way);
      if (!state || rests(state->z.q) ||
          std::ranges::any_of(found, [&](const TurnedState& other) { return same(other, *state); }))
        return true;
      found.push_back(std::move(*state));
      return !enough(found.back());
    };
    const Eigen::VectorXd drawn = Eigen::VectorXd::Zero(count);
    if (!take(drawn, Way::slowly) || !take(drawn, Way::together)) return;
    for (const double begin : {0., 0.15, -0.15, 0.5, -0.5, 1.2, -1.2, 2.1, -2.1, 3., 1.7})
      if (!take(begin * scattered(count, 7 * begin), Way::at_once)) return;
    // What is not stable is left, to either side.
    constexpr double beside = 0.05;
    for (std::size_t i = 0, first = found.size(); i < first; ++i)
      for (const double side : {beside, -beside})
        if (!take(along_of(found[i]) + side * scattered(count, 1), Way::slowly)) return;
  }

  std::optional<AngleTies> find_ties() {
    if (!find_directions()) return {};
    return ties();
  }

  std::optional<TurnedState> run_beside(const TurnedState& other) {
    if (!find_directions()) return {};
    Eigen::VectorXd along = along_of(other);
    auto found = solve_from(along, Way::together);
    if (!found || rests(found->z.q)) return {};
    return found;
  }

 private:
  // How the angles are found: by Newton-Raphson, together with the balance first or not, or as they drift
  // (pseudo-transient continuation: Kelley and Keyes 1998), which leads to stable ones.
  enum class Way { together, at_once, slowly };

  // Of no particular direction, the first entry 1.
  static Eigen::VectorXd scattered(Eigen::Index count, double seed) {
    Eigen::VectorXd out = Eigen::VectorXd::Ones(count);
    for (Eigen::Index i = 1; i < count; ++i)
      out[i] = 1.2 * std::sin(0.6 + 1.9 * static_cast<double>(i) + seed);
    return out;
  }

  Eigen::VectorXd along_of(const TurnedState& state) const {
    Eigen::VectorXd by(found_);
    for (Eigen::Index i = 0; i < found_; ++i) {
      const std::size_t l = links_[static_cast<std::size_t>(i)];
      by[i] = (state.starts[static_cast<Eigen::Index>(l)] - given_.parameters.links[l].start) /
              units_[static_cast<std::size_t>(i)];
    }
    return directions_.transpose() * by;
  }

  // But for whole turns of what turns.
  bool same(const TurnedState& a, const TurnedState& b) const {
    constexpr double near = 1e-6, turn = 2 * std::numbers::pi;
    for (Eigen::Index i = 0; i < found_; ++i) {
      const std::size_t l = links_[static_cast<std::size_t>(i)];
      double by = (b.starts - a.starts)[static_cast<Eigen::Index>(l)] / units_[static_cast<std::size_t>(i)];
      if (given_.system.links[l].type == LinkType::revolute) by -= turn * std::round(by / turn);
      if (std::abs(by) > near) return false;
    }
    return scaled_difference(problem_, a.z.q, b.z.q).lpNorm<Eigen::Infinity>() < near;
  }

  // Forces and open loops with all that is driven `by` further on, with these multipliers.
  Eigen::VectorXd effect(const Eigen::VectorXd& by, const Eigen::VectorXd& lambda) {
    turn(by);
    const System& system = given_.system;
    forward<double>(system, p_, q_, 0, w_.kinematics);
    evaluate_residual<double>(system, p_, q_, lambda, w_.kinematics, w_.residual);
    Eigen::VectorXd out(system.nv + system.rows);
    out << w_.residual.f.cwiseProduct(given_.scaling.column),
        w_.residual.phi.cwiseProduct(given_.scaling.row);
    for (const CutJoint& cut : system.cuts) // see closed_angles()
      if (cut.by_rates)
        out.segment(system.nv + cut.first_row, static_cast<Eigen::Index>(cut.rows.size())).setZero();
    return out;
  }

  // The first of links_ alone where `by` has no more.
  void turn(const Eigen::VectorXd& by) {
    for (Eigen::Index i = 0; i < by.size(); ++i) {
      const std::size_t l = links_[static_cast<std::size_t>(i)];
      p_.links[l].start = given_.parameters.links[l].start + by[i] * units_[static_cast<std::size_t>(i)];
    }
  }

  // d/dx effect(at + x along) at 0.
  Eigen::VectorXd slope(const Eigen::VectorXd& at, const Eigen::VectorXd& along,
                        const Eigen::VectorXd& lambda) {
    return central_difference([&](double x) { return effect(at + x * along, lambda); });
  }

  // Along which gears and loops that are tied by their rates stay closed, too: orthonormal, by column.
  std::optional<Eigen::MatrixXd> closed_angles() {
    const System& system = given_.system;
    turn(Eigen::VectorXd::Zero(found_));
    forward<double>(system, p_, q_, 0, w_.kinematics);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(system.rows, found_);
    for (std::size_t c = 0; c < system.cuts.size(); ++c) {
      const CutJoint& cut = system.cuts[c];
      for (std::size_t r = 0; r < cut.rows.size() && cut.by_rates; ++r)
        row_gradient(cut, p_.cuts[c], cut.rows[r], w_.kinematics, [&](int v, double g) {
          for (Eigen::Index i = 0; i < found_; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const Eigen::Index row = cut.first_row + static_cast<Eigen::Index>(r);
            if (system.links[links_[k]].v == v) rows(row, i) += g * given_.scaling.row[row] * units_[k];
          }
        });
    }
    SymmetricEigen squares; // of what opens them
    if (!rows.allFinite() || !squares.compute(rows.transpose() * rows)) return {};
    constexpr double opens = 1e-12;
    Eigen::Index closed = 0;
    while (closed < found_ && squares.values()[closed] <= opens * squares.values()[found_ - 1])
      ++closed;
    return Eigen::MatrixXd(squares.vectors().leftCols(rows.isZero(0) ? found_ : closed));
  }

  // V, M and h.
  bool find_directions() {
    const auto m = static_cast<Eigen::Index>(links_.size());
    const Eigen::Index n = given_.system.nv + given_.system.rows;
    constexpr int places = 3; // of no particular angles
    Eigen::MatrixXd by_angles(places * n, m);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(given_.system.rows);
    for (int place = 0; place < places; ++place) {
      Eigen::VectorXd at = Eigen::VectorXd::Zero(m);
      for (Eigen::Index i = 0; i < found_; ++i)
        at[i] = 0.4 * place * std::sin(1.3 + 2.1 * static_cast<double>(i) + place);
      for (Eigen::Index i = 0; i < m; ++i)
        by_angles.block(place * n, i, n, 1) = slope(at, Eigen::VectorXd::Unit(m, i), none);
    }
    turn(Eigen::VectorXd::Zero(m));
    if (!by_angles.allFinite()) return false;
    const auto closed = closed_angles();
    if (!closed || closed->cols() == 0) return false;
    closed_ = *closed;
    const Eigen::MatrixXd by_found = by_angles.leftCols(found_);
    const auto parts = singular_vectors(by_found * closed_);
    if (!parts || parts->values.size() == 0 || !(parts->values[0] > 0)) return false;
    Eigen::Index rank = 0;
    while (rank < parts->values.size() && parts->values[rank] > counts * parts->values[0])
      ++rank;
    directions_ = closed_ * parts->right.leftCols(rank);
    const auto rates = least_squares_columns(by_found * directions_, by_angles);
    if (!rates) return false;
    of_found_ = rates->leftCols(found_);
    of_given_ = rates->rightCols(m - found_).transpose();
    drift_ = Eigen::VectorXd::Zero(rank);
    for (Eigen::Index i = found_; i < m; ++i) {
      const auto k = static_cast<std::size_t>(i);
      drift_ += of_given_.row(i - found_).transpose() * p_.links[links_[k]].speed / units_[k];
    }
    return true;
  }

  AngleTies ties() const {
    AngleTies out;
    for (std::size_t i = 0; i < links_.size(); ++i)
      (static_cast<Eigen::Index>(i) < found_ ? out.found : out.given).push_back(static_cast<int>(links_[i]));
    const Eigen::VectorXd per_unit =
        Eigen::Map<const Eigen::VectorXd>(units_.data(), static_cast<Eigen::Index>(units_.size()))
            .cwiseInverse();
    out.along = per_unit.head(found_).cwiseInverse().asDiagonal() * directions_;
    out.of_found = per_unit.head(found_).asDiagonal() * of_found_.transpose();
    out.of_given = per_unit.tail(per_unit.size() - found_).asDiagonal() * of_given_;
    return out;
  }

  // Of forces and loops by coordinates and multipliers, scaled, at what is evaluated. Unlike the balance
  // elsewhere it knows what the multipliers of loops that these angles close do to what turns.
  void assemble(const Unknowns& z) {
    const System& system = given_.system;
    const Eigen::Index n = system.nv, rows = system.rows;
    const Eigen::VectorXd &column = given_.scaling.column, &row = given_.scaling.row;
    linearize(system, p_, z.q, z.lambda, w_.kinematics, w_.residual, linearization_);
    const Eigen::MatrixXd& of_balance = linearization_.constraint;
    matrix_.setZero(n + rows, n + rows);
    matrix_.topLeftCorner(n, n) = column.asDiagonal() * linearization_.stiffness * column.asDiagonal();
    if (rows == 0) return;
    const Eigen::MatrixXd all = constraints_of_motion(system, p_, w_.kinematics, of_balance);
    matrix_.topRightCorner(n, rows) = column.asDiagonal() * all.transpose() * row.asDiagonal();
    matrix_.bottomLeftCorner(rows, n) = row.asDiagonal() * of_balance * column.asDiagonal();
  }

  Eigen::VectorXd left_of_balance() const {
    Eigen::VectorXd left(given_.system.nv + given_.system.rows);
    left << w_.residual.f.cwiseProduct(given_.scaling.column),
        w_.residual.phi.cwiseProduct(given_.scaling.row);
    return left;
  }

  // Newton-Raphson on angles and balance at once, with speeds that are tied from the beginning on: untied
  // ones may be of no balance. Whether it comes near a solution.
  bool approach(Eigen::VectorXd& along, Unknowns& z) {
    const Eigen::Index n = given_.system.nv, rows = given_.system.rows, count = along.size();
    Eigen::MatrixXd by_speeds = Eigen::MatrixXd::Zero(count, n + rows);
    double fastest = 0;
    for (Eigen::Index i = 0; i < found_; ++i) {
      const int v = given_.system.links[links_[static_cast<std::size_t>(i)]].v;
      by_speeds.col(v) = of_found_.col(i) * given_.scaling.column[v] / units_[static_cast<std::size_t>(i)];
      fastest = std::max(fastest, std::abs(speed(i, z.q)));
    }
    if (!(fastest > 0)) return false;
    const Eigen::VectorXd apart = directions_ * drift_of(z.q);
    for (Eigen::Index i = 0; i < found_; ++i)
      z.q[given_.system.links[links_[static_cast<std::size_t>(i)]].q] -=
          apart[i] * units_[static_cast<std::size_t>(i)];
    constexpr int most_steps = 60;
    constexpr double longest = 1, longest_turn = 0.5, near = 1e-8; // scaled; rad
    for (int i = 0; i < most_steps && spent_ < most_iterations(); ++i) {
      turn(directions_ * along);
      evaluate(problem_, z, 0, w_);
      history_.push_back(scaled_residual(problem_, w_));
      ++spent_;
      assemble(z);
      const Eigen::VectorXd left = left_of_balance();
      Eigen::MatrixXd all(n + rows + count, n + rows + count);
      all.setZero();
      all.topLeftCorner(n + rows, n + rows) = matrix_;
      all.bottomLeftCorner(count, n + rows) = by_speeds / fastest;
      const Eigen::VectorXd q = std::exchange(q_, z.q);
      for (Eigen::Index k = 0; k < count; ++k)
        all.col(n + rows + k).head(n + rows) = slope(directions_ * along, directions_.col(k), z.lambda);
      q_ = q;
      Eigen::VectorXd rhs(n + rows + count);
      rhs << -left, -drift_of(z.q) / fastest;
      if (!all.allFinite() || !rhs.allFinite()) return false;
      const auto step = least_squares(all, rhs);
      if (!step || !step->allFinite()) return false;
      const double size = largest_size(step->head(n)), turned = largest_size(step->tail(count));
      const double part = std::min({1., longest / std::max(way_of(step->head(n), z.q), 1e-300),
                                    longest_turn / std::max(turned, 1e-300)});
      const Eigen::VectorXd moved = part * step->head(n).cwiseProduct(given_.scaling.column);
      retract<double>(given_.system, moved, z.q);
      z.lambda += part * step->segment(n, rows).cwiseProduct(given_.scaling.row);
      along += part * step->tail(count);
      if (std::max(size, turned) < near) return true;
    }
    return false;
  }

  // Newton-Raphson on forces and loops, from z.
  bool balance(Unknowns& z) {
    const System& system = given_.system;
    const Eigen::Index n = system.nv, rows = system.rows;
    const Eigen::VectorXd &column = given_.scaling.column, &row = given_.scaling.row;
    double last = 1;
    for (int i = 0; i < 60; ++i) {
      evaluate(problem_, z, 0, w_);
      history_.push_back(scaled_residual(problem_, w_));
      ++spent_;
      assemble(z);
      const Eigen::VectorXd left = left_of_balance();
      if (!left.allFinite()) return false;
      const auto step = least_squares(matrix_, -left);
      if (!step || !step->allFinite()) return false;
      const double size = largest_size(step->head(n));
      const double part = std::min(1., 3 / std::max(way_of(step->head(n), z.q), 1e-300));
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

  // Of a scaled step of q; of a speed that has grown beyond its scale as a share of that.
  double way_of(const Eigen::VectorXd& step, const Eigen::VectorXd& q) const {
    double out = 0;
    for (const Link& link : given_.system.links)
      for (int v = link.v; link.v >= 0 && v < link.v + (link.type == LinkType::spherical ? 3 : 1); ++v) {
        const double grown = finds_speed(link) ? std::abs(q[link.q]) / given_.scaling.column[v] : 0;
        out = std::max(out, std::abs(step[v]) / std::max(1., grown));
      }
    return out;
  }

  // M w + h, 1/s.
  Eigen::VectorXd drift_of(const Eigen::VectorXd& q) const { return of_found_ * speeds_of(q) + drift_; }

  // At the balance where the angles are turned so far along V. Nothing where there is none.
  std::optional<Eigen::VectorXd> drift_at(const Eigen::VectorXd& along, Unknowns& z) {
    turn(directions_ * along);
    if (!balance(z)) return {};
    return drift_of(z.q);
  }

  // That are found, over their units.
  Eigen::VectorXd speeds_of(const Eigen::VectorXd& q) const {
    Eigen::VectorXd out(found_);
    for (Eigen::Index i = 0; i < found_; ++i)
      out[i] = speed(i, q);
    return out;
  }

  // That is found, over its unit: 1/s.
  double speed(Eigen::Index i, const Eigen::VectorXd& q) const {
    const auto k = static_cast<std::size_t>(i);
    return q[given_.system.links[links_[k]].q] / units_[k];
  }

  // What the same balance is with the first of what turns where it was drawn: all may turn on together. Loops
  // that are tied by their rates stay closed as they are.
  void leave_first_as_drawn(const Eigen::VectorXd& along) {
    const bool tied = std::ranges::any_of(
        given_.system.cuts, [](const CutJoint& cut) { return cut.by_rates && cut.type != JointType::gear; });
    Eigen::VectorXd by = directions_ * along;
    const Eigen::VectorXd first = Eigen::VectorXd::Unit(by.size(), 0),
                          together = closed_ * (closed_.transpose() * first) -
                                     directions_ * (directions_.transpose() * first);
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

  std::optional<TurnedState> solve_from(Eigen::VectorXd& along, Way way) {
    history_.clear();
    Unknowns z{q_, Eigen::VectorXd::Zero(given_.system.rows)};
    if (way == Way::together && !approach(along, z)) return {};
    auto drift = drift_at(along, z);
    const Eigen::Index count = along.size();
    constexpr double longest = 0.5; // rad, of a step
    double last = 1, most = longest;
    double time = drift ? first_drift / drift->norm() : 0; // s, of a step
    const int most_steps = way == Way::slowly ? 120 : 60;
    for (int i = 0; i < most_steps && drift && spent_ < most_iterations(); ++i) {
      double size = 0;
      for (Eigen::Index k = 0; k < found_; ++k)
        size = std::max(size, std::abs(speed(k, z.q)));
      if (drift->norm() <= 1e-14 * size || (last < 1e-12 && drift->norm() <= 1e-10 * size)) {
        leave_first_as_drawn(along);
        if (!balance(z)) return {};
        TurnedState out;
        out.z = z;
        out.ties = ties();
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
      if (way == Way::slowly) jacobian.diagonal().array() -= 1 / time;
      Lu lu;
      if (!lu.compute(jacobian)) return {};
      Eigen::VectorXd step = -lu.solve(*drift);
      const bool cut = step.norm() > most;
      if (cut) step *= most / step.norm();
      last = step.norm();
      if (!std::isfinite(last)) return {};
      const Eigen::VectorXd from = along;
      const Unknowns at = z;
      const Eigen::VectorXd before = *drift;
      constexpr int most_halvings = 3; // where a step leads to no balance
      for (int k = 0; k <= most_halvings; ++k) {
        along = from + step;
        drift = drift_at(along, z);
        if (drift) break;
        z = at;
        step /= 2;
        time /= 2;
      }
      if (!drift) continue;
      time *= std::clamp(before.norm() / drift->norm(), 0.5, 10.);
      // Beyond a stop they drift back: between such places a step must not be as long as from one to the
      // other.
      most = cut && drift->dot(before) < 0 ? most / 2 : std::min(1.5 * most, longest);
    }
    return {};
  }

  // Of Newton-Raphson on the balance, in all: so many that a refusal takes a few seconds.
  int most_iterations() const {
    const double n = given_.system.nv + given_.system.rows;
    return static_cast<int>(std::clamp(2.5e8 / (n * n * n), 100., 6000.));
  }

  // Whether something of which the angle counts stands still.
  bool rests(const Eigen::VectorXd& q) const {
    double fastest = 0;
    for (Eigen::Index i = 0; i < found_; ++i)
      fastest = std::max(fastest, std::abs(speed(i, q)));
    for (std::size_t k = static_cast<std::size_t>(found_); k < links_.size(); ++k)
      fastest = std::max(fastest, std::abs(p_.links[links_[k]].speed) / units_[k]);
    for (Eigen::Index i = 0; i < found_; ++i)
      if (directions_.row(i).norm() > counts && !(std::abs(speed(i, q)) > 1e-6 * fastest)) return true;
    return false;
  }

  const Problem& given_;
  Parameters p_;
  const Problem problem_;
  Eigen::VectorXd q_;
  Workspace& w_;
  std::vector<std::size_t> links_; // that are driven: first those whose speeds are found
  Eigen::Index found_ = 0;         // how many these are
  std::vector<double> units_;      // of links_: 1 rad, or the reach
  Eigen::MatrixXd closed_;         // angles along which what is tied by rates stays closed
  Eigen::MatrixXd directions_;     // V, among these
  Eigen::MatrixXd of_found_;       // M, by speeds over their units
  Eigen::MatrixXd of_given_;       // h by the speeds of the others, over their units
  Eigen::VectorXd drift_;          // h, 1/s
  Linearization linearization_;
  Eigen::MatrixXd matrix_;      // of balance()
  std::vector<double> history_; // of solve_from()
  int spent_ = 0;               // iterations, see most_iterations()
};

bool may_stand_turned(const Problem& problem) {
  const System& system = problem.system;
  const bool momenta = std::ranges::any_of(system.torques, &DriveTorqueElement::keeps_momentum);
  return !system.torques.empty() && !momenta && system.nv <= most_turned_coordinates &&
         !problem.parameters.phase_free;
}

} // namespace

Parameters at_angles_of(const Parameters& drawn, const TurnedState& state) {
  Parameters out = drawn;
  for (std::size_t l = 0; l < out.links.size(); ++l)
    out.links[l].start = state.starts[static_cast<Eigen::Index>(l)];
  return out;
}

std::optional<AngleTies> find_angle_ties(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  if (!may_stand_turned(problem)) return {};
  return PhaseSearch(problem, q, w).find_ties();
}

bool tie_alike(const AngleTies& a, const AngleTies& b) {
  if (a.found != b.found || a.given != b.given || a.along.cols() != b.along.cols()) return false;
  constexpr double alike = 1e-7;
  // Whatever basis V is.
  const auto differ = [](const AngleTies& x, const AngleTies& y, const auto& of) {
    const Eigen::MatrixXd first = of(x), second = of(y);
    return !((first - second).norm() <= alike * (1 + first.norm()));
  };
  return !differ(a, b, [](const AngleTies& t) {
    return Eigen::MatrixXd(t.along * t.of_found.transpose());
  }) && !differ(a, b, [](const AngleTies& t) { return Eigen::MatrixXd(t.along * t.of_given.transpose()); });
}

Eigen::VectorXd angles_between(const Problem& problem, const AngleTies& ties, const Eigen::VectorXd& from,
                               const Eigen::VectorXd& to) {
  constexpr double turn = 2 * std::numbers::pi;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(ties.along.cols());
  for (std::size_t i = 0; i < ties.found.size(); ++i) {
    const bool turns =
        problem.system.links[static_cast<std::size_t>(ties.found[i])].type == LinkType::revolute;
    const double unit = turns ? 1 : problem.parameters.length;
    double by = (to - from)[ties.found[i]] / unit;
    if (turns) by -= turn * std::round(by / turn);
    out += ties.along.row(static_cast<Eigen::Index>(i)).transpose() / unit * by;
  }
  return out;
}

void turn_along(const AngleTies& ties, const Eigen::VectorXd& step, Eigen::VectorXd& starts) {
  const Eigen::VectorXd by = ties.along * step;
  for (std::size_t i = 0; i < ties.found.size(); ++i)
    starts[ties.found[i]] += by[static_cast<Eigen::Index>(i)];
}

std::optional<TurnedState> find_turned_state(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  if (!may_stand_turned(problem)) return {};
  std::optional<TurnedState> out;
  Workspace elsewhere;
  PhaseSearch(problem, q, w).run([&](const TurnedState& state) {
    const Parameters turned = at_angles_of(problem.parameters, state);
    const Problem there{problem.system, turned, problem.scaling, problem.cancel};
    if (!check_existence(there, state.z.q, sample_phases(problem.system, turned, state.z.q), elsewhere).holds)
      return false;
    const bool stable = find_stability(factor_at(there, state.z, elsewhere), false).stable == true;
    if (stable || !out) out = state;
    return stable;
  });
  return out;
}

std::optional<TurnedState> find_turned_state_beside(const Problem& problem, const TurnedState& other,
                                                    Workspace& w) {
  if (!may_stand_turned(problem)) return {};
  return PhaseSearch(problem, other.z.q, w).run_beside(other);
}

} // namespace flyball
