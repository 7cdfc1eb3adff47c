#include "engine/system/implied_rates.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/linearization.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

bool has_one_axis(const Link& link) {
  return link.type == LinkType::revolute || link.type == LinkType::prismatic;
}

// 1/m or 1: rows of points and lengths by the reach.
double per_unit(const ConstraintRow& row, const Parameters& p) {
  return row.type == RowType::point || row.type == RowType::distance ? 1 / p.length : 1;
}

// What springs and stops hold may move as well, or stands still.
enum class Elastic { moves, stands };

// In the drawn pose: the rates of q_R and the speeds that are found (rad/s or m/s) at which no loop opens,
// with drives by torque as near as can be to where their search begins, and all else moving as little as can
// be. Nothing where the loops cannot stay closed.
std::optional<Eigen::VectorXd> closing_rates(const System& system, const Parameters& p,
                                             Elastic elastic = Elastic::moves) {
  Eigen::VectorXd q;
  drawn_configuration(system, p, q);
  Kinematics<double> k;
  forward<double>(system, p, q, 0, k);
  const double fastest = fastest_given_rate(system, p);
  constexpr double stiff = 1e-3; // of what a drive gives the speed of
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(system.nv), scale = Eigen::VectorXd::Ones(system.nv);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0) continue;
    if (link.type == LinkType::prismatic) scale[link.v] = p.length;
    if (elastic == Elastic::stands && p.links[l].elastic && !finds_speed(link))
      scale.segment(link.v, link.type == LinkType::spherical ? 3 : 1).setZero();
    if (!finds_speed(link)) continue;
    rates[link.v] = p.links[l].speed;
    if (rates[link.v] != 0) scale[link.v] *= stiff;
  }
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(system.rows, system.nv);
  Eigen::VectorXd open(system.rows);
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const Eigen::Index row = cut.first_row + static_cast<Eigen::Index>(r);
      const double unit = per_unit(cut.rows[r], p);
      row_gradient(cut, p.cuts[c], cut.rows[r], k, [&](int v, double g) { gradient(row, v) += unit * g; });
      open[row] = cut.type == JointType::gear ? rates[cut.gear_vb] - p.cuts[c].ratio * rates[cut.gear_va]
                                              : unit * row_rate<double>(cut, p.cuts[c], cut.rows[r], q, k);
    }
  }
  gradient *= scale.asDiagonal();
  const auto change = least_squares(gradient, -open);
  if (!change) return {};
  if ((gradient * *change + open).lpNorm<Eigen::Infinity>() > 1e-9 * fastest) return {};
  rates += change->cwiseProduct(scale);
  for (Eigen::Index v = 0; v < system.nv; ++v)
    if (std::abs(rates[v]) <= 1e-9 * fastest * scale[v]) rates[v] = 0;
  return rates;
}

} // namespace

std::vector<CoordinateReference> implied_turning(const System& system, const Parameters& p, bool beside) {
  std::vector<CoordinateReference> out;
  if (system.rows == 0) return out;
  const auto rates = closing_rates(system, p, Elastic::stands);
  if (!rates) return out;
  std::vector<bool> turns(static_cast<std::size_t>(system.nv));
  std::vector<bool> may(static_cast<std::size_t>(system.nv));
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0) continue;
    const int entries = link.type == LinkType::spherical ? 3 : 1;
    for (int v = link.v; v < link.v + entries; ++v)
      turns[static_cast<std::size_t>(v)] = finds_speed(link) || (*rates)[v] != 0;
    may[static_cast<std::size_t>(link.v)] = link.type == LinkType::revolute && !p.links[l].elastic;
  }
  for (bool more = beside; more;) {
    more = false;
    for (const CutJoint& cut : system.cuts) {
      std::vector<int> tied{cut.gear_va, cut.gear_vb};
      if (cut.type != JointType::gear) {
        tied.clear();
        for (const SupportColumn& column : cut.ends.support)
          tied.push_back(column.v);
      }
      const auto is_turning = [&](int v) { return turns[static_cast<std::size_t>(v)]; };
      if (std::ranges::none_of(tied, is_turning)) continue;
      for (const int v : tied)
        if (const auto i = static_cast<std::size_t>(v); may[i] && !turns[i]) turns[i] = more = true;
    }
  }
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0 || finds_speed(link) || !turns[static_cast<std::size_t>(link.v)]) continue;
    const int joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint;
    if (joint < 0 || !has_one_axis(link) || p.links[l].elastic) return {};
    out.push_back({joint, link.coordinate});
  }
  return out;
}

bool loops_turn_with_drives(const System& system, const Parameters& p) {
  const auto rates = closing_rates(system, p, Elastic::stands);
  if (!rates) return false;
  if (fastest_given_rate(system, p) == 0) return false;
  Eigen::VectorXd step = *rates, drawn;
  drawn_configuration(system, p, drawn);
  for (const Link& link : system.links)
    if (finds_speed(link)) {
      drawn[link.q] = (*rates)[link.v];
      step[link.v] = 0;
    }
  Kinematics<double> k;
  Eigen::VectorXd phi = Eigen::VectorXd::Zero(system.rows), first;
  const std::vector<DriveRate> turning = drive_rates(system, p, drawn);
  std::vector<double> times = phase_times(turning);
  times.insert(times.begin(), 0);
  for (const double time : times) {
    Eigen::VectorXd q = drawn;
    retract<double>(system, time * step, q);
    forward<double>(system, p, q, time, k);
    for (std::size_t c = 0; c < system.cuts.size(); ++c) {
      const CutJoint& cut = system.cuts[c];
      for (std::size_t r = 0; r < cut.rows.size() && cut.type != JointType::gear; ++r)
        phi[cut.first_row + static_cast<int>(r)] =
            per_unit(cut.rows[r], p) * row_value<double>(cut, p.cuts[c], cut.rows[r], q, k);
    }
    if (first.size() == 0) first = phi;
    if ((phi - first).lpNorm<Eigen::Infinity>() > 1e-6 + 4 * angle_rounding(turning, time)) return false;
  }
  return true;
}

std::vector<CoordinateReference> slipping_turning(const System& system, const Parameters& p) {
  std::vector<CoordinateReference> out;
  std::vector<std::size_t> may; // links
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v >= 0 && !finds_speed(link) && link.type == LinkType::revolute && !p.links[l].elastic &&
        system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint >= 0)
      may.push_back(l);
  }
  const auto count = static_cast<Eigen::Index>(may.size());
  if (count == 0) return out;
  const auto entry = [&](Eigen::Index i) { return system.links[may[static_cast<std::size_t>(i)]].v; };
  Eigen::VectorXd q;
  drawn_configuration(system, p, q);
  Kinematics<double> k;
  Residual<double> residual;
  const Eigen::VectorXd no_lambda = Eigen::VectorXd::Zero(system.rows);
  const auto evaluate_at = [&](const Eigen::VectorXd& moved) {
    forward<double>(system, p, moved, 0, k);
    evaluate_residual<double>(system, p, moved, no_lambda, k, residual);
  };
  evaluate_at(q);
  const Eigen::VectorXd phi = residual.phi;
  Eigen::VectorXd units(system.rows);
  for (const CutJoint& cut : system.cuts)
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      units[cut.first_row + static_cast<int>(r)] = per_unit(cut.rows[r], p);
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(count, count);
  if (system.rows > 0) {
    Linearization l;
    linearize_constraints(system, p, k, l);
    Eigen::MatrixXd own(system.rows, count);
    for (Eigen::Index i = 0; i < count; ++i)
      own.col(i) = l.constraint.col(entry(i));
    const auto kernel = null_space(own);
    if (!kernel || kernel->cols() == 0) return out;
    basis = *kernel;
  }
  Magnitudes sizes;
  evaluate_magnitudes(system, p, q, no_lambda, k, sizes);
  const auto push = [&] {
    Eigen::VectorXd f(count);
    for (Eigen::Index i = 0; i < count; ++i)
      f[i] = residual.f[entry(i)];
    return Eigen::VectorXd(basis.transpose() * f);
  };
  const Eigen::VectorXd pushed = push();
  double size = 0;
  for (Eigen::Index i = 0; i < count; ++i)
    size = std::max(size, sizes.force[entry(i)]);
  if (!(pushed.norm() > 1e-6 * size)) return out;
  const Eigen::VectorXd along = basis * pushed.normalized();
  for (const double far : {0.3, -1.1, 2.3}) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(system.nv), moved = q;
    for (Eigen::Index i = 0; i < count; ++i)
      step[entry(i)] = far * along[i];
    retract<double>(system, step, moved);
    evaluate_at(moved);
    if ((push() - pushed).norm() > 1e-9 * (size + pushed.norm())) return out;
    if (phi.size() > 0 && (residual.phi - phi).cwiseProduct(units).lpNorm<Eigen::Infinity>() > 1e-9)
      return out;
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const Link& link = system.links[may[static_cast<std::size_t>(i)]];
    if (std::abs(along[i]) > 1e-9)
      out.push_back({system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint, link.coordinate});
  }
  return out;
}

void set_implied_rates(const System& system, Parameters& p) {
  if (std::ranges::none_of(system.torques, &DriveTorqueElement::implied)) return;
  const auto rates = closing_rates(system, p);
  for (const DriveTorqueElement& torque : system.torques)
    if (const Link& link = system.links[static_cast<std::size_t>(torque.link)];
        torque.implied && finds_speed(link) && rates)
      p.links[static_cast<std::size_t>(torque.link)].speed = (*rates)[link.v];
}

void set_closing_rates(const System& system, Parameters& p) {
  if (system.torques.empty()) return;
  auto rates = closing_rates(system, p, Elastic::stands);
  if (!rates) rates = closing_rates(system, p);
  for (std::size_t l = 0; l < system.links.size() && rates; ++l)
    if (const Link& link = system.links[l]; finds_speed(link)) p.links[l].speed = (*rates)[link.v];
}

void set_closures(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                  const Kinematics<double>& k, Eigen::VectorXd& phi) {
  for (std::size_t i = 0; i < system.cuts.size(); ++i) {
    const CutJoint& cut = system.cuts[i];
    if (!cut.by_rates) continue;
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      phi[cut.first_row + static_cast<int>(r)] =
          cut.type == JointType::gear ? 0 : row_value<double>(cut, p.cuts[i], cut.rows[r], q, k);
  }
}

} // namespace flyball
