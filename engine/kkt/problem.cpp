#include "engine/kkt/problem.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double small_rate =
    1e-3; // of the fastest: what an implied rate begins with tells nothing of its size

double speed_unit(const Link& link, const Parameters& p, double begins) {
  return begins != 0 ? std::abs(begins) : link.type == LinkType::prismatic ? p.length : 1;
}

// With begins(l): at which speed the search for that of link l begins.
template <class Begins>
void scale(const System& system, const Parameters& p, const Begins& begins, Scaling& out) {
  out.column.resize(system.nv);
  out.row.resize(system.rows);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0) continue;
    if (finds_speed(link))
      out.column[link.v] = speed_unit(link, p, begins(l));
    else if (link.type == LinkType::spherical)
      out.column.segment<3>(link.v).setOnes();
    else
      out.column[link.v] = link.type == LinkType::revolute ? 1 : p.length;
  }
  // A rate that loops and gears give may be small at first, as that of a planet whose neighbours begin alike:
  // that is not its size.
  double fastest_drive = 0;
  for (const DriveTorqueElement& torque : system.torques)
    fastest_drive = std::max(fastest_drive, std::abs(begins(static_cast<std::size_t>(torque.link))));
  for (const DriveTorqueElement& torque : system.torques) {
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    if (torque.implied && finds_speed(link) && link.type == LinkType::revolute &&
        out.column[link.v] < small_rate * fastest_drive)
      out.column[link.v] = fastest_drive;
  }
  for (const CutJoint& cut : system.cuts)
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      double scale = 1;
      switch (cut.rows[r].type) {
      case RowType::point:
      case RowType::distance: scale = 1 / p.length; break;
      case RowType::direction: break;
      case RowType::gear:
        scale = 1 / std::max(out.column[cut.gear_vb],
                             std::abs(p.cuts[static_cast<std::size_t>(&cut - system.cuts.data())].ratio) *
                                 out.column[cut.gear_va]);
        break;
      }
      if (cut.by_rates && cut.type != JointType::gear) {
        double fastest = 0;
        for (const SupportColumn& column : cut.ends.support)
          fastest = std::max(fastest, out.column[column.v]);
        scale /= fastest;
      }
      out.row[cut.first_row + static_cast<int>(r)] = scale;
    }
}

} // namespace

double found_speed_unit(const System& system, const Parameters& p, const Link& link) {
  return speed_unit(link, p, p.links[static_cast<std::size_t>(&link - system.links.data())].speed);
}

double largest_found_speed(const Problem& problem, const Link& link) {
  return 1e8 * problem.scaling.column[link.v];
}

void set_scaling(const System& system, const Parameters& p, Scaling& out) {
  scale(
      system, p, [&](std::size_t l) { return p.links[l].speed; }, out);
}

Scaling motion_scaling(const Problem& problem) {
  const System& system = problem.system;
  if (system.torques.empty()) return problem.scaling;
  Scaling out;
  scale(
      system, problem.parameters,
      [&](std::size_t l) { return finds_speed(system.links[l]) ? 0 : problem.parameters.links[l].speed; },
      out);
  return out;
}

double rank_tolerance(const Problem& problem, const Eigen::VectorXd& phi) {
  const double open = phi.size() > 0 ? phi.cwiseProduct(problem.scaling.row).lpNorm<Eigen::Infinity>() : 0;
  return std::clamp(10 * open, 1e-10, 1e-3);
}

} // namespace flyball
