#include "engine/solve/unbounded.hpp"

#include "engine/solve/eigenvector_descent.hpp"
#include "engine/system/linearization.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int largest_searched = 2000;  // coordinates, each looked at by itself
constexpr int largest_with_loops = 200; // the constraints are then written as a dense matrix
constexpr double far = 1000;            // reaches, or radians
constexpr double rounding = 1e-9;       // of the terms that a force is the sum of

class Search {
 public:
  Search(const Problem& problem, const Eigen::VectorXd& start, Workspace& w)
      : p_(problem), start_(start), w_(w) {}

  Unbounded run() {
    if (p_.system.nv == 0 || !assemble(p_, start_, 0, w_)) return {};
    along_coordinates();
    if (pushed_.empty() && has_descent(p_)) downhill();
    Unbounded out;
    if (pushed_.empty() || p_.cancelled()) return out;
    blame(out);
    name(out);
    return out;
  }

 private:
  struct Pushed {
    int v;        // coordinate of q_R
    double force; // generalised (N or N m), positive along the coordinate
  };

  // The balance without multipliers, d potential / d q, where the coordinate is `by` further on.
  double slope(int v, double by) {
    moved_ = start_;
    w_.step.setZero(p_.system.nv);
    w_.step[v] = by;
    retract<double>(p_.system, w_.step, moved_);
    evaluate(p_, {moved_, Eigen::VectorXd::Zero(p_.system.rows)}, 0, w_);
    return w_.residual.f[v];
  }

  // Whether what pushes along the coordinate at the start goes on pushing wherever it leads.
  bool goes_on(const Link& link, double first) {
    const double way = first > 0 ? -1 : 1; // downhill
    const auto pushes = [&](double by, double part) {
      const double there = slope(link.v, by) * -way;
      return std::isfinite(there) && there >= part * std::abs(first);
    };
    if (link.type == LinkType::prismatic) {
      const double reach = p_.scaling.column[link.v];
      return std::ranges::all_of(std::array{far, 1.0, 30.0},
                                 [&](double s) { return pushes(way * s * reach, 1 - 1e-6); });
    }
    // A weight pulls back half a turn on; what pushes all round, and after many turns, pushes on.
    constexpr int parts = 24;
    if (!pushes(pi, 1e-3) || !pushes(way * far * 2 * pi, 1 - 1e-6)) return false;
    for (int i = 1; i < parts; ++i)
      if (!pushes(2 * pi * i / parts, 1e-3)) return false;
    return true;
  }

  void along_coordinates() {
    const System& system = p_.system;
    if (system.nv > largest_searched || (system.rows > 0 && system.nv > largest_with_loops)) return;
    evaluate(p_, {start_, Eigen::VectorXd::Zero(system.rows)}, 0, w_);
    const Eigen::VectorXd slopes = w_.residual.f, sizes = w_.magnitudes.force;
    Eigen::MatrixXd loops;
    if (system.rows > 0) {
      linearize_constraints(system, p_.parameters, w_.kinematics, w_.dense.linearization);
      loops = w_.dense.linearization.constraint;
    }
    for (const Link& link : system.links) {
      if (p_.cancelled()) return;
      const bool scalar = link.type == LinkType::revolute || link.type == LinkType::prismatic;
      if (link.v < 0 || !scalar) continue;
      const double first = slopes[link.v];
      if (!(std::abs(first) > rounding * sizes[link.v])) continue;
      if (loops.size() > 0 && loops.col(link.v).cwiseAbs().maxCoeff() > 0) continue; // part of a loop
      if (goes_on(link, first)) pushed_.push_back({link.v, -first});
    }
    direction_.setZero(system.nv);
    for (const Pushed& p : pushed_)
      direction_[p.v] = std::copysign(p_.scaling.column[p.v], p.force);
  }

  // A descent without a bottom shows by what has moved.
  void downhill() {
    Unknowns z{start_, Eigen::VectorXd::Zero(p_.system.rows)};
    DescentOutcome descent = descend(p_, z, w_, nullptr, true, false);
    if (descent.end != DescentEnd::unbounded && p_.form == KktForm::dense && !p_.cancelled()) {
      z = {start_, Eigen::VectorXd::Zero(p_.system.rows)};
      descent = descend_by_eigenvectors(p_, z, w_, nullptr);
    }
    if (descent.end != DescentEnd::unbounded || !z.q.allFinite()) return;
    end_ = z.q;
    direction_.setZero(p_.system.nv);
    for (const Link& link : p_.system.links)
      if (link.v >= 0 && link.type != LinkType::spherical) direction_[link.v] = z.q[link.q] - start_[link.q];
    const Eigen::VectorXd scaled = direction_.cwiseQuotient(p_.scaling.column);
    const double most = scaled.lpNorm<Eigen::Infinity>();
    constexpr double a_long_way = 10; // reaches, or radians
    if (!(most > a_long_way)) return;
    fell_ = true;
    const double whole = push(p_);
    for (const Link& link : p_.system.links)
      if (link.v >= 0 && std::abs(scaled[link.v]) > 0.1 * most)
        pushed_.push_back({link.v, -whole / direction_[link.v]});
  }

  double potential_at(const Problem& problem, const Eigen::VectorXd& q) {
    forward<double>(problem.system, problem.parameters, q, 0, w_.kinematics);
    return amended_potential(problem.system, problem.parameters, q, w_.kinematics).value;
  }

  // Work against the forces (J) in the direction that was found, negative where they push on: over the whole
  // way of a descent, else over one scaled unit at the start.
  double push(const Problem& problem) {
    if (fell_) return potential_at(problem, end_) - potential_at(problem, start_);
    evaluate(problem, {start_, Eigen::VectorXd::Zero(problem.system.rows)}, 0, w_);
    return w_.residual.f.dot(direction_);
  }

  // Which of the forces it takes.
  void blame(Unbounded& out) {
    const double whole = push(p_);
    const auto without = [&](const auto& change) {
      Parameters parameters = p_.parameters;
      change(parameters);
      const double rest = push({p_.system, parameters, p_.scaling, p_.cancel, p_.form});
      return rest >= 1e-6 * whole; // `whole` is negative
    };
    out.by_weight = p_.parameters.gravity.norm() > 0 && without([](Parameters& p) { p.gravity.setZero(); });
    out.by_inertia = p_.parameters.moving && without([](Parameters& p) { p.moving = false; });
  }

  void name(Unbounded& out) const {
    for (const CoordinateInfo& info : p_.system.coordinates) {
      const Link& link = p_.system.links[static_cast<std::size_t>(info.link)];
      const auto pushed = std::ranges::find(pushed_, link.v, &Pushed::v);
      if (link.v < 0 || link.type == LinkType::spherical || pushed == pushed_.end()) continue;
      const TreeJoint& joint = p_.system.tree_joints[static_cast<std::size_t>(info.tree_joint)];
      out.coordinates.push_back(
          {joint.name, info.index, coordinate_count(joint.type), info.angle, pushed->force});
    }
  }

  const Problem& p_;
  Eigen::VectorXd start_;
  Workspace& w_;
  std::vector<Pushed> pushed_;
  Eigen::VectorXd moved_, end_, direction_; // direction_: rad or m, by coordinate of q_R
  bool fell_ = false;                       // from start_ to end_ in a descent
};

std::string names_of(const Unbounded& found) {
  constexpr std::size_t most = 5;
  std::vector<std::string> names;
  for (const UnheldCoordinate& c : found.coordinates)
    if (std::ranges::find(names, c.joint) == names.end()) names.push_back(c.joint);
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

} // namespace

Unbounded find_unbounded(const Problem& problem, const Eigen::VectorXd& start, Workspace& w) {
  return Search(problem, start, w).run();
}

void explain_unbounded(const Problem& problem, const Eigen::VectorXd& start, Workspace& w, Solution& out) {
  const bool unstable = out.status == Status::converged && out.stable == false;
  if ((out.status != Status::not_converged && !unstable) || problem.cancelled()) return;
  const Unbounded found = find_unbounded(problem, start, w);
  if (found.coordinates.empty() || problem.cancelled()) return;
  out.unheld = found.coordinates;
  out.unheld_by_weight = found.by_weight;
  const bool one = found.coordinates.size() == 1;
  const std::string words =
      "Nothing holds " + names_of(found) + " against " +
      (found.by_weight    ? "the weight"
       : found.by_inertia ? "the centrifugal force"
                          : "the forces on it") +
      ": " + (one ? "it goes" : "they go") + " on without end" +
      (unstable ? " from the drawn pose. " : ", so there is no steady state to find. ") +
      (one ? "It needs a spring or a stop" : "They need springs or stops") +
      (found.by_weight ? ", or no gravity." : ".");
  out.message = unstable ? out.message + " " + words : words;
}

bool weight_turns(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  if (!(problem.parameters.gravity.norm() > 0)) return false;
  Parameters weightless = problem.parameters;
  weightless.gravity.setZero();
  // How much the balance on the closed loops changes from the drawn phase.
  const auto change = [&](const Parameters& parameters) {
    const Problem part{problem.system, parameters, problem.scaling, problem.cancel, problem.form};
    Eigen::VectorXd f[2];
    for (const int i : {0, 1}) {
      evaluate(part, {q, Eigen::VectorXd::Zero(problem.system.rows)}, i == 0 ? 0 : t, w);
      factor_constraints(part, w);
      w.scaled_force = w.residual.f.cwiseProduct(problem.scaling.column);
      w.kkt(part).project(w.scaled_force, f[i]);
    }
    return (f[1] - f[0]).norm();
  };
  const double whole = change(problem.parameters);
  return std::isfinite(whole) && change(weightless) <= 1e-6 * whole;
}

} // namespace flyball
