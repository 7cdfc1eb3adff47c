#include "engine/equilibrium/all_equilibria.hpp"

#include "engine/equilibrium/find_equilibrium.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <numbers>
#include <random>

namespace flyball {
namespace {

// Squared scaled distance of two configurations, entry by entry of the tangent space.
template <class Visit>
void distances(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b, Visit visit) {
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical) {
      const double cosine = std::min(1., std::abs(a.segment<4>(link.q).dot(b.segment<4>(link.q))));
      visit(link.v, 3, 2 * std::acos(cosine));
      continue;
    }
    double d = a[link.q] - b[link.q];
    if (link.type == LinkType::revolute && !problem.parameters.links[l].elastic)
      d = std::remainder(d, 2 * std::numbers::pi);
    visit(link.v, 1, d / problem.scaling.column[link.v]);
  }
}

// The deflation operator prod_i (1 + 1 / |x - r_i|^2).
double deflation(const Problem& problem, const Eigen::VectorXd& q, const std::vector<Unknowns>& roots) {
  double product = 1;
  for (const Unknowns& root : roots) {
    double squared = 0;
    distances(problem, q, root.q, [&](int, int, double d) { squared += d * d; });
    product *= 1 + 1 / std::max(squared, 1e-30);
  }
  return product;
}

// Newton-Raphson on the balance times the deflation operator: the same direction, another length (Farrell et
// al., section 3.2).
bool deflated_newton(const Problem& problem, Unknowns& z, const std::vector<Unknowns>& roots, Workspace& w) {
  for (int i = 0; i < 60; ++i) {
    evaluate(problem, z, 0, w);
    if (!std::isfinite(scaled_residual(problem, w))) return false;
    factor(problem, z, w);
    if (problem.system.rows > 0) w.residual.f.noalias() -= w.linearization.constraint.transpose() * z.lambda;
    newton_step(problem, w.residual.f, w.residual.phi, w, w.scaled_step, z.lambda);
    const double size = w.scaled_step.size() > 0 ? w.scaled_step.lpNorm<Eigen::Infinity>() : 0;
    if (!std::isfinite(size) || size == 0) return false;
    // Directional derivative of the operator along the step, by a central difference.
    const double h = 1e-5 / std::max(1., size);
    double side[2];
    for (int k : {0, 1}) {
      w.moved = z.q;
      w.step = (k == 0 ? h : -h) * w.scaled_step.cwiseProduct(problem.scaling.column);
      retract<double>(problem.system, w.step, w.moved);
      side[k] = deflation(problem, w.moved, roots);
    }
    const double slope = (side[0] - side[1]) / (2 * h) / deflation(problem, z.q, roots);
    double length = 1 / (1 - slope);
    if (!std::isfinite(length)) return false;
    length = std::clamp(length, -2., 2.);
    length *= std::min(1., 1.5 / (std::abs(length) * size));
    w.step = length * w.scaled_step.cwiseProduct(problem.scaling.column);
    retract<double>(problem.system, w.step, z.q);
    if (size < 1e-3 && std::abs(slope) < 0.3) return true; // near a new one: plain Newton-Raphson finishes
  }
  return false;
}

} // namespace

bool same_pose(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance,
               const std::vector<int>& ignore) {
  bool same = true;
  distances(problem, a, b, [&](int v, int count, double d) {
    for (int i = v; i < v + count; ++i)
      if (std::ranges::find(ignore, i) != ignore.end()) return;
    if (std::abs(d) > tolerance) same = false;
  });
  return same;
}

Eigen::VectorXd scaled_difference(const Problem& problem, const Eigen::VectorXd& from,
                                  const Eigen::VectorXd& to) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(problem.system.nv);
  for (std::size_t l = 0; l < problem.system.links.size(); ++l) {
    const Link& link = problem.system.links[l];
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical) {
      const auto rotation = [&](const Eigen::VectorXd& q) {
        return Quat(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
      };
      out.segment<3>(link.v) = log_rotation<double>(rotation(to) * rotation(from).conjugate());
      continue;
    }
    double d = to[link.q] - from[link.q];
    if (link.type == LinkType::revolute && !problem.parameters.links[l].elastic)
      d = std::remainder(d, 2 * std::numbers::pi);
    out[link.v] = d / problem.scaling.column[link.v];
  }
  return out;
}

std::vector<SearchRange> search_ranges(const Problem& problem, const Eigen::VectorXd& drawn) {
  std::vector<SearchRange> ranges;
  for (const CoordinateInfo& c : problem.system.coordinates) {
    const Link& link = problem.system.links[static_cast<std::size_t>(c.link)];
    const LinkParameters& lp = problem.parameters.links[static_cast<std::size_t>(c.link)];
    const double value = coordinate_value(problem.system, problem.parameters, drawn, c);
    if (link.drive >= 0) {
      ranges.push_back({value, value});
      continue;
    }
    if (c.angle) {
      ranges.push_back({-std::numbers::pi, std::numbers::pi});
      continue;
    }
    const double reach = 2 * problem.parameters.length;
    SearchRange range{value - reach, value + reach};
    const CoordinateForce& f = lp.force[0];
    if (f.stiffness != 0)
      range = {std::min(range.lower, f.free - reach), std::max(range.upper, f.free + reach)};
    if (f.has_lower) range.lower = std::max(range.lower, f.lower - 0.1 * reach);
    if (f.has_upper) range.upper = std::min(range.upper, f.upper + 0.1 * reach);
    ranges.push_back(range);
  }
  return ranges;
}

EquilibriumList find_all_equilibria(const Problem& problem, const Eigen::VectorXd& drawn, unsigned seed,
                                    Workspace& w) {
  EquilibriumList list;
  list.report.ranges = search_ranges(problem, drawn);
  const System& system = problem.system;
  const auto keep = [&](Unknowns z) {
    const NewtonOutcome outcome = newton(problem, z, w, {}, nullptr);
    if (!outcome.converged || !closed_the_right_way(problem, w.kinematics)) return;
    for (std::size_t c = 0; c < system.coordinates.size();
         ++c) { // slides that left the range were not asked for
      const CoordinateInfo& info = system.coordinates[c];
      const double value = coordinate_value(system, problem.parameters, z.q, info);
      const SearchRange& r = list.report.ranges[c];
      if (!info.angle && (value < 2 * r.lower - r.upper || value > 2 * r.upper - r.lower)) return;
    }
    for (const Unknowns& known : list.states)
      if (same_pose(problem, known.q, z.q, 1e-6)) return;
    list.states.push_back(std::move(z));
    list.outcomes.push_back(outcome);
  };
  const auto run = [&](const Eigen::VectorXd& from) {
    ++list.report.starts;
    Unknowns z{from, Eigen::VectorXd::Zero(system.rows)};
    if (const NewtonOutcome plain = newton(problem, z, w, {}, nullptr); plain.converged)
      return keep(std::move(z));
    z = {from, Eigen::VectorXd::Zero(system.rows)};
    if (newton(problem, z, w, {100, true}, nullptr).converged) keep(std::move(z));
  };
  const auto deflate = [&](const Eigen::VectorXd& from) {
    for (int i = 0; i < 8 && !problem.cancelled(); ++i) {
      ++list.report.starts;
      Unknowns z{from, Eigen::VectorXd::Zero(system.rows)};
      if (!list.states.empty() && same_pose(problem, from, list.states.back().q, 1e-9)) {
        w.step = Eigen::VectorXd::Constant(system.nv, 0.01).cwiseProduct(problem.scaling.column);
        retract<double>(system, w.step, z.q);
      }
      const std::size_t before = list.states.size();
      if (deflated_newton(problem, z, list.states, w)) keep(std::move(z));
      if (list.states.size() == before) return;
    }
  };

  run(drawn);
  deflate(drawn);
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * (static_cast<double>(random()) / 4294967296.);
  };
  const int starts = system.nv == 0 ? 0 : std::min(60 + 30 * system.nv, 600);
  for (int i = 0; i < starts && !problem.cancelled(); ++i) {
    Eigen::VectorXd q = drawn;
    for (std::size_t c = 0; c < system.coordinates.size(); ++c)
      set_coordinate(system, problem.parameters, system.coordinates[c],
                     uniform(list.report.ranges[c].lower, list.report.ranges[c].upper), q);
    if (!assemble(problem, q, 0, w)) continue;
    run(q);
  }
  for (std::size_t i = 0; i < list.states.size() && i < 64 && !problem.cancelled(); ++i)
    deflate(Eigen::VectorXd(list.states[i].q));
  return list;
}

} // namespace flyball
