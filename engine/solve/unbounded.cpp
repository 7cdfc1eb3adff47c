#include "engine/solve/unbounded.hpp"

#include "engine/solve/eigenvector_descent.hpp"
#include "engine/solve/existence.hpp"
#include "engine/system/linearization.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int largest_searched = 2000;  // coordinates, each looked at by itself
constexpr int largest_with_loops = 200; // the constraints are then written as a dense matrix
constexpr double far = 1000;            // reaches, or radians

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
    if (out.by_inertia) soften(out);
    out.for_a_moment = turns_with_drives();
    return out;
  }

 private:
  struct Pushed {
    int v;        // coordinate of q_R
    double force; // generalised (N or N m), positive along the coordinate
  };

  // The balance without multipliers, d potential / d q, where the coordinate is `by` further on, at the time
  // `t` (s) along the drives.
  double slope(int v, double by, double t = 0) {
    moved_ = start_;
    w_.step.setZero(p_.system.nv);
    w_.step[v] = by;
    retract<double>(p_.system, w_.step, moved_);
    evaluate(p_, {moved_, Eigen::VectorXd::Zero(p_.system.rows)}, t, w_);
    return w_.residual.f[v];
  }

  // Whether what pushes along the coordinate at the start goes on pushing wherever it leads.
  bool goes_on(const Link& link, double first) {
    const double downhill = first > 0 ? -1 : 1;
    const auto pushes = [&](double by, double part) {
      const double there = slope(link.v, by) * -downhill;
      return std::isfinite(there) && there >= part * std::abs(first);
    };
    if (link.type == LinkType::prismatic) {
      const double reach = p_.scaling.column[link.v];
      return std::ranges::all_of(std::array{far, 1.0, 30.0}, [&](double s) {
        return pushes(downhill * s * reach, 1 - tolerance::constant_push);
      });
    }
    // A weight pulls back half a turn on; what pushes all round, and after many turns, pushes on.
    constexpr int parts = 24;
    if (!pushes(pi, tolerance::remaining_push) ||
        !pushes(downhill * far * 2 * pi, 1 - tolerance::constant_push))
      return false;
    for (int i = 1; i < parts; ++i)
      if (!pushes(2 * pi * i / parts, tolerance::remaining_push)) return false;
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
      if (link.v < 0 || link.drive >= 0 || !scalar) continue;
      const double first = slopes[link.v];
      if (!(std::abs(first) > tolerance::push_rounding * sizes[link.v])) continue;
      if (loops.size() > 0 && loops.col(link.v).cwiseAbs().maxCoeff() > 0) continue; // part of a loop
      if (goes_on(link, first)) pushed_.push_back({link.v, -first});
    }
    direction_.setZero(system.nv);
    for (const Pushed& p : pushed_)
      direction_[p.v] = std::copysign(p_.scaling.column[p.v], p.force);
  }

  // Whether what pushes at the start does not, or the other way, at another phase of the drives.
  bool turns_with_drives() {
    const std::vector<double> phases = sample_phases(p_.system, p_.parameters, start_);
    return std::ranges::any_of(pushed_, [&](const Pushed& pushed) {
      const double first = slope(pushed.v, 0);
      return std::ranges::any_of(phases, [&](double t) { return !(slope(pushed.v, 0, t) * first > 0); });
    });
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
      return rest >= tolerance::constant_push * whole; // `whole` is negative
    };
    out.by_weight = p_.parameters.gravity.norm() > 0 && without([](Parameters& p) { p.gravity.setZero(); });
    // Drag and dampers push by speeds, too: what is left without masses is not inertia's.
    out.by_inertia = p_.parameters.moving && without([](Parameters& p) { p.moving = false; }) &&
                     without([](Parameters& p) {
                       for (LinkParameters& link : p.links) {
                         link.mass = 0;
                         link.inertia.setZero();
                       }
                     });
  }

  void soften(Unbounded& out) {
    constexpr double little = 0.01;    // reaches
    constexpr double by_little = 1e-4; // of the centrifugal force: a spring as little stiffer may be no help
    Parameters still = p_.parameters;
    still.moving = false;
    const auto stiffness = [&](const Parameters& parameters, int v) {
      const double by = little * p_.scaling.column[v];
      const Problem problem{p_.system, parameters, p_.scaling, p_.cancel, p_.form};
      Search at(problem, start_, w_);
      return (at.slope(v, by) - at.slope(v, -by)) / (2 * by);
    };
    for (const CoordinateInfo& info : p_.system.coordinates) {
      const Link& link = p_.system.links[static_cast<std::size_t>(info.link)];
      if (std::ranges::find(pushed_, link.v, &Pushed::v) == pushed_.end()) continue;
      if (link.type != LinkType::prismatic) return out.softened.clear();
      Softening& along = out.softened.emplace_back();
      along.held = stiffness(still, link.v);
      along.driven = along.held - stiffness(p_.parameters, link.v);
      if (!(along.held > tolerance::push_rounding * along.driven &&
            along.held < (1 + by_little) * along.driven))
        return out.softened.clear();
    }
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

} // namespace

Unbounded find_unbounded(const Problem& problem, const Eigen::VectorXd& start, Workspace& w) {
  return Search(problem, start, w).run();
}

} // namespace flyball
